// SPDX-License-Identifier: BSD-3-Clause
// The SIMD leaves of the fast path: one table of functions per instruction set, chosen once per
// frame. They work on the columns of one block; every table gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <rastrum/image.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/terrain/samples.hpp>

namespace rastrum::terrain {

/// Columns of a block. One of its rows is four cache lines of colours, and its marks at 1,080 rows
/// stay within 276 KiB of a second-level cache.
inline constexpr std::size_t kBlockColumns = 64;

/// The state of a block's columns while its slices are walked. Arrays are aligned for vectors and
/// have full length: columns beyond the picture are hidden from the start.
struct ColumnBlock {
  alignas(64) float ux[kBlockColumns] = {}, uy[kBlockColumns] = {};
  /// The first row that is drawn, −inf once that is the picture's first one.
  alignas(64) float hidden[kBlockColumns];
  float deepest;  ///< the largest of them: no column shows anything from there on
  alignas(64) float heights[kBlockColumns] = {};       ///< of the slice at hand
  alignas(64) std::int32_t cells[kBlockColumns] = {};  ///< where they were read, in their level
  /// The visible samples of the slice: where each one's mark belongs (row · kBlockColumns +
  /// column), and its cell. There is room for a vector beyond the last.
  alignas(64) std::int32_t mark[kBlockColumns * 2], cell[kBlockColumns * 2];

  /// Nothing is drawn yet in columns [0, n) of a picture `height` rows high.
  void restart(std::size_t n, int height) {
    for (std::size_t i = 0; i < kBlockColumns; ++i)
      hidden[i] = i < n ? static_cast<float>(height) : -std::numeric_limits<float>::infinity();
    deepest = static_cast<float>(height);
  }
};

/// Where classic samples stand. N slices lie side by side, so that positions accumulate along each.
struct ClassicSlices {
  const double* x;  ///< at the block's first column
  const double* y;
  const double* dx;
  const double* dy;
};

struct MapSize {
  int width, height;
  Tiling tiling;
  bool powers_of_two;  ///< and repeated, and no position beyond ±2³¹
};

struct Kernels {
  /// Heights and cells of columns [0, n) on a slice. No cells with MapFilter::bilinear.
  void (*heights)(const Samples& samples, const Slice& slice, std::size_t n,
                  ColumnBlock& block) noexcept;

  /// The colours of the n columns of a map that `mark` lists, behind the fog. `colors` has room for
  /// kBlockColumns; those beyond n are overwritten.
  void (*colors)(const Samples& samples, const Slice& slice, std::size_t n,
                 const ColumnBlock& block, Rgba8* colors) noexcept;

  /// Finds the columns whose sample lies above all before: lowers `hidden` and `deepest`, lists the
  /// columns in order in `mark` and `cell`, and returns how many there are. A sample's row is
  /// (altitude − height) · rows + horizon.
  std::size_t (*occlude)(float altitude, float rows, float horizon, std::size_t n,
                         ColumnBlock& block) noexcept;
  /// The same in float64; `hidden` are integers all the same.
  std::size_t (*occlude64)(double altitude, double rows, double horizon, std::size_t n,
                           ColumnBlock& block) noexcept;

  /// Moves the positions of kClassicSlices slices on by `columns` columns, one addition each.
  void (*advance)(std::size_t columns, const double* dx, const double* dy, double* x,
                  double* y) noexcept;
  /// Finds cells[column · kClassicSlices + slice] of kClassicSlices slices.
  void (*classic_cells)(const ClassicSlices& slices, const MapSize& map, std::size_t n,
                        std::int32_t* cells) noexcept;

  /// Gives every empty (0) mark of rows [first, last) the one above it, or that in `above`, and
  /// writes rows to `out`; the marks are empty afterwards. With `stream`, writes past the caches.
  void (*fill)(std::uint32_t* marks, int first, int last, std::size_t n, std::uint32_t* above,
               std::uint32_t* out, std::ptrdiff_t stride, bool stream) noexcept;
};

/// How many slices accumulate classic positions at once; their number is rounded up to a multiple.
inline constexpr std::size_t kClassicSlices = 8;

/// Kernels::colors, one colour at a time.
void colors_one_by_one(const Samples& samples, const Slice& slice, std::size_t n,
                       const ColumnBlock& block, Rgba8* colors) noexcept;

/// The table of `isa`, one of available_isas() (choose_isa).
[[nodiscard]] const Kernels& kernels(Isa isa) noexcept;
/// Plain C++.
extern const Kernels kScalarKernels;

}  // namespace rastrum::terrain
