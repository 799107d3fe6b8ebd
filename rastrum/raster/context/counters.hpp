// SPDX-License-Identifier: BSD-3-Clause
// Named counters of a method's work, by which the rows of a table differ.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace rastrum::raster {

using Counters = std::vector<std::pair<std::string_view, std::uint64_t>>;

void add_counter(Counters& counters, std::string_view name, std::uint64_t value);
/// Makes the counter at least `value`.
void raise_counter(Counters& counters, std::string_view name, std::uint64_t value);

}  // namespace rastrum::raster
