// SPDX-License-Identifier: BSD-3-Clause
// Checks by hand the estimates that Device::automatic uses.
#include <rastrum/parallel/device_estimate.hpp>

#include <gtest/gtest.h>

namespace rastrum::device_estimate_test {
namespace {

FrameWork work() {
  FrameWork w{.what = "three triangles", .host_ns = 4e6, .device_ns = 1e6};
  w.launches = 50;      // 0.2 ms
  w.bytes = 8'000'000;  // 1 ms
  return w;
}

TEST(DeviceEstimate, AddsKernelsLaunchesAndTheBusAndSharesTheHostsAmongThreads) {
  EXPECT_DOUBLE_EQ(estimate(work(), 1).host_ms, 4);
  EXPECT_DOUBLE_EQ(estimate(work(), 4).host_ms, 1);
  EXPECT_DOUBLE_EQ(estimate(work(), 1).device_ms, 2.2);
  FrameWork more = work();
  more.device_ns += 1e6;
  EXPECT_DOUBLE_EQ(estimate(more, 1).device_ms, 3.2);
}

TEST(DeviceEstimate, ChoosesTheSoonerAndSaysTheFigures) {
  const DeviceChoice gpu{Device::cuda, "there is a GPU"};
  const DeviceChoice one = choose_device(gpu, work(), 1);
  EXPECT_EQ(one.device, Device::cuda);
  EXPECT_EQ(one.why,
            "there is a GPU; three triangles are expected to take 4.00 ms on 1 thread and 2.20 ms "
            "there, with "
            "8.00 MB to copy");
  const DeviceChoice two = choose_device(gpu, work(), 2);
  EXPECT_EQ(two.device, Device::threads);
  EXPECT_EQ(two.why,
            "there is a GPU, but three triangles are expected to take 2.00 ms on 2 threads and "
            "2.20 ms there, "
            "with 8.00 MB to copy");
}

TEST(DeviceEstimate, ChoosesNothingWhereThereIsNoGpu) {
  const DeviceChoice none = choose_device({Device::threads, "no CUDA: why"}, work(), 1);
  EXPECT_EQ(none.device, Device::threads);
  EXPECT_EQ(none.why, "no CUDA: why");
}

}  // namespace
}  // namespace rastrum::device_estimate_test
