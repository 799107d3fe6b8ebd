// SPDX-License-Identifier: BSD-3-Clause
// The fragments of a turn on a device: the covered samples of its blocks. They are found again by
// number, and only a part of them is in memory at a time.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <papers/axes/frame.cuh>
#include <papers/axes/turns.cuh>

namespace rastrum::family {

/// A fragment by the index of its key in the surface.
struct Fragment {
  std::uint32_t element;
  std::uint64_t key;
};

[[nodiscard]] RASTRUM_HD inline Fragment fragment_at(const Piece* pieces, const SurfaceView& keys,
                                                     const Block& b, int i) {
  return {static_cast<std::uint32_t>(keys.index(b.bx, b.by) * 64 + static_cast<std::size_t>(i)),
          DeviceSurface::key(pieces[b.piece], b.bx, b.by, i)};
}

/// Functor: fragment k of the blocks that `plan` expands.
template <class Plan>
struct FragmentAt {
  Plan plan;
  std::span<const Block> blocks;
  const Piece* pieces;
  SurfaceView keys;
  RASTRUM_HD Fragment operator()(std::size_t k) const {
    const std::size_t b = plan.segment_of(k);
    const int j = static_cast<int>(k - plan.first(b));
    return fragment_at(pieces, keys, blocks[b], parallel::select_bit<64>(blocks[b].mask, j));
  }
};

template <class At>
struct WriteFragment {
  At at;
  std::size_t first;
  std::uint32_t* element;
  std::uint64_t* key;
  RASTRUM_HD void operator()(std::size_t k) const {
    const Fragment f = at(first + k);
    element[k] = f.element;
    key[k] = f.key;
  }
};

/// Calls f(at, begin, end) for consecutive parts of at most `most` fragments of a turn. The functor
/// `at` makes fragment k.
template <class Exec, class F>
void each_part_of_fragments(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
                            std::span<const Block> blocks, std::size_t most, F&& f) {
  const auto places = parallel::make_expansion(frame.exec, blocks, FragmentCount{});
  const FragmentAt<decltype(places.view())> at{places.view(), blocks, pieces.data(),
                                               frame.surface.keys};
  each_turn(places.size(), most, [&](std::size_t begin, std::size_t end) { f(at, begin, end); });
}

/// Writes the fragments to memory part by part and calls f(elements, keys). f may change both
/// buffers and may use `fragment_bytes` for each fragment.
template <class Exec, class F>
void each_written_part(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
                       std::span<const Block> blocks, std::uint64_t fragment_bytes, F&& f) {
  each_part_of_fragments(
      frame, pieces, blocks, frame.most_fragments(fragment_bytes),
      [&](const auto& at, std::size_t begin, std::size_t end) {
        auto element = parallel::make_buffer<std::uint32_t>(frame.exec, end - begin);
        auto key = parallel::make_buffer<std::uint64_t>(frame.exec, end - begin);
        parallel::for_each_index(frame.exec, end - begin,
                                 WriteFragment<std::remove_cvref_t<decltype(at)>>{
                                     at, begin, element.data(), key.data()});
        f(element, key);
      });
}

/// Sorts the elements of a part's fragments, so that a pixel's fragments are a segment. Returns
/// which fragment each one was. All sorts of the family use these types, because CUB's sort takes
/// most of nvcc's time.
template <class Exec, class Elements>
[[nodiscard]] auto sort_by_pixel(FamilyFrame<Exec>& frame, Elements& element) {
  auto which = parallel::make_buffer<std::uint32_t>(frame.exec, element.size());
  parallel::tabulate(frame.exec, which, parallel::range_detail::IndexItself<std::uint32_t>{});
  parallel::sort_by_key(frame.exec, element, which,
                        static_cast<int>(std::bit_width(frame.pixel_count() - 1)));
  return which;
}

}  // namespace rastrum::family
