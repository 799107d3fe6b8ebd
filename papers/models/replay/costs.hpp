// SPDX-License-Identifier: BSD-3-Clause
// The costs of oneTBB itself on this machine, for the replay of a frame (simulate.hpp).
#pragma once

#include <papers/models/replay/simulate.hpp>

namespace rastrum::bench {

/// Measured with two threads, in some tenths of a second. `rounds`: of each. Without two free
/// cores, costs that need two keep the values measured on two cores of a Zen 4.
[[nodiscard]] LoopCosts measure_costs(int rounds);

}  // namespace rastrum::bench
