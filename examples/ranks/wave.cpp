// A simulation that draws itself where its pieces lie: waves on a membrane that go through two
// slits and meet behind them. Each rank of MPI has a strip of the membrane (finite differences,
// leapfrog in time, halos of one row); every so many steps all of them draw one picture of the
// nodes that the solver itself computes with, without a copy of them. Each node is computed by the
// same operations in the same order on whichever rank, so one rank and many write the same files.
//
// usage: mpirun -n 4 wave [CELLS [STEPS [EVERY [PREFIX [WIDTH HEIGHT]]]]], as in wave 400 900 150
// wave_
#include <cstdio>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <mpi.h>

#include <rastrum/io.hpp>
#include <rastrum/mpi/mpi_ranks.hpp>

using rastrum::Mat4d, rastrum::Vec3;

constexpr double kAmplitude = 0.02, kWavelength = 0.09;
constexpr double kWall = 0.4, kThickness = 0.02;  // along z
constexpr double kSlits[] = {0.36, 0.64}, kSlit = 0.045;

/// A node as it is drawn: its place in the plane, and how high it is.
struct Node {
  double x, height, z;
};

/// Rows of cells [first, last) of n × n on the unit square, and their nodes.
class Membrane {
 public:
  Membrane(MPI_Comm comm, int n) : comm_(comm), n_(n) {
    int rank = 0, size = 0;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &size);
    if (n < size) throw std::invalid_argument("there are more ranks than rows of cells");
    first_ = static_cast<int>(static_cast<long long>(n) * rank / size);
    last_ = static_cast<int>(static_cast<long long>(n) * (rank + 1) / size);
    below_ = rank > 0 ? rank - 1 : MPI_PROC_NULL;
    above_ = rank + 1 < size ? rank + 1 : MPI_PROC_NULL;
    MPI_Type_vector(n + 1, 1, 3, MPI_DOUBLE, &heights_);
    MPI_Type_commit(&heights_);
    // The nodes of both sides of the strip, and a halo beyond each.
    for (int row = first_ - 1; row <= last_ + 1; ++row)
      for (int i = 0; i <= n; ++i)
        now_.push_back({static_cast<double>(i) / n, 0, static_cast<double>(row) / n});
    before_ = now_;
    normals_.resize(static_cast<std::size_t>((last_ - first_ + 1) * (n + 1)));
    for (int row = 0; row < last_ - first_; ++row)
      for (int i = 0; i < n; ++i) {
        const int a = row * (n + 1) + i, b = a + n + 1;
        for (const int node : {a, b, a + 1, a + 1, b, b + 1}) triangles_.push_back(node);
      }
  }
  ~Membrane() { MPI_Type_free(&heights_); }
  Membrane(const Membrane&) = delete;
  Membrane& operator=(const Membrane&) = delete;

  /// Half a cell's width of a wave's way.
  void step() {
    ++steps_;
    for (int row = first_; row <= last_; ++row) {
      Node* const next = at(before_, row);
      const Node* const here = at(now_, row);
      if (row == 0) {  // where the waves come from
        for (int i = 0; i <= n_; ++i)
          next[i].height = source(static_cast<double>(steps_) * 0.5 / n_ / kWavelength);
      } else if (row < n_) {
        const Node *const lower = at(now_, row - 1), *const upper = at(now_, row + 1);
        for (int i = 1; i < n_; ++i) {
          if (is_wall(here[i])) continue;
          const double h = here[i].height;
          const double around =
              (here[i - 1].height + here[i + 1].height) + (lower[i].height + upper[i].height);
          next[i].height = (2 * h - next[i].height) + 0.25 * (around - 4 * h);
        }
      }
    }
    now_.swap(before_);
    exchange(first_ + 1, below_, last_ + 1, above_);
    exchange(last_ - 1, above_, first_ - 1, below_);
  }

  /// The solver's own nodes; normals are of their slopes, across the cuts between ranks.
  [[nodiscard]] rastrum::MeshView view() {
    std::size_t k = 0;
    for (int row = first_; row <= last_; ++row)
      for (int i = 0; i <= n_; ++i) {
        const auto height = [&](int x, int y) {
          return at(now_, y < 0 ? 0 : y > n_ ? n_ : y)[x < 0 ? 0 : x > n_ ? n_ : x].height;
        };
        const double along_x = (height(i + 1, row) - height(i - 1, row)) * n_ / 2;
        const double along_z = (height(i, row + 1) - height(i, row - 1)) * n_ / 2;
        normals_[k++] = Vec3(rastrum::Vec3d{-along_x, 1, -along_z});
      }
    const Node* const nodes = at(now_, first_);
    rastrum::MeshView mesh;
    mesh.positions = rastrum::ArrayView<Vec3>::of(&nodes->x, normals_.size());
    mesh.normals.values = normals_;
    mesh.indices = triangles_;
    mesh.scalars.values = rastrum::ScalarView::of(&nodes->height, normals_.size(), sizeof(Node));
    return mesh;
  }

 private:
  [[nodiscard]] Node* at(std::vector<Node>& nodes, int row) const {
    return nodes.data() +
           static_cast<std::size_t>(row - first_ + 1) * (static_cast<std::size_t>(n_) + 1);
  }
  /// A row goes to one neighbour, and one comes from the other.
  void exchange(int sent, int to, int received, int from) {
    MPI_Sendrecv(&at(now_, sent)->height, 1, heights_, to, 0, &at(now_, received)->height, 1,
                 heights_, from, 0, comm_, MPI_STATUS_IGNORE);
  }
  /// As a sine, made of parabolas; for five periods.
  static double source(double periods) {
    if (periods >= 5) return 0;
    const double part = periods - static_cast<double>(static_cast<long long>(periods));
    const double half = part < 0.5 ? 2 * part : 2 * part - 1;
    return (part < 0.5 ? 4 : -4) * half * (1 - half) * kAmplitude;
  }
  static bool is_wall(const Node& node) {
    if (node.z < kWall || node.z > kWall + kThickness) return false;
    for (const double slit : kSlits)
      if (node.x > slit - kSlit / 2 && node.x < slit + kSlit / 2) return false;
    return true;
  }

  MPI_Comm comm_;
  int n_, first_ = 0, last_ = 0, below_ = 0, above_ = 0;
  long long steps_ = 0;
  MPI_Datatype heights_ = MPI_DATATYPE_NULL;
  std::vector<Node> now_, before_;
  std::vector<Vec3> normals_;
  std::vector<std::int32_t> triangles_;
};

/// The walls between the slits: [0, 1]³, placed.
struct Walls {
  std::vector<Vec3> corners;
  std::vector<std::uint32_t> triangles{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  rastrum::MeshView box;
  Walls() {
    for (int i = 0; i < 8; ++i)
      corners.push_back(
          {static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2)});
    box.positions = corners;
    box.indices = triangles;
  }
  void add_to(std::vector<rastrum::InstanceView>& instances) const {
    double x = 0;
    for (const double end : {kSlits[0] - kSlit / 2, kSlits[1] - kSlit / 2, 1.0}) {
      rastrum::InstanceView wall{.geometry = box, .color = rastrum::Vec4{0.35F, 0.3F, 0.28F, 1}};
      wall.object_to_world =
          Mat4d{{{end - x, 0, 0, x}, {0, 0.06, 0, -0.03}, {0, 0, kThickness, kWall}, {0, 0, 0, 1}}};
      instances.push_back(wall);
      x = end + kSlit;
    }
  }
};

int run(std::span<char* const> arguments) {
  const auto number = [&](std::size_t i, int otherwise) {
    return i < arguments.size() ? std::atoi(arguments[i]) : otherwise;
  };
  const int cells = number(1, 400), steps = number(2, 900), every = number(3, 150);
  const std::string prefix = arguments.size() > 4 ? arguments[4] : "wave_";
  const int width = number(5, 1280), height = number(6, 720);
  if (cells < 2 || every < 1) throw std::invalid_argument("too few cells or steps");

  int rank = 0, size = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  Membrane membrane(MPI_COMM_WORLD, cells);
  const Walls walls;
  // Kept: threads, scratch and a communicator of their own.
  rastrum::Renderer renderer({.threads = 1});
  rastrum::mpi::MpiRanks ranks(MPI_COMM_WORLD);

  rastrum::ScalarMapping colors{.map = rastrum::color_map("coolwarm")};
  colors.range = {-1.5 * kAmplitude, 1.5 * kAmplitude};
  const rastrum::Camera camera{
      .eye = {1.2, 0.85, 1.8}, .target = {0.5, -0.05, 0.52}, .fov_rad = 0.56F};
  rastrum::FrameOptions frame{.width = width, .height = height};
  frame.background = {0.06F, 0.07F, 0.09F, 1};
  frame.samples = 4;
  frame.lights = {{.kind = rastrum::AmbientLight{}, .intensity = 0.3F},
                  {.kind = rastrum::DirectionalLight{{-0.8F, -0.45F, 0.35F}}, .intensity = 0.9F}};
  frame.shadows = true;
  rastrum::Image<rastrum::Rgba8> picture;
  if (rank == 0) picture = {width, height};

  double solved_s = 0, drawn_s = 0;
  for (int step = 1; step <= steps; ++step) {
    const double begin = MPI_Wtime();
    membrane.step();
    solved_s += MPI_Wtime() - begin;
    if (step % every != 0) continue;
    const double drawing = MPI_Wtime();
    // Strips are parts 0 to size − 1, in the order of one rank's triangles; walls come behind.
    const rastrum::MeshView strip = membrane.view();
    std::vector<rastrum::InstanceView> instances{{strip}};
    std::vector<std::uint64_t> parts{static_cast<std::uint64_t>(rank)};
    if (rank == 0) walls.add_to(instances);
    while (parts.size() < instances.size())
      parts.push_back(static_cast<std::uint64_t>(size) + parts.size());
    rastrum::SceneView scene;
    scene.instances = instances;
    scene.scalar_mappings = {&colors, 1};
    rastrum::Targets targets;
    if (rank == 0) targets.color8 = picture;
    (void)rastrum::render_parts(ranks, renderer, scene, parts, camera, frame, targets);
    drawn_s += MPI_Wtime() - drawing;
    if (rank != 0) continue;
    char name[32];
    std::snprintf(name, sizeof name, "%05d.png", step);
    rastrum::io::write_png(prefix + name, picture);
  }
  if (rank == 0)
    std::printf("%d ranks, %d x %d cells: %.2f ms a step, %.0f ms a picture\n", size, cells, cells,
                1000 * solved_s / steps, 1000 * drawn_s / (steps / every > 0 ? steps / every : 1));
  return 0;
}

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int status = 1;
  try {
    status = run({argv, static_cast<std::size_t>(argc)});
  } catch (const std::exception& e) {
    // If a picture fails, all ranks throw alike. If only one throws, the job ends for all.
    std::fprintf(stderr, "wave: %s\n", e.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
  return status;
}
