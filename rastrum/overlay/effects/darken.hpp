// SPDX-License-Identifier: BSD-3-Clause
// The way of factors into a row of 8-bit colours: what the plain kernel and those of each
// instruction set have in common.
#pragma once

#include <rastrum/device.hpp>
#include <rastrum/image.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::overlay {

/// colors[i] becomes colors[i] · factor[i] + ink · (1 − factor[i]), to the nearest, ties to even;
/// alpha stays. `ink`: in [0, 255].
using DarkenKernel = void (*)(const float* factor, Vec3 ink, int count, Rgba8* colors);

void darken_plain(const float* factor, Vec3 ink, int count, Rgba8* colors);

[[nodiscard]] DarkenKernel darken_kernel(Isa isa) noexcept;

}  // namespace rastrum::overlay
