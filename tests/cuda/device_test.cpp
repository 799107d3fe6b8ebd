// SPDX-License-Identifier: BSD-3-Clause
// The words on the build's device: a GPU, or the CPU (CMakeLists.txt).
#include <gtest/gtest.h>

#include <rastrum/parallel/cuda/status.hpp>

#include "words_on_device.hpp"

namespace rastrum::parallel::test::device_test {
namespace {

TEST(Cuda, EveryWordIsBitEqualToSerial) {
#if !defined(RASTRUM_TEST_DEVICE_WORDS)
  const CudaStatus status = cuda_status();
  if (!status.usable) GTEST_SKIP() << "no device: " << status.why_not;
#endif
  EXPECT_EQ(words_that_differ(), std::vector<std::string>{});
}

}  // namespace
}  // namespace rastrum::parallel::test::device_test
