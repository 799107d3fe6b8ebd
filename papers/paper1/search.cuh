// SPDX-License-Identifier: BSD-3-Clause
// search on a device: a first pass over a turn's blocks raises the depths with 32-bit atomics. A
// second pass raises the keys of the fragments that have their pixel's depth (paper 1, section
// 3.2.2). Between turns the depths equal those of the keys, so they are kept.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>

#include <papers/axes/fragments.cuh>

namespace rastrum::family {

/// value = max(value, candidate), from many threads at once.
RASTRUM_HD inline void raise_depth(std::uint32_t& value, std::uint32_t candidate) noexcept {
#if defined(__CUDA_ARCH__)
  if (*static_cast<const volatile std::uint32_t*>(&value) < candidate) atomicMax(&value, candidate);
#else
  const std::atomic_ref<std::uint32_t> shared(value);
  std::uint32_t now = shared.load(std::memory_order_relaxed);
  while (now < candidate &&
         !shared.compare_exchange_weak(now, candidate, std::memory_order_relaxed)) {
  }
#endif
}

[[nodiscard]] RASTRUM_HD inline std::uint32_t depth_bits(std::uint64_t key) {
  return static_cast<std::uint32_t>(key >> kIdBits);
}

/// Is 0 both for a surface at depth 0 and for no surface. The second pass raises whole keys and so
/// tells them apart.
struct DepthOfKey {
  const std::uint64_t* keys;
  RASTRUM_HD std::uint32_t operator()(std::size_t i) const { return depth_bits(keys[i]); }
};
struct RaiseDepth {
  const Piece* pieces;
  SurfaceView keys;
  std::uint32_t* depth;
  RASTRUM_HD void operator()(const Block& b, int i) const {
    const Fragment f = fragment_at(pieces, keys, b, i);
    raise_depth(depth[f.element], depth_bits(f.key));
  }
};
struct RaiseKeyOfDepth {
  const Piece* pieces;
  SurfaceView keys;
  const std::uint32_t* depth;
  std::uint64_t* matches;
  RASTRUM_HD void operator()(const Block& b, int i) const {
    const Fragment f = fragment_at(pieces, keys, b, i);
    if (depth[f.element] != depth_bits(f.key)) return;
    parallel::atomic_maximum(keys.keys[f.element], f.key);
    parallel::add_to_sum(*matches, 1);
  }
};

/// Work O(fragments), twice; 4 bytes a pixel. Counters: "fragments compared" (second pass) and
/// "depth matches" among them. Both grow with the number of turns.
template <class Exec>
class SearchOnDevice final : public DeviceVisibility<Exec> {
 public:
  explicit SearchOnDevice(FamilyFrame<Exec>& frame)
      : depth_(parallel::make_buffer<std::uint32_t>(frame.exec, frame.pixel_count())),
        matches_(parallel::make_buffer<std::uint64_t>(frame.exec, 1)) {
    parallel::tabulate(frame.exec, depth_, DepthOfKey{frame.surface.keys.keys});
    parallel::tabulate(frame.exec, matches_, parallel::range_detail::SameValue<std::uint64_t>{0});
  }
  void resolve(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
               std::span<const Block> blocks, std::uint64_t fragments) override {
    const SurfaceView& keys = frame.surface.keys;
    for_each_sample(frame.exec, blocks, RaiseDepth{pieces.data(), keys, depth_.data()});
    for_each_sample(frame.exec, blocks,
                    RaiseKeyOfDepth{pieces.data(), keys, depth_.data(), matches_.data()});
    frame.count("fragments compared", fragments);
  }
  void finish(FamilyFrame<Exec>& frame) override {
    frame.count("depth matches", parallel::to_host(frame.exec, matches_)[0]);
  }

 private:
  decltype(parallel::make_buffer<std::uint32_t>(std::declval<Exec&>(), 0)) depth_;
  decltype(parallel::make_buffer<std::uint64_t>(std::declval<Exec&>(), 0)) matches_;
};

}  // namespace rastrum::family
