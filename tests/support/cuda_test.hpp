// SPDX-License-Identifier: BSD-3-Clause
// Tests of --device cuda through the façade: on a GPU, or on the CPU if the program contains device
// code compiled for it (tests/CMakeLists.txt).
#pragma once

#include <gtest/gtest.h>

#include <rastrum/parallel/cuda/status.hpp>
#include <rastrum/render.hpp>

#include "tests/support/painter.hpp"

namespace rastrum::test {

/// Skips without a device, with words that tests/cuda/CMakeLists.txt looks for.
class CudaTest : public testing::Test {
 protected:
  void SetUp() override {
    const parallel::CudaStatus status = parallel::cuda_status();
    if (!status.usable) GTEST_SKIP() << "no device: " << status.why_not;
  }
};

/// A frame whose bits do not depend on the device.
inline RenderOptions device_options(int width, int height, Device device) {
  return RenderOptions({.width = width, .height = height, .background = {0.2F, 0.3F, 0.4F, 0.5F}},
                       {.device = device, .threads = 2, .isa = Isa::scalar});
}

}  // namespace rastrum::test
