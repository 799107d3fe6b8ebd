// SPDX-License-Identifier: BSD-3-Clause
// Refuses each device call of a frame once, and expects the next frame to be right
// (support/device_faults.hpp).
#include <cstdint>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "tests/support/device_faults.hpp"
#include "tests/support/device_frames.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::device_faults_test {
namespace {

constexpr int kWidth = 72, kHeight = 40;

/// Triangles of all sizes, so that each queue has work; some are clipped.
Scene triangles() {
  Random random(11);
  Mesh mesh;
  for (int t = 0; t < 60; ++t) {
    const double size = t % 20 == 0 ? 90 : t % 4 == 0 ? 20 : random.real(0.5, 6);
    const double x = random.real(0, kWidth), y = random.real(0, kHeight);
    for (int c = 0; c < 3; ++c)
      mesh.positions.push_back(at_pixel(x + random.real(-size, size), y + random.real(-size, size),
                                        random.real(0.1, 0.9), kWidth, kHeight));
  }
  return single(std::move(mesh));
}

struct Look {
  const char* name;
  float opacity;
  int samples;
  const char* rasterizer;
};
class FaultsOfADevice : public CudaTest, public testing::WithParamInterface<Look> {};

TEST_P(FaultsOfADevice, EndAFrameAndNoMore) {
  const Look look = GetParam();
  RenderOptions o = device_options(kWidth, kHeight, Device::serial);
  o.opacity = look.opacity;
  o.samples = look.samples;
  o.threads = 1;
  const Viewed seen(triangles(), pixel_camera(kWidth, kHeight));
  Painter serial(o);
  // Without overdraw, which layers do not count.
  const Frame expected = draw(serial, seen, kPicture);
  o.device = Device::cuda;
  o.rasterizer = look.rasterizer;

  // From a new renderer, so that memory is allocated too.
  const std::uint64_t refused = refuse_each_call(
      [&] { return Painter(o); },
      [&](Painter& cuda) {
        const Frame frame = draw(cuda, seen, kPicture);
        EXPECT_EQ(frame.stats.device, Device::cuda) << frame.stats.device_why;
      },
      [&](Painter& cuda) { EXPECT_TRUE(same_images(draw(cuda, seen, kPicture), expected)); });
  EXPECT_GT(refused, 20U);
}
INSTANTIATE_TEST_SUITE_P(Looks, FaultsOfADevice,
                         testing::Values(Look{"opaque", 1, 1, "auto"},
                                         Look{"layers", 0.5F, 1, "auto"},
                                         Look{"samples", 1, 4, "auto"},
                                         Look{"layers_of_samples", 0.5F, 4, "auto"},
                                         Look{"tiled", 1, 1, "tiled"}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(CudaTest, ARendererWithoutItsStreamIsRefused) {
  for (std::uint64_t n = 1; n < 3; ++n) {
    bool is_made = true;
    try {
      const Refused fault(n);
      const Painter cuda(device_options(8, 8, Device::cuda));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::no_device) << error.what();
      is_made = false;
    }
    EXPECT_EQ(is_made, n > 1);
  }
}

}  // namespace
}  // namespace rastrum::test::device_faults_test
