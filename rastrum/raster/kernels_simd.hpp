// Where the Highway sources meet the table.
#pragma once

#include <rastrum/raster/kernels.hpp>

namespace rastrum::raster {

/// Null where no SIMD source was compiled for `isa`.
[[nodiscard]] const Kernels* simd_kernels(Isa isa) noexcept;

}  // namespace rastrum::raster
