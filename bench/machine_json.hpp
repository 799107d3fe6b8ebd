// SPDX-License-Identifier: BSD-3-Clause
// MachineLimits as JSON, in a header of its own so that users of machine.hpp need no JSON library.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "machine.hpp"

namespace rastrum::bench {

/// An object with the members' names.
[[nodiscard]] nlohmann::json to_json(const MachineLimits& limits);

}  // namespace rastrum::bench
