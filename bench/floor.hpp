// SPDX-License-Identifier: BSD-3-Clause
// The floor, the least time of a frame on a machine: the larger of its memory traffic over the
// measured bandwidth and its operations over the measured arithmetic.
#pragma once

#include <cstdint>
#include <string_view>

#include "machine.hpp"

namespace rastrum::bench {

struct Workload {
  std::uint64_t vertices = 0, triangles = 0;
  std::uint64_t fragments = 0;       ///< samples covered, over all triangles
  std::uint64_t pixels_covered = 0;  ///< pixels shaded
  std::uint64_t pixels = 0;          ///< W × H
  std::uint64_t blended = 0;         ///< translucent fragments: shaded, then blended
};

struct Floor {
  double bytes = 0, operations = 0;
  double bytes_ms = 0, operations_ms = 0;

  [[nodiscard]] double ms() const { return bytes_ms > operations_ms ? bytes_ms : operations_ms; }
  [[nodiscard]] std::string_view binds() const {
    return bytes_ms > operations_ms ? "bytes" : "ops";
  }
};

/// Bytes: positions, normals and indices are read once at the read bandwidth, and 4 bytes a pixel
/// are written once by streaming stores. Operations (float32 or integer lanes, counted in
/// floor.cpp) run at the peak without fused multiply-add, which the picture rules forbid.
[[nodiscard]] Floor floor_of(const Workload& work, const MachineLimits& machine);

}  // namespace rastrum::bench
