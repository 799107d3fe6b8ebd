// SPDX-License-Identifier: BSD-3-Clause
// An instruction set that this machine lacks.
#pragma once

#include <algorithm>

#include <rastrum/parallel/device.hpp>

namespace rastrum::test {

/// No machine has both SSE4 and NEON.
inline Isa missing_isa() {
  const auto isas = available_isas();
  return std::ranges::find(isas, Isa::neon) == isas.end() ? Isa::neon : Isa::sse4;
}

}  // namespace rastrum::test
