// Files that are no library of device code (parallel/cuda/library.hpp). tests/cuda/library_test.cpp
// tests one that is.
#include <gtest/gtest.h>

#include <rastrum/parallel/cuda/library.hpp>

namespace rastrum::parallel::device_library_test {
namespace {

bool has(const std::string& text, const char* what) {
  return text.find(what) != std::string::npos;
}

TEST(DeviceLibrary, OneThatIsNotThereIsNamedWithWhatToDo) {
  const OpenedCudaLibrary none = open_cuda_library("librastrum_cuda_not_there.so");
  EXPECT_EQ(none.library, nullptr);
  EXPECT_TRUE(has(none.why_not, "librastrum_cuda_not_there.so: ")) << none.why_not;
  EXPECT_TRUE(has(none.why_not, "-DRASTRUM_CUDA=ON")) << none.why_not;
  EXPECT_TRUE(has(none.why_not, "LD_LIBRARY_PATH")) << none.why_not;
}

TEST(DeviceLibrary, AnotherLibraryIsNone) {
  const OpenedCudaLibrary other = open_cuda_library("libm.so.6");
  EXPECT_EQ(other.library, nullptr);
  EXPECT_EQ(other.why_not, "libm.so.6 is no library of Rastrum's device code");
}

}  // namespace
}  // namespace rastrum::parallel::device_library_test
