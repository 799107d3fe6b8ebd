// SPDX-License-Identifier: BSD-3-Clause
// Pieces that a SurfaceDrawer leaves to others (fragment tests, layers), in a queue on the device.
// They are set up once, with all others, and the host need not know their number.
//
// Others walk the queue by the 8 × 8 blocks of the pieces' boxes. A thread takes a small box. A
// larger one goes in runs of blocks to a second queue, for teams; the thread walks runs without
// room there. If the first queue overflowed, nothing is drawn from it. The host, which reads the
// counter with the picture, then makes the pieces by a listing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/parallel/reduce_by_index.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/setup/assemble.hpp>

namespace rastrum::raster {

/// Device memory. Pieces come in any order, but those of a clipped triangle side by side. Some are
/// of no primitive and have flags 0.
struct LeftPieces {
  std::span<Piece> pieces;         ///< room; empty: none is kept
  std::uint64_t* count = nullptr;  ///< may exceed the room

  /// Whether pieces are missing.
  [[nodiscard]] RASTRUM_HD bool is_full() const { return *count > pieces.size(); }
  [[nodiscard]] parallel::LoopCount loop() const { return {pieces.size(), count}; }
  RASTRUM_HD void put(const Piece& piece) const { write(parallel::take_place(*count), piece); }
  RASTRUM_HD void write(std::uint64_t place, const Piece& piece) const {
    if (place < pieces.size()) pieces[static_cast<std::size_t>(place)] = piece;
  }
};

/// Puts the pieces of one primitive there. Used by one thread, which calls end() last.
class LeaveOfPrimitive {
 public:
  RASTRUM_HD explicit LeaveOfPrimitive(const LeftPieces& left) : left_(left) {}

  RASTRUM_HD void put(const Piece& piece) {
    if ((piece.flags & kClipped) == 0) return left_.put(piece);
    if (used_ == 0) first_ = parallel::atomic_add(*left_.count, std::uint64_t{kPlaces});
    left_.write(first_ + used_++, piece);
  }
  RASTRUM_HD void end() {
    if (used_ == 0) return;
    const Piece none{};
    for (; used_ < kPlaces; ++used_) left_.write(first_ + used_, none);
  }

 private:
  /// One more than a triangle has, so that an empty place follows: code that looks there for pieces
  /// of the same triangle must not read an earlier frame's.
  static constexpr std::uint32_t kPlaces = kMaxPieces + 1;

  const LeftPieces& left_;
  std::uint64_t first_ = 0;
  std::uint32_t used_ = 0;
};

namespace cuda_detail {

/// Blocks of a piece's box, by their number in it, from 128 · part on.
struct BlockRun {
  std::uint32_t piece, part;
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint64_t kBlocks = 128;
};
struct BlockRuns {
  std::span<BlockRun> runs;
  std::uint64_t* count;  ///< may exceed the room

  /// Whether there was room for all of a piece.
  RASTRUM_HD bool put(std::uint32_t piece, std::uint64_t blocks) const {
    const std::uint64_t parts = (blocks + BlockRun::kBlocks - 1) / BlockRun::kBlocks;
    const std::uint64_t first = parallel::atomic_add(*count, parts), room = runs.size();
    const bool fits = first + parts <= room;
    for (std::uint64_t p = 0; p < parts && first + p < room; ++p)
      runs[static_cast<std::size_t>(first + p)] = {fits ? piece : BlockRun::kNone,
                                                   static_cast<std::uint32_t>(p)};
    return fits;
  }
};

/// Pieces with small boxes, a thread each.
template <class Visit>
struct VisitPieces {
  LeftPieces left;
  BlockRuns runs;
  Visit visit;
  std::uint64_t* held;

  using Local = typename Visit::Local;
  RASTRUM_HD void operator()(std::size_t i, Local& local) const {
    if (left.is_full()) {
      if (i == 0) parallel::atomic_add(*held, std::uint64_t{1});
      return;
    }
    constexpr std::uint64_t kBlocksOfThread = 8;
    const auto piece = static_cast<std::uint32_t>(i);
    const std::uint64_t blocks = visit.blocks(piece);
    if (blocks > kBlocksOfThread && runs.put(piece, blocks)) return;
    for (std::uint64_t j = 0; j < blocks; ++j) visit(piece, static_cast<std::size_t>(j), local);
  }
  RASTRUM_HD void end(const Local& local) const { visit.end(local); }
};

/// The others' runs, a team each.
template <class Visit>
struct VisitRuns {
  BlockRuns runs;
  Visit visit;

  template <class Team>
  RASTRUM_HD void operator()(std::size_t i, char&, const Team& team) const {
    const BlockRun run = runs.runs[i];
    if (run.piece == BlockRun::kNone) return;
    const std::uint64_t first = run.part * BlockRun::kBlocks, blocks = visit.blocks(run.piece);
    const std::uint64_t left = blocks - first;
    const std::uint64_t end = first + (left < BlockRun::kBlocks ? left : BlockRun::kBlocks);
    typename Visit::Local local{};
    for (std::uint64_t j = first + team.rank(); j < end; j += team.size())
      visit(run.piece, static_cast<std::size_t>(j), local);
    visit.end(local);
  }
};

}  // namespace cuda_detail

[[nodiscard]] inline std::size_t room_for_runs(const LeftPieces& left) {
  constexpr std::size_t kLeast = std::size_t{1} << 12, kMost = std::size_t{1} << 22;
  const std::size_t room = kLeast + left.pieces.size() / 4;
  return room < kMost ? room : kMost;
}

/// Calls visit(i, j, local) for j < visit.blocks(i) of each piece i of `left`, in any order by many
/// threads, and then visit.end(local) by each. Visit::Local has a thread's counts. If pieces are
/// missing it calls nothing and adds to *held. `run_count`: 0, on the device. Work O(pieces +
/// blocks). Does not wait.
template <class Visit>
void visit_blocks(parallel::Cuda& exec, const LeftPieces& left, const Visit& visit,
                  std::uint64_t* run_count, std::uint64_t* held) {
  using namespace cuda_detail;  // NOLINT: its kernels are the subject here
  auto room = parallel::make_buffer<BlockRun>(exec, room_for_runs(left));
  const BlockRuns runs{parallel::view_of(room), run_count};
  parallel::for_each_strided<typename Visit::Local>(exec, left.loop(),
                                                    VisitPieces<Visit>{left, runs, visit, held});
  parallel::for_each_team<char, 128>(exec, {room.size(), run_count}, VisitRuns<Visit>{runs, visit});
}

}  // namespace rastrum::raster
