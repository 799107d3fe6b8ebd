// SPDX-License-Identifier: BSD-3-Clause
// The costs of oneTBB on this machine, for the replay of a frame (simulate.hpp).
#pragma once

#include <papers/models/replay/simulate.hpp>

namespace rastrum::bench {

/// Measured with two threads, `rounds` times each, in some tenths of a second. Without two free
/// cores, the costs that need two are those of a Zen 4.
[[nodiscard]] LoopCosts measure_costs(int rounds);

}  // namespace rastrum::bench
