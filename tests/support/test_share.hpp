// SPDX-License-Identifier: BSD-3-Clause
// How much of its work a test does.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace rastrum::test {

/// The share in per cent: RASTRUM_TEST_SHARE, or 100. The sanitizers' runs ask for a few per cent,
/// since they look for wrong memory and races while the other build compares all numbers (decision
/// 0088); tests labelled `full` ask for many hundred.
[[nodiscard]] inline int test_share() {
  const char* const asked = std::getenv("RASTRUM_TEST_SHARE");
  return asked != nullptr ? std::stoi(asked) : 100;
}

/// Whether this is a test of `./dev check --full`; the others skip what takes too long, and say
/// why.
[[nodiscard]] inline bool is_full() {
  return test_share() > 100;
}
inline constexpr const char* kOnlyFull = "only in ./dev check --full";
inline constexpr const char* kOnlyWhole = "computes long: only without RASTRUM_TEST_SHARE";

/// The share of `all` scenes (triangles, pixels, …), and no fewer than `least`.
[[nodiscard]] inline int share_of(int all, int least = 1) {
  return std::max(static_cast<int>(std::int64_t{all} * test_share() / 100), least);
}

}  // namespace rastrum::test
