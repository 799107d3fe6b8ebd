// SPDX-License-Identifier: BSD-3-Clause
// How long a call of Kernels::cover may be that raises rows (RowKeys).
#pragma once

#include <cstddef>

namespace rastrum::raster {

/// Pieces that Kernels::cover takes at once where it is given rows, so that who calls looks in
/// between at what they hide and whether to stop: they need no room for blocks, which would end it.
inline constexpr std::size_t kMostRowPieces = 4096;

}  // namespace rastrum::raster
