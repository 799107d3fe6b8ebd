// SPDX-License-Identifier: BSD-3-Clause
// sorted on a device: counts, writes and sorts fragments by pixel and keeps the maximum of each
// pixel's segment (paper 5, sections 3.1 to 3.4), without an atomic operation on a pixel.
//
// As in the paper, an index is sorted, here by radix, and the reduction gathers the keys. Fragments
// that do not fit into memory together are sorted in parts, each of which raises the surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <papers/axes/fragments.cuh>

namespace rastrum::family {

struct KeyAt {
  const std::uint64_t* key;
  const std::uint32_t* which;
  RASTRUM_HD std::uint64_t operator()(std::size_t k) const { return key[which[k]]; }
};
/// No other segment has this pixel.
struct RaiseToMaximum {
  const std::uint32_t* element;
  const std::uint64_t* maximum;
  std::uint64_t* keys;
  RASTRUM_HD void operator()(std::size_t k) const {
    std::uint64_t& key = keys[element[k]];
    if (key < maximum[k]) key = maximum[k];
  }
};

/// Work O(fragments · digits); 44 bytes a fragment. Counters: "fragments materialized", "sorts",
/// "segments" (pixels of each sort).
template <class Exec>
class SortedOnDevice final : public DeviceVisibility<Exec> {
 public:
  explicit SortedOnDevice(FamilyFrame<Exec>&) {}
  void resolve(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
               std::span<const Block> blocks, std::uint64_t fragments) override {
    // Key, element and index twice while they are sorted, the segment's values, and a share of the
    // scratch of sort and reduction.
    constexpr std::uint64_t kFragmentBytes = 8 + 2 * 8 + 12 + 8;
    each_written_part(frame, pieces, blocks, kFragmentBytes, [&](auto& element, auto& key) {
      const auto which = sort_by_pixel(frame, element);
      const auto segments = parallel::reduce_by_key(
          frame.exec, element, parallel::Computed(which.size(), KeyAt{key.data(), which.data()}),
          parallel::Maximum{});
      parallel::for_each_index(
          frame.exec, segments.keys.size(),
          RaiseToMaximum{segments.keys.data(), segments.values.data(), frame.surface.keys.keys});
      frame.count("sorts", 1);
      frame.count("segments", segments.keys.size());
    });
    frame.count("fragments materialized", fragments);
  }
};

}  // namespace rastrum::family
