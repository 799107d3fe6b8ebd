// SPDX-License-Identifier: BSD-3-Clause
// Iterates over all pixels of an image by row, and compares them with a function of the place.
#pragma once

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <rastrum/image.hpp>
#include <rastrum/transform.hpp>

namespace rastrum::test {

class PixelRange {
 public:
  struct Pixel {
    int x, y;
  };
  struct Iterator {
    Pixel at;
    int width;
    const Pixel& operator*() const { return at; }
    void operator++() { at = at.x + 1 < width ? Pixel{at.x + 1, at.y} : Pixel{0, at.y + 1}; }
    bool operator!=(const Iterator& end) const { return at.y != end.at.y; }
  };
  PixelRange(int width, int height) : width_(width), height_(width > 0 ? height : 0) {}
  [[nodiscard]] Iterator begin() const { return {{0, 0}, width_}; }
  [[nodiscard]] Iterator end() const { return {{0, height_}, width_}; }

 private:
  int width_, height_;
};

/// `for (const auto& [x, y] : pixels(width, height))`
[[nodiscard]] inline PixelRange pixels(int width, int height) {
  return {width, height};
}

/// Whether same(image(x, y), expected(x, y)) everywhere. The message names the first differing
/// pixel.
template <class T, class F, class Same>
[[nodiscard]] testing::AssertionResult pixels_are(const Image<T>& image, const F& expected,
                                                  const Same& same) {
  for (const auto& [x, y] : pixels(image.width(), image.height()))
    if (const auto wanted = expected(x, y); !same(image(x, y), wanted))
      return testing::AssertionFailure()
             << x << ", " << y << ": " << testing::PrintToString(image(x, y)) << ", and not "
             << testing::PrintToString(wanted);
  return testing::AssertionSuccess();
}
template <class T, class F>
[[nodiscard]] testing::AssertionResult pixels_are(const Image<T>& image, const F& expected) {
  return pixels_are(image, expected, [](const T& a, const auto& b) { return a == b; });
}
/// Numbers that are no farther than `tolerance` from what is expected.
template <class T, class F>
[[nodiscard]] testing::AssertionResult pixels_are_near(const Image<T>& image, double tolerance,
                                                       const F& expected) {
  return pixels_are(image, expected, [&](const T& a, double b) {
    return std::abs(static_cast<double>(a) - b) <= tolerance;
  });
}

/// m (x, y, z, 1).
[[nodiscard]] inline std::array<double, 4> product(const Mat4d& m, double x, double y, double z) {
  std::array<double, 4> p{};
  for (std::size_t i = 0; i < 4; ++i)
    p[i] = m.m[i][0] * x + m.m[i][1] * y + m.m[i][2] * z + m.m[i][3];
  return p;
}

}  // namespace rastrum::test
