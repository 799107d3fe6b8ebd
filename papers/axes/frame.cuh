// SPDX-License-Identifier: BSD-3-Clause
// Shared by the two axes of the papers' rasterizers on a device. As on the host (frame.hpp), a
// coverage enumerates the blocks of pieces and a visibility resolves them, and neither knows the
// other. Between them is an array of blocks in the device's memory, a turn at a time.
//
// Each turn is resolved by itself onto the keys, which only rise. So turns, like bands and batches,
// change no bit, and nothing is enumerated twice. The functors are the host's. The fast rasterizer
// of a device is by-size (raster/cuda/by_size.cuh), which never writes a block.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include <papers/axes/names.hpp>
#include <papers/axes/region.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/cover.cuh>
#include <rastrum/raster/cuda/surface_drawer.cuh>
#include <rastrum/tuning.hpp>

namespace rastrum::family {

/// Bytes of a block of a turn and of its place among the fragments.
inline constexpr std::uint64_t kBlockBytes = sizeof(Block) + sizeof(std::size_t);

struct FragmentCount {
  RASTRUM_HD std::size_t operator()(const Block& b) const {
    return static_cast<std::size_t>(parallel::popcount(b.mask));
  }
};
struct FragmentCountAt {
  std::span<const Block> blocks;
  RASTRUM_HD std::uint64_t operator()(std::size_t i) const {
    return static_cast<std::uint64_t>(parallel::popcount(blocks[i].mask));
  }
};

/// Calls f(block, i) for the covered samples of blocks, one thread a sample.
template <class F>
struct CallWithSample {
  std::span<const Block> blocks;
  F f;
  RASTRUM_HD void operator()(std::size_t k) const {
    const Block& block = blocks[k / 64];
    if ((block.mask >> (k % 64) & 1) != 0) f(block, static_cast<int>(k % 64));
  }
};
/// In any order; neighbouring threads have neighbouring keys.
template <class Exec, class F>
void for_each_sample(Exec& exec, std::span<const Block> blocks, const F& f) {
  parallel::for_each_index(exec, blocks.size() * 64, CallWithSample<F>{blocks, f});
}

struct CountOverdraw {
  SurfaceView keys;
  std::uint32_t* overdraw;
  RASTRUM_HD void operator()(const Block& b, int i) const {
    parallel::atomic_add(overdraw[keys.index(b.bx, b.by) * 64 + static_cast<std::size_t>(i)], 1U);
  }
};

template <class Exec>
class FamilyFrame;

/// Resolves the fragments of a band.
template <class Exec>
class DeviceVisibility {
 public:
  virtual ~DeviceVisibility() = default;
  /// Raises the keys of the frame's surface to those of the covered samples of `blocks`. There are
  /// `fragments` ≥ 1 of them. Masks may be empty; none reaches outside of the view.
  virtual void resolve(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
                       std::span<const Block> blocks, std::uint64_t fragments) = 0;
  /// Called after the last turn of the band.
  virtual void finish(FamilyFrame<Exec>&) {}
};

template <class Exec>
class FamilyFrame {
 public:
  FamilyFrame(Exec& e, const DeviceSurface& s, const Tuning& t, const FragmentColors& c,
              std::uint64_t scratch_bytes)
      : exec(e), surface(s), tuning(t), shading(c), bytes(scratch_bytes) {}

  Exec& exec;
  const DeviceSurface& surface;
  const Tuning& tuning;
  const FragmentColors& shading;
  std::uint64_t bytes;  ///< the most that turns of all kinds may take together; 0: no limit
  DeviceVisibility<Exec>* visibility = nullptr;
  std::uint64_t fragments = 0;
  Counters counters;

  /// How many results of an expansion fit into a turn. A coverage expands twice: to rows, bins or
  /// queue entries, and to blocks. Each expansion has a quarter of the bytes.
  [[nodiscard]] std::size_t most(std::uint64_t result_bytes) const {
    return share(bytes / 4, result_bytes);
  }
  /// How many fragments may be in memory. They have half of the bytes.
  [[nodiscard]] std::size_t most_fragments(std::uint64_t fragment_bytes) const {
    return share(bytes / 2, fragment_bytes);
  }
  [[nodiscard]] std::size_t pixel_count() const { return block_count(surface.view) * 64; }

  void count(std::string_view name, std::uint64_t value) { add_counter(counters, name, value); }

  /// Ends a turn of a coverage: counts fragments and overdraw, and resolves.
  void emit(std::span<const Piece> pieces, std::span<const Block> blocks) {
    const std::uint64_t n = parallel::reduce(
        exec, parallel::Computed(blocks.size(), FragmentCountAt{blocks}), std::uint64_t{0});
    if (n == 0) return;
    fragments += n;
    if (surface.overdraw != nullptr)
      for_each_sample(exec, blocks, CountOverdraw{surface.keys, surface.overdraw});
    visibility->resolve(*this, pieces, blocks, n);
  }

 private:
  [[nodiscard]] std::size_t share(std::uint64_t of_bytes, std::uint64_t each) const {
    // Fragments are numbered in 32 bits.
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (bytes == 0) return kMost;
    // An arena's blocks can be a quarter larger than what was asked for.
    return std::clamp<std::size_t>(static_cast<std::size_t>(of_bytes / each / 5 * 4), 1, kMost);
  }
};

}  // namespace rastrum::family
