// SPDX-License-Identifier: BSD-3-Clause
// MachineLimits as JSON; apart from machine.hpp, so that its users need no JSON library.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "machine.hpp"

namespace rastrum::bench {

/// An object with the members' names.
[[nodiscard]] nlohmann::json to_json(const MachineLimits& limits);

}  // namespace rastrum::bench
