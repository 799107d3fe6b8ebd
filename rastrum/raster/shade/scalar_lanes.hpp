// SPDX-License-Identifier: BSD-3-Clause
// The colours of many numbers at once, by instruction set: what the scalar form says of each
// (scalar_colors.cpp), in the same order, so the same bits.
#pragma once

#include <vector>

#include <rastrum/color_map.hpp>
#include <rastrum/device.hpp>

namespace rastrum::raster {

struct alignas(64) MappedColors {
  float r[64], g[64], b[64], a[64];
};

/// A mapping with is_ramp(), without its isolines.
class ScalarRamp {
 public:
  explicit ScalarRamp(const ScalarColors& colors);

  double low, high, span;
  Vec4 below, above, nan;
  double last;                 ///< place of the last colour
  std::vector<double> colors;  ///< RGBA
};

/// Sets the colours of 64 numbers, 64-byte aligned.
using MapNumbers = void (*)(const ScalarRamp& ramp, const double* numbers,
                            MappedColors& colors) noexcept;
/// Null where there are no lanes.
[[nodiscard]] MapNumbers map_numbers(Isa isa) noexcept;

}  // namespace rastrum::raster
