// SPDX-License-Identifier: BSD-3-Clause
// Targets and picks of spheres, cylinders, cones, tubes and discs: against the surface oracle,
// beside and through triangles, cut by planes, and with the same bits on every backend.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/render.hpp>

#include "tests/support/picked.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/surface_scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::surface_outputs_test {

constexpr int kW = 40, kH = 27;

SurfaceScene scene_of(int seed, int width = kW, int height = kH) {
  SurfaceScene s = generate_surfaces(static_cast<std::uint64_t>(seed), width, height);
  if (seed % 3 == 1) add_clip_planes(s, static_cast<std::uint64_t>(seed));
  return s;
}

Frame draw(Renderer& renderer, const SurfaceScene& s, FrameOptions frame) {
  frame.width = s.width;
  frame.height = s.height;
  frame.clip_planes = s.clip_planes;
  return test::draw(renderer, s.view(), s.camera, frame, kSurfaces);
}

/// The oracle's surface at a pixel; null for a tie or a triangle.
const SurfaceHit* hit_of(const std::vector<SurfaceHit>& hits, std::int64_t id, float depth) {
  const SurfaceHit* best = nullptr;
  const auto off = [&](const SurfaceHit& h) {
    return std::abs(h.depth - static_cast<Real>(depth));
  };
  for (const SurfaceHit& h : hits)
    if (h.id == id && (best == nullptr || off(h) < off(*best))) best = &h;
  return best != nullptr && off(*best) <= 1e-6L * static_cast<Real>(depth) + 1e-12L ? best
                                                                                    : nullptr;
}

/// Checked pixels, and those that differ by more than rounding: where an end meets a side, or at
/// silhouettes.
struct Seen {
  int pixels = 0, position = 0, normal = 0, along = 0, backs = 0, inside = 0;
};

void check_pixel(const SurfaceScene& s, const Frame& images, const SurfaceHit& hit, int x, int y,
                 Seen& seen) {
  ++seen.pixels;
  seen.backs += hit.front ? 0 : 1;
  const auto p = std::ranges::find(s.primitives, hit.id, &SurfacePrimitive::id);
  const Real reach = std::max(p->r0, p->r1);
  const Real off = length(hit.position - widen(images.positions(x, y)));
  seen.position += off > 2e-7L * length(hit.position) + 1e-6L * reach ? 1 : 0;
  // Unit length, towards the viewer.
  const Vec3 n = images.normals(x, y);
  ASSERT_NEAR(length(n), 1, 1e-6);
  const OracleCamera& eye = s.eye;
  const Point3 from_eye = hit.position - eye.eye;
  const Point3 ray = eye.orthographic ? Point3{0, 0, -1} : from_eye;
  ASSERT_LE(dot(ray, widen(n)) / length(ray), 1e-4L);
  const Point3 unit = hit.normal * (1 / length(hit.normal));
  const Vec3 outwards{static_cast<float>(unit.x), static_cast<float>(unit.y),
                      static_cast<float>(unit.z)};
  seen.normal += std::min(length(n - outwards), length(n + outwards)) > 1e-4F ? 1 : 0;
  seen.inside += length(n - outwards) > 1 ? 1 : 0;
  // The camera's axes equal the world's.
  ASSERT_LE(length(images.camera_normals(x, y) - n), 1e-6F);
  seen.along +=
      std::abs(static_cast<Real>(images.barycentrics(x, y).x) - hit.along) > 1e-4L ? 1 : 0;
  ASSERT_EQ(images.barycentrics(x, y).y, 0);
  const auto z = static_cast<double>(hit.view_depth);
  ASSERT_NEAR(images.view_depth(x, y), z, 2e-5 * z);
  const auto away = static_cast<double>(eye.orthographic ? hit.view_depth : length(from_eye));
  ASSERT_NEAR(images.distance(x, y), away, 2e-5 * away);
}

TEST(SurfaceOutputs, AreThoseOfTheOracle) {
  Renderer renderer({.threads = 1});
  Seen seen;
  const int scenes = share_of(660, 110);
  int empty = 0, ties = 0;
  for (int seed = 0; seed < scenes; ++seed) {
    const SurfaceScene s = scene_of(seed);
    SCOPED_TRACE(s.kind + " " + std::to_string(seed));
    FrameOptions frame{.cull = seed % 5 == 2 ? Cull::front : Cull::none};
    const Frame images = draw(renderer, s, frame);
    for (const auto& [x, y] : pixels(kW, kH)) {
      const std::int64_t id = images.ids(x, y);
      if (id < 0) {
        ++empty;
        ASSERT_EQ(images.instances(x, y), -1);
        ASSERT_EQ(images.positions(x, y), Vec3{});
        ASSERT_EQ(images.normals(x, y), Vec3{});
        continue;
      }
      const Located at = locate(s.view(), static_cast<std::uint64_t>(id));
      ASSERT_EQ(images.instances(x, y), static_cast<std::int64_t>(at.instance));
      ASSERT_EQ(images.primitives(x, y), static_cast<std::int64_t>(at.primitive));
      // At or beyond the far plane, depth does not tell the sides apart.
      if (s.instances[at.instance].mesh() != nullptr || !(images.depth(x, y) > 0)) continue;
      const auto hits = surfaces_at(s.eye, s.primitives, x + 0.5L, y + 0.5L);
      const SurfaceHit* const hit = hit_of(hits, id, images.depth(x, y));
      ties += hit == nullptr ? 1 : 0;
      if (hit != nullptr) check_pixel(s, images, *hit, x, y, seen);
      if (HasFatalFailure()) FAIL() << "at " << x << ", " << y;
    }
  }
  EXPECT_GT(seen.pixels, 150 * scenes);
  EXPECT_GT(seen.backs, 7 * scenes);
  EXPECT_GT(seen.inside, 7 * scenes);
  EXPECT_GT(empty, 150 * scenes);
  EXPECT_LE(ties, seen.pixels / 5000);
  EXPECT_LE(seen.position, seen.pixels / 20000);
  EXPECT_LE(seen.normal, seen.pixels / 20000);
  EXPECT_LE(seen.along, seen.pixels / 20000);
}

TEST(SurfaceOutputs, ArePickedOneByOne) {
  Renderer renderer({.threads = 1});
  const int scenes = share_of(330, 110);
  int seen = 0, fronts = 0;
  for (int seed = 0; seed < scenes; ++seed) {
    const SurfaceScene s = scene_of(seed, 150, 97);
    FrameOptions frame{.width = s.width,
                       .height = s.height,
                       .opacity = seed % 4 == 1 ? 0.4F : 1,
                       .samples = seed % 5 == 2 ? 4 : 1,
                       .clip_planes = s.clip_planes};
    const Frame images = draw(renderer, s, frame);
    Random r(static_cast<std::uint64_t>(seed));
    for (int n = 0; n < 6; ++n) {
      const int x = r.integer(0, s.width - 1), y = r.integer(0, s.height - 1);
      SCOPED_TRACE(s.kind + " " + std::to_string(seed) + " at " + std::to_string(x) + ", " +
                   std::to_string(y));
      const std::optional<Pick> p = renderer.pick(s.view(), s.camera, frame, x, y);
      ASSERT_EQ(p.has_value(), images.ids(x, y) >= 0);
      if (!p) continue;
      ASSERT_NO_FATAL_FAILURE(expect_picked(*p, images, x, y));
      const auto& b = p->barycentrics.weight;
      if (s.instances[p->instance].mesh() != nullptr) continue;
      ++seen;
      ASSERT_EQ(b[0] + b[1], 1);
      const Barycentrics again = barycentrics(s.view(), s.camera, s.width, s.height, p->id, x, y);
      fronts += std::memcmp(&again, &p->barycentrics, sizeof again) == 0 ? 1 : 0;
      // Their place is on the primitive's axis.
      const auto of =
          std::ranges::find(s.primitives, static_cast<std::int64_t>(p->id), &SurfacePrimitive::id);
      const bool one_end = of->kind == SurfaceKind::sphere || of->kind == SurfaceKind::disc;
      const Real u = one_end ? 0 : static_cast<Real>(b[1]);
      const Point3 want = of->to_world(one_end ? of->p0 : of->p0 + (of->p1 - of->p0) * u);
      const Vec3d axis = position(s.view(), {p->instance, p->primitive}, p->barycentrics);
      const Point3 off = widen(axis) - want;
      ASSERT_LE(std::abs(off.x) + std::abs(off.y) + std::abs(off.z),
                1e-12L * (length(want) + length(of->p0) + length(of->p1)));
    }
  }
  EXPECT_GT(seen, scenes * 9 / 10);
  EXPECT_GT(fronts, seen * 3 / 4);
}

/// A scene of one geometry before an eye at the origin that looks along −z.
struct One {
  std::vector<Vec3> centers{{0, 0, -4}};
  std::vector<Vec4> colors{{0.5F, 0.25F, 1, 0.5F}};
  std::vector<Material> materials;
  OneInstance instance{SpheresView{.centers = centers, .colors = colors}};

  One() = default;
  One(const One&) = delete;
  One& operator=(const One&) = delete;
  [[nodiscard]] Frame draw(FrameOptions frame, int size, const RendererOptions& by = {},
                           unsigned kinds = kSurfaces) const {
    frame.width = frame.height = size;
    return test::draw(by, {instance.view().instances, materials, {}},
                      {.eye = {0, 0, 0}, .target = {0, 0, -1}}, frame, kinds);
  }
};

// If only a sample covers the surface, the point is the sample's.
TEST(SurfaceOutputs, OfSeveralSamplesLieOnTheSurface) {
  const One one;
  const Frame images = one.draw({.samples = 8}, 31), centre = one.draw({}, 31);
  int beside = 0;
  for (const auto& [x, y] : pixels(31, 31)) {
    if (images.ids(x, y) < 0) continue;
    const Vec3 from = images.positions(x, y) - one.centers[0];
    ASSERT_NEAR(length(from), 1, 1e-6);
    ASSERT_LE(length(images.normals(x, y) - from), 1e-6F);
    if (centre.ids(x, y) >= 0)
      ASSERT_EQ(images.positions(x, y), centre.positions(x, y));
    else
      ++beside;
  }
  EXPECT_GT(beside, 10);
}

TEST(SurfaceOutputs, AlbedoIsTheBaseColourBeforeLight) {
  One one;
  const auto albedo = [&](Shader shader) {
    const Frame f = one.draw({.shader = shader}, 15, {}, kAlbedo);
    EXPECT_EQ(f.albedo(0, 0), Vec4{});
    return f.albedo(7, 7);
  };
  const Vec4 light = raster::converted(one.colors[0], ColorSpace::display, ColorSpace::linear);
  EXPECT_NEAR(light.y, 0.0508761F, 1e-6F);
  for (const Shader shader : {Shader::phong, Shader::depth, Shader::material})
    EXPECT_EQ(albedo(shader), light);
  one.materials.resize(1);
  one.materials[0].base_color = {1, 0.5F, 0.5F, 0.5F};
  for (const Shader shader : {Shader::phong, Shader::material})
    EXPECT_EQ(albedo(shader), one.materials[0].base_color * light);
  one.instance.color = Vec4{0, 1, 0, 1};
  EXPECT_EQ(albedo(Shader::flat), (Vec4{0, 0.5F, 0, 0.5F}));
  one.instance.color = {};
  one.instance.show(SpheresView{.centers = one.centers});
  one.materials.clear();
  EXPECT_EQ(albedo(Shader::flat), plain_material(false).base_color);
}

// If a tube's thick end contains its thin end, all is the thick end: its colour, its place on the
// axis.
TEST(SurfaceOutputs, OfATubeThatOneEndHoldsAreThatEnds) {
  const std::vector<Vec3> positions{{0, 0, -4}, {0, 0.25F, -4}};
  const std::vector<Vec4> colors{{1, 0, 0, 1}, {0, 1, 0, 1}};
  One one;
  for (const bool second : {false, true}) {
    const std::vector<float> radii{second ? 0.25F : 1.0F, second ? 1.0F : 0.25F};
    one.instance.show(TubesView{.positions = positions, .radii = radii, .colors = colors});
    const Frame images = one.draw({.shader = Shader::flat}, 15, {}, kColor | kSurfaces);
    EXPECT_EQ(images.color(7, 7), colors[second ? 1 : 0]);
    EXPECT_EQ(images.barycentrics(7, 7), (Vec2{second ? 1.0F : 0.0F, 0}));
    EXPECT_EQ(images.albedo(7, 7), colors[second ? 1 : 0]);
  }
}

// AlphaMode::mask by a quadric's values: the factor and the colours, linear along the axis. It cuts
// off the nearer end, so the inside is visible.
TEST(SurfaceOutputs, MasksCutWhatTheirColoursSay) {
  const std::vector<Vec3> positions{{-0.5F, 0, -3}, {0.5F, 0.25F, -6}};
  const std::vector<Vec4> colors{{1, 1, 1, 0}, {1, 1, 1, 1}};
  One one;
  one.instance.show(CylindersView{.positions = positions, .radius = 0.75F, .colors = colors});
  one.materials.resize(1);
  one.materials[0].base_color.w = 0.5F;
  one.materials[0].alpha_mode = AlphaMode::mask;
  one.materials[0].alpha_cutoff = 0.125F;
  const Vec3d start = positions[0], axis = Vec3d(positions[1]) - start;
  for (const Shader shader : {Shader::flat, Shader::material, Shader::depth})
    for (const int samples : {1, 4})
      for (const RendererOptions& by :
           {RendererOptions{.device = Device::serial}, RendererOptions{.threads = 2}}) {
        const Frame images = one.draw({.shader = shader, .samples = samples}, 60, by);
        int outside = 0, inside = 0;
        for (const auto& [x, y] : pixels(60, 60)) {
          if (images.ids(x, y) < 0) continue;
          const Vec3d from = Vec3d(images.positions(x, y)) - start;
          const double along = dot(from, axis) / dot(axis, axis);
          // A pixel of several samples is tested at one of them.
          ASSERT_GE(along, samples == 1 ? 0.25 - 1e-6 : 0.15) << x << ", " << y;
          const Vec3d across = from - axis * along;
          (dot(across, Vec3d(images.normals(x, y))) < 0 ? inside : outside) += along < 0.99;
        }
        EXPECT_GT(inside, 100);
        EXPECT_GT(outside, 30);
      }
}

TEST(SurfaceOutputs, PlanesThatKeepAllChangeNothingAndThatKeepNothingLeaveNothing) {
  One one;
  const auto cut_by = [&](std::vector<ClipPlane> planes) {
    return one.draw({.clip_planes = std::move(planes)}, 31, {.threads = 1});
  };
  const Frame whole = cut_by({});
  const Frame kept = cut_by(std::vector<ClipPlane>(kMaxClipPlanes, {{0, 1, 0}, 2}));
  EXPECT_TRUE(same_images(whole, kept));
  EXPECT_EQ(whole.stats.fragments, kept.stats.fragments)
      << "no fragment is asked for, and no back is made";
  const FrameStats none = cut_by({{{0, 1, 0}, -2}}).stats;
  EXPECT_EQ(none.pixels_covered, 0U);
  EXPECT_EQ(none.fragments, 0U);
  EXPECT_EQ(none.triangles.culled, 1U);
  // A cut sphere shows its inside, turned to the viewer.
  const Frame inside = cut_by({{{0, 0, -1}, -4}});
  EXPECT_LT(inside.positions(15, 15).z, -4.9F);
  EXPECT_GT(inside.normals(15, 15).z, 0.9F);
  const std::vector<ClipPlane> bad{{{0, 0, 0}, 1}};
  one.instance.clip_planes = bad;
  expect_refused("instance 0: clip plane 0 has no direction", [&] { (void)cut_by({}); });
}

}  // namespace rastrum::test::surface_outputs_test
