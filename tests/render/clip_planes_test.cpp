// SPDX-License-Identifier: BSD-3-Clause
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
#include "tests/support/pixels.hpp"
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

/// A generated scene with up to three planes near the camera's target, and a plane for every second
/// instance.
struct Cut {
  GeneratedScene g;
  std::vector<ClipPlane> own;
  std::vector<InstanceView> instances;
  RenderOptions options = clip_planes_test::options();

  explicit Cut(std::uint64_t seed)
      : g(generate(seed, kW, kH)), instances(g.view().instances.begin(), g.view().instances.end()) {
    Random r(seed);
    const auto direction = [&] { return Vec3d{r.real(-1, 1), r.real(-1, 1), r.real(-1, 1)}; };
    const int count = r.integer(0, 3);
    for (int i = 0; i < count; ++i) {
      const Vec3d n = direction(), through = g.camera.target + direction();
      options.clip_planes.push_back({n, -dot(n, through)});
    }
    own.push_back({direction(), r.real(-1, 1)});
    for (std::size_t i = 0; i < instances.size(); i += 2) instances[i].clip_planes = own;
  }
  Cut(const Cut&) = delete;  // the instances' planes belong to this object
  Cut& operator=(const Cut&) = delete;
  [[nodiscard]] SceneView scene() const { return {instances, g.scene.materials, g.scene.textures}; }
};

/// The distance of a corner in front of each of its planes.
std::vector<Real> ahead(const Cut& cut, const InstanceView& instance, Vec3 p) {
  std::vector<Real> values;
  const Point3 in_world = transformed(instance.object_to_world, p);
  for (const ClipPlane& c : cut.options.clip_planes)
    values.push_back(dot(widen(c.normal), in_world) + c.offset);
  for (const ClipPlane& c : instance.clip_planes)
    values.push_back(dot(widen(c.normal), widen(p)) + c.offset);
  return values;
}

TEST(ClipPlanes, KeepThePixelsThatAnOracleKeeps) {
  int seen = 0, cut_away = 0, ties = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const Cut cut(seed);
    const SceneView scene = cut.scene();
    const auto projected = project(scene, cut.g.camera, kW, kH);
    // The oracle takes whole snapped triangles. The next test covers the clipper's.
    if (std::ranges::any_of(projected, [](const auto& t) { return t.fate == Fate::needs_clip; }))
      continue;
    const Frame frame = draw(cut.options, scene, cut.g.camera);
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
    for (const auto& [x, y] : pixels(kW, kH)) {
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
          // A tie, which float64 may decide differently.
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
      seen += nearest != 0 ? 1 : 0;
      const std::int64_t wants =
          nearest == 0 ? -1
                       : static_cast<std::int64_t>((std::uint64_t{1} << 33) - 1 -
                                                   (nearest & ((std::uint64_t{1} << 33) - 1)));
      ASSERT_EQ(frame.ids(x, y), wants) << cut.g.kind << " " << seed << " at " << x << ", " << y;
    }
  }
  EXPECT_GT(seen, 50000);
  EXPECT_GT(cut_away, 50000);
  EXPECT_LT(ties, 100);
  RecordProperty("ties", ties);
}

// All visible points lie in front of the planes, also on clipped triangles.
TEST(ClipPlanes, LeaveNothingBehindThem) {
  int seen = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Cut cut(seed);
    const Frame frame = draw(cut.options, cut.g.view(), cut.g.camera, kIds | kPositions);
    for (std::size_t i = 0; i < frame.ids.pixels().size(); ++i) {
      if (frame.ids.pixels()[i] < 0) continue;
      ++seen;
      const Vec3d p = frame.positions.pixels()[i];
      for (const ClipPlane& c : cut.options.clip_planes)
        ASSERT_GE(dot(c.normal, p) + c.offset,
                  -1e-5 * (length(c.normal) * length(p) + std::abs(c.offset) + 1))
            << cut.g.kind << " " << seed;
    }
  }
  EXPECT_GT(seen, 20000);
}

TEST(ClipPlanes, AreTheSameBitsWhateverDraws) {
  for (const int samples : {1, 4})
    for (const float opacity : {1.0F, 0.5F})
      for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(share_of(24, 6)); ++seed) {
        Cut cut(seed);
        cut.options.samples = samples;
        cut.options.opacity = opacity;
        SCOPED_TRACE(cut.g.kind + " " + std::to_string(seed));
        EveryWay(cut.options).same([&](Painter& painter) {
          return draw(painter, cut.scene(), cut.g.camera);
        });
      }
}

/// With all outputs, and clip planes on surfaces too.
TEST(ClipPlanes, OfEveryRowOfTheFamily) {
  for (const family::AxisInfo& row : family::rasterizer_axis())
    for (const std::uint64_t seed : {0U, 3U, 8U}) {
      const Cut cut(seed);
      const auto drawn = [&](const family::Row& by, bool is_cut) {
        RenderOptions o = is_cut ? cut.options : options();
        static_cast<family::Row&>(o) = by;
        return is_cut ? draw(o, cut.scene(), cut.g.camera)
                      : draw(o, cut.g.view(), cut.g.camera, kSurfaces);
      };
      for (const bool is_cut : {false, true})
        ASSERT_TRUE(same_images(drawn({}, is_cut), drawn({.rasterizer = row.name}, is_cut),
                                is_cut ? kVisible | kOverdraw : kSurfaces))
            << row.name << " " << seed;
    }
}

TEST(ClipPlanes, ThatKeepAllChangeNothingAndThatKeepNothingLeaveNothing) {
  const Mesh sphere = shapes::sphere();
  const OneInstance instance(sphere.view());
  const auto cut_by = [&](std::vector<ClipPlane> planes) {
    RenderOptions o = options();
    o.clip_planes = std::move(planes);
    return draw(o, instance.view(), {.eye = {0, 0, 3}});
  };
  const Frame without = cut_by({});
  const Frame kept = cut_by(std::vector<ClipPlane>(kMaxClipPlanes, {{0, 1, 0}, 100}));
  EXPECT_TRUE(same_surfaces(without, kept));
  EXPECT_TRUE(same_counts(without.stats, kept.stats));
  const Frame none = cut_by({{{0, 0, -1}, -100}});
  EXPECT_EQ(none.stats.pixels_covered, 0U);
  EXPECT_EQ(none.stats.fragments, 0U) << "whole triangles are left out early";
  // Half a sphere shows its inside, which is farther away than its front was.
  const Frame inside = cut_by({{{0, 0, -1}, 0}});
  EXPECT_LT(inside.depth(kW / 2, kH / 2), without.depth(kW / 2, kH / 2));
  EXPECT_GT(inside.depth(kW / 2, kH / 2), 0);
}

TEST(ClipPlanes, OfAnInstanceGoWithIt) {
  const Mesh sphere = shapes::sphere();
  const std::vector<ClipPlane> left{{{-1, 0, 0}, 0}};
  OneInstance turned(sphere.view(), rotation(rotation_about({0, 0, 1}, 1.5707963267948966)));
  turned.clip_planes = left;
  const Frame frame = draw(options(), turned.view(), {.eye = {0, 0, 3}});
  // Its −x is the world's −y, so the lower half stays.
  EXPECT_EQ(frame.ids(kW / 2, kH / 2 - 8), -1);
  EXPECT_GE(frame.ids(kW / 2, kH / 2 + 8), 0);
}

TEST(ClipPlanes, RefuseWhatIsNone) {
  const std::vector<Vec3> positions{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  OneInstance instance(MeshView{.positions = positions});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [&](std::vector<ClipPlane> planes) {
    return [planes] { check(FrameOptions{.clip_planes = planes}); };
  };
  expect_refused("the frame: clip plane 1 has no direction",
                 with({{{1, 0, 0}, 0}, {{0, 0, 0}, 1}}));
  expect_refused("clip plane 0 is not finite", with({{{nan, 0, 0}, 0}}));
  expect_refused("clip plane 0 is not finite", with({{{1, 0, 0}, nan}}));
  expect_refused("9 clip planes; there are at most 8",
                 with(std::vector<ClipPlane>(9, {{1, 0, 0}, 0})));
  const std::vector<ClipPlane> bad{{{0, 0, 0}, 0}};
  instance.clip_planes = bad;
  expect_refused("instance 0: clip plane 0",
                 [&] { (void)draw(options(), instance.view(), {}, kDepth); });
  // An index out of range is an error before a plane tests its vertex.
  const std::vector<std::uint32_t> indices{0, 1, 7};
  instance.show(MeshView{.positions = positions, .indices = indices});
  const std::vector<ClipPlane> good{{{1, 0, 0}, 0}};
  instance.clip_planes = good;
  for (const Device device : {Device::serial, Device::threads})
    expect_refused("out of range", [&] {
      RenderOptions o = options();
      o.device = device;
      (void)draw(o, instance.view(), {}, kDepth);
    });
}

}  // namespace
}  // namespace rastrum::test::clip_planes_test
