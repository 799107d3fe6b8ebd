// SPDX-License-Identifier: BSD-3-Clause
// Files that are not a library of device code (parallel/cuda/library.hpp).
// tests/cuda/library_test.cpp tests a valid one.
#include <gtest/gtest.h>

#include <rastrum/parallel/cuda/library.hpp>

#include "tests/support/refused.hpp"

namespace rastrum::parallel::device_library_test {
namespace {

TEST(DeviceLibrary, OneThatIsNotThereIsNamedWithWhatToDo) {
  const OpenedCudaLibrary none = open_cuda_library("librastrum_cuda_not_there.so");
  EXPECT_EQ(none.library, nullptr);
  for (const char* part :
       {"librastrum_cuda_not_there.so: ", "-DRASTRUM_CUDA=ON", "LD_LIBRARY_PATH"})
    EXPECT_TRUE(rastrum::test::holds(none.why_not, part));
}

TEST(DeviceLibrary, AnotherLibraryIsNone) {
  const OpenedCudaLibrary other = open_cuda_library("libm.so.6");
  EXPECT_EQ(other.library, nullptr);
  EXPECT_EQ(other.why_not, "libm.so.6 is no library of Rastrum's device code");
}

}  // namespace
}  // namespace rastrum::parallel::device_library_test
