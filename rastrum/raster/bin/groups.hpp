// SPDX-License-Identifier: BSD-3-Clause
// Setup and binning of the fast path: sort-middle (Molnar et al., 1994; paper 1, section 3.3), for
// a CPU. Triangles are set up in groups whose pieces stay in a core's cache. Each group sorts its
// (bin, piece) pairs by bin; a bin's owner walks the groups.
//
// Deviations from the paper. The sort is a counting sort in each group: no global sort, and one
// barrier. Bins are 64² px of 8² blocks. Micro triangles become fragments in setup, where the
// caller takes them (docs/decisions/0104).
#pragma once

#include <algorithm>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/bin/collected.hpp>
#include <rastrum/raster/bin/tile_grid.hpp>
#include <rastrum/raster/context/frame_context.hpp>
#include <rastrum/raster/cover/windows.hpp>
#include <rastrum/raster/setup/set_up.hpp>

namespace rastrum::raster {

/// The lists of a view: one a bin, or a second one for pieces that face away or may drop fragments,
/// drawn after the rest. In closed surfaces half of the pieces face away and nearly all of those
/// are hidden; hierarchical Z then drops them before it covers them. A piece that may drop
/// fragments hides nothing before its test. The order changes no pixel.
struct BinTable {
  TileGrid bins;
  bool two = false;
  /// Setup may make deferred pieces (bin/bin_quadrics.hpp).
  bool defers = false;
  /// Triangles make one piece for all samples of the pixels (kAllSamples), which lie at most so far
  /// from the centres, n.8. 0: no such pieces.
  int reach = 0;
  /// Setup writes small triangles straight to their bins, for a sink that raises rows.
  bool small = false;

  [[nodiscard]] std::size_t count() const { return bins.count() * (two ? 2 : 1); }
  /// With two lists, the later one of bin `b`.
  [[nodiscard]] std::size_t later(std::size_t b) const { return b + bins.count(); }
  [[nodiscard]] BinNumbers numbers() const {
    return {bins.view, two ? static_cast<std::uint32_t>(bins.count()) : 0, reach};
  }
};

struct Group {
  explicit Group(MemoryAccount& memory)
      : pieces(memory), by_bin(memory), fragments(memory), small(memory), deferred(memory) {}

  Pieces pieces;
  std::uint32_t binned = 0;  ///< pieces whose pairs are or were in by_bin or deferred
  BinLists<PieceInBin> by_bin;
  BinLists<BinFragment> fragments;
  BinLists<BinTriangle> small;       ///< if lists ask for them; numbered as by_bin
  BinLists<DeferredInBin> deferred;  ///< if lists defer

  [[nodiscard]] bool is_empty(const BinTable& lists, std::size_t bin) const {
    return by_bin.bin(bin).empty() && fragments.bin(bin).empty() &&
           (!lists.two || by_bin.bin(lists.later(bin)).empty()) &&
           (!lists.small || (small.bin(bin).empty() && small.bin(lists.later(bin)).empty())) &&
           (!lists.defers || deferred.bin(bin).empty());
  }
};

/// How much all groups together have in a bin.
struct BinLoad {
  std::uint64_t pieces = 0, fragments = 0;
};

/// Sets up and bins the triangles of a view. Keeps its memory. Work O(triangles + (bin, piece)
/// pairs). Memory: 48 bytes a drawn triangle and 8 a pair; a small one 32 a bin; 16 a fragment of a
/// micro triangle.
class TriangleGroups {
 public:
  explicit TriangleGroups(MemoryAccount& memory);
  TriangleGroups(TriangleGroups&&) = delete;
  ~TriangleGroups();

  /// Fills groups with the pieces of triangles [first, last), with fragments of micro triangles if
  /// `micro`, and with pairs as far as FrameContext::expansion_bytes allows; the rest is for
  /// bin_more. Returns nothing if they take more than FrameContext::view_bytes. Counts "bins"
  /// (pairs) and "micro fragments", and sets FrameContext::clips. Throws Error{invalid_argument}
  /// naming an index that is out of range.
  [[nodiscard]] std::optional<std::span<Group>> set_up(FrameContext& frame, const BinTable& lists,
                                                       bool micro, std::uint64_t first,
                                                       std::uint64_t last);
  /// The same for runs, each whole in one group.
  [[nodiscard]] std::optional<std::span<Group>> set_up(FrameContext& frame, const BinTable& lists,
                                                       bool micro, std::span<const SetupRun> runs);
  /// Replaces pairs and fragments by the next pairs.
  void bin_more(FrameContext& frame, const BinTable& lists, std::span<Group> groups);
  /// How much the last set_up or bin_more put into a bin.
  [[nodiscard]] BinLoad load(std::size_t bin) const {
    return {loads_[bin].pieces.load(std::memory_order_relaxed),
            loads_[bin].fragments.load(std::memory_order_relaxed)};
  }
  [[nodiscard]] static bool are_binned(std::span<const Group> groups) {
    return std::ranges::all_of(groups, [](const Group& g) { return g.binned == g.pieces.count; });
  }

 private:
  struct Filler;
  /// All threads that fill groups add to it.
  struct Load {
    std::atomic<std::uint64_t> pieces, fragments;
  };
  void begin_loads(const BinTable& lists);
  void add_loads(const BinTable& lists, const Filler& filler, bool alone);
  template <class Fill>
  std::optional<std::span<Group>> set_up(FrameContext& frame, const BinTable& lists, bool micro,
                                         std::size_t group_count, const Fill& fill);

  MemoryAccount& memory_;
  std::vector<Group> groups_;
  std::unique_ptr<Load[]> loads_;
  std::size_t load_count_ = 0;
  std::vector<std::size_t> first_run_;  ///< of each group, and one past the last
  parallel::ScratchPool<Filler> fillers_;
};

/// With fewer pieces in the later list, testing what hides them does not pay.
inline constexpr std::size_t kWorthALook = 16;

template <class S>
concept BinSink = requires(S& sink, const Piece* pieces, std::size_t n, Rect bin,
                           std::span<const BinFragment> fragments) {
  sink.use(pieces);                                   // pieces of the blocks that follow
  { sink.room() } -> std::same_as<std::span<Block>>;  // room for kBlocksPerBin blocks or more
  sink.written(n);                                    // so many were filled
  { sink.bounds() } -> std::same_as<DepthBounds*>;    // what hides pieces, or null
  sink.find_bounds();                                 // updates the bounds
  sink.fragments(bin, fragments);                     // finished keys
  sink.flush();                                       // hands on the collected blocks
};
/// A sink whose room that function may fill with windows; null: with blocks.
template <class S>
concept WindowSink = BinSink<S> && requires(S& sink) {
  { sink.windows() } -> std::same_as<CoverWindows>;
};
/// A sink with rows for small triangles (null: not now), which draws lists of them.
template <class S>
concept RowSink = BinSink<S> && requires(S& sink, Rect rect, std::span<const BinTriangle> some) {
  { sink.rows() } -> std::same_as<RowKeys*>;
  sink.small(rect, rect, some);  // the whole bin, and the part of it that is drawn
};

template <BinSink Sink>
void emit_fragments(std::span<const BinFragment> fragments, Rect bin, Rect rect, Sink& sink) {
  if (fragments.empty()) return;
  if (rect.x0 == bin.x0 && rect.y0 == bin.y0 && rect.x1 == bin.x1 && rect.y1 == bin.y1)
    return sink.fragments(bin, fragments);
  BinFragment inside[256];
  std::size_t n = 0;
  for (const BinFragment& f : fragments) {
    const int x = bin.x0 + column_in_bin(f), y = bin.y0 + row_in_bin(f);
    if (x < rect.x0 || x >= rect.x1 || y < rect.y0 || y >= rect.y1) continue;
    inside[n++] = f;
    if (n == std::size(inside)) sink.fragments(bin, {inside, std::exchange(n, 0)});
  }
  if (n != 0) sink.fragments(bin, {inside, n});
}

template <BinSink Sink>
void enumerate_pieces(const FrameContext& frame, const Group& group, std::size_t list_number,
                      Rect rect, Sink& sink) {
  const std::span<const PieceInBin> list = group.by_bin.bin(list_number);
  if (list.empty()) return;
  const PieceList pieces{group.pieces.data.data(), list.data(), list.size()};
  sink.use(pieces.pieces);
  for (std::size_t cursor = 0; cursor < pieces.count;) {
    const std::span<Block> room = sink.room();
    if constexpr (WindowSink<Sink>)
      if (const CoverWindows windows = sink.windows(); windows != nullptr) {
        sink.written(windows(pieces, cursor, rect, room.data(), room.size(), sink.bounds()));
        continue;
      }
    RowKeys* rows = nullptr;
    if constexpr (RowSink<Sink>) rows = sink.rows();
    sink.written(
        frame.kernel.cover(pieces, cursor, rect, room.data(), room.size(), sink.bounds(), rows));
    // Draws these first, so that the rest omits pieces that they hide.
    if (rows != nullptr && cursor < pieces.count) sink.flush();
  }
  // Each group numbers its pieces from 0.
  sink.flush();
}

/// Enumerates what groups have in a bin's lists, or in its part `rect`.
template <BinSink Sink>
void enumerate_bin(const FrameContext& frame, const BinTable& lists, std::span<const Group> groups,
                   std::size_t bin, Rect rect, Sink& sink) {
  const Rect whole = lists.bins.rect(bin);
  // A list of fragments is a few cache lines, written long ago and too short for hardware
  // prefetching.
  constexpr std::size_t kListsAhead = 4, kMostBytes = 1024, kLineBytes = 64;
  std::size_t later = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Group& group = groups[g];
    if (g + kListsAhead < groups.size()) {
      const auto next = std::as_bytes(groups[g + kListsAhead].fragments.bin(bin));
      for (std::size_t i = 0; i < std::min(next.size(), kMostBytes); i += kLineBytes)
        __builtin_prefetch(next.data() + i);
    }
    emit_fragments(group.fragments.bin(bin), whole, rect, sink);
    if constexpr (RowSink<Sink>)
      if (lists.small) {
        sink.small(whole, rect, group.small.bin(bin));
        later += group.small.bin(lists.later(bin)).size();
      }
    enumerate_pieces(frame, group, bin, rect, sink);
    if (lists.two) later += group.by_bin.bin(lists.later(bin)).size();
  }
  if (later == 0) return;
  if (later >= kWorthALook) sink.find_bounds();
  for (const Group& group : groups) {
    if constexpr (RowSink<Sink>)
      if (lists.small) sink.small(whole, rect, group.small.bin(lists.later(bin)));
    enumerate_pieces(frame, group, lists.later(bin), rect, sink);
  }
}

}  // namespace rastrum::raster
