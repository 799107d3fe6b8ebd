// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/bin/groups.hpp>

#include <atomic>
#include <cstdlib>
#include <limits>

#include <rastrum/raster/draws/numbering.hpp>
#include <rastrum/raster/rules/coverage.hpp>

namespace rastrum::raster {
namespace {

/// Triangles of a group: many, since each group costs some work for every bin. Few where memory is
/// planned, and fewer where a thread would get too few groups …
constexpr std::uint64_t kMostGroup = 32768, kPlannedGroup = 4096, kLeastGroup = 512,
                        kGroupsOfThread = 4;
/// … but enough that the groups' bin tables together stay small.
constexpr std::uint64_t kMaxBinTables = std::uint64_t{1} << 19;

void bin_deferred(const Piece& piece, const BinTable& lists, Collected<DeferredInBin>& out) {
  const Rect view = lists.bins.view;
  const Rect box = sample_bounds(piece.x, piece.y, view);
  if (box.empty()) return;
  const int bx0 = box.x0 / kBinSize, by0 = box.y0 / kBinSize;
  const int bx1 = (box.x1 - 1) / kBinSize, by1 = (box.y1 - 1) / kBinSize;
  const auto touched =
      static_cast<std::size_t>(bx1 - bx0 + 1) * static_cast<std::size_t>(by1 - by0 + 1);
  DeferredInBin* next = out.room(touched);
  for (int by = by0; by <= by1; ++by)
    for (int bx = bx0; bx <= bx1; ++bx) {
      const auto in_bin = [](int v, int bin) {
        return static_cast<std::uint8_t>(std::clamp(v - bin * kBinSize, 0, kBinSize));
      };
      const int row = by - view.y0 / kBinSize, column = bx - view.x0 / kBinSize;
      *next++ = {piece.low,
                 piece.z0,
                 in_bin(box.x0, bx),
                 in_bin(box.y0, by),
                 in_bin(box.x1, bx),
                 in_bin(box.y1, by),
                 static_cast<std::uint32_t>(row * lists.bins.columns() + column)};
    }
  out.added(touched);
}

Rect bounds_of(const Piece& piece, const BinTable& lists) {
  const Rect view = lists.bins.view;
  return (piece.flags & kAllSamples) != 0 ? sample_bounds(piece.x, piece.y, view, lists.reach)
                                          : piece_bounds(piece, view);
}

/// Adds the pairs of a piece with the bins that it may touch.
void bin_piece(const Piece& piece, std::uint32_t index, const BinTable& lists,
               const BinNumbers& numbers, Collected<PieceInBin>& pairs) {
  const Rect view = numbers.view;
  const int columns = (view.x1 - view.x0 + kBinSize - 1) / kBinSize;
  const Rect box = bounds_of(piece, lists);
  if (box.empty()) return;
  const int bx0 = box.x0 / kBinSize, by0 = box.y0 / kBinSize;
  const int bx1 = (box.x1 - 1) / kBinSize, by1 = (box.y1 - 1) / kBinSize;
  const std::size_t touched =
      static_cast<std::size_t>(bx1 - bx0 + 1) * static_cast<std::size_t>(by1 - by0 + 1);
  PieceInBin* const out = pairs.room(touched);
  std::size_t n = 0;
  // A box in two bins has a vertex in each, unless the view cuts it: not worth the test.
  const bool asks = touched > 2 && !is_quadric(piece);
  Edges edges = asks ? edges_of(piece) : Edges{};
  if ((piece.flags & kAllSamples) != 0)
    for (int i = 0; i < edges.count; ++i) {  // at its best sample
      Edge& e = edges.edge[i];
      const std::int64_t steep = std::int64_t{std::abs(e.a)} + std::abs(e.b);
      e.base += (steep * lists.reach >> kSubpixelBits) + 1;
    }
  for (int by = by0; by <= by1; ++by)
    for (int bx = bx0; bx <= bx1; ++bx) {
      const int x0 = bx * kBinSize, y0 = by * kBinSize;
      if (asks && !may_touch(edges, {x0, y0, x0 + kBinSize, y0 + kBinSize})) continue;
      const int row = by - view.y0 / kBinSize, column = bx - view.x0 / kBinSize;
      const auto bin = static_cast<std::uint32_t>(row * columns + column);
      out[n++] = {numbers.of(piece, bin), index};
    }
  pairs.added(n);
}

/// Adds the pairs of pieces [first, …) until all are there, or `most` are reached after a piece.
/// Returns the first piece left.
std::uint32_t bin_pieces(const Kernels& kernel, std::span<const Piece> pieces, std::uint32_t first,
                         std::size_t most, const BinTable& lists, Collected<PieceInBin>& pairs,
                         Collected<DeferredInBin>& deferred) {
  const BinNumbers numbers = lists.numbers();
  const auto count = [&] { return pairs.entries().size() + deferred.entries().size(); };
  std::uint32_t bin[64];
  std::uint32_t index = first;
  while (index < pieces.size() && count() < most) {
    auto n = static_cast<std::uint32_t>(
        std::min({std::size(bin), pieces.size() - index, most - count()}));
    kernel.bins(pieces.data() + index, n, numbers, bin);
    for (std::uint32_t i = 0; i < n;) {
      PieceInBin* const out = pairs.room(n - i);
      std::uint32_t k = 0;
      for (; i < n && bin[i] != kManyBins; ++i) out[k++] = {bin[i], index + i};
      pairs.added(k);
      if (i < n) {
        const Piece& piece = pieces[index + i];
        if (is_deferred(piece))
          bin_deferred(piece, lists, deferred);
        else
          bin_piece(piece, index + i, lists, numbers, pairs);
        ++i;
      }
      // A piece in many bins may leave no room for those after it.
      if (i < n && count() + (n - i) > most) {
        n = i;
        break;
      }
    }
    index += n;
  }
  return index;
}

/// The most pairs of a group at once. Each is in the group, and before that is collected by a
/// thread, in memory that has doubled.
std::size_t most_pairs(const FrameContext& frame, const BinTable& lists, std::size_t groups) {
  const std::size_t entry_bytes = lists.defers ? sizeof(DeferredInBin) : sizeof(PieceInBin);
  if (frame.expansion_bytes == 0) return std::numeric_limits<std::size_t>::max();
  const auto threads = static_cast<std::uint64_t>(frame.concurrency());
  // There may be as many runs.
  const std::size_t collected_bytes = entry_bytes + sizeof(BinRun);
  return frame.expansion_bytes / (groups * entry_bytes + 3 * threads * collected_bytes);
}

void keep_in_view(Pieces& pieces, const BinTable& lists) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < pieces.count; ++i)
    if (!bounds_of(pieces.data[i], lists).empty()) pieces.data[kept++] = pieces.data[i];
  pieces.count = kept;
}

}  // namespace

struct TriangleGroups::Filler final : MicroSink {
  explicit Filler(MemoryAccount& memory)
      : pieces(memory), pairs(memory), micro(memory), small(memory), deferred(memory) {}
  Pieces pieces;  ///< of a group, before those outside of the view are dropped
  Collected<PieceInBin> pairs;
  Collected<BinFragment> micro;
  Collected<BinTriangle> small;
  bool takes_small = false;
  Collected<DeferredInBin> deferred;
  bool whole = true;        ///< the view is the image, whose bins setup numbers; else:
  int image_columns = 0;    ///< bins in a row of it
  int column = 0, row = 0;  ///< the view's first bin
  int columns = 0, rows = 0;

  void restart(const FrameContext& frame, const BinTable& lists) {
    const TileGrid& bins = lists.bins;
    pairs.restart(lists.count());
    micro.restart(bins.count());
    takes_small = lists.small;
    if (takes_small) small.restart(lists.count());
    deferred.restart(lists.defers ? bins.count() : 0);
    const TileGrid image{{0, 0, frame.request.width, frame.request.height}, kBinSize};
    whole = bins.count() == image.count();
    image_columns = image.columns();
    column = bins.view.x0 / kBinSize;
    row = bins.view.y0 / kBinSize;
    columns = bins.columns();
    rows = bins.rows();
  }

  BinTriangle* small_room() override {
    return takes_small ? small.room(std::size_t{4} * kSetupBatch) : nullptr;
  }
  void small_written(std::size_t n) override { small.added(n); }
  BinFragment* room(std::size_t n) override { return micro.room(n); }
  void written(std::size_t n) override {
    if (whole) {
      micro.added(n);
      return;
    }
    BinFragment* const all = micro.room(0);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto bin = static_cast<int>(all[i].bin);
      const int x = bin % image_columns - column, y = bin / image_columns - row;
      all[kept] = all[i];
      all[kept].bin = static_cast<std::uint32_t>(y * columns + x);
      kept += x >= 0 && x < columns && y >= 0 && y < rows;
    }
    micro.added(kept);
  }
};

TriangleGroups::TriangleGroups(MemoryAccount& memory)
    : memory_(memory), fillers_([&memory] { return Filler(memory); }) {}
TriangleGroups::~TriangleGroups() = default;

void TriangleGroups::begin_loads(const BinTable& lists) {
  const std::size_t bins = lists.bins.count();
  if (load_count_ < bins) {
    loads_ = std::make_unique<Load[]>(bins);
    load_count_ = bins;
  }
  for (std::size_t b = 0; b < bins; ++b) {
    loads_[b].pieces.store(0, std::memory_order_relaxed);
    loads_[b].fragments.store(0, std::memory_order_relaxed);
  }
}

void TriangleGroups::add_loads(const BinTable& lists, const Filler& filler, bool alone) {
  const std::size_t bins = lists.bins.count();
  const std::span<const std::uint32_t> pieces = filler.pairs.counts(lists.count());
  const std::span<const std::uint32_t> fragments = filler.micro.counts(bins);
  const std::span<const std::uint32_t> deferred = filler.deferred.counts(lists.defers ? bins : 0);
  const std::span<const std::uint32_t> small =
      lists.small ? filler.small.counts(lists.count()) : pieces.first(0);
  const auto add = [alone](std::atomic<std::uint64_t>& to, std::uint64_t n) {
    if (n == 0) return;
    if (alone)  // a locked addition costs as much as ten others
      to.store(to.load(std::memory_order_relaxed) + n, std::memory_order_relaxed);
    else
      to.fetch_add(n, std::memory_order_relaxed);
  };
  for (std::size_t b = 0; b < bins; ++b) {
    add(loads_[b].pieces, std::uint64_t{pieces[b + 1]} +
                              (lists.two ? pieces[lists.later(b) + 1] : 0) +
                              (lists.small ? small[b + 1] + small[lists.later(b) + 1] : 0U) +
                              (lists.defers ? deferred[b + 1] : 0));
    add(loads_[b].fragments, fragments[b + 1]);
  }
}

namespace {

/// The group size for so many triangles of a view.
std::uint64_t group_size_of(const FrameContext& frame, const BinTable& lists,
                            std::uint64_t triangles) {
  const std::uint64_t most_groups =
      std::max<std::uint64_t>(kMaxBinTables / (2 * lists.bins.count()), 1);
  const bool planned = frame.plans_memory();
  const std::uint64_t most = planned ? kPlannedGroup : kMostGroup;
  const auto threads = static_cast<std::uint64_t>(frame.concurrency());
  const std::uint64_t share = triangles / (kGroupsOfThread * threads);
  return std::max(threads == 1 ? most : std::clamp(share, kLeastGroup, most),
                  (triangles + most_groups - 1) / most_groups);
}

}  // namespace

std::optional<std::span<Group>> TriangleGroups::set_up(FrameContext& frame, const BinTable& lists,
                                                       bool micro, std::uint64_t first,
                                                       std::uint64_t last) {
  const std::uint64_t size = group_size_of(frame, lists, last - first);
  const auto count = static_cast<std::size_t>((last - first + size - 1) / size);
  return set_up(frame, lists, micro, count,
                [&](std::size_t g, Pieces& pieces, const SetUpWay& way) {
                  const std::uint64_t begin = first + g * size;
                  return raster::set_up(frame, begin, std::min(begin + size, last), pieces, way);
                });
}

std::optional<std::span<Group>> TriangleGroups::set_up(FrameContext& frame, const BinTable& lists,
                                                       bool micro, std::span<const SetupRun> runs) {
  std::uint64_t triangles = 0;
  for (const SetupRun& run : runs) triangles += run.count;
  const std::uint64_t size = group_size_of(frame, lists, triangles);
  first_run_.clear();
  std::uint64_t in_group = size;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (in_group >= size) {
      first_run_.push_back(i);
      in_group = 0;
    }
    in_group += runs[i].count;
  }
  const std::size_t count = first_run_.size();
  first_run_.push_back(runs.size());
  return set_up(
      frame, lists, micro, count, [&](std::size_t g, Pieces& pieces, const SetUpWay& way) {
        const std::size_t begin = first_run_[g];
        return raster::set_up(frame, runs.subspan(begin, first_run_[g + 1] - begin), pieces, way);
      });
}

template <class Fill>
std::optional<std::span<Group>> TriangleGroups::set_up(FrameContext& frame, const BinTable& lists,
                                                       bool micro, std::size_t group_count,
                                                       const Fill& fill) {
  if (frame.view_bytes != 0) groups_.clear();  // of other views
  const std::size_t bin_count = lists.bins.count(), list_count = lists.count();
  while (groups_.size() < group_count) groups_.emplace_back(memory_);
  const std::size_t most = most_pairs(frame, lists, group_count);
  std::atomic<bool> in_range = true;
  std::atomic<std::uint64_t> pairs = 0, micro_fragments = 0, bytes = 0;
  const bool limited = frame.view_bytes != 0;
  const bool alone = frame.concurrency() == 1;
  begin_loads(lists);
  frame.for_each_index(group_count, [&](std::size_t g) {
    if (limited && bytes.load(std::memory_order_relaxed) > frame.view_bytes) return;
    Group& group = groups_[g];
    Filler& scratch = fillers_.local();
    Pieces& pieces = limited ? scratch.pieces : group.pieces;
    pieces.restart();
    scratch.restart(frame, lists);
    if (!fill(g, pieces,
              {micro ? &scratch : nullptr, lists.numbers(), lists.defers, lists.reach != 0})) {
      in_range = false;
      return;
    }
    if (limited) keep_in_view(pieces, lists);
    group.binned =
        bin_pieces(frame.kernel, pieces.span(), 0, most, lists, scratch.pairs, scratch.deferred);
    const std::size_t n = scratch.pairs.entries().size(), m = scratch.micro.entries().size();
    if (limited) {
      const std::uint64_t own =
          pieces.count * sizeof(Piece) + n * sizeof(PieceInBin) + m * sizeof(BinFragment) +
          (list_count + bin_count) * sizeof(std::uint32_t) + pieces.quadric_bytes();
      if (bytes.fetch_add(own, std::memory_order_relaxed) + own > frame.view_bytes) return;
      group.pieces.data.reserve(pieces.count);
      group.pieces.restart();
      for (const Piece& piece : pieces.span()) group.pieces.add(piece);
      group.pieces.triangles = pieces.triangles;
    }
    group.by_bin.sort(scratch.pairs, list_count);
    group.fragments.sort(scratch.micro, bin_count);
    if (lists.small) group.small.sort(scratch.small, list_count);
    if (lists.defers) group.deferred.sort(scratch.deferred, bin_count);
    add_loads(lists, scratch, alone);
    const std::size_t small = lists.small ? scratch.small.entries().size() : 0;
    pairs.fetch_add(n + small + scratch.deferred.entries().size(), std::memory_order_relaxed);
    micro_fragments.fetch_add(m, std::memory_order_relaxed);
  });
  if (!in_range) check_indices(frame.request.draws, frame.request.names);
  if (limited && bytes > frame.view_bytes) {
    groups_.clear();
    return std::nullopt;
  }
  frame.clips = false;
  for (std::size_t g = 0; g < group_count; ++g) {
    count_triangles(frame, groups_[g].pieces.triangles);
    frame.clips |= groups_[g].pieces.triangles.clipped != 0;
  }
  frame.count("bins", pairs);
  frame.count("micro fragments", micro_fragments);
  return std::span<Group>{groups_.data(), group_count};
}

void TriangleGroups::bin_more(FrameContext& frame, const BinTable& lists, std::span<Group> groups) {
  const std::size_t most = most_pairs(frame, lists, groups.size());
  std::atomic<std::uint64_t> pairs = 0;
  const bool alone = frame.concurrency() == 1;
  begin_loads(lists);
  frame.for_each_index(groups.size(), [&](std::size_t g) {
    Group& group = groups[g];
    Filler& scratch = fillers_.local();
    scratch.restart(frame, lists);
    group.binned = bin_pieces(frame.kernel, group.pieces.span(), group.binned, most, lists,
                              scratch.pairs, scratch.deferred);
    group.by_bin.sort(scratch.pairs, lists.count());
    group.fragments.sort(scratch.micro, lists.bins.count());
    if (lists.small) group.small.sort(scratch.small, lists.count());
    if (lists.defers) group.deferred.sort(scratch.deferred, lists.bins.count());
    add_loads(lists, scratch, alone);
    pairs.fetch_add(scratch.pairs.entries().size() + scratch.deferred.entries().size(),
                    std::memory_order_relaxed);
  });
  frame.count("bins", pairs);
}

}  // namespace rastrum::raster
