// SPDX-License-Identifier: BSD-3-Clause
// available_isas, which asks the compiler's runtime, agrees with Highway; and a missing instruction
// set is an error.
#include <algorithm>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <rastrum/parallel/simd_targets.hpp>  // as the library

#include <hwy/targets.h>

#include <rastrum/parallel/device.hpp>
#include "tests/support/isa.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::isa_test {
namespace {

TEST(Isa, AvailableOnesAreHighways) {
  const auto isas = available_isas();
  const auto has = [&](Isa isa) { return std::ranges::find(isas, isa) != isas.end(); };
  const std::int64_t known = hwy::SupportedTargets() & HWY_TARGETS;
  EXPECT_TRUE(has(Isa::scalar));
#if HWY_ARCH_X86
  EXPECT_EQ(has(Isa::sse4), (known & HWY_SSE4) != 0);
  EXPECT_EQ(has(Isa::avx2), (known & HWY_AVX2) != 0);
  EXPECT_EQ(has(Isa::avx512), (known & HWY_AVX3) != 0);
#elif HWY_ARCH_ARM
  EXPECT_EQ(has(Isa::neon), (known & HWY_NEON) != 0);
#elif HWY_ARCH_WASM
  EXPECT_EQ(has(Isa::wasm), (known & HWY_WASM) != 0);
#endif
}

TEST(Isa, OneThatIsNotThereIsRefused) {
  for (const Isa isa : available_isas()) EXPECT_EQ(choose_isa(isa), isa);
  EXPECT_EQ(choose_isa({}), available_isas().back());
  const std::string said =
      test::refusal_of([] { static_cast<void>(choose_isa(test::missing_isa())); }, Errc::no_device);
  EXPECT_TRUE(said.starts_with("--isa " + std::string(name(test::missing_isa())) + ": ")) << said;
  EXPECT_TRUE(test::holds(said, "has only scalar"));
}

}  // namespace
}  // namespace rastrum::isa_test
