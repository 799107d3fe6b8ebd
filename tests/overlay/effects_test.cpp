// SPDX-License-Identifier: BSD-3-Clause
// Ambient occlusion, eye-dome lighting and silhouettes: equal bits for all threads, instruction
// sets and layouts, and their formulas in float64.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/effects.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/overlay/effects/lens.hpp>
#include <rastrum/overlay/effects/occlusion.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/golden.hpp"
#include "tests/support/isa.hpp"
#include "tests/support/pixels.hpp"

namespace rastrum::effects_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Drawn {
  Camera camera;
  Image<float> depth;
  Image<Vec3> normals;
  Image<std::int64_t> ids;

  [[nodiscard]] Surface surface() const { return {depth.view(), normals.view(), ids.view()}; }
};

Drawn drawn(const std::string& spec, int width, int height, bool orthographic = false) {
  const Scene scene = shapes::scene_from_spec(spec);
  const SceneBinding binding(scene);
  Camera view{.eye = {1.2, 0.9, 1.7}, .orthographic = orthographic};
  Drawn d{fit_picture(binding.view(), view, width, height), Image<float>(width, height),
          Image<Vec3>(width, height), Image<std::int64_t>(width, height)};
  Renderer renderer;
  renderer.render(binding.view(), d.camera, {.width = width, .height = height},
                  {.instances = d.ids, .camera_normals = d.normals, .view_depth = d.depth});
  return d;
}

Image<float> occlusion(Effects& effects, const Drawn& d, const AmbientOcclusion& options) {
  Image<float> factor(d.depth.width(), d.depth.height());
  effects.ambient_occlusion(d.surface(), d.camera, options, factor);
  return factor;
}

float least(const Image<float>& image) {
  return *std::min_element(image.pixels().begin(), image.pixels().end());
}

constexpr int kWide = 160, kHigh = 120;
/// Looks along −z.
const Camera kAhead{.eye = {0, 0, 0}, .target = {0, 0, -1}};

/// A picture made from planes: f gives the depth and normal of each pixel.
template <class F>
Drawn made(int width, int height, F&& f) {
  Drawn d{kAhead, Image<float>(width, height), Image<Vec3>(width, height),
          Image<std::int64_t>(width, height)};
  const overlay::Lens lens = overlay::lens_of(kAhead, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = lens.ux * (x + 0.5) + lens.uy * (y + 0.5) + lens.u0,
                   v = lens.vy * (y + 0.5) + lens.v0;
      const auto [depth, normal] = f(u, v);
      d.depth(x, y) = static_cast<float>(depth);
      d.normals(x, y) = normal;
    }
  return d;
}

/// Two walls at a right angle that meet at x = 0, z = −4 and open towards the eye.
Drawn corner() {
  const auto half = static_cast<float>(std::numbers::sqrt2 / 2);
  return made(kWide, kHigh, [&](double u, double) {
    return std::pair{4 / (1 + std::fabs(u)), u < 0 ? Vec3{half, 0, half} : Vec3{-half, 0, half}};
  });
}

TEST(Effects, AreTheSameBitsForThreadsInstructionSetsAndLayouts) {
  for (const bool orthographic : {false, true})
    for (const auto& [width, height] : {std::pair{331, 203}, {64, 48}, {5, 3}}) {
      const Drawn d = drawn("gyroid?cells=24", width, height, orthographic);
      // Rows are stored bottom-up, with gaps between them.
      const int stride = width + 7;
      std::vector<float> turned(static_cast<std::size_t>(stride * height));
      const ImageView<float> view{turned.data() + stride * (height - 1), width, height, -stride};
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) view(x, y) = d.depth(x, y);
      const auto all_by = [&, width = width, height = height](int threads, Isa isa) {
        Effects effects(threads, isa);
        Surface surface = d.surface();
        if (threads == 3) surface.view_depth = view;
        std::array<Image<float>, 4> images;
        images.fill(Image<float>(width, height));
        effects.ambient_occlusion(surface, d.camera, {.radius = 0.5}, images[0]);
        effects.ambient_occlusion({.view_depth = surface.view_depth}, d.camera, {.radius = 0.5},
                                  images[1]);
        effects.eye_dome(surface, d.camera, {}, images[2]);
        effects.silhouettes(surface, d.camera, {}, images[3]);
        return images;
      };
      const auto expected = all_by(1, Isa::scalar);
      for (const Isa isa : available_isas())
        for (const int threads : {1, 3}) {
          const auto images = all_by(threads, isa);
          for (std::size_t i = 0; i < images.size(); ++i)
            ASSERT_EQ(digest(images[i].view()), digest(expected[i].view()))
                << name(isa) << ", " << threads << " threads, " << width << "x" << height;
        }
      if (width == 331) {
        const std::string kind = orthographic ? "orthographic" : "perspective";
        const char* const names[] = {"occlusion_", "occlusion_by_depth_", "eye_dome_",
                                     "silhouettes_"};
        for (std::size_t i = 0; i < std::size(names); ++i)
          EXPECT_TRUE(test::matches_golden(std::string("effects/") + names[i] + kind,
                                           digest(expected[i].view())));
        EXPECT_LT(least(expected[0]), 0.85F);
      }
    }
}

// Occlusion works on tiles of 128 × 32 px in bands. Whole rows and rows that are cut where lanes
// may begin give the same bits.
TEST(Effects, OcclusionIsTheSameBitsHoweverRowsAreCut) {
  constexpr int kWidth = 301, kHeight = 71;
  for (const bool by_depth : {false, true}) {
    const Drawn d = drawn("gyroid?cells=24", kWidth, kHeight);
    Surface surface = d.surface();
    if (by_depth) surface = {.view_depth = d.depth.view()};
    const AmbientOcclusion options{.radius = 0.5};
    const overlay::OcclusionFrame frame = overlay::occlusion_frame(surface, d.camera, options);
    Image<float> rows(kWidth, kHeight), across(kWidth, kHeight), whole(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      overlay::occlusion_plain(frame, y, 0, kWidth, rows.view().row(y));
      overlay::blur_plain(frame, rows.view().row(y), y, {false, 1}, 0, kWidth,
                          across.view().row(y));
    }
    for (int y = 0; y < kHeight; ++y)
      overlay::blur_plain(frame, across.view().row(y), y, {true, across.view().stride}, 0, kWidth,
                          whole.view().row(y));
    EXPECT_LT(least(whole), 0.85F);
    for (const Isa isa : available_isas()) {
      Image<float> factor(kWidth, kHeight), cut(kWidth, kHeight);
      Effects(3, isa).ambient_occlusion(surface, d.camera, options, factor);
      EXPECT_EQ(digest(factor.view()), digest(whole.view())) << name(isa);
      std::uint32_t state = 9;
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0, end = 0; x < kWidth; x = end) {
          state = state * 1664525 + 1013904223;
          end = std::min(kWidth, x + 16 * static_cast<int>(1 + (state >> 24) % 5));
          overlay::occlusion_kernel(isa)(frame, y, x, end, cut.view().row(y));
        }
      EXPECT_EQ(digest(cut.view()), digest(rows.view())) << name(isa);
    }
  }
}

// The effects on a part of the picture, with the border that they read, equal that part of the
// whole picture's effects.
TEST(Effects, DomesAndSilhouettesOfAPartAreThatPart) {
  constexpr int kWidth = 150, kHeight = 90, kAround = 2;
  const Drawn d = drawn("gyroid?cells=24", kWidth, kHeight);
  Effects effects(2);
  Image<float> dome(kWidth, kHeight), lines(kWidth, kHeight);
  effects.eye_dome(d.surface(), d.camera, {.radius_px = kAround}, dome);
  effects.silhouettes(d.surface(), d.camera, {.width_px = 1}, lines);
  EXPECT_LT(least(dome), 0.5F);
  const auto part = [](const auto& view, int x, int y, int w, int h) {
    return std::remove_cvref_t<decltype(view)>{view.data + y * view.stride + x, w, h, view.stride};
  };
  for (const auto& [x0, y0, w, h] : {std::array{0, 0, 64, 90}, {60, 0, 90, 33}, {60, 29, 90, 61}}) {
    Surface surface = d.surface();
    surface = {part(surface.view_depth, x0, y0, w, h), part(surface.normals, x0, y0, w, h),
               part(surface.ids, x0, y0, w, h)};
    Image<float> of_part(w, h), lines_of_part(w, h);
    effects.eye_dome(surface, d.camera, {.radius_px = kAround}, of_part);
    effects.silhouettes(surface, d.camera, {.width_px = 1}, lines_of_part);
    // A border is missing only at the picture's edge.
    const int left = x0 > 0 ? kAround : 0, top = y0 > 0 ? kAround : 0,
              right = x0 + w < kWidth ? kAround : 0, bottom = y0 + h < kHeight ? kAround : 0;
    for (int y = top; y < h - bottom; ++y)
      for (int x = left; x < w - right; ++x) {
        ASSERT_EQ(of_part(x, y), dome(x0 + x, y0 + y)) << x << ", " << y;
        ASSERT_EQ(lines_of_part(x, y), lines(x0 + x, y0 + y)) << x << ", " << y;
      }
  }
}

TEST(Effects, LensFindsPointsAgain) {
  Mat4d pose = Mat4d::identity();
  pose.m[2][3] = 5;
  const Camera cameras[] = {Camera{.eye = {1, 2, 3}},
                            Camera{.eye = {1, 2, 3}, .orthographic = true, .far_plane = 100},
                            camera_from_opencv({900, 870, 280, 260, 3}, pose, 640, 480)};
  for (const Camera& camera : cameras) {
    const Mat4d to_clip = world_to_clip(camera, 640, 480), to_camera = world_to_camera(camera);
    const overlay::Lens lens = overlay::lens_of(camera, 640, 480);
    const auto clip = test::product(to_clip, 0.2, 0.3, -0.4),
               seen = test::product(to_camera, 0.2, 0.3, -0.4);
    const double x = (clip[0] / clip[3] + 1) * 320, y = (1 - clip[1] / clip[3]) * 240;
    const double s = lens.perspective ? -seen[2] : 1;
    EXPECT_NEAR((lens.ux * x + lens.uy * y + lens.u0) * s, seen[0], 1e-9);
    EXPECT_NEAR((lens.vy * y + lens.v0) * s, seen[1], 1e-9);
  }
}

TEST(AmbientOcclusion, LeavesPlanesAndDarkensCorners) {
  // A slanted plane: n · p = −3.
  const Vec3 n{0.36F, 0.48F, 0.8F};
  const Drawn plane = made(kWide, kHigh, [&](double u, double v) {
    return std::pair{3 / (0.8 - 0.36 * u - 0.48 * v), n};
  });
  Effects effects;
  EXPECT_EQ(least(occlusion(effects, plane, {.radius = 0.5})), 1);
  const Image<float> dark = occlusion(effects, corner(), {.radius = 0.5});
  EXPECT_NEAR(dark(80, 60), 0.25, 0.1);
  EXPECT_EQ(dark(10, 60), 1);
  for (int x = 80; x < 110; ++x) EXPECT_LE(dark(x, 60), dark(x + 1, 60) + 0.02F) << x;
  // The same edge from outside has no occlusion.
  const auto half = static_cast<float>(std::numbers::sqrt2 / 2);
  const Drawn ridge = made(kWide, kHigh, [&](double u, double) {
    return std::pair{3 / (1 - std::fabs(u)), u < 0 ? Vec3{-half, 0, half} : Vec3{half, 0, half}};
  });
  EXPECT_EQ(least(occlusion(effects, ridge, {.radius = 0.5})), 1);
}

TEST(AmbientOcclusion, FindsNormalsFromDepth) {
  Effects effects;
  const AmbientOcclusion options{.radius = 0.5, .samples = 16};
  const Image<float> given = occlusion(effects, corner(), options);
  Image<float> found(kWide, kHigh);
  effects.ambient_occlusion({.view_depth = corner().depth.view()}, kAhead, options, found);
  // Pixels beside the fold have a neighbour on the other wall, and the blur spreads it.
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      ASSERT_NEAR(given(x, y), found(x, y), x < 74 || x > 85 ? 0.01 : 0.15) << x << ", " << y;
  // The normals themselves, with an arbitrary camera: those of a frame with flat faces.
  for (const bool orthographic : {false, true}) {
    const Drawn boxes = drawn("boxes?count=2", 200, 150, orthographic);
    const Surface depth_alone{.view_depth = boxes.depth.view()};
    const overlay::OcclusionFrame frame =
        overlay::occlusion_frame(depth_alone, boxes.camera, {.radius = 0.5});
    int near = 0, all = 0;
    for (int y = 0; y < 150; ++y)
      for (int x = 0; x < 200; ++x) {
        if (!(boxes.depth(x, y) < kInfinity)) continue;
        ++all;
        near += dot(overlay::normal_from_depth(frame, x, y), boxes.normals(x, y)) > 0.99F;
      }
    // Except at creases, where the nearer neighbour may be on another face.
    EXPECT_GT(all, 3000);
    EXPECT_GT(near, all * 94 / 100) << orthographic;
  }
}

TEST(AmbientOcclusion, IsNotTakenFromFarAheadNorFromNothing) {
  const Drawn disc = made(80, 60, [&](double u, double v) {
    const double r = u * u + v * v;
    if (r < 0.05) return std::pair{2.0, Vec3{0, 0, 1}};
    if (r < 0.2) return std::pair{9.0, Vec3{0, 0, 1}};
    return std::pair{static_cast<double>(kInfinity), Vec3{}};
  });
  Effects effects;
  EXPECT_EQ(least(occlusion(effects, disc, {.radius = 1})), 1);
}

TEST(EyeDome, IsItsFormula) {
  const Drawn d = drawn("boxes?count=3", 97, 61);
  Effects effects;
  Image<float> factor(97, 61);
  effects.eye_dome(d.surface(), d.camera, {.strength = 0.7, .radius_px = 2}, factor);
  const int around[8][2] = {{2, 0}, {1, 1}, {0, 2}, {-1, 1}, {-2, 0}, {-1, -1}, {0, -2}, {1, -1}};
  int dark = 0;
  for (int y = 0; y < 61; ++y)
    for (int x = 0; x < 97; ++x) {
      double sum = 0;
      if (d.depth(x, y) < kInfinity)
        for (const auto& [dx, dy] : around) {
          if (x + dx < 0 || x + dx >= 97 || y + dy < 0 || y + dy >= 61) continue;
          const double q = d.depth(x + dx, y + dy), p = d.depth(x, y);
          if (q < p) sum += std::log(p / q);
        }
      // (1 − t/16)¹⁶ is below exp(−t) by at most 0.02.
      const double wanted = std::exp(-100 * 0.7 / 8 * sum);
      ASSERT_NEAR(factor(x, y), wanted, 0.02) << x << ", " << y;
      dark += wanted < 0.5;
    }
  EXPECT_GT(dark, 50);
}

TEST(Silhouettes, AreWhereSurfacesEndAndBend) {
  // A square in front of a slanted plane in front of an empty background.
  Drawn d = made(40, 40, [&](double u, double v) {
    if (std::fabs(u) < 0.2 && std::fabs(v) < 0.2) return std::pair{2.0, Vec3{0, 0, 1}};
    if (std::fabs(u) < 0.4 && std::fabs(v) < 0.4)
      return std::pair{4 / (1 - 0.5 * u), Vec3{0, 0, 1}};
    return std::pair{static_cast<double>(kInfinity), Vec3{}};
  });
  Effects effects;
  Image<float> factor(40, 40);
  effects.silhouettes(d.surface(), kAhead, {}, factor);
  const auto is_there = [&](int x, int y) {
    return x >= 0 && x < 40 && y >= 0 && y < 40 && d.depth(x, y) < kInfinity;
  };
  EXPECT_TRUE(test::pixels_are(factor, [&](int x, int y) {
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
      if (is_there(x, y) &&
          (!is_there(x + dx, y + dy) || (d.depth(x, y) == 2 && d.depth(x + dx, y + dy) != 2)))
        return 0.0F;
    return 1.0F;
  }));
  // Only normals and ids.
  for (float& depth : d.depth.pixels()) depth = 3;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      d.normals(x, y) = x < 10 ? Vec3{0, 0, 1} : x < 30 ? Vec3{0.6F, 0, 0.8F} : Vec3{};
      d.ids(x, y) = y < 20 ? 4 : 5;
    }
  effects.silhouettes(d.surface(), kAhead, {}, factor);
  EXPECT_TRUE(
      test::pixels_are(factor, [](int x, int y) { return x == 9 || y == 19 ? 0.0F : 1.0F; }));
  effects.silhouettes(d.surface(), kAhead, {.angle_degrees = 40, .instances = false}, factor);
  for (const float f : factor.pixels()) ASSERT_EQ(f, 1);
}

TEST(Effects, DarkenMixesTowardsInkAndKeepsAlpha) {
  Image<Rgba8> color8(2, 1);
  Image<Vec4> color(2, 1);
  Image<float> factor(2, 1);
  color8(0, 0) = color8(1, 0) = {200, 100, 50, 128};
  color(0, 0) = color(1, 0) = {0.4F, 0.2F, 0.1F, 0.5F};
  factor(0, 0) = 0.5F;
  factor(1, 0) = 1;
  Effects effects;
  effects.darken(color8, color, factor, {1, 0, 0});
  EXPECT_EQ(color8(0, 0), (Rgba8{228, 50, 25, 128}));
  EXPECT_EQ(color8(1, 0), (Rgba8{200, 100, 50, 128}));
  EXPECT_NEAR(color(0, 0).x, 0.2 + 0.25, 1e-6);
  EXPECT_EQ(color(0, 0).w, 0.5F);
  EXPECT_EQ(color(1, 0).x, 0.4F);
}

// Only some tiles have a surface. One object is used twice, so that leftovers in its scratch would
// show.
TEST(Effects, OccludeIsOcclusionAndDarkenAtOnce) {
  constexpr int kWidth = 700, kHeight = 200;
  const auto painted = [] {
    std::pair<Image<Rgba8>, Image<Vec4>> p{Image<Rgba8>(kWidth, kHeight),
                                           Image<Vec4>(kWidth, kHeight)};
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const auto byte = [&](int k) { return static_cast<std::uint8_t>(x * k + y * 31); };
        p.first(x, y) = {byte(1), byte(3), byte(7), byte(5)};
        p.second(x, y) = {static_cast<float>(x) / kWidth, 0.5F, static_cast<float>(y) / kHeight, 1};
      }
    return p;
  };
  for (const Isa isa : available_isas())
    for (const int threads : {1, 3}) {
      Effects together(threads, isa), apart(threads, isa);
      for (const char* spec : {"gyroid?cells=24", "torus_knot"}) {
        const Drawn d = drawn(spec, kWidth, kHeight);
        auto [want8, want] = painted();
        auto [got8, got] = painted();
        const Vec3 ink{0.25F, 0, 0.5F};
        const Image<float> factor = occlusion(apart, d, {.radius = 0.5});
        ASSERT_LT(least(factor), 0.9F);
        apart.darken(want8, want, factor.view(), ink);
        together.occlude(d.surface(), d.camera, {.radius = 0.5}, got8, got, ink);
        EXPECT_EQ(digest(got8.view()), digest(want8.view())) << spec << ", " << name(isa);
        EXPECT_EQ(digest(got.view()), digest(want.view())) << spec << ", " << name(isa);
      }
      Image<Rgba8> small(kWidth - 1, kHeight);
      const Drawn d = drawn("torus_knot", kWidth, kHeight);
      EXPECT_THROW(together.occlude(d.surface(), d.camera, {.radius = 0.5}, small, {}), Error);
    }
}

TEST(Effects, DarkenIsTheSameOnEveryInstructionSet) {
  constexpr int kWidth = 67, kHeight = 64;
  Image<Rgba8> before(kWidth, kHeight);
  Image<float> factor(kWidth, kHeight);
  std::uint32_t state = 1;
  const auto random = [&] { return (state = state * 1664525 + 1013904223) >> 8; };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
      before(x, y) = {byte(), byte(), byte(), byte()};
      // Whole rows and single pixels that do not change, and halves that are ties.
      factor(x, y) = y % 4 == 0 || random() % 3 == 0 ? 1.0F
                     : random() % 2 == 0             ? 0.5F
                                                     : static_cast<float>(random() % 1025) / 1024;
    }
  for (const Vec3 ink : {Vec3{0, 0, 0}, Vec3{0.2F, 1, 0.5F}})
    for (const Isa isa : available_isas()) {
      Image<Rgba8> after = before;
      Effects(1, isa).darken(after, {}, factor.view(), ink);
      const auto expected = [&](int x, int y) {
        const Rgba8 c = before(x, y);
        const auto mixed = [f = factor(x, y)](std::uint8_t from, float to) {
          return static_cast<std::uint8_t>(
              std::nearbyint(static_cast<float>(from) * f + to * 255.0F * (1 - f)));
        };
        return Rgba8{mixed(c.r, ink.x), mixed(c.g, ink.y), mixed(c.b, ink.z), c.a};
      };
      EXPECT_TRUE(test::pixels_are(after, expected)) << name(isa);
    }
}

// A leaf on the left half of a blended quad: effects see the leaf, and nothing beside it.
TEST(Effects, LookAtTexturesThatBlendWhereTheyAreSolid) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.texcoords.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.instances.resize(1);
  Texture& texture = scene.textures.emplace_back();
  texture.image = Image<Rgba8>(8, 1);
  for (int x = 0; x < 8; ++x)
    texture.image(x, 0) = {0, 255, 0, static_cast<std::uint8_t>(x < 4 ? 255 : 0)};
  Material& material = scene.materials.emplace_back();
  EXPECT_TRUE(materials_of_surface(SceneBinding(scene).view()).empty());
  material.alpha_mode = AlphaMode::blend;
  EXPECT_TRUE(materials_of_surface(SceneBinding(scene).view()).empty());
  material.base_color_texture = 0;
  const SceneBinding binding(scene);
  const std::vector<Material> solid = materials_of_surface(binding.view());
  ASSERT_EQ(solid.size(), 1U);
  SceneView view = binding.view();
  view.materials = solid;
  Image<float> depth(40, 40);
  Renderer({.threads = 1})
      .render(view, Camera{.eye = {0, 0, 2}}, {.width = 40, .height = 40}, {.view_depth = depth});
  EXPECT_NEAR(depth(10, 20), 2, 1e-5);
  EXPECT_EQ(depth(30, 20), kInfinity);
}

TEST(Effects, RefuseWhatIsOutOfRange) {
  const Drawn d = drawn("teapot", 16, 12);
  Effects effects;
  Image<float> factor(16, 12), other(16, 13);
  const double nan = std::nan("");
  const AmbientOcclusion bad_occlusion[] = {{},  // no radius
                                            {.radius = -1},
                                            {.radius = nan},
                                            {.radius = 1e-38},
                                            {.radius = 1e-32},
                                            {.radius = 1e38},
                                            {.radius = HUGE_VAL},
                                            {.radius = 1, .strength = nan},
                                            {.radius = 1, .strength = -1},
                                            {.radius = 1, .samples = 0}};
  for (const AmbientOcclusion& options : bad_occlusion)
    EXPECT_THROW(occlusion(effects, d, options), Error) << options.radius;
  // With a valid radius all factors are in [0, 1].
  for (const double radius : {1e-29, 1e37}) {
    const Image<float> factors = occlusion(effects, d, {.radius = radius, .strength = 16});
    for (const float f : factors.pixels()) ASSERT_TRUE(f >= 0 && f <= 1) << radius;
  }
  Surface surface = d.surface();
  EXPECT_THROW(effects.ambient_occlusion(surface, d.camera, {.radius = 1}, other), Error);
  surface.normals = {};
  for (const EyeDome& options :
       {EyeDome{.strength = nan}, EyeDome{.strength = -1}, EyeDome{.radius_px = 0}})
    EXPECT_THROW(effects.eye_dome(surface, d.camera, options, factor), Error);
  for (const Silhouettes& options :
       {Silhouettes{.depth = nan}, Silhouettes{.depth = -1}, Silhouettes{.angle_degrees = 181},
        Silhouettes{.width_px = 0}, Silhouettes{.width_px = 17}})
    EXPECT_THROW(effects.silhouettes(surface, d.camera, options, factor), Error);
  EXPECT_THROW(effects.eye_dome({}, d.camera, {}, factor), Error);
  EXPECT_THROW(effects.silhouettes(surface, d.camera, {}, {}), Error);
  EXPECT_THROW(Effects(1, test::missing_isa()), Error);
}

}  // namespace
}  // namespace rastrum::effects_test
