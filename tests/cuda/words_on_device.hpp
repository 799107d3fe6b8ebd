// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace rastrum::parallel::test {

/// Runs every word of rastrum/parallel/cuda on the current device and on Serial. Returns the names
/// of those with different results. Throws the device's errors.
[[nodiscard]] std::vector<std::string> words_that_differ();

}  // namespace rastrum::parallel::test
