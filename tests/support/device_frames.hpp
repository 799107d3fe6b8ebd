// SPDX-License-Identifier: BSD-3-Clause
// Compares frames of a device with the host's, bit for bit.
#pragma once

#include <utility>

#include <gtest/gtest.h>

#include "tests/support/cuda_test.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/layer_picture.hpp"
#include "tests/support/painter.hpp"

namespace rastrum::test {

struct Viewed {
  explicit Viewed(Scene drawn, const Camera& from = {.eye = {0, 0, 3}})
      : scene(std::move(drawn)), camera(from) {}
  Viewed(const Viewed&) = delete;
  Viewed& operator=(const Viewed&) = delete;
  [[nodiscard]] SceneView view() const { return binding.view(); }

  Scene scene;
  SceneBinding binding{scene};
  Camera camera;
};
[[nodiscard]] inline Frame draw(Painter& painter, const Viewed& seen, unsigned kinds = kCounted) {
  return draw(painter, seen.view(), seen.camera, kinds);
}
[[nodiscard]] inline LayerPicture take(Painter& painter, const Viewed& seen) {
  return take(painter, seen.view(), seen.camera);
}

/// The same options with another device.
[[nodiscard]] inline RenderOptions by(RenderOptions options, Device device) {
  options.device = device;
  return options;
}

/// Compares all bits and counters.
[[nodiscard]] inline testing::AssertionResult same_frame(const Frame& a, const Frame& b) {
  if (auto r = same_images(a, b); !r) return r;
  return same_counts(a.stats, b.stats);
}
/// The same, and expects that a device has drawn the frame.
inline void expect_by_device(const Frame& frame, const Frame& expected) {
  EXPECT_EQ(frame.stats.device, Device::cuda) << frame.stats.device_why;
  EXPECT_TRUE(same_frame(frame, expected));
}
/// Compares all bits and the number of layers.
inline void expect_by_device(const LayerPicture& frame, const LayerPicture& expected) {
  EXPECT_EQ(frame.stats.device, Device::cuda) << frame.stats.device_why;
  EXPECT_TRUE(same_bits(frame, expected));
  EXPECT_EQ(frame.stats.pixels_covered, expected.stats.pixels_covered);
  if (expected.stats.device == Device::serial) return;  // serial counts no layers
  for (const char* name : {"translucent fragments", "deepest"})
    EXPECT_EQ(frame.counter(name), expected.counter(name)) << name;
}

}  // namespace rastrum::test
