// SPDX-License-Identifier: BSD-3-Clause
// Ticks and their text; the places and hiding of bars, axes and boxes; golden pictures.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/golden.hpp"
#include "tests/support/pixels.hpp"

namespace rastrum::annotations_test {
namespace {

using overlay::ScalarBar;

std::string joined(const std::vector<overlay::Tick>& ticks) {
  std::string text;
  for (const overlay::Tick& tick : ticks) text += (text.empty() ? "" : " ") + tick.label;
  return text;
}

TEST(Ticks, AreRoundNumbersWrittenAlike) {
  struct Case {
    double low, high;
    int wanted;
    const char* labels;
    bool logarithmic = false;
  };
  for (const Case& c : {
           Case{0, 1, 5, "0 0.2 0.4 0.6 0.8 1.0"},
           {-0.37, 1.42, 4, "0 0.5 1.0"},
           {-2, 2, 4, "−2 −1 0 1 2"},
           {0, 3000, 3, "0 1000 2000 3000"},
           {0, 250000, 5, "0 0.5×10⁵ 1.0×10⁵ 1.5×10⁵ 2.0×10⁵ 2.5×10⁵"},
           {1e-9, 4e-9, 3, "1×10⁻⁹ 2×10⁻⁹ 3×10⁻⁹ 4×10⁻⁹"},
           {1000.1, 1000.3, 2, "1000.1 1000.2 1000.3"},
           {7, 7, 5, "7"},
           // One tick is wanted, but there is no multiple of 10.
           {220.54299926757812, 226.43099975585938, 1, "225"},
           // Logarithms have decades, with round numbers between.
           {0.01, 100, 5, "0.01 0.1 1 10 100", true},
           {1, 100, 8, "1 2 5 10 20 50 100", true},
           {3e-7, 2e9, 5, "10⁻⁴ 10⁰ 10⁴ 10⁸", true},
           {2.1, 4.4, 4, "3 4", true},
       })
    EXPECT_EQ(joined(overlay::ticks(c.low, c.high, c.wanted, c.logarithmic)), c.labels);
  EXPECT_EQ(overlay::ticks(0, 0.3, 3)[3].value, 0.3);
  EXPECT_EQ(joined(overlay::ticks(1e300, 1e300 * (1 + 1e-15), 5)).substr(0, 6), "1e+300");
}

TEST(Ticks, LieWithinAnyRange) {
  for (int exponent = -250; exponent <= 250; exponent += 7)
    for (const double from : {-3.7, 0.0, 1.0, 2.9})
      for (const double width : {0.001, 0.7, 9.0}) {
        const double scale = std::ldexp(1.0, exponent * 3), low = from * scale,
                     high = (from + width) * scale;
        const auto found = overlay::ticks(low, high, 6);
        ASSERT_GE(found.size(), 2U) << low << " to " << high;
        ASSERT_LE(found.size(), 9U) << low << " to " << high;
        for (const overlay::Tick& tick : found) {
          EXPECT_GE(tick.value, low - 1e-5 * (high - low));
          EXPECT_LE(tick.value, high + 1e-5 * (high - low));
        }
        for (std::size_t i = 1; i < found.size(); ++i)
          EXPECT_NE(found[i].label, found[i - 1].label);
      }
}

TEST(Ticks, RefuseRangesThatAreNone) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(static_cast<void>(overlay::ticks(1, 0, 5)), Error);
  EXPECT_THROW(static_cast<void>(overlay::ticks(nan, 1, 5)), Error);
  EXPECT_THROW(static_cast<void>(overlay::ticks(0, infinity, 5)), Error);
  EXPECT_THROW(static_cast<void>(overlay::ticks(0, 1, 5, true)), Error);
}

const std::vector<Vec4> kColors{{0.27F, 0, 0.33F, 1}, {0.13F, 0.57F, 0.55F, 1}, {1, 0.9F, 0.1F, 1}};

TEST(ScalarBar, HasItsColoursInOrder) {
  for (const bool discrete : {false, true}) {
    Image<Rgba8> picture(320, 240);
    overlay::draw_scalar_bar({.color8 = picture.view()},
                             {.colors = kColors, .discrete = discrete, .title = "Speed"});
    // Finds the column through the bar: the one with the most pixels of the map's colours.
    int column = 0, best = 0;
    for (int x = 0; x < 320; ++x) {
      int n = 0;
      for (int y = 0; y < 240; ++y)
        n += picture(x, y).r > 240 && picture(x, y).g > 200 && picture(x, y).b < 60;
      if (n > best) {
        best = n;
        column = x;
      }
    }
    ASSERT_GT(best, 0);
    std::vector<Rgba8> seen;
    for (int y = 239; y >= 0; --y) {
      const Rgba8 c = picture(column, y);
      if (c.a == 255 && !(c == Rgba8{245, 245, 245, 255}) && (seen.empty() || !(seen.back() == c)))
        seen.push_back(c);
    }
    if (discrete) {
      EXPECT_EQ(seen,
                (std::vector<Rgba8>{{69, 0, 84, 255}, {33, 145, 140, 255}, {255, 230, 26, 255}}));
    } else {
      EXPECT_GT(seen.size(), 100U);
      for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GE(seen[i].g, seen[i - 1].g);
    }
  }
}

TEST(ScalarBar, RefusesWhatIsNone) {
  Image<Rgba8> picture(64, 64);
  const overlay::Canvas canvas{.color8 = picture.view()};
  EXPECT_THROW(overlay::draw_scalar_bar(canvas, {}), Error);
  EXPECT_THROW(overlay::draw_scalar_bar(canvas, {.colors = kColors, .low = 1, .high = 0}), Error);
  EXPECT_THROW(overlay::draw_scalar_bar(canvas, {.colors = kColors, .low = std::nan("")}), Error);
  EXPECT_THROW(overlay::draw_scalar_bar(canvas, {.colors = kColors, .logarithmic = true}), Error);
  EXPECT_THROW(overlay::draw_scalar_bar(canvas, {.colors = kColors, .categories = {"one"}}), Error);
  EXPECT_THROW(overlay::draw_title(canvas, "a", {.scale = 0}), Error);
}

TEST(Bounds, AreHiddenBehindWhatIsNearer) {
  const Camera camera{.eye = {3, 2, 4}};
  const auto drawn = [&](float depth) {
    Image<Rgba8> picture(200, 150);
    Image<float> depths(200, 150);
    for (float& d : depths.pixels()) d = depth;
    overlay::draw_bounds({.color8 = picture.view()}, camera, {-1, -1, -1}, {1, 1, 1},
                         depths.view());
    std::size_t n = 0;
    for (const Rgba8 c : picture.pixels()) n += c.a > 100;
    return n;
  };
  // Numbers stay. near = 0.01, so reversed depth 0.01 / 4 hides half of the box.
  const std::size_t all = drawn(0), none = drawn(1), half = drawn(0.01F / 4.9F);
  EXPECT_GT(all, none + 200);
  EXPECT_GT(none, 100U);
  EXPECT_GT(half, none + 50);
  EXPECT_LT(half, all - 50);
  Image<Rgba8> picture(20, 15);
  const overlay::Canvas canvas{.color8 = picture.view()};
  EXPECT_THROW(overlay::draw_bounds(canvas, camera, {1, 0, 0}, {0, 1, 1}), Error);
  EXPECT_THROW(overlay::draw_bounds(canvas, camera, {0, 0, std::nan("")}, {0, 1, 1}), Error);
  Image<float> other(21, 15);
  EXPECT_THROW(overlay::draw_bounds(canvas, camera, {0, 0, 0}, {1, 1, 1}, other.view()), Error);
  // From inside, and with the box behind the eye, nothing appears in wrong places.
  overlay::draw_bounds(canvas, {.eye = {0, 0, 0.5}}, {-1, -1, -1}, {1, 1, 1});
  overlay::draw_bounds(canvas, {.eye = {0, 0, -5}, .target = {0, 0, -6}}, {-1, -1, -1}, {1, 1, 1});
}

// A fitted camera with this room shows all corners of the box, with a tenth around them.
TEST(Bounds, HaveRoomInTheirPicture) {
  const Scene scene = shapes::scene_from_spec("torus_knot");
  const SceneBinding binding(scene);
  const Bounds box = bounds(binding.view());
  for (const bool orthographic : {false, true}) {
    Camera view{.eye = {5, 4, 3}, .fov_rad = 0.5F, .orthographic = orthographic};
    const Camera fitted = fit_picture(binding.view(), view, 200, 150);
    const Vec3d low = box.min, high{box.max.x, box.max.y, 1.3 * box.max.z};
    const double room = overlay::room_for_bounds(fitted, low, high, 200, 150);
    EXPECT_GT(room, 1.5);
    EXPECT_EQ(overlay::room_for_bounds(fitted, {}, {}, 200, 150), 1.5);
    const Mat4d to_clip = world_to_clip(zoomed(fitted, 1 / room), 200, 150);
    double farthest = 0;
    for (int i = 0; i < 8; ++i) {
      const auto c = test::product(to_clip, i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                                   i & 4 ? high.z : low.z);
      farthest = std::max({farthest, std::fabs(c[0] / c[3]), std::fabs(c[1] / c[3])});
    }
    EXPECT_NEAR(farthest, 0.8, 1e-5);
  }
}

TEST(Annotations, AreTheSameBits) {
  for (const bool orthographic : {false, true}) {
    const Scene scene = shapes::scene_from_spec("teapot?n=6");
    const SceneBinding binding(scene);
    Camera view{.eye = {1.3, 0.8, 1.6}, .orthographic = orthographic};
    Camera camera = fit_picture(binding.view(), view, 640, 360);
    camera.fov_rad = 1.4F;
    camera.orthographic_height *= 1.4F;
    Image<Rgba8> picture(640, 360);
    Image<float> depth(640, 360);
    const FrameOptions frame{.width = 640, .height = 360, .background = {0.9F, 0.9F, 0.9F, 1}};
    Renderer renderer;
    renderer.render(binding.view(), camera, frame, {.color8 = picture, .depth = depth});
    const overlay::Canvas canvas{.color8 = picture.view()};
    const overlay::Look look = overlay::look_on(frame.background);
    const Bounds box = bounds(binding.view());
    overlay::draw_bounds(canvas, camera, box.min, box.max, depth.view(), look);
    overlay::draw_axes(canvas, camera, overlay::Corner::bottom_left, look);
    overlay::draw_title(canvas, "Teapot, α = 3°", look);
    overlay::draw_caption(canvas, "Utah, 1975", overlay::Corner::bottom_right, look);
    overlay::draw_scalar_bar(canvas,
                             {.colors = kColors,
                              .low = 1e-3,
                              .high = 20,
                              .logarithmic = true,
                              .title = "Density",
                              .unit = "kg/m³",
                              .below = Vec4{0, 0, 0, 1},
                              .above = Vec4{1, 0, 0, 1},
                              .nan = Vec4{0.5F, 0.5F, 0.5F, 1}},
                             look);
    overlay::draw_scalar_bar(canvas,
                             {.colors = kColors,
                              .title = "Rock",
                              .categories = {"clay", "lime", "salt"},
                              .side = overlay::Side::bottom},
                             look);
    EXPECT_TRUE(test::matches_golden(
        orthographic ? "overlay/annotated_orthographic" : "overlay/annotated", digest(picture)));
  }
}

}  // namespace
}  // namespace rastrum::annotations_test
