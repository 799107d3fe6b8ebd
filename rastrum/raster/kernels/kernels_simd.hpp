// SPDX-License-Identifier: BSD-3-Clause
// Connects the Highway sources with the table of kernels.
#pragma once

#include <rastrum/raster/kernels/kernels.hpp>

namespace rastrum::raster {

using FillKernels = void (*)(Kernels&);

/// Each sets its part to the kernels of `isa`; null where those were not compiled.
[[nodiscard]] FillKernels fill_setup_kernels(Isa isa) noexcept;
[[nodiscard]] FillKernels fill_cover_kernels(Isa isa) noexcept;
[[nodiscard]] FillKernels fill_block_kernels(Isa isa) noexcept;
[[nodiscard]] FillKernels fill_quadric_kernels(Isa isa) noexcept;
[[nodiscard]] FillKernels fill_sampled_kernels(Isa isa) noexcept;

}  // namespace rastrum::raster
