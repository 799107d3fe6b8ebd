// SPDX-License-Identifier: BSD-3-Clause
// The share of its work that a test does.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace rastrum::test {

/// The share in per cent: RASTRUM_TEST_SHARE, or 100. The sanitizers' runs use a few per cent,
/// since they look for memory errors and races while another build compares all numbers (decision
/// 0088). Tests labelled `full` use many hundred.
[[nodiscard]] inline int test_share() {
  const char* const asked = std::getenv("RASTRUM_TEST_SHARE");
  return asked != nullptr ? std::stoi(asked) : 100;
}

/// Whether this is a test of `./dev check --full`. Others skip what takes too long, and say why.
[[nodiscard]] inline bool is_full() {
  return test_share() > 100;
}
inline constexpr const char* kOnlyFull = "only in ./dev check --full";
inline constexpr const char* kOnlyWhole = "computes long: only without RASTRUM_TEST_SHARE";

/// The share of `all` scenes (triangles, pixels, …), at least `least`.
[[nodiscard]] inline int share_of(int all, int least = 1) {
  return std::max(static_cast<int>(std::int64_t{all} * test_share() / 100), least);
}

}  // namespace rastrum::test
