// SPDX-License-Identifier: BSD-3-Clause
// The SIMD leaves of packed fragments (packed_simd.cpp), once for each instruction set and with the
// same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/frame.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/samples.hpp>
#include <rastrum/raster/shade/shader.hpp>
#include <rastrum/transparency/blend_kernels.hpp>
#include <rastrum/transparency/records.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::transparency {

/// Pixels of a region of at most 64 × 64 px are numbered 64 · row + column.
inline constexpr int kPackedPitch = raster::kRunPitch;

/// Kernels may write this many elements beyond what they return.
inline constexpr std::size_t kPackSlack = raster::kRunSlack;

/// A sort_key is a fragment's depth and, in the place of an id, its number: sort_keys of a pixel
/// compare as keys do where numbers rise with ids. 0: none.
constexpr std::uint64_t packed_sort_key(std::uint64_t key, std::size_t number) {
  return (key & ~raster::kIdMask) | (raster::kIdMask - number);
}
constexpr std::size_t number_of_sort_key(std::uint64_t sort_key) {
  return static_cast<std::size_t>(raster::kIdMask - (sort_key & raster::kIdMask));
}

/// The fragments of 8 pixels: `layers` rows of 8 sort_keys, and the colours of all fragments by
/// number, beginning with colors[1]; colors[0] is 0.
struct PackedRow {
  const std::uint64_t* sort_keys;
  std::size_t layers;
  const Vec4* colors;
};

/// The place of a sort_key's colour: without a branch, as 0 is that of no sort_key.
constexpr std::uint32_t color_of_sort_key(std::uint64_t sort_key) {
  return 0U - static_cast<std::uint32_t>(sort_key);
}

/// The first pixel of a region in the picture.
struct PackedPlace {
  int x, y;
};

inline bool is_translucent(const raster::BinFragment& f) {
  return (f.pixel & raster::kTranslucentFragment) != 0;
}
/// The pixel of `f`, which a bin counts by blocks, in a region whose first pixel is `first` of the
/// bin.
inline std::uint16_t packed_pixel(const raster::BinFragment& f, std::uint32_t first) {
  const int pixel = raster::row_in_bin(f) * kPackedPitch + raster::column_in_bin(f);
  return static_cast<std::uint16_t>(static_cast<std::uint32_t>(pixel) - first);
}

/// Fragments of micro triangles: keys and pixels, of which kPackSlack more may be read. These keys
/// are 0.
struct MicroFragments {
  const std::uint64_t* keys = nullptr;
  const std::uint16_t* pixels = nullptr;
  std::size_t count = 0;
};

struct PackedKernels {
  /// The translucent ones that `fragments` begin with: their keys, and their pixels, counted from
  /// pixel `first` of the bin. Returns how many.
  std::size_t (*take)(std::span<const raster::BinFragment> fragments, std::uint32_t first,
                      std::uint64_t* keys, std::uint16_t* pixels) noexcept;

  /// The fragments of `windows`, one window behind the other, and between them, by their ids, those
  /// of `micro`: keys and pixels. Returns how many. Ids of either rise.
  std::size_t (*pack)(std::span<const Window> windows, const MicroFragments& micro,
                      const PackedPlace& place, std::uint64_t* keys,
                      std::uint16_t* pixels) noexcept;

  /// Which of `count` keys are the first of their ids: a bit each, whole words. Returns whether ids
  /// never fall from one to the next. Sets kPackSlack keys behind the last to 0.
  bool (*find_firsts)(std::uint64_t* keys, std::size_t count, std::uint64_t* firsts) noexcept;

  /// How many fragments each pixel has of `rows` rows of 8 pixels, and the most in each row.
  void (*count)(const std::uint16_t* pixels, std::size_t count, std::size_t rows,
                std::uint16_t* of_pixel, std::uint16_t* most) noexcept;

  /// Where 64 fragments are, for a shader that takes element i to be at row i / 8, column i % 8.
  void (*points)(const std::uint16_t* pixels, raster::ShadingPoints& points) noexcept;

  /// Sorts the sort_keys of 8 pixels, each pixel's largest first: `sort_keys` is `layers` rows
  /// of 8.
  void (*sort)(std::uint64_t* sort_keys, std::size_t layers) noexcept;

  /// Inserts the sort_keys of 8 pixels, one after the other, looking back over at most `filter`
  /// (layer_lists.hpp). Returns the pixels where one was to go farther.
  std::uint8_t (*filter)(std::uint64_t* sort_keys, std::size_t layers, std::size_t filter) noexcept;

  /// 64 colours, one after the other.
  void (*interleave)(const raster::BlockColors& colors, Vec4* out) noexcept;

  /// The colours of the first 8 sort_keys of `row`: elements `first` … of `out`, 0 where there is
  /// none.
  void (*gather)(const PackedRow& row, std::size_t first, raster::BlockColors& out) noexcept;

  /// All layers of a row one behind the other, as BlendKernels::behind has it: elements `first` … .
  /// With `opaque_at` above 0 a pixel takes no more once no more than that is seen through it.
  void (*behind)(const PackedRow& row, std::size_t first, float opaque_at, Seen& seen) noexcept;

  /// All layers of a block's rows, and what is seen of `behind` (null: nothing is there), as
  /// `behind` for each row and BlendKernels::finish have it.
  void (*over)(const PackedRow (&rows)[8], const raster::BlockColors* behind, float opaque_at,
               raster::BlockColors& out) noexcept;

  /// All layers of a row one before the other, as BlendKernels::before has it.
  void (*before)(const PackedRow& row, std::size_t first, raster::BlockColors& colors) noexcept;
};

[[nodiscard]] const PackedKernels& packed_kernels(Isa isa) noexcept;

}  // namespace rastrum::transparency
