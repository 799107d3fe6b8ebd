// All pixels of an image against a function of their places.
#pragma once

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <rastrum/image.hpp>
#include <rastrum/transform.hpp>

namespace rastrum::test {

/// same(image(x, y), expected(x, y)) everywhere; the message names the first pixel where it is not.
template <class T, class F, class Same>
[[nodiscard]] testing::AssertionResult pixels_are(const Image<T>& image, const F& expected,
                                                  const Same& same) {
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
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
