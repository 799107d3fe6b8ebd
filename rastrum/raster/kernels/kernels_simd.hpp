// Where the Highway sources meet the table of kernels.
#pragma once

#include <rastrum/raster/kernels/kernels.hpp>

namespace rastrum::raster {

/// Each sets its part of `table` to the kernels of `isa`. Returns false where they were not
/// compiled for this architecture; the table then stays as it is.
bool fill_setup_kernels(Isa isa, Kernels& table) noexcept;
bool fill_cover_kernels(Isa isa, Kernels& table) noexcept;
bool fill_block_kernels(Isa isa, Kernels& table) noexcept;

}  // namespace rastrum::raster
