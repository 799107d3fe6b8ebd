// SPDX-License-Identifier: BSD-3-Clause
// A device for the tests of rastrum/terrain/cuda: the CPU, with memory that a test sets
// (cuda_device.cpp); or a GPU, without which the tests are skipped (cuda_gpu.cpp).
#pragma once

#include <cstdint>

#include <gtest/gtest.h>

#include <rastrum/parallel/cuda/status.hpp>

namespace rastrum::test {

class TerrainOnDevice : public testing::Test {
 protected:
  void SetUp() override {
    static_cast<void>(set_free_bytes(std::uint64_t{1} << 40));
    const parallel::CudaStatus status = parallel::cuda_status();
    if (!status.usable) GTEST_SKIP() << "no device: " << status.why_not;
  }
  /// Sets the device's free memory from now on. False for a GPU, which does not allow it.
  static bool set_free_bytes(std::uint64_t bytes);
};

}  // namespace rastrum::test
