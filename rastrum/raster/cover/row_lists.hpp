// SPDX-License-Identifier: BSD-3-Clause
// Limits a call of Kernels::cover that raises rows (RowKeys).
#pragma once

#include <cstddef>

namespace rastrum::raster {

/// The most pieces that Kernels::cover takes at once with rows. They need no room for blocks, which
/// would end the call, and between calls the caller updates bounds and checks for a stop.
inline constexpr std::size_t kMostRowPieces = 4096;

}  // namespace rastrum::raster
