// SPDX-License-Identifier: BSD-3-Clause
// Argument checks of procedural shapes. Messages name the shape and the parameter.
#pragma once

#include <cstdint>
#include <string_view>

namespace rastrum::shapes {

/// Throws Error{invalid_argument} "SHAPE: PARAMETER must lie in [low, high], got VALUE" unless
/// low ≤ value ≤ high. NaN is outside of every range.
void require_range(std::string_view shape, std::string_view parameter, double value, double low,
                   double high);

/// Throws Error{invalid_argument} naming both parameters unless 32 bits number the mesh's vertices
/// and triangles.
void require_size(std::string_view shape, std::string_view parameters, double vertices);

}  // namespace rastrum::shapes
