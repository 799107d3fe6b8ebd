// available_isas, which asks the processor by the compiler's runtime, against Highway's own
// question.
#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <rastrum/parallel/device.hpp>

namespace rastrum::isa_test {
namespace {

TEST(Isa, AvailableOnesAreHighways) {
  const auto isas = available_isas();
  const auto has = [&](Isa isa) { return std::ranges::find(isas, isa) != isas.end(); };
  const std::int64_t known = hwy::SupportedTargets();
  EXPECT_TRUE(has(Isa::scalar));
#if HWY_ARCH_X86
  EXPECT_EQ(has(Isa::sse4), (known & HWY_SSE4) != 0);
  EXPECT_EQ(has(Isa::avx2), (known & HWY_AVX2) != 0);
  EXPECT_EQ(has(Isa::avx512), (known & HWY_AVX3) != 0);
#elif HWY_ARCH_ARM
  EXPECT_EQ(has(Isa::neon), (known & HWY_NEON) != 0);
#endif
}

}  // namespace
}  // namespace rastrum::isa_test
