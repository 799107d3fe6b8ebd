// SPDX-License-Identifier: BSD-3-Clause
// Prepared meshes give the same bits as unprepared ones.
#include <rastrum/prepared_mesh.hpp>

#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene/mesh_clusters.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::prepared_test {
namespace {

void expect_equal(const Frame& plain, const Frame& prepared) {
  EXPECT_TRUE(same_images(plain, prepared));
  EXPECT_EQ(plain.stats.triangles.input, prepared.stats.triangles.input);
  EXPECT_EQ(plain.stats.triangles.dropped, prepared.stats.triangles.dropped);
  EXPECT_EQ(plain.stats.triangles.clipped, prepared.stats.triangles.clipped);
  EXPECT_EQ(plain.stats.pixels_covered, prepared.stats.pixels_covered);
}

constexpr const char* kOutside = "triangles of clusters outside";
constexpr const char* kAway = "triangles of clusters that face away";
constexpr const char* kHidden = "triangles of hidden clusters";

/// Sums of the frames' counters, which show that something was left out.
class LeftOut {
 public:
  void add(const FrameStats& stats) {
    for (const auto& [name, value] : stats.counters) sum_[name] += value;
  }
  [[nodiscard]] std::uint64_t operator[](const char* name) const {
    const auto found = sum_.find(name);
    return found == sum_.end() ? 0 : found->second;
  }

 private:
  std::map<std::string, std::uint64_t> sum_;
};

/// A scene whose meshes have small clusters even if the meshes are small.
class SmallClusters {
 public:
  SmallClusters(const SceneView& scene, std::uint32_t triangles)
      : instances_(scene.instances.begin(), scene.instances.end()), view_(scene) {
    for (InstanceView& i : instances_)
      if (i.mesh() != nullptr) {
        try {
          check_indices(*i.mesh());
        } catch (const Error&) {
          continue;
        }
        MeshView& mesh = meshes_.emplace_back(*i.mesh());
        mesh.clusters = &clusters_.emplace_back(mesh, nullptr, MeshClusters::Way{triangles, true});
        i.geometry = mesh;
      }
    view_.instances = instances_;
  }
  [[nodiscard]] const SceneView& view() const { return view_; }

 private:
  std::deque<MeshClusters> clusters_;
  std::deque<MeshView> meshes_;
  std::vector<InstanceView> instances_;
  SceneView view_;
};

/// Layers of grids in front of each other, in tiles of either facing, some behind all others.
Scene layers(Random& r) {
  Mesh mesh;
  const int cells = r.integer(2, 10), count = r.integer(2, 6);
  const bool steep = r.chance(0.3);
  for (int layer = 0; layer < count; ++layer) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double z = r.real(-1, 1), tilt = r.real(-0.5, 0.5) * (steep ? 3 : 1);
    for (int y = 0; y <= cells; ++y)
      for (int x = 0; x <= cells; ++x) {
        const double u = 2.0 * x / cells - 1, v = 2.0 * y / cells - 1;
        const double bump = r.chance(0.05) ? r.real(-0.3, 0.3) : 0;
        mesh.positions.push_back({static_cast<float>(u), static_cast<float>(v),
                                  static_cast<float>(z + tilt * u + bump)});
      }
    for_each_cell(cells, cells, first, [&](auto a, auto b, auto c, auto d) {
      const bool turned = layer % 2 == 1;
      add_triangle(mesh, turned ? b : a, turned ? a : b, c);
      add_triangle(mesh, turned ? d : b, turned ? b : d, c);
    });
  }
  if (r.chance(0.2)) mesh.positions[0].x = std::numeric_limits<float>::quiet_NaN();
  if (r.chance(0.1)) mesh.positions.back().y = std::numeric_limits<float>::infinity();
  Scene scene = single(std::move(mesh));
  scene.instances.resize(static_cast<std::size_t>(r.integer(1, 5)));
  for (Instance& instance : scene.instances) {
    auto& m = instance.object_to_world.m;
    for (int row = 0; row < 3; ++row) {
      m[row][row] = r.real(0.3, 1.2) * (r.chance(0.2) ? -1 : 1);
      m[row][3] = &instance == scene.instances.data() ? 0 : r.real(-2, 2);
      if (r.chance(0.3)) m[row][(row + 1) % 3] = r.real(-0.5, 0.5);
    }
  }
  return scene;
}

Camera any_camera(Random& r) {
  Camera c{.eye = {r.real(-3, 3), r.real(-3, 3), r.real(0.2, 4)},
           .target = {r.real(-0.5, 0.5), r.real(-0.5, 0.5), r.real(-0.5, 0.1)},
           .fov_rad = r.real32(0.2, 2.0),
           .near_plane = r.real32(0.001, 1.0)};
  c.orthographic = r.chance(0.25);
  c.orthographic_height = r.real32(0.3, 6);
  c.far_plane =
      c.orthographic || r.chance(0.3) ? r.real32(2, 20) : std::numeric_limits<float>::infinity();
  return c;
}

/// Draws frames of one scene along a path, plain and prepared.
void compare(std::uint64_t seed, LeftOut& left_out) {
  Random r(seed * 7919 + 1);
  FrameOptions o{.width = r.integer(8, 150), .height = r.integer(8, 120)};
  GeneratedScene g = seed % 2 == 0 ? generate(seed / 2, o.width, o.height)
                                   : GeneratedScene{"layers", layers(r), any_camera(r)};
  SCOPED_TRACE(std::to_string(seed) + " " + g.kind);
  o.shader = r.chance(0.5) ? Shader::phong : Shader::flat;
  o.cull = static_cast<Cull>(r.integer(0, 2));
  if (r.chance(0.15)) o.opacity = 0.5F;
  if (r.chance(0.15)) o.samples = r.chance(0.5) ? 4 : 8;
  const auto isas = available_isas();
  RendererOptions how{.threads = r.integer(1, 3), .isa = isas[seed % isas.size()]};
  if (r.chance(0.1)) how.memory_limit = std::uint64_t{8} << 20;
  Renderer plain(how), prepared(how);
  const SmallClusters clusters(g.view(), static_cast<std::uint32_t>(r.integer(1, 12)));
  for (int frame = 0; frame < 3; ++frame) {
    const Frame expected = draw(plain, g.view(), g.camera, o);
    const Frame got = draw(prepared, clusters.view(), g.camera, o);
    expect_equal(expected, got);
    left_out.add(got.stats);
    g.camera.eye = g.camera.eye + Vec3d{r.real(-0.1, 0.1), r.real(-0.1, 0.1), r.real(-0.1, 0.1)};
  }
}

TEST(Prepared, DrawsTheBitsOfGeneratedScenes) {
  LeftOut left_out;
  const auto n = static_cast<std::uint64_t>(share_of(400, 20));
  for (std::uint64_t seed = 0; seed < n && !HasFailure(); ++seed) compare(seed, left_out);
  if (HasFailure()) return;
  for (const char* const why : {kOutside, kAway, kHidden}) EXPECT_GT(left_out[why], n) << why;
}

void compare_along(const SceneView& plain_scene, const SceneView& prepared_scene,
                   std::span<const Camera> cameras, const FrameOptions& o, LeftOut& left_out) {
  Renderer plain, prepared;
  for (std::size_t i = 0; i < cameras.size() && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("camera " + std::to_string(i));
    const Frame got = draw(prepared, prepared_scene, cameras[i], o);
    expect_equal(draw(plain, plain_scene, cameras[i], o), got);
    left_out.add(got.stats);
  }
}

FrameOptions of_size(int width, int height, Cull cull = Cull::none, int samples = 1) {
  return FrameOptions{.width = width, .height = height, .cull = cull, .samples = samples};
}

struct Both {
  PreparedMesh prepared;
  OneInstance plain, own;

  explicit Both(const MeshView& mesh) : prepared(mesh), plain(mesh), own(prepared.view()) {}
};

TEST(Prepared, LeavesOutWhatIsHiddenOutsideAndFacingAway) {
  const Mesh knot = shapes::torus_knot(2, 3, 1024, 64);
  const Both both(knot.view());
  EXPECT_GE(both.prepared.cluster_count(), knot.triangle_count() / 128);
  std::vector<Camera> cameras;
  for (int i = 0; i < 8; ++i) {
    Camera c = fit_camera(both.plain.view(), 1, false);
    c.eye = c.eye * (1 - 0.11 * i) + Vec3d{0.02 * i, 0.1 * i, 0};
    cameras.push_back(c);
  }
  const auto left_out = [&](std::size_t count, const FrameOptions& o) {
    LeftOut sum;
    compare_along(both.plain.view(), both.own.view(), {cameras.data(), count}, o, sum);
    return sum;
  };
  const std::uint64_t drawn = cameras.size() * knot.triangle_count();
  const LeftOut none = left_out(8, of_size(200, 160));
  EXPECT_GT(none[kHidden], drawn / 10);
  EXPECT_GT(none[kOutside], drawn / 20);
  EXPECT_EQ(none[kAway], 0U);
  EXPECT_GT(left_out(2, of_size(200, 160, Cull::none, 4))[kHidden], knot.triangle_count() / 5);
  EXPECT_GT(left_out(8, of_size(200, 160, Cull::back))[kAway], drawn / 10);
}

// A sheet that faces away, with triangles so small that snapping may flip them: none may be left
// out for its facing.
TEST(Prepared, TinyTrianglesMayFaceEitherWay) {
  Random r(5);
  // Long and flat, so that a flipped one may still cover a sample.
  constexpr int kColumns = 40, kRows = 400;
  Mesh sheet;
  for (int y = 0; y <= kRows; ++y)
    for (int x = 0; x <= kColumns; ++x)
      sheet.positions.push_back({static_cast<float>((x + r.real(-0.3, 0.3)) / kColumns - 0.5),
                                 static_cast<float>((y + r.real(-0.3, 0.3)) / kRows - 0.5), 0.0F});
  for_each_cell(kColumns, kRows, 0, [&](auto a, auto b, auto c, auto d) {
    add_triangle(sheet, a, c, b);
    add_triangle(sheet, b, c, d);
  });
  const Both both(sheet.view());
  Renderer plain, own;
  LeftOut left_out;
  for (int i = 0; i < 40 && !testing::Test::HasFailure(); ++i) {
    Camera c;
    // From 1 to 3 px across; a triangle is a 400th of that.
    c.eye = {r.real(-0.2, 0.2), r.real(-0.2, 0.2), 20.8 / (1 + 0.05 * i)};
    const FrameOptions o = of_size(24, 24, Cull::back);
    const Frame got = draw(own, both.own.view(), c, o);
    expect_equal(draw(plain, both.plain.view(), c, o), got);
    left_out.add(got.stats);
  }
  EXPECT_EQ(left_out[kAway], 0U);
  // Triangles larger than the snapping's error are left out.
  const Camera close{.eye = {0, 0, 0.7}};
  left_out.add(draw(own, both.own.view(), close, of_size(2048, 2048, Cull::back)).stats);
  EXPECT_GT(left_out[kAway], sheet.triangle_count() / 4);
}

/// One of `large_every` balls is large; 0: none.
void compare_hall(int side, int large_every) {
  const Mesh ball = shapes::sphere(4, 6), large = shapes::sphere(16, 20);
  const MeshView ball_view = ball.view(), large_view = large.view();
  const PreparedMesh small(ball_view, 1), prepared(large_view, 1);
  std::vector<InstanceView> plain, own;
  for (int z = 0; z < side; ++z)
    for (const auto& [x, y] : pixels(side, side)) {
      const bool is_large = large_every != 0 && (x + y + z) % large_every == 0;
      InstanceView i;
      for (int k = 0; k < 3; ++k) i.object_to_world.m[k][k] = is_large ? 0.6 : 0.4;
      i.object_to_world.m[0][3] = x - side / 2;
      i.object_to_world.m[1][3] = y - side / 2;
      i.object_to_world.m[2][3] = z - side / 2;
      if (z % 3 == 0) i.object_to_world.m[0][0] *= -1;
      i.geometry = is_large ? large_view : ball_view;
      plain.push_back(i);
      i.geometry = is_large ? prepared.view() : small.view();
      own.push_back(i);
    }
  Camera inside{.eye = {0.5, 0.5, 1.5}, .target = {0.7, 0.5, 0}};
  Camera beside = inside;
  beside.eye = {0.5, 0.5, 0.9 * side};
  const Camera cameras[] = {inside, beside};
  LeftOut left_out;
  compare_along({.instances = plain}, {.instances = own}, cameras, of_size(160, 120), left_out);
  EXPECT_GT(left_out[kOutside], plain.size() * ball.triangle_count() / 4);
  EXPECT_GT(left_out[kHidden], plain.size() * ball.triangle_count() / 4);
}

TEST(Prepared, AHallOfInstances) {
  compare_hall(is_full() ? 100 : 12, 16);
  compare_hall(16, 0);  // small copies, several of which are set up at once; some are hidden
}

TEST(Prepared, WideAndNarrowPositionsQuadsAndMaterials) {
  const Mesh knot = shapes::torus_knot(2, 5, 128, 20);
  std::vector<Vec3d> wide(knot.positions.begin(), knot.positions.end());
  for (Vec3d& p : wide) p = p + Vec3d{1e6, 0, 0};
  MeshView far_away = knot.view();
  far_away.positions = wide;
  const std::vector<std::uint16_t> narrow(knot.indices.begin(), knot.indices.end());
  MeshView of_shorts = knot.view();
  of_shorts.indices = narrow;
  std::vector<std::uint32_t> quads;
  for_each_cell(39, 39, 0, [&](auto a, auto b, auto c, auto d) {
    quads.insert(quads.end(), {a, b, d, c});
  });
  MeshView of_quads = knot.view();
  of_quads.indices = quads;
  of_quads.faces.kind = FaceKind::quads;
  of_quads.texcoords = {};  // they belong to other faces
  std::vector<std::uint32_t> materials(knot.triangle_count());
  for (std::size_t i = 0; i < materials.size(); ++i)
    materials[i] = static_cast<std::uint32_t>(i % 3);
  MeshView of_materials = knot.view();
  of_materials.face_materials = materials;
  std::vector<Material> list(3);
  list[1].alpha_mode = AlphaMode::blend;
  list[1].base_color = {1, 0, 0, 0.4F};
  for (const MeshView& mesh : {far_away, of_shorts, of_quads, of_materials}) {
    const Both both(mesh);
    SceneView plain = both.plain.view(), own = both.own.view();
    if (!mesh.face_materials.empty()) plain.materials = own.materials = list;
    Camera c = fit_camera(plain, 1, false);
    Camera close = c;
    close.eye = c.eye * 0.6 + c.target * 0.4;
    const Camera cameras[] = {c, close, c};
    LeftOut left_out;
    compare_along(plain, own, cameras, of_size(120, 100), left_out);
  }
}

TEST(Prepared, AMeshThatChangedIsRefused) {
  Mesh knot = shapes::torus_knot(2, 3, 128, 16);
  const PreparedMesh prepared(knot.view(), 1);
  OneInstance instance(prepared.view());
  const Camera camera = fit_camera(instance.view(), 1, false);
  Renderer renderer;
  const auto frame = [&] { (void)draw(renderer, instance.view(), camera, of_size(40, 40)); };
  frame();
  const char* const says =
      "instance 0: its positions or triangles are not those that were prepared";
  for (Vec3& p : knot.positions) p.x += 1;
  expect_refused(says, frame);
  for (Vec3& p : knot.positions) p.x -= 1;
  knot.positions = std::vector<Vec3>(knot.positions);  // other memory
  MeshView other = knot.view();
  other.clusters = prepared.view().clusters;
  instance.geometry = other;
  expect_refused(says, frame);
}

TEST(Prepared, RefusesWhatIsOutOfRangeAndTakesWhatIsEmpty) {
  Mesh broken;
  broken.positions.resize(3);
  broken.indices = {0, 1, 3};
  EXPECT_THROW(PreparedMesh{broken.view()}, Error);
  const PreparedMesh empty{MeshView{}};
  EXPECT_EQ(empty.cluster_count(), 0U);
  const Frame p =
      draw(RendererOptions{}, OneInstance(empty.view()).view(), Camera{}, of_size(16, 16));
  EXPECT_EQ(p.stats.pixels_covered, 0U);
}

/// Flights whose own near plane cuts what they meet.
void compare_flight(const std::string& file, int steps, int size) {
  const auto path = shared_data(file);
  if (!std::filesystem::exists(path)) GTEST_SKIP() << file << " is not there";
  const Scene scene = io::read_scene(path);
  const SceneBinding plain(scene);
  SceneBinding prepared(scene);
  prepared.prepare();
  const Bounds box = bounds(plain.view());
  const Vec3d low(box.min), extent = Vec3d(box.max) - low;
  std::vector<Camera> cameras;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps;
    Camera c{.eye = {low.x + extent.x * (-0.1 + 1.1 * t), low.y + extent.y * (0.3 + 0.2 * t),
                     low.z + extent.z * (0.4 + 0.2 * std::sin(7 * t))}};
    c.target = c.eye + Vec3d{std::cos(3 * t), 0.2 - 0.3 * t, std::sin(3 * t)};
    c.near_plane = static_cast<float>(length(extent) * 1e-3);
    cameras.push_back(c);
  }
  LeftOut left_out;
  FrameOptions o = of_size(size, size * 3 / 4);
  compare_along(plain.view(), prepared.view(), cameras, o, left_out);
  EXPECT_GT(left_out[kOutside], scene.triangle_count() * static_cast<std::uint64_t>(steps) / 8);
  EXPECT_GT(left_out[kHidden] + left_out[kAway], 0U);
}

TEST(Prepared, AWalkThroughSponza) {
  const bool full = is_full();
  compare_flight("sponza/sponza.obj", full ? 200 : 6, full ? 640 : 160);
}

TEST(Prepared, AFlightThroughBrain) {
  if (!is_full()) GTEST_SKIP() << kOnlyFull;
  compare_flight("big/brain_iso126_1033k.ply", 100, 640);
}

}  // namespace
}  // namespace rastrum::test::prepared_test
