// SPDX-License-Identifier: BSD-3-Clause
// Colours of many scalars at once, by instruction set, with the operations, order and bits of the
// scalar form (scalar_colors.cpp).
#pragma once

#include <vector>

#include <rastrum/color_map.hpp>
#include <rastrum/device.hpp>

namespace rastrum::raster {

struct alignas(64) MappedColors {
  float r[64], g[64], b[64], a[64];
};

/// A mapping with is_ramp(), without isolines.
class ScalarRamp {
 public:
  explicit ScalarRamp(const ScalarColors& colors);

  double low, high, span;
  Vec4 below, above, nan;
  double last;                 ///< index of the last colour
  std::vector<double> colors;  ///< RGBA
};

/// Sets the colours of 64 numbers, 64-byte aligned.
using MapNumbers = void (*)(const ScalarRamp& ramp, const double* numbers,
                            MappedColors& colors) noexcept;
/// Null: the instruction set has none.
[[nodiscard]] MapNumbers map_numbers(Isa isa) noexcept;

}  // namespace rastrum::raster
