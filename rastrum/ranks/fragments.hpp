// SPDX-License-Identifier: BSD-3-Clause
// The data that a rank has drawn and hands on: the keys of its opaque surfaces, and its translucent
// fragments on their way to the owners of their pixels. docs/ranks_traffic.md lists what is sent.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <rastrum/parallel/scratch.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/part_list.hpp>
#include <rastrum/ranks/sparse_blocks.hpp>
#include <rastrum/raster/context/fragment_sink.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::ranks {

/// A fragment between ranks is a word (depth above the inverted place of its part in the list of
/// all parts, as in opaque words) and the premultiplied colour in float32.
inline constexpr std::size_t kFragmentBytes = 24;

/// Takes the keys of opaque surfaces, and no translucent fragments unless a derived one does.
class KeySink : public raster::FragmentSink {
 public:
  /// `keys`: null if nobody needs them.
  KeySink(raster::Translucent f, const BlockGrid& grid, SparseBlocks* keys)
      : FragmentSink(f), grid_(grid), keys_(keys) {}
  using FragmentSink::take;
  void take(const raster::OpaqueKeys& surfaces) override {
    if (keys_ == nullptr) return;
    keys_->set(grid_.at(surfaces.bx, surfaces.by), surfaces.keys, surfaces.mask);
  }

 protected:
  const BlockGrid& grid_;

 private:
  SparseBlocks* keys_;
};

/// Where a rank has fragments that its own opaque surfaces do not hide, and how many.
class LayerSurvey final : public KeySink {
 public:
  LayerSurvey(const BlockGrid& grid, SparseBlocks* keys)
      : KeySink(raster::Translucent::keys_to_sink, grid, keys),
        masks_(grid.count()),
        counts_(grid.count()) {}
  using KeySink::take;
  void take(const raster::FragmentPlane& plane) override;
  /// By block, in rows.
  [[nodiscard]] std::span<const std::uint64_t> masks() const { return masks_; }
  [[nodiscard]] std::uint64_t count(std::size_t block) const { return counts_[block]; }

 private:
  std::vector<std::uint64_t> masks_, counts_;
};

/// Which places, in the list of all parts, the keys of a pass have.
struct PlacesOfKeys {
  const OwnParts& own;
  std::span<const std::size_t> places;  ///< of own parts
  std::uint64_t from_pass;  ///< what is added to an id of the pass for one of the rank's
};

/// At some pixels, by rising block: the greatest opaque words of all ranks, 0 for nothing.
struct Hides {
  std::span<const BlockMask> where;
  std::span<const std::size_t> at;  ///< where the words of each begin
  std::span<const std::uint64_t> words;
};

/// A header; the bytes of planes that lie together follow it.
struct FragmentRun {
  std::uint64_t next;  ///< where the block's next one lies (FragmentRun*); 0: it is the last
  std::uint64_t bytes;

  [[nodiscard]] static FragmentRun* at(std::uint64_t place) {
    return reinterpret_cast<FragmentRun*>(static_cast<std::uintptr_t>(place));
  }
  [[nodiscard]] std::uint64_t place() const { return reinterpret_cast<std::uintptr_t>(this); }
  [[nodiscard]] std::byte* planes() { return reinterpret_cast<std::byte*>(this + 1); }
};

/// Returns memory for fragments, of the size asked for, or null if not enough is left. All threads
/// call it.
using FragmentRoom = std::function<std::byte*(std::size_t bytes)>;

/// Shaded fragments of a part of the picture, in the order in which one renderer blends this
/// rank's. They are stored as bytes, in planes of at most one fragment a pixel. A plane is a mask,
/// a number for its sample and whether its fragments are opaque, then the words of its pixels, then
/// their colours.
class FragmentBytes final : public KeySink {
 public:
  /// `most_bytes`: fragments beyond this size are left out. `room`: gives the memory for fragments
  /// until it returns null.
  FragmentBytes(const BlockGrid& grid, raster::Rect band, PlacesOfKeys places,
                SparseBlocks* keys = nullptr, std::uint64_t most_bytes = ~std::uint64_t{0},
                FragmentRoom room = {});
  using KeySink::take;
  void take(const raster::FragmentPlane& plane) override;
  /// Whether some were left out.
  [[nodiscard]] bool is_full() const { return bytes_.load() > most_bytes_; }
  /// Whether some did not fit into `room`.
  [[nodiscard]] bool has_memory_of_its_own() const { return own_memory_.load(); }
  /// Calls f(block, first run) for each block with fragments, in rising order.
  template <class F>
  void each_list(const F& f) const {
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      if (blocks_[b].first != nullptr) f(number_of(b), blocks_[b].first);
  }
  /// Calls f(BlockMask) for each block with fragments; the mask has the pixels with some.
  void each_block(const std::function<void(BlockMask)>& f) const;
  /// At the pixels where each of `samples` samples has an opaque surface, the least of their words:
  /// a fragment behind that is seen at no sample.
  [[nodiscard]] SparseBlocks hiding(const BlockGrid& grid, int samples) const;
  /// Removes the fragments that are hidden. Returns how many are left.
  std::uint64_t leave_out(const Hides& hides);
  /// Packs each block for its owner: its number, how many bytes follow, and these.
  void pack(Mail& mail) const;
  /// Call when memory from `room` has moved: the `bytes` that were at `from` are at `to` now.
  void has_moved(std::uint64_t from, std::uint64_t bytes, std::uint64_t to);

 private:
  struct Block {
    FragmentRun *first = nullptr, *last = nullptr;
    std::uint64_t fragments = 0;
  };
  /// The memory of one thread. Full chunks stay where they are.
  struct Memory {
    std::vector<std::unique_ptr<std::byte[]>> chunks;
    std::size_t taken = 0;  ///< chunks, of `room` too
    std::byte *at = nullptr, *end = nullptr;
  };
  void begin_chunk(Memory& own, std::size_t size);
  [[nodiscard]] std::byte* room_in(Block& block, std::size_t size);
  template <class F>
  static void each_run(const Block& block, const F& f);
  template <class F>
  static void each_plane(const Block& block, const F& f);
  [[nodiscard]] std::uint32_t number_of(std::size_t own) const;

  raster::Rect band_;
  PlacesOfKeys places_;
  std::uint64_t most_bytes_;
  FragmentRoom room_;
  std::atomic<std::uint64_t> bytes_ = 0;
  std::atomic<bool> own_memory_ = false;
  std::vector<Block> blocks_;
  parallel::ScratchPool<Memory> memory_;
};

/// A plane of FragmentBytes as it lies among bytes.
struct PackedPlane {
  std::uint64_t mask;
  int sample;
  bool opaque;
  const std::byte* words;   ///< one a pixel of the mask
  const std::byte* colors;  ///< as many Vec4

  [[nodiscard]] std::uint64_t word(std::size_t k) const {
    std::uint64_t word = 0;
    std::memcpy(&word, words + k * sizeof(word), sizeof(word));
    return word;
  }
};
[[nodiscard]] PackedPlane take_plane(Reader& planes);

/// The rank that blends the layers of a block. Blocks are spread as if at random, so that ranks
/// have equal work wherever the picture is full.
[[nodiscard]] std::size_t layer_owner(std::uint32_t block, std::size_t ranks);

}  // namespace rastrum::ranks
