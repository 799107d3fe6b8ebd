// SPDX-License-Identifier: BSD-3-Clause
// Signed fields against brute force: all pixels × all fields.
#include <rastrum/raster/rules/field.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.hpp"

namespace rastrum::test::field_test {
namespace {

using raster::Rect;

/// A superellipse: convex, concave or a diamond.
struct Blob {
  float x, y, radius, power;
};

Rect box_of(const Blob& b) {
  return {static_cast<int>(std::floor(b.x - b.radius)),
          static_cast<int>(std::floor(b.y - b.radius)), static_cast<int>(std::ceil(b.x + b.radius)),
          static_cast<int>(std::ceil(b.y + b.radius))};
}

float value(const Blob& b, float x, float y) {
  return std::pow(b.radius, b.power) - std::pow(std::abs(x - b.x), b.power) -
         std::pow(std::abs(y - b.y), b.power);
}

using Pixel = std::tuple<std::uint32_t, int, int>;

std::vector<Pixel> brute_force(const std::vector<Blob>& blobs, Rect view) {
  std::vector<Pixel> pixels;
  for (std::uint32_t i = 0; i < blobs.size(); ++i)
    for (int y = view.y0; y < view.y1; ++y)
      for (int x = view.x0; x < view.x1; ++x)
        if (value(blobs[i], static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F) >= 0)
          pixels.emplace_back(i, x, y);
  return pixels;
}

template <class Exec>
std::vector<Pixel> rasterized(Exec& exec, const std::vector<Blob>& blobs, Rect view) {
  std::vector<Pixel> pixels;
  for (const raster::FieldPixel& p : raster::field_pixels(exec, blobs, view, box_of, value))
    pixels.emplace_back(p.field, p.x, p.y);
  std::sort(pixels.begin(), pixels.end(), [](const Pixel& a, const Pixel& b) {
    return std::tuple(std::get<0>(a), std::get<2>(a), std::get<1>(a)) <
           std::tuple(std::get<0>(b), std::get<2>(b), std::get<1>(b));
  });
  return pixels;
}

TEST(Field, CoversWhatBruteForceDoes) {
  Random random(3);
  parallel::Serial serial;
  parallel::Threads threads(2);
  for (const Rect view : {Rect{0, 0, 100, 70}, Rect{0, 64, 37, 101}, Rect{16, 8, 17, 9}}) {
    std::vector<Blob> blobs;
    for (int i = 0; i < 60; ++i)
      blobs.push_back({static_cast<float>(random.real(-30, 130)),
                       static_cast<float>(random.real(-30, 130)),
                       static_cast<float>(random.chance(0.1) ? 150 : random.real(0, 30)),
                       static_cast<float>(random.real(0.5, 4))});
    const std::vector<Pixel> expected = brute_force(blobs, view);
    EXPECT_GT(expected.size(), 3U);
    EXPECT_EQ(rasterized(serial, blobs, view), expected);
    EXPECT_EQ(rasterized(threads, blobs, view), expected);
  }
}

TEST(Field, WithoutFieldsSamplesOrNumbers) {
  parallel::Threads threads(2);
  const Rect view{0, 0, 64, 64};
  EXPECT_TRUE(rasterized(threads, {}, view).empty());
  EXPECT_TRUE(rasterized(threads, {{500, 500, 20, 2}, {-90, 3, 20, 2}}, view).empty());
  // A box without a sample of its field, and a field of NaN.
  const std::vector<Blob> fields{{8, 8, 0.1F, 2}, {20, 20, 5, 2}};
  const auto nowhere = [](const Blob&, float, float) {
    return std::numeric_limits<float>::quiet_NaN();
  };
  EXPECT_TRUE(raster::field_pixels(threads, fields, view, box_of, nowhere).empty());
  EXPECT_EQ(rasterized(threads, fields, view), brute_force(fields, view));
}

}  // namespace
}  // namespace rastrum::test::field_test
