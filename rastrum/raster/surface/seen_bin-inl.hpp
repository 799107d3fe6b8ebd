// SPDX-License-Identifier: BSD-3-Clause
// The triangles that a bin's pixels see, numbered in order of appearance and set up in groups of
// kLanes. Meanwhile the next group's vertices and later indices come from memory.
#if defined(RASTRUM_RASTER_SURFACE_SEEN_BIN_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SURFACE_SEEN_BIN_INL_HPP
#undef RASTRUM_RASTER_SURFACE_SEEN_BIN_INL_HPP
#else
#define RASTRUM_RASTER_SURFACE_SEEN_BIN_INL_HPP
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>

#include <hwy/highway.h>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/surface/seen_bin.hpp>
#include <rastrum/raster/surface/seen_triangles-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

/// Groups whose indices are prefetched.
constexpr std::size_t kAhead = 3;

HWY_INLINE std::uint64_t covered_of(const std::uint64_t* keys) {
  const hn::CappedTag<std::uint64_t, 8> d;
  constexpr std::size_t kStep = hn::MaxLanes(hn::CappedTag<std::uint64_t, 8>());
  std::uint64_t empty = 0;
  for (std::size_t i = 0; i < 64; i += kStep) {
    std::uint8_t bits = 0;
    hn::StoreMaskBits(d, hn::Eq(hn::Load(d, keys + i), hn::Zero(d)), &bits);
    empty |= (std::uint64_t{bits} & ((1U << kStep) - 1)) << i;
  }
  return ~empty;
}

/// Numbers the triangles seen by rows of blocks from `row` on, while there is room, and sets places
/// and end_row. Returns their number.
HWY_INLINE std::size_t find_triangles(const FrameGeometry& frame, const BinSurface& bin, int row,
                                      SeenBin& seen) {
  std::memset(seen.table, 0, sizeof seen.table);
  const hn::CappedTag<std::uint16_t, 8> d;
  std::uint64_t count = 0;
  const Rect image{0, 0, frame.width, frame.height};
  for (; row < block_rows(bin.rect) && count + SeenBin::kOfRow <= SeenBin::kRoom; ++row)
    for (int column = 0; column < block_columns(bin.rect); ++column) {
      const std::uint64_t* const keys = bin.block(column, row);
      std::uint64_t covered = covered_of(keys);
      const int bx = bin.rect.x0 / kBlockSize + column, by = bin.rect.y0 / kBlockSize + row;
      if ((bx + 1) * kBlockSize > image.x1 || (by + 1) * kBlockSize > image.y1)
        covered &= samples_inside(image, bx, by);
      std::uint16_t* const place = seen.places_of(bx * kBlockSize, by * kBlockSize);
      std::uint64_t starts = run_starts(keys, covered);
      for (; starts != 0; starts &= starts - 1) {
        const int i = std::countr_zero(starts);
        const std::uint64_t low = keys[i] & kIdMask;
        std::uint64_t& entry = seen.table[low % std::size(seen.table)];
        // Branch-free, since the branch is unpredictable and compilers make one of `?:`. A triangle
        // may be listed twice: what the table forgets costs only time. With the low part in the
        // entry nothing is loaded that was just stored.
        const std::uint64_t next = low << 16 | count;
        const std::uint64_t is_new = entry >> 16 != low ? 1 : 0;
        const std::uint64_t known = entry ^ ((entry ^ next) & (0U - is_new));
        seen.low[count] = low;
        count += is_new;
        entry = known;
        hn::StoreU(hn::Set(d, static_cast<std::uint16_t>(known)), d, place + i);
      }
    }
  seen.end_row = row;
  return count;
}

/// Sets up the first `count` triangles of `seen` by groups. Calls find(their low parts, number,
/// group) before the previous group is set up, and then set_up(first triangle, number, group).
/// `finder` can prefetch() by low part.
template <class Group, class Finder, class Find, class SetUp>
HWY_INLINE void set_up_bin(std::size_t count, const SeenBin& seen, Finder& finder, const Find& find,
                           const SetUp& set_up) {
  const std::size_t group_count = (count + kLanes - 1) / kLanes;
  const auto triangles_of = [&](std::size_t g)
                                HWY_ATTR { return std::min(kLanes, count - g * kLanes); };
  Group groups[2];
  const auto prefetch = [&](std::size_t g) HWY_ATTR {
    if (g >= group_count) return;
    const std::size_t n = triangles_of(g);
    for (std::size_t i = 0; i < n; ++i) finder.prefetch(seen.low[g * kLanes + i]);
  };
  const auto find_group = [&](std::size_t g) HWY_ATTR {
    if (g < group_count) find(seen.low + g * kLanes, triangles_of(g), groups[g % 2]);
  };
  for (std::size_t g = 0; g < kAhead; ++g) prefetch(g);
  find_group(0);
  for (std::size_t g = 0; g < group_count; ++g) {
    prefetch(g + kAhead);
    find_group(g + 1);
    set_up(g * kLanes, triangles_of(g), groups[g % 2]);
  }
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SURFACE_SEEN_BIN_INL_HPP
