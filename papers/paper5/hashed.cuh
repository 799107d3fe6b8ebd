// SPDX-License-Identifier: BSD-3-Clause
// hashed on a device: compare-and-swap takes the slots of a table from pixels to keys, and an
// atomic maximum raises the keys. Then the entries raise the surface (paper 5 names this as future
// work in section 6). The slots are the host's (hash_slots.hpp). The table is sized by the counted
// fragments of its part and by the pixels, so it is never full.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include <papers/axes/fragments.cuh>
#include <papers/paper5/hash_slots.hpp>

namespace rastrum::family {

/// Takes an empty slot for a pixel, from many threads at once. Returns the previous content.
RASTRUM_HD inline std::uint32_t take_slot(std::uint32_t& slot, std::uint32_t pixel) noexcept {
#if defined(__CUDA_ARCH__)
  return atomicCAS(&slot, kNoPixel, pixel);
#else
  std::uint32_t held = kNoPixel;
  std::atomic_ref<std::uint32_t>(slot).compare_exchange_strong(held, pixel,
                                                               std::memory_order_relaxed);
  return held;
#endif
}

template <class At>
struct Insert {
  At at;
  std::size_t first;
  HashSlots slots;
  std::uint32_t* pixel;
  std::uint64_t* key;
  std::uint64_t* probes;
  RASTRUM_HD void operator()(std::size_t k) const {
    const Fragment f = at(first + k);
    std::uint64_t slot = slots.home(f.element / 64) + f.element % 64;
    for (std::uint64_t n = 1;; ++n, slot = slots.next(slot)) {
      const std::uint32_t held = take_slot(pixel[slot], f.element);
      if (held == kNoPixel) parallel::add_to_sum(*probes, n);
      if (held == kNoPixel || held == f.element) break;
    }
    parallel::atomic_maximum(key[slot], f.key);
  }
};

/// No other entry has this pixel.
struct RaiseToEntry {
  const std::uint32_t* pixel;
  const std::uint64_t* key;
  std::uint64_t* keys;
  RASTRUM_HD std::uint32_t operator()(std::size_t slot) const {
    if (pixel[slot] == kNoPixel) return 0;
    std::uint64_t& held = keys[pixel[slot]];
    if (held < key[slot]) held = key[slot];
    return 1;
  }
};

/// Work O(fragments · log + slots) expected. Counters as on the host: "fragments hashed", "probes",
/// "table slots", "table entries".
template <class Exec>
class HashedOnDevice final : public DeviceVisibility<Exec> {
 public:
  explicit HashedOnDevice(FamilyFrame<Exec>&) {}
  void resolve(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
               std::span<const Block> blocks, std::uint64_t fragments) override {
    using parallel::range_detail::SameValue;
    Exec& exec = frame.exec;
    // A slot and its flag for taken, at the table's load.
    constexpr std::uint64_t kEntryBytes = (HashSlots::kBytes + sizeof(std::uint32_t)) *
                                              HashSlots::kLoadDenominator /
                                              HashSlots::kLoadNumerator +
                                          1;
    std::size_t most = frame.most_fragments(kEntryBytes);
    // If all pixels have room, fragments are not cut into parts.
    if (most >= frame.pixel_count()) most = static_cast<std::size_t>(fragments);
    auto probes = parallel::make_buffer<std::uint64_t>(exec, 1);
    parallel::tabulate(exec, probes, SameValue<std::uint64_t>{0});
    each_part_of_fragments(
        frame, pieces, blocks, most, [&](const auto& at, std::size_t begin, std::size_t end) {
          const HashSlots slots = HashSlots::of(std::min(end - begin, frame.pixel_count()));
          const auto n = static_cast<std::size_t>(slots.count);
          auto pixel = parallel::make_buffer<std::uint32_t>(exec, n);
          auto key = parallel::make_buffer<std::uint64_t>(exec, n);
          parallel::tabulate(exec, pixel, SameValue<std::uint32_t>{kNoPixel});
          parallel::tabulate(exec, key, SameValue<std::uint64_t>{0});
          parallel::for_each_index(exec, end - begin,
                                   Insert<std::remove_cvref_t<decltype(at)>>{
                                       at, begin, slots, pixel.data(), key.data(), probes.data()});
          auto taken = parallel::make_buffer<std::uint32_t>(exec, n);
          parallel::tabulate(exec, taken,
                             RaiseToEntry{pixel.data(), key.data(), frame.surface.keys.keys});
          frame.count("table slots", slots.count);
          frame.count("table entries", parallel::reduce(exec, taken, std::uint64_t{0}));
        });
    frame.count("fragments hashed", fragments);
    frame.count("probes", parallel::to_host(exec, probes)[0]);
  }
};

}  // namespace rastrum::family
