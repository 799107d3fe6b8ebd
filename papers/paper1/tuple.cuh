// SPDX-License-Identifier: BSD-3-Clause
// tuple on a device: every fragment is shaded, and (key, colour) pairs are reduced by pixel, the
// greater key with its colour (paper 1, section 3.2.1). No atomic operation changes 24 bytes, so a
// sort brings the fragments of a pixel together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <papers/axes/fragments.cuh>
#include <rastrum/parallel/cuda/words.cuh>

namespace rastrum::family {

/// The nearest fragment of a pixel so far.
struct Seen {
  std::uint64_t key;
  Vec4 color;
};
/// Equal keys belong to the same fragment, which has one colour.
struct GreaterKey {
  RASTRUM_HD Seen operator()(const Seen& a, const Seen& b) const { return a.key < b.key ? b : a; }
};

}  // namespace rastrum::family

namespace rastrum::parallel {
template <>
inline constexpr bool kAnyOrder<family::Seen, family::GreaterKey> = true;
}  // namespace rastrum::parallel

namespace rastrum::family {

struct SeenAt {
  const std::uint64_t* key;
  const Vec4* color;  ///< null: not wanted
  const std::uint32_t* which;
  RASTRUM_HD Seen operator()(std::size_t k) const {
    const std::uint32_t i = which[k];
    return {key[i], color == nullptr ? Vec4{} : color[i]};
  }
};
/// No other segment has this pixel.
struct RaiseToSeen {
  const std::uint32_t* element;
  const Seen* nearest;
  std::uint64_t* keys;
  Vec4* colors;  ///< null: not wanted
  RASTRUM_HD void operator()(std::size_t k) const {
    const std::uint32_t i = element[k];
    if (nearest[k].key <= keys[i]) return;
    keys[i] = nearest[k].key;
    if (colors != nullptr) colors[i] = nearest[k].color;
  }
};

/// Work O(fragments) shading and O(fragments · digits); 80 bytes a fragment. Counter: "fragments
/// shaded"; 0 if the frame wants no colours or the host shades what is visible.
template <class Exec>
class TupleOnDevice final : public DeviceVisibility<Exec> {
 public:
  explicit TupleOnDevice(FamilyFrame<Exec>&) {}
  void resolve(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
               std::span<const Block> blocks, std::uint64_t) override {
    using parallel::view_of;
    // Key and colour, element and index twice while they are sorted, the segment's values, and a
    // share of the scratch of sort and reduction.
    constexpr std::uint64_t kFragmentBytes = 8 + sizeof(Vec4) + 2 * 8 + 4 + sizeof(Seen) + 8;
    const FragmentColors& shading = frame.shading;
    each_written_part(frame, pieces, blocks, kFragmentBytes, [&](auto& element, auto& key) {
      auto color = parallel::make_buffer<Vec4>(frame.exec, shading.shade ? key.size() : 0);
      if (shading.shade) {
        shading.shade(view_of(std::as_const(element)), view_of(std::as_const(key)), view_of(color));
        frame.count("fragments shaded", key.size());
      }
      const auto which = sort_by_pixel(frame, element);
      const auto nearest = parallel::reduce_by_key(
          frame.exec, element,
          parallel::Computed(which.size(), SeenAt{key.data(), color.data(), which.data()}),
          GreaterKey{});
      parallel::for_each_index(
          frame.exec, nearest.keys.size(),
          RaiseToSeen{nearest.keys.data(), nearest.values.data(), frame.surface.keys.keys,
                      shading.shade ? shading.colors.data() : nullptr});
    });
  }
};

}  // namespace rastrum::family
