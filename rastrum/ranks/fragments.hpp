// SPDX-License-Identifier: BSD-3-Clause
// The data for other ranks: the keys of opaque surfaces, and translucent fragments.
// docs/ranks_traffic.md lists all messages.
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

/// A fragment in a message is a word (depth above the inverted place of its part in the list of all
/// parts, as for opaque surfaces) and the premultiplied colour in float32.
inline constexpr std::size_t kFragmentBytes = 24;

/// Takes the keys of opaque surfaces.
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

/// Finds where a rank has fragments that its own opaque surfaces do not hide, and counts them.
class LayerSurvey final : public KeySink {
 public:
  LayerSurvey(const BlockGrid& grid, SparseBlocks* keys)
      : KeySink(raster::Translucent::keys_to_sink, grid, keys),
        masks_(grid.count()),
        counts_(grid.count()) {}
  using KeySink::take;
  void take(const raster::FragmentPlane& plane) override;
  /// One per block, row by row.
  [[nodiscard]] std::span<const std::uint64_t> masks() const { return masks_; }
  [[nodiscard]] std::uint64_t count(std::size_t block) const { return counts_[block]; }

 private:
  std::vector<std::uint64_t> masks_, counts_;
};

/// Maps the keys of a pass to places in the list of all parts.
struct PlacesOfKeys {
  const OwnParts& own;
  std::span<const std::size_t> places;  ///< of own parts
  std::uint64_t from_pass;              ///< added to an id of the pass, gives the rank's id
};

/// The greatest opaque words of all ranks at some pixels, by rising block; 0 for none.
struct Hides {
  std::span<const BlockMask> where;
  std::span<const std::size_t> at;  ///< where each block's words begin
  std::span<const std::uint64_t> words;
};

/// A header; its planes' bytes follow.
struct FragmentRun {
  std::uint64_t next;  ///< address of the block's next run; 0: the last one
  std::uint64_t bytes;

  [[nodiscard]] static FragmentRun* at(std::uint64_t place) {
    return reinterpret_cast<FragmentRun*>(static_cast<std::uintptr_t>(place));
  }
  [[nodiscard]] std::uint64_t place() const { return reinterpret_cast<std::uintptr_t>(this); }
  [[nodiscard]] std::byte* planes() { return reinterpret_cast<std::byte*>(this + 1); }
};

/// Returns memory of the given size for fragments, or null if too little is left. Thread-safe.
using FragmentRoom = std::function<std::byte*(std::size_t bytes)>;

/// Shaded fragments of a part of the picture, in one renderer's order of blending. They are stored
/// as planes of at most one fragment per pixel: a mask, a number with the sample and an opaque bit,
/// the words, then the colours.
class FragmentBytes final : public KeySink {
 public:
  /// Fragments beyond `most_bytes` are dropped. `room` gives memory until it returns null; then
  /// they take their own.
  FragmentBytes(const BlockGrid& grid, raster::Rect band, PlacesOfKeys places,
                SparseBlocks* keys = nullptr, std::uint64_t most_bytes = ~std::uint64_t{0},
                FragmentRoom room = {});
  using KeySink::take;
  void take(const raster::FragmentPlane& plane) override;
  /// Whether fragments were dropped.
  [[nodiscard]] bool is_full() const { return bytes_.load() > most_bytes_; }
  [[nodiscard]] bool has_memory_of_its_own() const { return own_memory_.load(); }
  /// Calls f(block, first run) for each block with fragments, in rising order.
  template <class F>
  void each_list(const F& f) const {
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      if (blocks_[b].first != nullptr) f(number_of(b), blocks_[b].first);
  }
  /// Calls f(BlockMask) for each block with fragments, masking their pixels.
  void each_block(const std::function<void(BlockMask)>& f) const;
  /// The pixels where all `samples` samples have an opaque surface, with the least of their words:
  /// a fragment behind that is invisible in all samples.
  [[nodiscard]] SparseBlocks hiding(const BlockGrid& grid, int samples) const;
  /// Removes hidden fragments. Returns how many remain.
  std::uint64_t leave_out(const Hides& hides);
  /// Packs each block for its owner: its number, a size in bytes, the bytes.
  void pack(Mail& mail) const;
  /// Call when memory from `room` has moved: `bytes` bytes from `from` to `to`.
  void has_moved(std::uint64_t from, std::uint64_t bytes, std::uint64_t to);

 private:
  struct Block {
    FragmentRun *first = nullptr, *last = nullptr;
    std::uint64_t fragments = 0;
  };
  /// One thread's memory. Full chunks stay in place.
  struct Memory {
    std::vector<std::unique_ptr<std::byte[]>> chunks;
    std::size_t taken = 0;  ///< chunks, including those of `room`
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

/// A plane as FragmentBytes stores it.
struct PackedPlane {
  std::uint64_t mask;
  int sample;
  bool opaque;
  const std::byte* words;   ///< one per pixel of the mask
  const std::byte* colors;  ///< one Vec4 per pixel of the mask

  [[nodiscard]] std::uint64_t word(std::size_t k) const {
    std::uint64_t word = 0;
    std::memcpy(&word, words + k * sizeof(word), sizeof(word));
    return word;
  }
};
[[nodiscard]] PackedPlane take_plane(Reader& planes);

/// The rank that blends a block's layers. Blocks are spread as if at random, to balance the work
/// wherever the picture is full.
[[nodiscard]] std::size_t layer_owner(std::uint32_t block, std::size_t ranks);

}  // namespace rastrum::ranks
