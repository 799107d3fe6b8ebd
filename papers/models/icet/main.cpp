// SPDX-License-Identifier: BSD-3-Clause
// A program for mpirun: pictures of parts by MPI processes, beside IceT's radix-k on the same
// ranks' pictures in the same run. For opaque surfaces all must have the bits of one renderer. For
// translucent ones IceT blends whole pictures in one order of ranks, so its error is shown: for
// parts in slabs, where one order is right, and for interleaved parts, where none is.
//   mpirun -n 8 rastrum-bench-icet [rounds] [triangles] [width height]
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <IceT.h>
#include <IceTMPI.h>

#include <rastrum/camera.hpp>
#include <rastrum/mpi/mpi_ranks.hpp>
#include <rastrum/shapes.hpp>

#include "bench/ranks.hpp"

namespace rastrum::bench {
namespace {

struct Setting {
  int rank = 0, size = 1, rounds = 5;
  FrameOptions frame;
  Camera camera;
  SceneView all, own;
  std::vector<std::uint64_t> numbers;  ///< of the parts in `own`
  std::vector<InstanceView> instances;
};

/// IceT with float colours, sequential strategy, radix-k, the picture at rank 0.
class IceT {
 public:
  IceT(const Setting& s, bool blends)
      : setting_(s),
        communicator_(icetCreateMPICommunicator(MPI_COMM_WORLD)),
        context_(icetCreateContext(communicator_)),
        color_(s.frame.width, s.frame.height),
        depth_(s.frame.width, s.frame.height),
        blends_(blends) {
    icetSetContext(context_);
    icetResetTiles();
    icetAddTile(0, 0, s.frame.width, s.frame.height, 0);
    icetStrategy(ICET_STRATEGY_SEQUENTIAL);
    icetSingleImageStrategy(ICET_SINGLE_IMAGE_STRATEGY_RADIXK);
    icetSetColorFormat(ICET_IMAGE_COLOR_RGBA_FLOAT);
    icetSetDepthFormat(blends ? ICET_IMAGE_DEPTH_NONE : ICET_IMAGE_DEPTH_FLOAT);
    icetCompositeMode(blends ? ICET_COMPOSITE_MODE_BLEND : ICET_COMPOSITE_MODE_Z_BUFFER);
    if (!blends) return;
    icetEnable(ICET_ORDERED_COMPOSITE);
    // The camera looks along falling x, against the slabs' numbers, so the last rank is the
    // nearest.
    std::vector<IceTInt> order;
    for (int r = s.size; r-- > 0;) order.push_back(r);
    icetCompositeOrder(order.data());
  }
  IceT(const IceT&) = delete;
  IceT& operator=(const IceT&) = delete;
  ~IceT() {
    icetDestroyContext(context_);
    icetDestroyMPICommunicator(communicator_);
  }

  /// The picture at rank 0. `composite_ms` is the time of IceT's call alone.
  const float* draw(Renderer& renderer, double& composite_ms) {
    Targets targets{.color = color_};
    if (!blends_) targets.depth = depth_;
    (void)renderer.render(setting_.own, setting_.camera, setting_.frame, targets);
    // Nearer is greater here and smaller in IceT, where 1 is empty. Changing the sign is exact.
    for (float& d : depth_.pixels()) d = d == 0 ? 1.0F : -d;
    icetSetContext(context_);
    const double begin = MPI_Wtime();
    const std::vector<IceTFloat> nothing(4);
    const IceTImage image =
        icetCompositeImage(color_.pixels().data(), blends_ ? nullptr : depth_.pixels().data(),
                           nullptr, nullptr, nullptr, nothing.data());
    composite_ms = (MPI_Wtime() - begin) * 1e3;
    return setting_.rank == 0 ? icetImageGetColorcf(image) : nullptr;
  }

 private:
  const Setting& setting_;
  IceTCommunicator communicator_;
  IceTContext context_;
  Image<Vec4> color_;
  Image<float> depth_;
  bool blends_;
};

struct Difference {
  std::size_t pixels = 0;
  double most = 0, mean = 0;  ///< of a channel
};

/// Compares premultiplied colours, four floats a pixel.
Difference difference(const Image<Vec4>& right, const float* color) {
  Difference d;
  std::size_t i = 0;
  for (const Vec4& p : right.pixels()) {
    const float of_p[] = {p.x, p.y, p.z, p.w};
    bool same = true;
    for (const float expected : of_p) {
      const float got = color[i++];
      same = same && std::bit_cast<std::uint32_t>(got) == std::bit_cast<std::uint32_t>(expected);
      const double off = std::abs(static_cast<double>(got) - static_cast<double>(expected));
      d.most = std::max(d.most, off);
      d.mean += off;
    }
    d.pixels += same ? 0 : 1;
  }
  d.mean /= static_cast<double>(i);
  return d;
}

struct Form {
  std::string name;
  std::function<const float*(double&)> draw;
  std::vector<double> frame_ms, composite_ms;
};

double median(std::vector<double> v) {
  std::ranges::sort(v);
  return v.empty() ? 0 : v[v.size() / 2];
}

/// One table: all forms take turns. A frame ends when rank 0 has its picture.
bool compare(Setting& s, const char* title, bool translucent) {
  s.frame.opacity = translucent ? 0.3F : 1;
  s.own.instances = s.instances;
  Renderer renderer({.threads = 1});
  Image<Vec4> expected(s.frame.width, s.frame.height), ours(s.frame.width, s.frame.height);
  if (s.rank == 0) (void)renderer.render(s.all, s.camera, s.frame, {.color = expected});
  IceT icet(s, translucent);
  std::vector<Form> forms;
  std::vector<std::pair<const char*, WordExchange>> exchanges{
      {"ours, sparse", WordExchange::sparse}, {"ours, two hops", WordExchange::two_hops}};
  for (const auto& [name, exchange] : exchanges) {
    RanksOptions options;
    options.exchange = exchange;
    forms.push_back({name,
                     [&, options](double&) -> const float* {
                       (void)mpi::render(MPI_COMM_WORLD, renderer, s.own, s.numbers, s.camera,
                                         s.frame, s.rank == 0 ? Targets{.color = ours} : Targets{},
                                         options);
                       return &ours.pixels()[0].x;
                     },
                     {},
                     {}});
  }
  forms.push_back({"IceT, radix-k", [&](double& ms) { return icet.draw(renderer, ms); }, {}, {}});
  bool right = true;
  std::vector<Difference> differences;
  for (Form& form : forms) {
    double ms = 0;
    const float* const color = form.draw(ms);
    if (s.rank != 0) continue;
    differences.push_back(difference(expected, color));
    if (form.name.starts_with("ours")) right = right && differences.back().pixels == 0;
  }
  for (int round = 0; round < s.rounds; ++round)
    for (Form& form : forms) {
      MPI_Barrier(MPI_COMM_WORLD);
      const double begin = MPI_Wtime();
      double ms = 0;
      (void)form.draw(ms);
      form.frame_ms.push_back((MPI_Wtime() - begin) * 1e3);
      if (ms > 0) form.composite_ms.push_back(ms);
    }
  if (s.rank != 0) return true;
  std::printf(
      "\n%s, %d ranks\n\n| | frame ms | of it compositing | pixels that differ | most | mean |\n"
      "|---|--:|--:|--:|--:|--:|\n",
      title, s.size);
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const Difference& d = differences[i];
    std::printf("| %s | %.2f | ", forms[i].name.c_str(), median(forms[i].frame_ms));
    if (!forms[i].composite_ms.empty()) std::printf("%.2f", median(forms[i].composite_ms));
    std::printf(" | %zu | %.3g | %.3g |\n", d.pixels, d.most, d.mean);
  }
  return right;
}

int run(int argc, char** argv) {
  Setting s;
  MPI_Comm_rank(MPI_COMM_WORLD, &s.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &s.size);
  const auto number = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  s.rounds = number(1, 5);
  const double triangles = number(2, 600'000);
  s.frame.width = number(3, 1280);
  s.frame.height = number(4, 720);
  s.frame.shader = Shader::lambert;
  s.frame.background = {0, 0, 0, 0};
  const Mesh whole = shapes::gyroid(std::max(8, static_cast<int>(std::sqrt(triangles / 14))));
  const Slabs slabs(whole, 48);
  s.all.instances = slabs.parts;
  s.camera = fit_camera(s.all, 1.0472F, false, {-1, -0.7, -0.5});
  const auto deal = [&](bool interleaved) {
    s.numbers.clear();
    s.instances.clear();
    const auto n = static_cast<std::size_t>(s.size), me = static_cast<std::size_t>(s.rank);
    for (std::size_t p = 0; p < slabs.parts.size(); ++p)
      if ((interleaved ? p % n : p * n / slabs.parts.size()) == me) {
        s.numbers.push_back(p);
        s.instances.push_back(slabs.parts[p]);
      }
  };
  if (s.rank == 0)
    std::printf("%zu triangles in 48 slabs, %d x %d, float colours, one thread a rank\n",
                slabs.triangles, s.frame.width, s.frame.height);
  deal(false);
  bool right = compare(s, "Opaque, slabs", false);
  right = compare(s, "Opacity 0.3, slabs", true) && right;
  deal(true);
  right = compare(s, "Opaque, interleaved slabs", false) && right;
  right = compare(s, "Opacity 0.3, interleaved slabs", true) && right;
  if (!right) std::fprintf(stderr, "a picture of ours is wrong\n");
  return right ? 0 : 1;
}

}  // namespace
}  // namespace rastrum::bench

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const int result = rastrum::bench::run(argc, argv);
  MPI_Finalize();
  return result;
}
