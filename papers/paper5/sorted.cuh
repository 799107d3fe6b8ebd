// SPDX-License-Identifier: BSD-3-Clause
// sorted on a device: fragments are counted, written, sorted by pixel, and the maximum of each
// pixel's segment is kept (paper 5, sections 3.1 to 3.4): no atomic operation on a pixel.
//
// As in the paper an index is sorted, by radix, and the keys are gathered where they are reduced.
// Fragments that do not fit into the memory together are sorted part by part, and each part raises
// the surface.
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
/// A segment has its pixel for itself.
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
/// "segments", a pixel of a sort each.
template <class Exec>
class SortedOnDevice final : public DeviceVisibility<Exec> {
 public:
  explicit SortedOnDevice(FamilyFrame<Exec>&) {}
  void resolve(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
               std::span<const Block> blocks, std::uint64_t fragments) override {
    // Its key, its element and index twice while they are sorted, its segment's, and a share of
    // what sorts and reduces.
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
