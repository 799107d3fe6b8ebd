// SPDX-License-Identifier: BSD-3-Clause
// The SIMD kernels of the fast path, a table per instruction set, chosen once per frame. They work
// on the columns of one block, and every table gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <rastrum/image.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/terrain/samples.hpp>

namespace rastrum::terrain {

/// A row of a block is four cache lines of colours; its marks at 1,080 rows (270 KiB) fit into a
/// second-level cache.
inline constexpr std::size_t kBlockColumns = 64;

/// The columns of a block while its slices are walked. Columns beyond the picture are hidden from
/// the start.
struct ColumnBlock {
  alignas(64) float ux[kBlockColumns] = {}, uy[kBlockColumns] = {};
  /// The first row that is drawn; −inf once that is the picture's first one.
  alignas(64) float hidden[kBlockColumns];
  float deepest;  ///< the largest of them: every column is drawn from there on
  alignas(64) float heights[kBlockColumns] = {};       ///< on the current slice
  alignas(64) std::int32_t cells[kBlockColumns] = {};  ///< of the heights, in their level
  /// Per visible sample of the slice: the place of its mark (row · kBlockColumns + column), and its
  /// cell. Vectors may be stored beyond the last.
  alignas(64) std::int32_t mark[kBlockColumns * 2], cell[kBlockColumns * 2];

  void restart(std::size_t n, int height) {
    for (std::size_t i = 0; i < kBlockColumns; ++i)
      hidden[i] = i < n ? static_cast<float>(height) : -std::numeric_limits<float>::infinity();
    deepest = static_cast<float>(height);
  }
};

/// Positions of several slices side by side, so that they accumulate along each.
struct ClassicSlices {
  const double* x;  ///< at the block's first column
  const double* y;
  const double* dx;
  const double* dy;
};

struct MapSize {
  int width, height;
  Tiling tiling;
  bool powers_of_two;  ///< the map also repeats, and no position is beyond ±2³¹
};

struct Kernels {
  /// Heights and cells of columns [0, n) on a slice; with MapFilter::bilinear heights alone.
  void (*heights)(const Samples& samples, const Slice& slice, std::size_t n,
                  ColumnBlock& block) noexcept;

  /// The fogged colours of the n map samples that `mark` lists. Elements up to kBlockColumns may be
  /// overwritten.
  void (*colors)(const Samples& samples, const Slice& slice, std::size_t n,
                 const ColumnBlock& block, Rgba8* colors) noexcept;

  /// Finds the columns whose sample lies above all earlier ones: lowers `hidden` and `deepest`,
  /// lists the columns in `mark` and `cell`, and returns their number. A sample's row is (altitude
  /// − height) · rows + horizon.
  std::size_t (*occlude)(float altitude, float rows, float horizon, std::size_t n,
                         ColumnBlock& block) noexcept;
  /// In float64; `hidden` are integers.
  std::size_t (*occlude64)(double altitude, double rows, double horizon, std::size_t n,
                           ColumnBlock& block) noexcept;

  /// Moves the positions by `columns` columns, one addition each.
  void (*advance)(std::size_t columns, const double* dx, const double* dy, double* x,
                  double* y) noexcept;
  /// Finds cells[column · kClassicSlices + slice].
  void (*classic_cells)(const ClassicSlices& slices, const MapSize& map, std::size_t n,
                        std::int32_t* cells) noexcept;

  /// Gives every empty (0) mark of rows [first, last) the one above it, or that in `above`, writes
  /// the rows to `out`, and clears the marks. With `stream`, writes past the caches.
  void (*fill)(std::uint32_t* marks, int first, int last, std::size_t n, std::uint32_t* above,
               std::uint32_t* out, std::ptrdiff_t stride, bool stream) noexcept;
};

/// Slices whose classic positions accumulate together.
inline constexpr std::size_t kClassicSlices = 8;

/// Kernels::colors, one colour at a time.
void colors_one_by_one(const Samples& samples, const Slice& slice, std::size_t n,
                       const ColumnBlock& block, Rgba8* colors) noexcept;

/// The table of `isa`, one of available_isas() (choose_isa).
[[nodiscard]] const Kernels& kernels(Isa isa) noexcept;
extern const Kernels kScalarKernels;

}  // namespace rastrum::terrain
