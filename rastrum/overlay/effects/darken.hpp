// SPDX-License-Identifier: BSD-3-Clause
// Darkens 8-bit colours by factors: what the plain and the SIMD kernels share.
#pragma once

#include <rastrum/device.hpp>
#include <rastrum/image.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::overlay {

/// colors[i] becomes colors[i] · factor[i] + ink · (1 − factor[i]), to nearest, ties to even; alpha
/// stays. `ink`: in [0, 255].
using DarkenKernel = void (*)(const float* factor, Vec3 ink, int count, Rgba8* colors);

void darken_plain(const float* factor, Vec3 ink, int count, Rgba8* colors);

[[nodiscard]] DarkenKernel darken_kernel(Isa isa) noexcept;

}  // namespace rastrum::overlay
