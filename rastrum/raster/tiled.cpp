#include <rastrum/raster/tiled.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include <rastrum/raster/assemble.hpp>
#include <rastrum/raster/coverage.hpp>
#include <rastrum/raster/kernels.hpp>
#include <rastrum/raster/resolve.hpp>
#include <rastrum/raster/stopwatch.hpp>

namespace rastrum::raster {
namespace {

/// Triangles of a group: few enough that what a thread collects stays in its L2 cache …
constexpr std::uint64_t kMinGroup = 4096;
/// … and that the groups' tables of bins together stay small.
constexpr std::uint64_t kMaxBinTables = std::uint64_t{1} << 18;
constexpr std::size_t kProjectGrain = 4096;
constexpr std::size_t kBlockCapacity = 512;

struct BinGrid {
  int columns, rows;
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
};

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
    for (std::size_t i = count_; i < count_ + n; ++i) ++next_[entries_[i].bin + 1];
    count_ += n;
  }
  [[nodiscard]] std::span<const Entry> entries() const { return {entries_.data(), count_}; }
  /// bins + 1 numbers; element b + 1 counts bin b.
  [[nodiscard]] std::span<const std::uint32_t> counts(std::size_t bins) const {
    return {next_.data(), bins + 1};
  }

 private:
  Buffer<Entry> entries_;
  Buffer<std::uint32_t> next_;
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
    for (const Entry& entry : entries) sorted_[begin_[entry.bin + 1]++] = entry;
  }
  [[nodiscard]] std::span<const Entry> bin(std::size_t b) const {
    return {sorted_.data() + begin_[b], begin_[b + 1] - begin_[b]};
  }

 private:
  Buffer<Entry> sorted_;
  Buffer<std::uint32_t> begin_;
};

/// What became of the triangles [first, last) of the frame.
struct Group {
  explicit Group(MemoryAccount& memory) : pieces(memory), by_bin(memory), fragments(memory) {}

  Buffer<Piece> pieces;
  std::uint32_t piece_count = 0;
  BinLists<PieceInBin> by_bin;
  BinLists<BinFragment> fragments;
  FrameStats::Triangles triangles;

  [[nodiscard]] bool is_empty(std::size_t bin) const {
    return by_bin.bin(bin).empty() && fragments.bin(bin).empty();
  }
};

/// What a thread needs to fill a group.
struct GroupScratch {
  explicit GroupScratch(MemoryAccount& memory) : pairs(memory), fragments(memory) {}
  Collected<PieceInBin> pairs;
  Collected<BinFragment> fragments;
};

/// Whether the bin's rectangle may hold an inside sample: none lies beyond any one edge.
bool may_touch(const Edge (&edges)[3], int bin_x, int bin_y) {
  for (const Edge& e : edges) {
    const std::int64_t x = bin_x * kBinSize + (e.a > 0 ? kBinSize - 1 : 0);
    const std::int64_t y = bin_y * kBinSize + (e.b > 0 ? kBinSize - 1 : 0);
    if (e.base + e.a * x + e.b * y < 0) return false;
  }
  return true;
}

void bin_pieces(const Group& group, std::uint32_t first_piece, Rect view, BinGrid grid,
                Collected<PieceInBin>& pairs) {
  for (std::uint32_t i = first_piece; i < group.piece_count; ++i) {
    const Piece& piece = group.pieces[i];
    const Rect box = sample_bounds(piece.x, piece.y, view);
    const int bx0 = box.x0 / kBinSize, by0 = box.y0 / kBinSize;
    const int bx1 = (box.x1 - 1) / kBinSize, by1 = (box.y1 - 1) / kBinSize;
    const std::size_t most =
        static_cast<std::size_t>(bx1 - bx0 + 1) * static_cast<std::size_t>(by1 - by0 + 1);
    PieceInBin* const out = pairs.room(most);
    std::size_t n = 0;
    const auto add = [&](int bx, int by) {
      out[n++] = {static_cast<std::uint32_t>(by * grid.columns + bx), i};
    };
    if (most == 1) {
      add(bx0, by0);
    } else {
      const Edge edges[3] = {edge_function(piece, 0), edge_function(piece, 1),
                             edge_function(piece, 2)};
      for (int by = by0; by <= by1; ++by)
        for (int bx = bx0; bx <= bx1; ++bx)
          if (may_touch(edges, bx, by)) add(bx, by);
    }
    pairs.added(n);
  }
}

/// Setup of triangles [first, last), which may span draws.
void fill_group(Group& group, GroupScratch& scratch, const FrameGeometry& frame,
                const Kernels& kernel, BinGrid grid, std::uint64_t first, std::uint64_t last,
                std::atomic<bool>& index_in_range) {
  const Rect view{0, 0, frame.width, frame.height};
  group.piece_count = 0;
  group.triangles = {};
  scratch.pairs.restart(grid.count());
  scratch.fragments.restart(grid.count());
  std::uint32_t slow[kSetupBatch];

  for (std::uint64_t id = first; id < last;) {
    const Draw& draw = frame.draw_of(id);
    const std::uint64_t t = id - draw.first_id;
    const auto count = static_cast<std::uint32_t>(
        std::min({std::uint64_t{kSetupBatch}, last - id, draw.triangle_count - t}));
    SetupInput input;
    input.indices = draw.indices.empty() ? nullptr : draw.indices.data();
    input.vertices = frame.projected + draw.first_vertex;
    input.vertex_count = draw.vertex_count;
    input.first = t;
    input.count = count;
    input.first_id = draw.first_id;
    input.flags = draw.flags;
    input.cull = draw.cull;
    input.view = view;
    input.bin_columns = static_cast<std::uint32_t>(grid.columns);

    const std::uint32_t first_piece = group.piece_count;
    group.pieces.grow(first_piece + kSetupBatch, first_piece);
    BinFragment* const fragments = scratch.fragments.room(kSetupBatch * kMicroSize * kMicroSize);
    const SetupOutput out = kernel.setup(input, group.pieces.data() + first_piece, fragments, slow);
    if (!out.index_in_range) {
      index_in_range = false;
      return;
    }
    group.piece_count += out.pieces;
    scratch.fragments.added(out.fragments);
    group.triangles.culled += count - out.pieces - out.micro - out.slow;
    for (std::uint32_t s = 0; s < out.slow; ++s) {
      const TriangleFate fate =
          assemble_triangle(frame, draw, t + slow[s], draw.cull, [&](const Piece& piece) {
            group.pieces.grow(group.piece_count + 1, group.piece_count);
            group.pieces[group.piece_count++] = piece;
          });
      group.triangles.dropped += fate == TriangleFate::dropped;
      group.triangles.culled += fate == TriangleFate::culled;
      group.triangles.clipped += fate == TriangleFate::clipped;
    }
    bin_pieces(group, first_piece, view, grid, scratch.pairs);
    id += count;
  }
  group.by_bin.sort(scratch.pairs, grid.count());
  group.fragments.sort(scratch.fragments, grid.count());
}

void test_fragments(const FrameRequest& request, const FrameGeometry& frame, const Piece* pieces,
                    std::span<Block> blocks) {
  for (Block& block : blocks)
    if ((pieces[block.piece].flags & kTested) != 0)
      block.mask = request.test->test(frame, pieces[block.piece], block);
}

void count_overdraw(const ImageView<std::uint32_t>& overdraw, std::span<const Block> blocks) {
  for (const Block& block : blocks)
    for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
      const int bit = std::countr_zero(m);
      ++overdraw(block.bx * kBlockSize + bit % kBlockSize,
                 block.by * kBlockSize + bit / kBlockSize);
    }
}

void count_overdraw(const ImageView<std::uint32_t>& overdraw, Rect bin,
                    std::span<const BinFragment> fragments) {
  for (const BinFragment& f : fragments) {
    const int block = static_cast<int>(f.pixel) / 64, sample = static_cast<int>(f.pixel) % 64;
    ++overdraw(bin.x0 + block % kBlocksPerBinRow * kBlockSize + sample % kBlockSize,
               bin.y0 + block / kBlocksPerBinRow * kBlockSize + sample / kBlockSize);
  }
}

/// What a thread needs to draw a bin.
struct alignas(64) BinScratch {
  std::uint64_t words[kBlocksPerBin * 64];
  Block blocks[kBlockCapacity];
  alignas(64) std::byte shader[kMaxShaderScratch];
};

struct BinCounts {
  std::uint64_t fragments = 0, covered = 0;
};

/// Resolves and shades one bin.
BinCounts draw_bin(const FrameRequest& request, const FrameGeometry& frame, const Kernels& kernel,
                   std::span<const Group> groups, std::size_t bin, Rect rect, BinScratch& scratch) {
  BinCounts counts;
  if (!request.targets.overdraw.empty())
    for (int y = rect.y0; y < rect.y1; ++y)
      std::fill_n(request.targets.overdraw.row(y) + rect.x0, rect.x1 - rect.x0, 0U);
  if (std::all_of(groups.begin(), groups.end(), [&](const Group& g) { return g.is_empty(bin); })) {
    resolve_empty(request, rect);
    return counts;
  }
  std::fill_n(scratch.words, kBlocksPerBin * 64, 0);
  for (const Group& group : groups) {
    const std::span<const BinFragment> fragments = group.fragments.bin(bin);
    counts.fragments += fragments.size();
    for (const BinFragment& f : fragments)
      scratch.words[f.pixel] = std::max(scratch.words[f.pixel], f.word);
    if (!request.targets.overdraw.empty())
      count_overdraw(request.targets.overdraw, rect, fragments);

    const std::span<const PieceInBin> in_bin = group.by_bin.bin(bin);
    const PieceList pieces{group.pieces.data(), in_bin.data(), in_bin.size()};
    for (std::size_t cursor = 0; cursor < pieces.count;) {
      const std::size_t n =
          kernel.cover(pieces, cursor, rect, scratch.blocks, kBlockCapacity, counts.fragments);
      const std::span<Block> blocks(scratch.blocks, n);
      if (!request.targets.overdraw.empty()) count_overdraw(request.targets.overdraw, blocks);
      if (request.test != nullptr) test_fragments(request, frame, pieces.pieces, blocks);
      kernel.maximum(pieces.pieces, blocks.data(), n, rect, scratch.words);
    }
  }
  if (request.shader != nullptr) std::memset(scratch.shader, 0, request.shader->scratch_bytes());
  for (int by = 0; by < kBlocksPerBinRow; ++by)
    for (int bx = 0; bx < kBlocksPerBinRow; ++bx) {
      const int x0 = rect.x0 + bx * kBlockSize, y0 = rect.y0 + by * kBlockSize;
      if (x0 >= rect.x1 || y0 >= rect.y1) continue;
      const std::uint64_t* words = scratch.words + (by * kBlocksPerBinRow + bx) * 64;
      counts.covered +=
          static_cast<std::uint64_t>(resolve_block(request, frame, words, x0, y0, scratch.shader));
    }
  return counts;
}

}  // namespace

struct TiledRasterizer::Scratch {
  explicit Scratch(MemoryAccount& m) : memory(m), projected(m) {}
  MemoryAccount& memory;
  Buffer<ProjectedVertex> projected;
  std::vector<Group> groups;
  tbb::enumerable_thread_specific<std::unique_ptr<BinScratch>> bins;
  tbb::enumerable_thread_specific<GroupScratch> fillers{[this] { return GroupScratch(memory); }};

  BinScratch& bin_scratch() {
    std::unique_ptr<BinScratch>& mine = bins.local();
    if (!mine) mine = std::make_unique<BinScratch>();
    return *mine;
  }
};

TiledRasterizer::TiledRasterizer(MemoryAccount& memory)
    : scratch_(std::make_unique<Scratch>(memory)) {}
TiledRasterizer::~TiledRasterizer() = default;

FrameStats TiledRasterizer::render(FrameRequest& request, parallel::Threads& exec) {
  Stopwatch watch;
  FrameStats stats;
  stats.rasterizer = "tiled";
  stats.visibility = "atomic";
  stats.isa = request.isa;
  const Kernels& kernel = kernels(request.isa);
  const Totals totals = number_draws(request.draws);

  FrameGeometry frame{request.width, request.height, Viewport::of(request.width, request.height),
                      request.draws, nullptr};
  scratch_->projected.reserve(totals.vertices);
  frame.projected = scratch_->projected.data();
  for (const Draw& draw : request.draws)
    parallel::for_each_index(
        exec, (draw.vertex_count + kProjectGrain - 1) / kProjectGrain, [&](std::size_t i) {
          const std::size_t begin = i * kProjectGrain;
          const std::size_t end = std::min(begin + kProjectGrain, draw.vertex_count);
          draw.source->project(begin, end, frame.viewport, request.isa,
                               scratch_->projected.data() + draw.first_vertex + begin);
        });
  watch.lap(stats, "project");

  const BinGrid grid{(request.width + kBinSize - 1) / kBinSize,
                     (request.height + kBinSize - 1) / kBinSize};
  const std::uint64_t most_groups = std::max<std::uint64_t>(kMaxBinTables / grid.count(), 1);
  const std::uint64_t group_size =
      std::max(kMinGroup, (totals.triangles + most_groups - 1) / most_groups);
  const auto group_count =
      static_cast<std::size_t>((totals.triangles + group_size - 1) / group_size);
  while (scratch_->groups.size() < group_count) scratch_->groups.emplace_back(scratch_->memory);
  const std::span<Group> groups(scratch_->groups.data(), group_count);
  std::atomic<bool> index_in_range = true;
  parallel::for_each_index(exec, group_count, [&](std::size_t g) {
    const std::uint64_t first = g * group_size;
    fill_group(groups[g], scratch_->fillers.local(), frame, kernel, grid, first,
               std::min(first + group_size, totals.triangles), index_in_range);
  });
  if (!index_in_range) check_indices(request.draws);
  stats.triangles.input = totals.triangles;
  for (const Group& g : groups) {
    stats.triangles.dropped += g.triangles.dropped;
    stats.triangles.culled += g.triangles.culled;
    stats.triangles.clipped += g.triangles.clipped;
  }
  stats.triangles.drawn = stats.triangles.input - stats.triangles.dropped - stats.triangles.culled;
  watch.lap(stats, "setup and bin");

  std::atomic<std::uint64_t> fragments = 0, covered = 0;
  parallel::for_each_index(exec, grid.count(), [&](std::size_t bin) {
    const int x0 = static_cast<int>(bin % static_cast<std::size_t>(grid.columns)) * kBinSize;
    const int y0 = static_cast<int>(bin / static_cast<std::size_t>(grid.columns)) * kBinSize;
    const Rect rect{x0, y0, std::min(x0 + kBinSize, request.width),
                    std::min(y0 + kBinSize, request.height)};
    const BinCounts counts =
        draw_bin(request, frame, kernel, groups, bin, rect, scratch_->bin_scratch());
    fragments.fetch_add(counts.fragments, std::memory_order_relaxed);
    covered.fetch_add(counts.covered, std::memory_order_relaxed);
  });
  stats.fragments = fragments;
  stats.pixels_covered = covered;
  watch.lap(stats, "draw and shade");
  return stats;
}

}  // namespace rastrum::raster
