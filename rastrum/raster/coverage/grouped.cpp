#include <rastrum/raster/coverage/grouped.hpp>

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <rastrum/core/error.hpp>
#include <rastrum/raster/cover/rules.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/setup/set_up.hpp>

namespace rastrum::raster {
namespace {

/// Triangles of a group: few enough that what a thread collects stays in its L2 cache …
constexpr std::uint64_t kMinGroup = 4096;
/// … and that the groups' tables of bins together stay small.
constexpr std::uint64_t kMaxBinTables = std::uint64_t{1} << 19;

/// Calls use(bin, run) for runs of entries of the same bin. Neighbours mostly share one, and a
/// counter that is raised for each of them would be waited for each time.
template <class Entry, class Use>
void for_each_run(std::span<const Entry> entries, const Use& use) {
  for (std::size_t i = 0; i < entries.size();) {
    const std::uint32_t bin = entries[i].bin;
    std::size_t end = i + 1;
    while (end < entries.size() && entries[end].bin == bin) ++end;
    use(bin, entries.subspan(i, end - i));
    i = end;
  }
}

/// Entries in the order in which they were made, and how many each bin gets. A thread's: it is
/// filled again for every group, so that it stays in cache. `Entry` has a member `bin`.
template <class Entry>
class Collected {
 public:
  explicit Collected(MemoryAccount& memory) : entries_(memory), next_(memory) {}

  void restart(std::size_t bins) {
    count_ = 0;
    next_.reserve(bins + 1);
    std::fill_n(next_.data(), bins + 1, 0U);
  }
  /// Room for `n` more entries; say with `added` how many were written.
  [[nodiscard]] Entry* room(std::size_t n) {
    entries_.grow(count_ + n, count_);
    return entries_.data() + count_;
  }
  void added(std::size_t n) {
    for_each_run(std::span<const Entry>(entries_.data() + count_, n),
                 [&](std::uint32_t bin, std::span<const Entry> run) {
                   next_[bin + 1] += static_cast<std::uint32_t>(run.size());
                 });
    count_ += n;
  }
  [[nodiscard]] std::span<const Entry> entries() const { return {entries_.data(), count_}; }
  /// bins + 1 numbers; element b + 1 counts bin b.
  [[nodiscard]] std::span<const std::uint32_t> counts(std::size_t bins) const {
    return {next_.data(), bins + 1};
  }

 private:
  ScratchBuffer<Entry> entries_;
  ScratchBuffer<std::uint32_t> next_;
  std::size_t count_ = 0;
};

/// The entries of a group, sorted by bin.
template <class Entry>
class BinLists {
 public:
  explicit BinLists(MemoryAccount& memory) : sorted_(memory), begin_(memory) {}

  /// Stable counting sort.
  void sort(const Collected<Entry>& collected, std::size_t bins) {
    const std::span<const Entry> entries = collected.entries();
    const std::span<const std::uint32_t> counts = collected.counts(bins);
    sorted_.reserve(entries.size());
    begin_.reserve(bins + 1);
    // Shifted by one, so that after the scatter each element has moved on to its own bin's begin.
    std::uint32_t sum = 0;
    begin_[0] = 0;
    for (std::size_t b = 0; b < bins; ++b) {
      begin_[b + 1] = sum;
      sum += counts[b + 1];
    }
    for_each_run(entries, [&](std::uint32_t bin, std::span<const Entry> run) {
      std::copy(run.begin(), run.end(), sorted_.data() + begin_[bin + 1]);
      begin_[bin + 1] += static_cast<std::uint32_t>(run.size());
    });
  }
  [[nodiscard]] std::span<const Entry> bin(std::size_t b) const {
    return {sorted_.data() + begin_[b], begin_[b + 1] - begin_[b]};
  }

 private:
  ScratchBuffer<Entry> sorted_;
  ScratchBuffer<std::uint32_t> begin_;
};

/// Bins of layers with more entries are cut to 32², and those with even more to 16² px (paper 4's
/// future work; there 32² for all), so that threads share what is dense. Each part covers the bin's
/// pieces again: with an eighth of these numbers a brain of a million triangles took 1.3 times as
/// long.
constexpr std::size_t kSparseBin = 1 << 16, kDenseBin = 1 << 19;
/// What a region of layers keeps of a piece in a block: 24 bytes twice and a key.
constexpr std::uint64_t kRecordBytes = 56;

/// The lists of a view: one a bin, or two, so that what faces away is drawn after the rest of the
/// bin. Where surfaces are closed, half of their pieces face away and nearly all of those are
/// hidden; hierarchical Z then drops them before it covers them. The order changes no pixel.
struct Lists {
  TileGrid bins;
  bool two = false;

  Lists(const Frame& frame, const TileGrid& grid)
      : bins(grid),
        two(frame.request.hierarchical_z && frame.visibility.hides &&
            frame.request.targets.overdraw.empty()) {}

  [[nodiscard]] std::size_t count() const { return bins.count() * (two ? 2 : 1); }
  /// That of the pieces of bin `b` that face away, where there are two.
  [[nodiscard]] std::size_t away(std::size_t b) const { return bins.count() + b; }
  [[nodiscard]] BinNumbers numbers() const {
    return {bins.view, two ? static_cast<std::uint32_t>(bins.count()) : 0};
  }
};

/// Fewer pieces that face away do not pay for a look at what hides them.
constexpr std::size_t kWorthALook = 16;

/// What became of the triangles [first, last) of the frame.
struct Group {
  explicit Group(MemoryAccount& memory) : pieces(memory), by_bin(memory), fragments(memory) {}

  Pieces pieces;
  std::uint32_t binned = 0;  ///< pieces whose pairs are, or were, in by_bin
  BinLists<PieceInBin> by_bin;
  BinLists<BinFragment> fragments;

  [[nodiscard]] bool is_empty(const Lists& lists, std::size_t bin) const {
    return by_bin.bin(bin).empty() && fragments.bin(bin).empty() &&
           (!lists.two || by_bin.bin(lists.away(bin)).empty());
  }
};

/// What a thread needs to fill a group.
struct GroupScratch final : MicroSink {
  explicit GroupScratch(MemoryAccount& memory) : pieces(memory), pairs(memory), micro(memory) {}
  Pieces pieces;  ///< of a group, before those outside of the view are left out
  Collected<PieceInBin> pairs;
  Collected<BinFragment> micro;
  bool whole = true;        ///< the view is the image, whose bins setup numbers; else:
  int image_columns = 0;    ///< bins in a row of it
  int column = 0, row = 0;  ///< the view's first bin
  int columns = 0, rows = 0;

  void restart(const Frame& frame, const Lists& lists) {
    const TileGrid& bins = lists.bins;
    pairs.restart(lists.count());
    micro.restart(bins.count());
    whole = bins.count() == TileGrid{{0, 0, frame.request.width, frame.request.height}}.count();
    image_columns = (frame.request.width + kBinSize - 1) / kBinSize;
    column = bins.view.x0 / kBinSize;
    row = bins.view.y0 / kBinSize;
    columns = bins.columns();
    rows = bins.rows();
  }

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

/// Adds the pairs of a piece with the bins of its box that it may touch.
void bin_piece(const Piece& piece, std::uint32_t index, const Lists& lists,
               Collected<PieceInBin>& pairs) {
  const BinNumbers numbers = lists.numbers();
  const Rect view = numbers.view;
  const Rect box = piece_bounds(piece, view);
  if (box.empty()) return;
  const int bx0 = box.x0 / kBinSize, by0 = box.y0 / kBinSize;
  const int bx1 = (box.x1 - 1) / kBinSize, by1 = (box.y1 - 1) / kBinSize;
  const std::size_t touched =
      static_cast<std::size_t>(bx1 - bx0 + 1) * static_cast<std::size_t>(by1 - by0 + 1);
  PieceInBin* const out = pairs.room(touched);
  std::size_t n = 0;
  // A box in two bins has a vertex in each, unless the view cuts it: not worth asking.
  const bool asks = touched > 2;
  const Edges edges = asks ? edges_of(piece) : Edges{};
  for (int by = by0; by <= by1; ++by)
    for (int bx = bx0; bx <= bx1; ++bx) {
      const int x0 = bx * kBinSize, y0 = by * kBinSize;
      if (asks && !may_touch(edges, {x0, y0, x0 + kBinSize, y0 + kBinSize})) continue;
      const int row = by - view.y0 / kBinSize, column = bx - view.x0 / kBinSize;
      const auto bin = static_cast<std::uint32_t>(row * lists.bins.columns() + column);
      out[n++] = {numbers.of(piece, bin), index};
    }
  pairs.added(n);
}

/// Adds the pairs of pieces [first, …) with the bins of `view` until all are there, or as many as
/// `most` after a piece. Returns the first piece that was left.
std::uint32_t bin_pieces(const Kernels& kernel, std::span<const Piece> pieces, std::uint32_t first,
                         std::size_t most, const Lists& lists, Collected<PieceInBin>& pairs) {
  const BinNumbers numbers = lists.numbers();
  std::uint32_t bin[64];
  std::uint32_t index = first;
  while (index < pieces.size() && pairs.entries().size() < most) {
    auto n = static_cast<std::uint32_t>(
        std::min({std::size(bin), pieces.size() - index, most - pairs.entries().size()}));
    kernel.bins(pieces.data() + index, n, numbers, bin);
    for (std::uint32_t i = 0; i < n;) {
      PieceInBin* const out = pairs.room(n - i);
      std::uint32_t k = 0;
      for (; i < n && bin[i] != kManyBins; ++i) out[k++] = {bin[i], index + i};
      pairs.added(k);
      if (i < n) {
        bin_piece(pieces[index + i], index + i, lists, pairs);
        ++i;
      }
      // A piece that touched many bins may have left no room for those after it.
      if (i < n && pairs.entries().size() + (n - i) > most) {
        n = i;
        break;
      }
    }
    index += n;
  }
  return index;
}

class Grouped final : public Coverage {
 public:
  explicit Grouped(MemoryAccount& memory) : memory_(memory) {}

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    const Lists lists(frame, {frame.view, kBinSize, frame.request.tuning.order});
    if (frame.view_bytes != 0) groups_.clear();  // what other views needed
    const auto set_up = set_up_groups(frame, lists, first, last);
    frame.watch.lap(frame.stats, "setup and bin");
    frame.fits = set_up.has_value();
    if (!set_up) return;
    const std::span<Group> groups = *set_up;
    if (frame.visibility.keeps_layers) {
      draw_layers(frame, lists, groups);
      return;
    }
    draw_bins(frame, lists, groups);
    while (std::any_of(groups.begin(), groups.end(),
                       [](const Group& g) { return g.binned < g.pieces.count; })) {
      bin_more(frame, lists, groups);
      frame.watch.lap(frame.stats, "setup and bin");
      draw_bins(frame, lists, groups);
    }
  }

 private:
  /// Fills groups with pieces and fragments, and with pairs as far as there is room for them.
  /// Nothing: they take more than Frame::view_bytes.
  std::optional<std::span<Group>> set_up_groups(Frame& frame, const Lists& lists,
                                                std::uint64_t first, std::uint64_t last);
  /// Replaces pairs and fragments by the next pairs.
  void bin_more(Frame& frame, const Lists& lists, std::span<Group> groups);
  void draw_bins(Frame& frame, const Lists& lists, std::span<const Group> groups);
  /// The same for a visibility that keeps layers: dense bins are cut.
  void draw_layers(Frame& frame, const Lists& lists, std::span<const Group> groups);

  MemoryAccount& memory_;
  std::vector<Group> groups_;
  parallel::ScratchPool<GroupScratch> fillers_{[this] { return GroupScratch(memory_); }};
};

/// Pairs of a group at one time: each is in the group, and those of a thread's group are collected
/// before, in memory that has doubled.
std::size_t most_pairs(const Frame& frame, std::size_t groups) {
  if (frame.expansion_bytes == 0) return std::numeric_limits<std::size_t>::max();
  const auto threads = static_cast<std::uint64_t>(frame.exec.concurrency());
  return frame.expansion_bytes / ((groups + 3 * threads) * sizeof(PieceInBin));
}

/// Leaves out the pieces that do not touch the view.
void keep_in_view(Pieces& pieces, Rect view) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < pieces.count; ++i)
    if (!piece_bounds(pieces.data[i], view).empty()) pieces.data[kept++] = pieces.data[i];
  pieces.count = kept;
}

std::optional<std::span<Group>> Grouped::set_up_groups(Frame& frame, const Lists& lists,
                                                       std::uint64_t first, std::uint64_t last) {
  const std::size_t bin_count = lists.bins.count(), list_count = lists.count();
  const std::uint64_t most_groups = std::max<std::uint64_t>(kMaxBinTables / (2 * bin_count), 1);
  const std::uint64_t group_size =
      std::max(kMinGroup, (last - first + most_groups - 1) / most_groups);
  const auto group_count = static_cast<std::size_t>((last - first + group_size - 1) / group_size);
  while (groups_.size() < group_count) groups_.emplace_back(memory_);
  const std::size_t most = most_pairs(frame, group_count);
  std::atomic<bool> in_range = true;
  std::atomic<std::uint64_t> pairs = 0, micro_fragments = 0, bytes = 0;
  const bool limited = frame.view_bytes != 0;
  parallel::for_each_index(frame.exec, group_count, [&](std::size_t g) {
    if (limited && bytes.load(std::memory_order_relaxed) > frame.view_bytes) return;
    Group& group = groups_[g];
    GroupScratch& scratch = fillers_.local();
    Pieces& pieces = limited ? scratch.pieces : group.pieces;
    pieces.count = 0;
    pieces.triangles = {};
    scratch.restart(frame, lists);
    const std::uint64_t begin = first + g * group_size;
    if (!set_up(frame, begin, std::min(begin + group_size, last), pieces,
                frame.visibility.takes_fragments ? &scratch : nullptr)) {
      in_range = false;
      return;
    }
    if (limited) keep_in_view(pieces, frame.view);
    group.binned = bin_pieces(frame.kernel, pieces.span(), 0, most, lists, scratch.pairs);
    const std::size_t n = scratch.pairs.entries().size(), m = scratch.micro.entries().size();
    if (limited) {
      const std::uint64_t own = pieces.count * sizeof(Piece) + n * sizeof(PieceInBin) +
                                m * sizeof(BinFragment) +
                                (list_count + bin_count) * sizeof(std::uint32_t);
      if (bytes.fetch_add(own, std::memory_order_relaxed) + own > frame.view_bytes) return;
      group.pieces.data.reserve(pieces.count);
      std::copy_n(pieces.data.data(), pieces.count, group.pieces.data.data());
      group.pieces.count = pieces.count;
      group.pieces.triangles = pieces.triangles;
    }
    group.by_bin.sort(scratch.pairs, list_count);
    group.fragments.sort(scratch.micro, bin_count);
    pairs.fetch_add(n, std::memory_order_relaxed);
    micro_fragments.fetch_add(m, std::memory_order_relaxed);
  });
  if (!in_range) check_indices(frame.request.draws, frame.request.draw_noun);
  if (limited && bytes > frame.view_bytes) {
    groups_.clear();
    return std::nullopt;
  }
  for (std::size_t g = 0; g < group_count; ++g) count_triangles(frame, groups_[g].pieces.triangles);
  frame.count("bins", pairs);
  frame.count("micro fragments", micro_fragments);
  return std::span<Group>{groups_.data(), group_count};
}

void Grouped::bin_more(Frame& frame, const Lists& lists, std::span<Group> groups) {
  const std::size_t most = most_pairs(frame, groups.size());
  std::atomic<std::uint64_t> pairs = 0;
  parallel::for_each_index(frame.exec, groups.size(), [&](std::size_t g) {
    Group& group = groups[g];
    GroupScratch& scratch = fillers_.local();
    scratch.restart(frame, lists);
    group.binned =
        bin_pieces(frame.kernel, group.pieces.span(), group.binned, most, lists, scratch.pairs);
    group.by_bin.sort(scratch.pairs, lists.count());
    group.fragments.sort(scratch.micro, lists.bins.count());
    pairs.fetch_add(scratch.pairs.entries().size(), std::memory_order_relaxed);
  });
  frame.count("bins", pairs);
}

/// Those of a bin's fragments that lie in the part `rect` of it.
void emit_fragments(std::span<const BinFragment> fragments, Rect bin, Rect rect, Emitter& emitter) {
  if (fragments.empty()) return;
  if (rect.x0 == bin.x0 && rect.y0 == bin.y0 && rect.x1 == bin.x1 && rect.y1 == bin.y1)
    return emitter.fragments(bin, fragments);
  BinFragment inside[256];
  std::size_t n = 0;
  for (const BinFragment& f : fragments) {
    const int x = bin.x0 + column_in_bin(f), y = bin.y0 + row_in_bin(f);
    if (x < rect.x0 || x >= rect.x1 || y < rect.y0 || y >= rect.y1) continue;
    inside[n++] = f;
    if (n == std::size(inside)) emitter.fragments(bin, {inside, std::exchange(n, 0)});
  }
  if (n != 0) emitter.fragments(bin, {inside, n});
}

/// Enumerates the pieces of a list, as far as they touch `rect`.
void enumerate_pieces(Frame& frame, const Group& group, std::size_t list_number, Rect rect,
                      Emitter& emitter) {
  const std::span<const PieceInBin> list = group.by_bin.bin(list_number);
  if (list.empty()) return;
  const PieceList pieces{group.pieces.data.data(), list.data(), list.size()};
  emitter.use(pieces.pieces);
  for (std::size_t cursor = 0; cursor < pieces.count;) {
    const std::span<Block> room = emitter.room();
    emitter.written(
        frame.kernel.cover(pieces, cursor, rect, room.data(), room.size(), emitter.bounds()));
  }
  // Groups number their pieces from 0 each.
  emitter.flush();
}

/// Enumerates what groups have in a bin, or in the part `rect` of it.
void enumerate_bin(Frame& frame, const Lists& lists, std::span<const Group> groups, std::size_t bin,
                   Rect rect, Emitter& emitter) {
  const Rect whole = lists.bins.rect(bin);
  std::size_t away = 0;
  for (const Group& group : groups) {
    emit_fragments(group.fragments.bin(bin), whole, rect, emitter);
    enumerate_pieces(frame, group, bin, rect, emitter);
    if (lists.two) away += group.by_bin.bin(lists.away(bin)).size();
  }
  if (away == 0) return;
  if (away >= kWorthALook) emitter.find_bounds();
  for (const Group& group : groups) enumerate_pieces(frame, group, lists.away(bin), rect, emitter);
}

void Grouped::draw_bins(Frame& frame, const Lists& lists, std::span<const Group> groups) {
  draw_tiles(
      frame, lists.bins,
      [&](std::size_t bin) {
        return std::all_of(groups.begin(), groups.end(),
                           [&](const Group& g) { return g.is_empty(lists, bin); });
      },
      [&](std::size_t bin, Emitter& emitter) {
        enumerate_bin(frame, lists, groups, bin, lists.bins.rect(bin), emitter);
      });
  frame.watch.lap(frame.stats, frame.has_surface() ? "draw" : "draw and shade");
}

/// A bin or a part of it.
struct Part {
  std::size_t bin, entries;
  Rect rect;
  int side_px;

  /// Most that a region may record of it.
  [[nodiscard]] std::uint64_t record_bytes() const {
    const auto across = static_cast<std::uint64_t>(side_px / kBlockSize);
    return entries * across * across * kRecordBytes;
  }
};

/// Cuts a bin into parts whose side its density and the memory for records ask for.
void cut_bin(std::size_t bin, Rect rect, std::size_t entries, std::uint64_t most_bytes,
             std::vector<Part>& parts) {
  int side = entries <= kSparseBin ? kBinSize : entries <= kDenseBin ? 32 : 16;
  while (most_bytes != 0 && side > kBlockSize &&
         Part{bin, entries, {}, side}.record_bytes() > most_bytes)
    side /= 2;
  for (int y = rect.y0; y < rect.y1; y += side)
    for (int x = rect.x0; x < rect.x1; x += side)
      parts.push_back(
          {bin, entries, {x, y, std::min(x + side, rect.x1), std::min(y + side, rect.y1)}, side});
}

void Grouped::draw_layers(Frame& frame, const Lists& lists, std::span<const Group> groups) {
  const TileGrid& bins = lists.bins;
  const std::uint64_t most_bytes = frame.context(nullptr).fragment_bytes / 2;
  std::vector<Part> parts;
  for (std::size_t position = 0; position < bins.count(); ++position) {
    const std::size_t bin = bins.tile_at(position);
    std::size_t entries = 0;
    for (const Group& g : groups) entries += g.by_bin.bin(bin).size() + g.fragments.bin(bin).size();
    cut_bin(bin, bins.rect(bin), entries, most_bytes, parts);
  }
  // Those that need more than a thread's share of a memory limit are drawn alone.
  const auto alone = std::stable_partition(parts.begin(), parts.end(), [&](const Part& p) {
    return most_bytes == 0 || p.record_bytes() <= most_bytes;
  });
  const auto draw = [&](const Part& part) {
    draw_tile(frame, part.rect, part.side_px, part.entries == 0, [&](Emitter& emitter) {
      enumerate_bin(frame, lists, groups, part.bin, part.rect, emitter);
    });
  };
  parallel::for_each_index(frame.exec, static_cast<std::size_t>(alone - parts.begin()),
                           [&](std::size_t i) { draw(parts[i]); });
  std::for_each(alone, parts.end(), draw);
  collect_tiles(frame);
  frame.watch.lap(frame.stats, "draw and shade");
}

}  // namespace

std::unique_ptr<Coverage> make_grouped(const Tuning& tuning, MemoryAccount& memory) {
  if ((tuning.bin_px != 0 && tuning.bin_px != kBinSize) ||
      (tuning.tile_px != 0 && tuning.tile_px != kBlockSize))
    throw Error(Errc::invalid_argument, "'grouped' is compiled for bins of 64 and tiles of 8 px");
  return std::make_unique<Grouped>(memory);
}

}  // namespace rastrum::raster
