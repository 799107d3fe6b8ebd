// SPDX-License-Identifier: BSD-3-Clause
// The SIMD kernels of packed fragments (packed_simd.cpp), a table per instruction set, with the
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

/// Kernels may write this many elements beyond their results.
inline constexpr std::size_t kPackSlack = raster::kRunSlack;

/// A sort_key has a fragment's depth and its number instead of an id. Numbers rise with ids, so
/// sort_keys of a pixel compare as keys. 0: none.
constexpr std::uint64_t packed_sort_key(std::uint64_t key, std::size_t number) {
  return (key & ~raster::kIdMask) | (raster::kIdMask - number);
}
constexpr std::size_t number_of_sort_key(std::uint64_t sort_key) {
  return static_cast<std::size_t>(raster::kIdMask - (sort_key & raster::kIdMask));
}

/// The fragments of 8 pixels: `layers` rows of 8 sort_keys, and the colours of all fragments by
/// number, from colors[1] on; colors[0] is 0.
struct PackedRow {
  const std::uint64_t* sort_keys;
  std::size_t layers;
  const Vec4* colors;
};

/// The index of a sort_key's colour. Needs no branch: 0, which is no sort_key, gives colors[0].
constexpr std::uint32_t color_of_sort_key(std::uint64_t sort_key) {
  return 0U - static_cast<std::uint32_t>(sort_key);
}

struct PackedPlace {
  int x, y;
};

inline bool is_translucent(const raster::BinFragment& f) {
  return (f.pixel & raster::kTranslucentFragment) != 0;
}
/// `f` counts its pixel by blocks of the bin, the region from pixel `first` of the bin.
inline std::uint16_t packed_pixel(const raster::BinFragment& f, std::uint32_t first) {
  const int pixel = raster::row_in_bin(f) * kPackedPitch + raster::column_in_bin(f);
  return static_cast<std::uint16_t>(static_cast<std::uint32_t>(pixel) - first);
}

/// Fragments of micro triangles. kPackSlack more may be read; their keys are 0.
struct MicroFragments {
  const std::uint64_t* keys = nullptr;
  const std::uint16_t* pixels = nullptr;
  std::size_t count = 0;
};

struct PackedKernels {
  /// Keys and pixels of the translucent fragments that `fragments` begin with. Returns their
  /// number.
  std::size_t (*take)(std::span<const raster::BinFragment> fragments, std::uint32_t first,
                      std::uint64_t* keys, std::uint16_t* pixels) noexcept;

  /// Keys and pixels of the fragments of `windows`, with those of `micro` between them by ids. Ids
  /// of both rise. Returns the number.
  std::size_t (*pack)(std::span<const Window> windows, const MicroFragments& micro,
                      const PackedPlace& place, std::uint64_t* keys,
                      std::uint16_t* pixels) noexcept;

  /// Sets a bit for the first key of each id, in whole words. Returns whether ids never fall. Sets
  /// kPackSlack keys behind the last to 0.
  bool (*find_firsts)(std::uint64_t* keys, std::size_t count, std::uint64_t* firsts) noexcept;

  /// Fragments of each pixel of `rows` rows of 8, and the most in each row.
  void (*count)(const std::uint16_t* pixels, std::size_t count, std::size_t rows,
                std::uint16_t* of_pixel, std::uint16_t* most) noexcept;

  /// The places of 64 fragments for a shader that takes element i to be at row i / 8, column i % 8.
  void (*points)(const std::uint16_t* pixels, raster::ShadingPoints& points) noexcept;

  /// `layers` rows of 8 sort_keys, largest first in each pixel.
  void (*sort)(std::uint64_t* sort_keys, std::size_t layers) noexcept;

  /// Inserts the sort_keys of 8 pixels one by one, looking back over at most `filter`
  /// (layer_lists.hpp). Returns the pixels where one had to go farther.
  std::uint8_t (*filter)(std::uint64_t* sort_keys, std::size_t layers, std::size_t filter) noexcept;

  void (*interleave)(const raster::BlockColors& colors, Vec4* out) noexcept;

  /// The colours of the first 8 sort_keys, elements `first` … of `out`; 0 where there is none.
  void (*gather)(const PackedRow& row, std::size_t first, raster::BlockColors& out) noexcept;

  /// All layers of a row, each behind the last. With `opaque_at` above 0 a pixel is finished once
  /// no more than that shows through.
  void (*behind)(const PackedRow& row, std::size_t first, float opaque_at, Seen& seen) noexcept;

  /// `behind` for each row of a block, then BlendKernels::finish; the block's `behind` may be null.
  void (*over)(const PackedRow (&rows)[8], const raster::BlockColors* behind, float opaque_at,
               raster::BlockColors& out) noexcept;

  /// All layers of a row, each over the last.
  void (*before)(const PackedRow& row, std::size_t first, raster::BlockColors& colors) noexcept;
};

[[nodiscard]] const PackedKernels& packed_kernels(Isa isa) noexcept;

}  // namespace rastrum::transparency
