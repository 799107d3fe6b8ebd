// Clip planes: each pixel against all triangles and planes in long double, and the same bits
// whatever draws.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/projection.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::clip_planes_test {
namespace {

constexpr int kW = 72, kH = 56;

RenderOptions options() {
  return RenderOptions({.width = kW, .height = kH}, {.threads = 1});
}

/// One to three planes near where the camera looks, and for every second instance one of its own.
struct Cut {
  std::vector<ClipPlane> world, own;
  std::vector<InstanceView> instances;

  Cut(const SceneView& scene, const Camera& camera, std::uint64_t seed)
      : instances(scene.instances.begin(), scene.instances.end()) {
    Random r(seed);
    const auto direction = [&] { return Vec3d{r.real(-1, 1), r.real(-1, 1), r.real(-1, 1)}; };
    const int count = r.integer(0, 3);
    for (int i = 0; i < count; ++i) {
      const Vec3d n = direction(), through = camera.target + direction();
      world.push_back({n, -dot(n, through)});
    }
    own.push_back({direction(), r.real(-1, 1)});
    for (std::size_t i = 0; i < instances.size(); i += 2) instances[i].clip_planes = own;
  }
};

/// How far a corner lies in front of each plane that counts for it.
std::vector<Real> ahead(const Cut& cut, const InstanceView& instance, Vec3 p) {
  std::vector<Real> values;
  const auto& m = instance.object_to_world.m;
  const auto row = [&](int i) {
    return Real(m[i][0]) * p.x + Real(m[i][1]) * p.y + Real(m[i][2]) * p.z + Real(m[i][3]);
  };
  for (const ClipPlane& c : cut.world)
    values.push_back(c.normal.x * row(0) + c.normal.y * row(1) + c.normal.z * row(2) + c.offset);
  for (const ClipPlane& c : instance.clip_planes)
    values.push_back(Real(c.normal.x) * p.x + Real(c.normal.y) * p.y + Real(c.normal.z) * p.z +
                     c.offset);
  return values;
}

TEST(ClipPlanes, KeepThePixelsThatAnOracleKeeps) {
  int pixels = 0, cut_away = 0, ties = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const GeneratedScene g = generate(seed, kW, kH);
    const Cut cut(g.view(), g.camera, seed);
    const SceneView scene{cut.instances, g.view().materials, g.view().textures};
    const auto projected = project(scene, g.camera, kW, kH);
    // The oracle has snapped triangles; what the clipper makes is the next test's.
    if (std::ranges::any_of(projected, [](const auto& t) { return t.fate == Fate::needs_clip; }))
      continue;
    RenderOptions o = options();
    o.clip_planes = cut.world;
    Painter painter(o);
    const Frame frame = draw(painter, scene, g.camera);
    struct Triangle {
      const ProjectedTriangle* projected;
      std::vector<Real> ahead[3];
    };
    std::vector<Triangle> triangles;
    std::size_t id = 0;
    for (const InstanceView& instance : scene.instances) {
      const MeshView& mesh = *instance.mesh();
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t, ++id) {
        if (projected[id].fate != Fate::whole || twice_area(projected[id].snapped) == 0) continue;
        Triangle& triangle = triangles.emplace_back();
        triangle.projected = &projected[id];
        for (std::size_t c = 0; c < 3; ++c)
          triangle.ahead[c] = ahead(cut, instance, mesh.positions[mesh.vertex(3 * t + c)]);
      }
    }
    for (int y = 0; y < kH; ++y)
      for (int x = 0; x < kW; ++x) {
        std::uint64_t nearest = 0;
        bool tie = false;
        for (const Triangle& t : triangles) {
          const SnappedTriangle& s = t.projected->snapped;
          if (!covers(s, x, y)) continue;
          const auto b = exact_weights(*t.projected, kW, kH, x, y);
          const Real sum = b[0] + b[1] + b[2];
          bool kept = true;
          for (std::size_t k = 0; k < t.ahead[0].size(); ++k) {
            Real value = 0, size = 0;
            for (std::size_t c = 0; c < 3; ++c) {
              value += b[c] / sum * t.ahead[c][k];
              size += std::abs(b[c] / sum * t.ahead[c][k]);
            }
            // A tie: what float64 may decide the other way.
            tie |= std::abs(value) <= 1e-12L * size;
            kept &= value >= 0;
          }
          cut_away += kept ? 0 : 1;
          if (kept) nearest = std::max(nearest, visibility_key(depth_at(s, x, y), s.id));
        }
        if (tie) {
          ++ties;
          continue;
        }
        pixels += nearest != 0 ? 1 : 0;
        const std::int64_t wants =
            nearest == 0 ? -1
                         : static_cast<std::int64_t>((std::uint64_t{1} << 33) - 1 -
                                                     (nearest & ((std::uint64_t{1} << 33) - 1)));
        ASSERT_EQ(frame.ids(x, y), wants) << g.kind << " " << seed << " at " << x << ", " << y;
      }
  }
  EXPECT_GT(pixels, 50000);
  EXPECT_GT(cut_away, 50000);
  EXPECT_LT(ties, 100);
  RecordProperty("ties", ties);
}

// All that is left lies in front of the planes, also of triangles that the clipper cuts.
TEST(ClipPlanes, LeaveNothingBehindThem) {
  int pixels = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const GeneratedScene g = generate(seed, kW, kH);
    const Cut cut(g.view(), g.camera, seed);
    RenderOptions o = options();
    o.clip_planes = cut.world;
    Image<Vec3> positions(kW, kH);
    Image<std::int64_t> ids(kW, kH);
    Painter(o).render(g.view(), g.camera, {.ids = ids, .positions = positions});
    for (int y = 0; y < kH; ++y)
      for (int x = 0; x < kW; ++x) {
        if (ids(x, y) < 0) continue;
        ++pixels;
        const Vec3d p = positions(x, y);
        for (const ClipPlane& c : cut.world)
          ASSERT_GE(dot(c.normal, p) + c.offset,
                    -1e-5 * (length(c.normal) * length(p) + std::abs(c.offset) + 1))
              << g.kind << " " << seed;
      }
  }
  EXPECT_GT(pixels, 20000);
}

TEST(ClipPlanes, AreTheSameBitsWhateverDraws) {
  for (const int samples : {1, 4})
    for (const float opacity : {1.0F, 0.5F})
      for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(share_of(24, 6)); ++seed) {
        const GeneratedScene g = generate(seed, kW, kH);
        const Cut cut(g.view(), g.camera, seed);
        const SceneView scene{cut.instances, g.view().materials, g.view().textures};
        RenderOptions base = options();
        base.samples = samples;
        base.opacity = opacity;
        base.clip_planes = cut.world;
        SCOPED_TRACE(g.kind + " " + std::to_string(seed));
        EveryWay(base).same([&](Painter& painter) { return draw(painter, scene, g.camera); });
      }
}

TEST(ClipPlanes, OfEveryRowOfTheFamily) {
  for (const family::AxisInfo& row : family::rasterizer_axis())
    for (const std::uint64_t seed : {0U, 3U, 8U}) {
      const GeneratedScene g = generate(seed, kW, kH);
      const Cut cut(g.view(), g.camera, seed);
      const SceneView scene{cut.instances, g.view().materials, g.view().textures};
      RenderOptions o = options();
      o.clip_planes = cut.world;
      Painter plain(o);
      o.rasterizer = row.name;
      Painter own(o);
      ASSERT_TRUE(same_surfaces(draw(plain, scene, g.camera), draw(own, scene, g.camera)))
          << row.name << " " << seed;
    }
}

TEST(ClipPlanes, ThatKeepAllChangeNothingAndThatKeepNothingLeaveNothing) {
  const Mesh sphere = shapes::sphere();
  const InstanceView instance{sphere.view(), Mat4d::identity()};
  const SceneView scene{.instances = {&instance, 1}};
  const Camera camera{.eye = {0, 0, 3}};
  RenderOptions o = options();
  Painter plain(o);
  const Frame without = draw(plain, scene, camera);
  o.clip_planes.assign(kMaxClipPlanes, ClipPlane{{0, 1, 0}, 100});
  Painter all(o);
  const Frame kept = draw(all, scene, camera);
  EXPECT_TRUE(same_surfaces(without, kept));
  EXPECT_TRUE(same_counts(without.stats, kept.stats));
  EXPECT_EQ(without.stats.fragments, kept.stats.fragments);
  o.clip_planes = {{{0, 0, -1}, -100}};
  Painter nothing(o);
  const Frame none = draw(nothing, scene, camera);
  EXPECT_EQ(none.stats.pixels_covered, 0U);
  EXPECT_EQ(none.stats.fragments, 0U) << "whole triangles are left out early";
  // Half a sphere shows its inside, further away than the front was.
  o.clip_planes = {{{0, 0, -1}, 0}};
  Painter half(o);
  const Frame inside = draw(half, scene, camera);
  EXPECT_LT(inside.depth(kW / 2, kH / 2), without.depth(kW / 2, kH / 2));
  EXPECT_GT(inside.depth(kW / 2, kH / 2), 0);
}

TEST(ClipPlanes, OfAnInstanceGoWithIt) {
  const Mesh sphere = shapes::sphere();
  const std::vector<ClipPlane> left{{{-1, 0, 0}, 0}};
  InstanceView turned{sphere.view(), rotation(rotation_about({0, 0, 1}, 1.5707963267948966))};
  turned.clip_planes = left;
  Painter painter(options());
  const Frame frame = draw(painter, {.instances = {&turned, 1}}, {.eye = {0, 0, 3}});
  // Its −x is the world's −y: what is left is the lower half.
  EXPECT_EQ(frame.ids(kW / 2, kH / 2 - 8), -1);
  EXPECT_GE(frame.ids(kW / 2, kH / 2 + 8), 0);
}

TEST(ClipPlanes, RefuseWhatIsNone) {
  const std::vector<Vec3> positions{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  InstanceView instance{MeshView{.positions = positions}, Mat4d::identity()};
  const SceneView scene{.instances = {&instance, 1}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [&](std::vector<ClipPlane> planes) {
    return [&, planes] {
      FrameOptions o{.clip_planes = planes};
      check(o);
    };
  };
  expect_refused("the frame: clip plane 1 has no direction",
                 with({{{1, 0, 0}, 0}, {{0, 0, 0}, 1}}));
  expect_refused("clip plane 0 is not finite", with({{{nan, 0, 0}, 0}}));
  expect_refused("clip plane 0 is not finite", with({{{1, 0, 0}, nan}}));
  expect_refused("9 clip planes; there are at most 8",
                 with(std::vector<ClipPlane>(9, {{1, 0, 0}, 0})));
  const std::vector<ClipPlane> bad{{{0, 0, 0}, 0}};
  instance.clip_planes = bad;
  Image<float> depth(kW, kH);
  expect_refused("instance 0: clip plane 0",
                 [&] { Painter(options()).render(scene, {}, {.depth = depth}); });
  // An index that is out of range is an error before a plane looks at its vertex.
  const std::vector<std::uint32_t> indices{0, 1, 7};
  instance.geometry = MeshView{.positions = positions, .indices = indices};
  const std::vector<ClipPlane> good{{{1, 0, 0}, 0}};
  instance.clip_planes = good;
  for (const Device device : {Device::serial, Device::threads})
    expect_refused("out of range", [&] {
      RenderOptions o = options();
      o.device = device;
      Painter(o).render(scene, {}, {.depth = depth});
    });
}

}  // namespace
}  // namespace rastrum::test::clip_planes_test
