// SPDX-License-Identifier: BSD-3-Clause
// Rules of the picture for every scene, device and size, each from a public conformance suite (dEQP
// `rasterization`, piglit, D3D11.3) or docs/coverage.md.
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/device_test.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::properties_test {
namespace {

class Properties : public DeviceTest {
 protected:
  /// Draws with the pixel camera.
  static Frame drawn(Mesh mesh, int w = 64, int h = 64) {
    return draw(options(w, h), single(std::move(mesh)), pixel_camera(w, h));
  }
};

using Index = std::uint32_t;

// A rectangle on the screen as two triangles; at(x, y) gives the corners.
template <class At>
void add_quad_at(Mesh& mesh, double x0, double y0, double x1, double y1, const At& at) {
  const auto first = static_cast<Index>(mesh.positions.size());
  for (const auto& [x, y] : {std::pair{x0, y0}, {x0, y1}, {x1, y1}, {x1, y0}})
    mesh.positions.push_back(at(x, y));
  add_triangle(mesh, first, first + 1, first + 2);
  add_triangle(mesh, first, first + 2, first + 3);
}
// For the pixel camera.
void add_quad(Mesh& mesh, double x0, double y0, double x1, double y1, double depth = 0.5,
              int w = 64, int h = 64) {
  add_quad_at(mesh, x0, y0, x1, y1,
              [&](double x, double y) { return at_pixel(x, y, depth, w, h); });
}

Mesh quad(double x0, double y0, double x1, double y1, int w = 64, int h = 64) {
  Mesh mesh;
  add_quad(mesh, x0, y0, x1, y1, 0.5, w, h);
  return mesh;
}

struct Point {
  double x, y;
};

// The order of triangles only decides between equal depths: the first submitted wins.
TEST_P(Properties, PermutingTrianglesChangesOnlyNumbers) {
  constexpr int kW = 64, kH = 48;
  Painter renderer(options(kW, kH));
  int ties = 0;
  for (std::uint64_t seed = 0; seed < 320 && !HasFailure(); ++seed) {
    GeneratedScene g = generate(seed, kW, kH);
    g.scene.instances.resize(1);
    SCOPED_TRACE(std::to_string(seed) + " " + g.kind);
    Mesh& mesh = g.scene.meshes[0];
    mesh = indexed(std::move(mesh));
    mesh.normals = {};
    mesh.colors = {};
    const Frame before = draw(renderer, SceneBinding(g.scene).view(), g.camera);
    const std::size_t n = mesh.triangle_count();
    std::vector<std::size_t> old_of(n), new_of(n);
    std::iota(old_of.begin(), old_of.end(), std::size_t{0});
    Random r(seed);
    for (std::size_t i = n; i > 1; --i)
      std::swap(old_of[i - 1], old_of[static_cast<std::size_t>(r.integer(0, int(i) - 1))]);
    std::vector<Index> shuffled;
    for (std::size_t i = 0; i < n; ++i) {
      new_of[old_of[i]] = i;
      for (std::size_t c = 0; c < 3; ++c) shuffled.push_back(mesh.indices[3 * old_of[i] + c]);
    }
    mesh.indices = shuffled;
    const Frame after = draw(renderer, SceneBinding(g.scene).view(), g.camera);
    EXPECT_TRUE(same_images(before, after, kOverdraw | kDepth));
    for (std::size_t i = 0; i < before.ids.pixels().size(); ++i) {
      const std::int64_t old_winner = before.ids.pixels()[i], now = after.ids.pixels()[i];
      ASSERT_EQ(old_winner < 0, now < 0);
      if (now < 0) continue;
      const auto first = static_cast<std::size_t>(old_winner);
      const std::size_t second = old_of[static_cast<std::size_t>(now)];
      if (first == second) continue;
      // A tie: each of the two came first in its order.
      ++ties;
      EXPECT_LT(first, second);
      EXPECT_LT(new_of[second], new_of[first]);
    }
  }
  EXPECT_GT(ties, 1000);
}

TEST_P(Properties, OneMeshEqualsTheSameTrianglesInInstances) {
  constexpr int kW = 80, kH = 60;
  Painter renderer(options(kW, kH));
  for (std::uint64_t seed = 0; seed < 64; ++seed) {
    GeneratedScene g = generate(seed, kW, kH);
    g.scene.instances.resize(1);
    SCOPED_TRACE(std::to_string(seed) + " " + g.kind);
    const Mesh& mesh = g.scene.meshes[0];
    if (mesh.indices.empty()) continue;
    const Frame whole = draw(renderer, SceneBinding(g.scene).view(), g.camera);
    Random r(seed);
    Scene parts;
    for (std::size_t begin = 0; begin < mesh.indices.size();) {
      const std::size_t end =
          std::min(begin + 3 * static_cast<std::size_t>(r.integer(0, 9)), mesh.indices.size());
      Mesh part = mesh;
      const auto slice = [&](std::vector<Index>& v) {
        if (!v.empty()) v = {v.begin() + std::ptrdiff_t(begin), v.begin() + std::ptrdiff_t(end)};
      };
      // An empty part has no positions either, else it would be drawn without indices.
      if (begin == end) part = Mesh{};
      slice(part.indices);
      slice(part.normals.indices);
      slice(part.colors.indices);
      parts.instances.push_back({static_cast<Index>(parts.meshes.size()), Mat4d::identity()});
      parts.meshes.push_back(std::move(part));
      begin = end;
    }
    const Frame split = draw(renderer, SceneBinding(parts).view(), g.camera);
    EXPECT_TRUE(same_frames(whole, split));
  }
}

TEST_P(Properties, FullScreenQuadCoversEveryPixelOnce) {
  for (const auto& [w, h] : {std::pair{1, 1}, {2, 3}, {7, 5}, {64, 64}, {65, 63}, {333, 17}}) {
    SCOPED_TRACE(std::to_string(w) + "x" + std::to_string(h));
    const Frame f = drawn(quad(0, 0, w, h, w, h), w, h);
    EXPECT_TRUE(std::ranges::all_of(f.overdraw.pixels(), [](auto n) { return n == 1; }));
    EXPECT_TRUE(std::ranges::all_of(f.depth.pixels(), [](float d) { return d == 0.5F; }));
    EXPECT_EQ(f.stats.fragments, static_cast<std::uint64_t>(w) * static_cast<std::uint64_t>(h));
    // Also far beyond the image on every side, where the guard band clips.
    const Frame far = drawn(quad(-1e6, -1e6, 1e6, 1e6, w, h), w, h);
    EXPECT_TRUE(std::ranges::all_of(far.overdraw.pixels(), [](auto n) { return n == 1; }));
    EXPECT_EQ(far.stats.triangles.clipped, 2U);
  }
}

// Columns and rows of a 64 × 64 picture that the rectangle covers.
struct Extent {
  int x0, y0, x1, y1;
  friend bool operator==(const Extent&, const Extent&) = default;
};
void PrintTo(const Extent& e, std::ostream* out) {
  *out << "[" << e.x0 << ", " << e.x1 << ") x [" << e.y0 << ", " << e.y1 << ")";
}

Extent extent_of(const Frame& f) {
  Extent e{1000, 1000, 0, 0};
  for (const auto& [x, y] : pixels(f.overdraw.width(), f.overdraw.height()))
    if (f.overdraw(x, y) != 0)
      e = {std::min(e.x0, x), std::min(e.y0, y), std::max(e.x1, x + 1), std::max(e.y1, y + 1)};
  return e;
}

TEST_P(Properties, SamplesOnAnEdgeBelongToTheTopAndTheLeft) {
  const Frame f = drawn(quad(10.5, 20.5, 14.5, 23.5));
  EXPECT_EQ(extent_of(f), (Extent{10, 20, 14, 23}));
  EXPECT_EQ(f.stats.fragments, 12U);
}

// Edges 1/512 px beside a sample are a tie between two n.8 positions.
TEST_P(Properties, SnappingRoundsTiesToEven) {
  constexpr double kHalf = 1.0 / 512;
  const auto covered = [](double x, double y) {
    return extent_of(drawn(quad(x, y, x + 4, y + 4)));
  };
  // 10.5 px = 2688/256, an even number: ± 1/512 px both round to it, and the left and top edges own
  // the samples on them.
  EXPECT_EQ(covered(10.5 + kHalf, 10.5 + kHalf), (Extent{10, 10, 14, 14}));
  EXPECT_EQ(covered(10.5 - kHalf, 10.5 - kHalf), (Extent{10, 10, 14, 14}));
  // 3/512 px beside it the tie is between 2689 and 2690.
  EXPECT_EQ(covered(10.5 + 3 * kHalf, 10.5 + 3 * kHalf), (Extent{11, 11, 15, 15}));
  EXPECT_EQ(covered(10.5 - 3 * kHalf, 10.5 - 3 * kHalf), (Extent{10, 10, 14, 14}));
  // 10.5 + 1/256 px is on the grid, one subpixel beyond the sample.
  EXPECT_EQ(covered(10.5 + 2 * kHalf, 10.5 - 2 * kHalf), (Extent{11, 10, 15, 14}));
}

TEST_P(Properties, FarPlane) {
  constexpr int kW = 60, kH = 40;
  Camera camera{.eye = {0, 0, 0}, .target = {0, 0, -1}, .near_plane = 0.25F};
  const Placer placer(camera, kW, kH);
  Mesh mesh;
  const double w_of[] = {0.25, 0.5, 1, 2, 4, 16};
  for (int i = 0; i < 6; ++i)
    add_quad_at(mesh, 10.0 * i, 0, 10.0 * i + 10, 40, [&](double x, double y) {
      return placer.at({x, y, w_of[i]});
    });
  const Scene scene = single(std::move(mesh));
  const Frame infinite = draw(options(kW, kH), scene, camera);
  camera.far_plane = 4;
  const Frame finite = draw(options(kW, kH), scene, camera);
  EXPECT_TRUE(same_images(infinite, finite, kIds | kOverdraw));
  for (int i = 0; i < 6; ++i) {
    const double w = w_of[i], n = 0.25, f = 4;
    const int x = 10 * i + 5;
    EXPECT_NEAR(infinite.depth(x, 20), n / w, 1e-6);
    // 1 at the near plane, 0 at the far plane and beyond, where the surface is still drawn.
    EXPECT_NEAR(finite.depth(x, 20), std::max(n * (f - w) / (w * (f - n)), 0.0), 1e-6);
    EXPECT_GE(finite.ids(x, 20), 0);
  }
  EXPECT_EQ(finite.depth(55, 20), 0.0F);
}

TEST_P(Properties, ZeroAreaDrawsNothing) {
  Mesh mesh;
  const auto triangle = [&](std::array<Point, 3> p) {
    const auto first = static_cast<Index>(mesh.positions.size());
    for (const Point& q : p) mesh.positions.push_back(at_pixel(q.x, q.y, 0.5, 64, 64));
    add_triangle(mesh, first, first + 1, first + 2);
  };
  triangle({{{10.5, 10.5}, {20.5, 20.5}, {30.5, 30.5}}});
  triangle({{{10.5, 10.5}, {10.5, 10.5}, {30.5, 30.5}}});
  triangle({{{10.5, 10.5}, {10.5, 10.5}, {10.5, 10.5}}});
  triangle({{{10.5, 10.5}, {50.5, 10.5}, {30.5, 10.5 + 1.0 / 1024}}});  // flat after snapping
  triangle({{{-1e5, 10.5}, {1e5, 10.5}, {0, 10.5}}});                   // flat and clipped
  const Frame f = drawn(std::move(mesh));
  EXPECT_EQ(f.stats.fragments, 0U);
  EXPECT_EQ(f.stats.triangles.culled, 5U);
  EXPECT_EQ(f.stats.triangles.drawn, 0U);
  EXPECT_TRUE(std::ranges::all_of(f.ids.pixels(), [](auto id) { return id == -1; }));
}

TEST_P(Properties, NonFiniteTrianglesAreDroppedAndKeepTheirNumbers) {
  Mesh mesh;
  add_quad(mesh, 0, 0, 20, 64);
  constexpr float kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInf, -kInf})
    for (const auto& [corner, axis] : {std::pair{0U, &Vec3::x}, {1U, &Vec3::y}, {2U, &Vec3::z}}) {
      const auto first = static_cast<Index>(mesh.positions.size());
      mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
      mesh.positions[first + corner].*axis = bad;
      add_triangle(mesh, first, first + 1, first + 2);
    }
  add_quad(mesh, 40, 0, 64, 64);
  const Frame f = drawn(std::move(mesh));
  EXPECT_EQ(f.stats.triangles.input, 13U);
  EXPECT_EQ(f.stats.triangles.dropped, 9U);
  EXPECT_EQ(f.stats.triangles.drawn, 4U);
  EXPECT_EQ(f.stats.fragments, 64U * 44U);
  EXPECT_EQ(f.ids(63, 63), 11);
  EXPECT_EQ(f.ids(63, 0), 12);
  EXPECT_EQ(f.ids(30, 30), -1);
}

TEST_P(Properties, CullingPartitionsTheUnculledPicture) {
  constexpr int kW = 50, kH = 64;
  RenderOptions o = options(kW, kH);
  std::array<Painter, 3> renderers{Painter(o), Painter((o.cull = Cull::back, o)),
                                   Painter((o.cull = Cull::front, o))};
  std::uint64_t fronts = 0, backs = 0;
  for (std::uint64_t seed = 0; seed < 160; ++seed) {
    const GeneratedScene g = generate(seed, kW, kH);
    SCOPED_TRACE(std::to_string(seed) + " " + g.kind);
    const Frame none = draw(renderers[0], g.view(), g.camera);
    const Frame back = draw(renderers[1], g.view(), g.camera);
    const Frame front = draw(renderers[2], g.view(), g.camera);
    for (std::size_t i = 0; i < none.overdraw.pixels().size(); ++i)
      ASSERT_EQ(none.overdraw.pixels()[i], back.overdraw.pixels()[i] + front.overdraw.pixels()[i]);
    EXPECT_EQ(none.stats.triangles.drawn, back.stats.triangles.drawn + front.stats.triangles.drawn);
    EXPECT_EQ(none.stats.triangles.clipped,
              back.stats.triangles.clipped + front.stats.triangles.clipped);
    EXPECT_EQ(none.stats.triangles.dropped, back.stats.triangles.dropped);
    fronts += back.stats.fragments;
    backs += front.stats.fragments;
  }
  EXPECT_GT(fronts, 10000U);
  EXPECT_GT(backs, 10000U);
}

TEST_P(Properties, CounterClockwiseIsFront) {
  RenderOptions o = options(64, 64);
  const Scene scene = single(quad(8, 8, 56, 56));  // down, right, up: counter-clockwise
  o.cull = Cull::back;
  EXPECT_EQ(draw(o, scene, pixel_camera(64, 64)).stats.fragments, 48U * 48U);
  o.cull = Cull::front;
  EXPECT_EQ(draw(o, scene, pixel_camera(64, 64)).stats.fragments, 0U);
}

TEST_P(Properties, FirstSubmittedWinsEqualDepthAlsoWhenClipped) {
  // Three times the same plane. Only the first copy is clipped by the guard band.
  Mesh mesh;
  add_quad(mesh, -1e6, -1e6, 1e6, 1e6);
  add_quad(mesh, 8, 8, 56, 56);
  add_quad(mesh, 0, 0, 64, 64, 0.25);
  const Frame f = drawn(std::move(mesh));
  EXPECT_TRUE(std::ranges::all_of(f.ids.pixels(), [](auto id) { return id == 0 || id == 1; }));
  EXPECT_EQ(f.stats.fragments, 2U * 64 * 64 + 48 * 48);
}

TEST_P(Properties, IndexOutOfRangeIsAnErrorThatNamesIt) {
  Mesh good = quad(8, 8, 56, 56), bad = good;
  bad.indices[4] = 4711;
  Scene scene{.meshes = {good, bad}, .instances = {{0, Mat4d::identity()}, {1, Mat4d::identity()}}};
  Painter renderer(options(64, 64));
  const std::string said =
      refusal_of([&] { (void)draw(renderer, SceneBinding(scene).view(), pixel_camera(64, 64)); });
  EXPECT_TRUE(holds(said, "4711"));
  EXPECT_TRUE(holds(said, "instance 1"));
  // The renderer still works.
  scene.meshes[1] = good;
  EXPECT_EQ(draw(renderer, SceneBinding(scene).view(), pixel_camera(64, 64)).stats.fragments,
            2U * 48 * 48);
}

TEST_P(Properties, IndicesWithoutPositionsAreAnError) {
  EXPECT_THROW((void)drawn({.indices = std::vector<Index>(3 * 64, 5)}), Error);
}

TEST_P(Properties, AttributeIndexOutOfRangeIsAnErrorThatNamesIt) {
  Mesh mesh = quad(8, 8, 56, 56);
  mesh.normals.values = {{0, 0, 1}};
  mesh.normals.indices = {0, 0, 0, 0, 4711, 0};
  expect_refused("4711", [&] { (void)drawn(mesh); });
}

TEST_P(Properties, AnEmptySceneIsBackground) {
  RenderOptions o = options(70, 9);
  o.background = {1, 0.5F, 0, 0.5F};
  for (const Scene& scene : {Scene{}, single(Mesh{})}) {
    const Frame f = draw(o, scene, Camera{});
    EXPECT_EQ(f.stats.fragments, 0U);
    EXPECT_TRUE(std::ranges::all_of(f.ids.pixels(), [](auto id) { return id == -1; }));
    EXPECT_TRUE(std::ranges::all_of(f.depth.pixels(), [](float d) { return d == 0; }));
    EXPECT_TRUE(std::ranges::all_of(f.overdraw.pixels(), [](auto n) { return n == 0; }));
    EXPECT_TRUE(std::ranges::all_of(f.color8.pixels(), [](Rgba8 c) {
      return c == Rgba8{255, 128, 0, 128};
    }));
    EXPECT_TRUE(std::ranges::all_of(f.color.pixels(), [](Vec4 c) {  // premultiplied
      return c.x == 0.5F && c.y == 0.25F && c.z == 0 && c.w == 0.5F;
    }));
  }
}

// A target does not depend on the other targets of the frame.
TEST_P(Properties, EachTargetAloneEqualsAllTogether) {
  constexpr int kW = 90, kH = 70;
  // Hierarchical Z leaves out fragments unless overdraw is counted.
  RenderOptions all_fragments = options(kW, kH);
  all_fragments.hierarchical_z = false;
  Painter renderer(all_fragments);
  for (std::uint64_t seed = 0; seed < 48; ++seed) {
    const GeneratedScene g = generate(seed, kW, kH);
    SCOPED_TRACE(std::to_string(seed) + " " + g.kind);
    const Frame all = draw(renderer, g.view(), g.camera);
    for (const unsigned kind : {kColor8, kDepth, kIds, kOverdraw}) {
      const Frame one = draw(renderer, g.view(), g.camera, kind);
      EXPECT_TRUE(same_images(one, all, kind));
      EXPECT_TRUE(same_counts(one.stats, all.stats));
    }
  }
}

// A target may be a window of a larger image.
TEST_P(Properties, TargetsWithAStrideKeepWhatLiesBesideThem) {
  constexpr int kW = 40, kH = 30, kStride = 53;
  const GeneratedScene g = generate(0, kW, kH);
  Painter renderer(options(kW, kH));
  const Frame whole = draw(renderer, g.view(), g.camera);
  std::vector<Rgba8> colors(kStride * kH, Rgba8{9, 9, 9, 9});
  std::vector<std::int64_t> ids(kStride * kH, -99);
  Targets targets{.color8 = {colors.data(), kW, kH, kStride}, .ids = {ids.data(), kW, kH, kStride}};
  renderer.render(g.view(), g.camera, targets);
  for (const auto& [x, y] : pixels(kStride, kH)) {
    const auto i = static_cast<std::size_t>(y * kStride + x);
    ASSERT_EQ(colors[i], x < kW ? whole.color8(x, y) : (Rgba8{9, 9, 9, 9})) << x << "," << y;
    ASSERT_EQ(ids[i], x < kW ? whole.ids(x, y) : -99) << x << "," << y;
  }
}

// A negative stride flips the rows (OpenGL's order) and changes nothing else.
TEST_P(Properties, TargetsMayLieUpsideDown) {
  constexpr int kW = 61, kH = 45;
  for (const bool deep : {false, true}) {
    RenderOptions o = options(kW, kH);
    if (deep) o.opacity = 0.5F;
    Painter renderer(o);
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
      const GeneratedScene g = generate(seed, kW, kH);
      SCOPED_TRACE(std::to_string(seed) + " " + g.kind);
      const Frame upright = draw(renderer, g.view(), g.camera);
      Image<std::uint64_t> keys(kW, kH), turned_keys(kW, kH);
      Frame turned(kW, kH, kCounted);
      const auto from_below = [](auto& image) {
        return decltype(image.view()){&image(0, kH - 1), kW, kH, -kW};
      };
      renderer.render(g.view(), g.camera, {.keys = keys});
      Targets targets{.keys = from_below(turned_keys)};
      for_each_kind([&](unsigned kind, const char*, auto member, auto target) {
        if ((kind & kCounted) != 0) targets.*target = from_below(turned.*member);
      });
      renderer.render(g.view(), g.camera, targets);
      const auto turn = [](auto& image) {
        for (int y = 0; y < kH / 2; ++y)
          std::swap_ranges(&image(0, y), &image(0, y) + kW, &image(0, kH - 1 - y));
      };
      for_each_kind([&](unsigned kind, const char*, auto member, auto) {
        if ((kind & kCounted) != 0) turn(turned.*member);
      });
      turn(turned_keys);
      EXPECT_TRUE(same_images(turned, upright));
      EXPECT_TRUE(std::ranges::equal(turned_keys.pixels(), keys.pixels()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, Properties, testing::Values(Device::serial, Device::threads),
                         device_name);

}  // namespace
}  // namespace rastrum::test::properties_test
