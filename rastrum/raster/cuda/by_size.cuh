// SPDX-License-Identifier: BSD-3-Clause
// by-size, a device's rasterizer: a listing of keys. The host knows nothing of it until the band is
// done: counters and queues lie on the device, where kernels read them.
//
//   project            a thread a vertex                                           geometry.cuh
//   draw the small     a thread a triangle without clipping: small ones (a box up to small_px) are
//                      drawn by the warp at once, a thread a sample; larger ones go to a queue of
//                      pieces, all else to one of primitives
//   draw the rest      a thread a primitive of that queue: the clipper, lines, points; with several
//                      samples a pixel, all primitives
//   draw the larger    a warp a piece of the middle; the 64 × 64 tiles of a large one (a box from
//                      large_px on) go to a third queue
//   draw the tiles     a block of threads each
//   resolve            the caller's: a band of keys is ready
//
// A piece or tile that finds its queue full is drawn where it is found: slower, the same keys.
// Triangles have two kernels, since the clipper would cost the first, which most take, registers
// (GPU.md of the project's research: 60 and 128).
//
// A maximum of keys does not depend on order. So queues, sizes, bands of rows and batches of
// primitives, which a memory limit asks for, change no bit. Setup culls boxes that miss every
// sample (make_piece). Sources: paper 1, hybrid; paper 2; decision 0014.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/cover.cuh>
#include <rastrum/raster/cuda/left_pieces.cuh>
#include <rastrum/raster/cuda/pieces.cuh>
#include <rastrum/raster/cuda/split.cuh>
#include <rastrum/raster/cuda/surface_drawer.cuh>
#include <rastrum/stop.hpp>

namespace rastrum::raster {

namespace cuda_detail {

/// A tile of a large piece.
struct PieceTile {
  std::uint32_t piece, tile;  ///< number in the queue; number in the box, row by row
};
inline constexpr std::uint32_t kNoPiece = std::numeric_limits<std::uint32_t>::max();

/// A batch's queues, on the device. Counters may exceed the room.
struct BySizeQueues {
  std::span<std::uint32_t> primitives;
  std::span<Piece> pieces;
  std::span<PieceTile> tiles;
  std::uint64_t* count;  ///< of each queue, in this order
};

struct BySizeLocal {
  std::uint32_t dropped = 0, culled = 0, clipped = 0, invalid = 0;
  std::uint64_t fragments = 0;

  RASTRUM_HD void take(Fate fate) {
    dropped += fate == Fate::dropped;
    culled += fate == Fate::culled;
    clipped += fate == Fate::clipped;
  }
};

/// Parameters of all kernels for primitives.
struct BySizeBatch {
  Assembly assembly;
  DeviceSurface surface;
  BySizeQueues queues;
  std::uint64_t small_px;
  std::uint32_t skip;
  LeftPieces left;
  std::uint64_t* sums;

  /// Whether the piece is large enough for its queue and found room.
  RASTRUM_HD bool queue(const Piece& piece, Rect bounds) const {
    if (area_of(bounds) <= small_px) return false;
    const std::uint64_t at = parallel::take_place(queues.count[1]);
    if (at >= queues.pieces.size()) return false;
    queues.pieces[static_cast<std::size_t>(at)] = piece;
    return true;
  }
  /// Whether the piece is left to others; puts it in `queue` for them.
  template <class Queue>
  RASTRUM_HD bool leave(const Piece& piece, Queue& queue) const {
    if ((piece.flags & skip) == 0) return false;
    if (!left.pieces.empty() && !surface.bounds(piece).empty()) queue.put(piece);
    return true;
  }
  RASTRUM_HD void draw(const Piece& piece, BySizeLocal& local) const {
    if (queue(piece, surface.bounds(piece))) return;
    surface.each_sample(piece, surface.view, [&](int s, const Piece& seen, Rect box) {
      local.fragments += static_cast<std::uint64_t>(draw_by_thread(surface, seen, box, s));
    });
  }
  RASTRUM_HD void end(const BySizeLocal& local) const {
    parallel::add_to_sum(sums[kDroppedSum], local.dropped);
    parallel::add_to_sum(sums[kCulledSum], local.culled);
    parallel::add_to_sum(sums[kClippedSum], local.clipped);
    parallel::add_to_sum(sums[kInvalidSum], local.invalid);
    parallel::add_to_sum(sums[kFragmentsSum], local.fragments);
  }
};

/// Triangles [each · i, each · (i + 1)) of the batch's `count`, with one sample a pixel. Each
/// member sets up one and the team draws them, or they go to the queue of primitives, which has
/// room for all.
struct DrawUnclipped : BySizeBatch {
  std::size_t count = 0, each = TeamTriangles::kCount;

  /// Few triangles are spread over more teams than their members need: else those that cover much
  /// would wait for each other.
  [[nodiscard]] static std::size_t each_of(std::size_t count) {
    constexpr std::size_t kTeams = 8192, kLeast = 4;
    std::size_t each = TeamTriangles::kCount;
    while (each > kLeast && count / each < kTeams) each /= 2;
    return each;
  }
  [[nodiscard]] std::size_t teams() const { return (count + each - 1) / each; }

  template <class Team>
  RASTRUM_HD void operator()(std::size_t i, BySizeLocal& local, TeamTriangles& shared,
                             const Team& team) const {
    for (std::size_t k = team.rank(); k < TeamTriangles::kCount; k += team.size()) {
      Piece piece;
      Rect box;
      const std::size_t p = i * each + k;
      if (k < each && p < count) box = set_up(p, piece, local);
      shared.set(static_cast<int>(k), piece, box);
    }
    local.fragments += shared.draw(surface, team);
  }

 private:
  /// The box to draw at once; may be empty.
  RASTRUM_HD Rect set_up(std::size_t i, Piece& piece, BySizeLocal& local) const {
    const std::uint64_t id = assembly.first + i;
    const Draw& draw_of_it = assembly.geometry.draw_of(id);
    const std::uint64_t p = id - draw_of_it.first_id;
    if (!Assembly::is_valid(draw_of_it, p)) {
      ++local.invalid;
      return {};
    }
    Fate fate = Fate::culled;
    if (!assemble_unclipped(assembly.geometry, draw_of_it, p, fate, piece)) {
      const std::uint64_t at = parallel::take_place(queues.count[0]);
      queues.primitives[static_cast<std::size_t>(at)] = static_cast<std::uint32_t>(i);
      return {};
    }
    local.take(fate);
    if (fate != Fate::drawn || leave(piece, left)) return {};
    const Rect box = piece_bounds(piece, surface.view);
    return box.empty() || queue(piece, box) ? Rect{} : box;
  }
};

/// A primitive of the queue or, without one, of the batch.
struct DrawAny : BySizeBatch {
  RASTRUM_HD void operator()(std::size_t k, BySizeLocal& local) const {
    const std::size_t i = queues.primitives.empty() ? k : queues.primitives[k];
    LeaveOfPrimitive others(left);
    const Outcome out = assembly.assemble(i, [&](const Piece& piece) {
      if (!leave(piece, others)) draw(piece, local);
    });
    others.end();
    if (!out.valid)
      ++local.invalid;
    else
      local.take(out.fate);
  }
};

/// Draws a piece of the queue or queues its tiles.
struct DrawLarger {
  DeviceSurface surface;
  BySizeQueues queues;
  std::uint64_t large_px;
  std::uint64_t* sums;

  template <class Team>
  RASTRUM_HD void operator()(std::size_t i, std::uint64_t& shared, const Team& team) const {
    const Piece& piece = queues.pieces[i];
    const Rect bounds = surface.bounds(piece);
    if (i == 0 && team.rank() == 0) parallel::add_to_sum(sums[kLargerSum], queues.count[1]);
    if (area_of(bounds) >= large_px) {
      const auto tiles = static_cast<std::uint64_t>(area_of(tiles_of(bounds, surface.view)));
      if (queue(i, tiles, shared, team)) return;
    }
    surface.each_sample(piece, surface.view, [&](int s, const Piece& seen, Rect box) {
      draw_by_team(surface, seen, box, sums + kFragmentsSum, team, s);
    });
  }

 private:
  /// Whether there was room for all.
  template <class Team>
  RASTRUM_HD bool queue(std::size_t piece, std::uint64_t tiles, std::uint64_t& shared,
                        const Team& team) const {
    if (team.rank() == 0) shared = parallel::atomic_add(queues.count[2], tiles);
    team.sync();
    const std::uint64_t first = shared, room = queues.tiles.size();
    team.sync();
    const bool fits = first + tiles <= room;
    for (std::uint64_t k = team.rank(); k < tiles && first + k < room; k += team.size())
      queues.tiles[static_cast<std::size_t>(first + k)] = {
          fits ? static_cast<std::uint32_t>(piece) : kNoPiece, static_cast<std::uint32_t>(k)};
    return fits;
  }
};

struct DrawTile {
  DeviceSurface surface;
  BySizeQueues queues;
  std::uint64_t* sums;
  template <class Team>
  RASTRUM_HD void operator()(std::size_t i, char&, const Team& team) const {
    if (i == 0 && team.rank() == 0) parallel::add_to_sum(sums[kTilesSum], queues.count[2]);
    const PieceTile at = queues.tiles[i];
    if (at.piece == kNoPiece) return;
    const Piece& piece = queues.pieces[at.piece];
    const Rect view = surface.view;
    const Rect tiles = tiles_of(surface.bounds(piece), view);
    const int j = static_cast<int>(at.tile), columns = tiles.x1 - tiles.x0;
    const int x0 = view.x0 + (tiles.x0 + j % columns) * kDeviceTile;
    const int y0 = view.y0 + (tiles.y0 + j / columns) * kDeviceTile;
    const Rect tile = common_of(view, {x0, y0, x0 + kDeviceTile, y0 + kDeviceTile});
    surface.each_sample(piece, tile, [&](int s, const Piece& seen, Rect part) {
      if (may_touch(edges_of(seen), part))
        draw_by_team(surface, seen, part, sums + kFragmentsSum, team, s);
    });
  }
};

}  // namespace cuda_detail

/// Draws with one or several samples a pixel. Counters: "batches", "larger pieces", "tile pairs".
class BySize final : public SurfaceDrawer {
 public:
  explicit BySize(DeviceSizes sizes = {}) : sizes_(sizes) {}

  [[nodiscard]] Kind kind() const override {
    return {.rasterizer = "by-size",
            .visibility = "atomic",
            .why = "cuda has by-size: a thread, a warp or blocks of threads a triangle",
            .has_samples = true,
            .leaves_pieces = true};
  }

  void draw(parallel::Cuda& exec, const DeviceScene<parallel::Cuda>& scene,
            const DeviceSurface& surface, const DeviceSplit& split, std::uint32_t skip,
            const LeftPieces& left, const FragmentColors& /*colors*/,
            std::uint64_t* sums) override {
    using namespace cuda_detail;  // NOLINT: its kernels are the subject here
    using parallel::view_of;
    // A small piece's fragments, at all samples, are counted in 16 bits.
    const std::uint64_t small_px = std::min(
        sizes_.small_px, std::uint64_t{4096} / static_cast<std::uint64_t>(surface.samples.count));
    const std::uint64_t end = scene.first_id() + scene.primitives();
    const std::uint64_t most = std::min(split.batch, scene.primitives());
    const bool has_fast_path = surface.samples.count == 1;
    auto primitives = parallel::make_buffer<std::uint32_t>(
        exec, has_fast_path ? static_cast<std::size_t>(most) : 0);
    auto pieces = parallel::make_buffer<Piece>(
        exec, static_cast<std::size_t>(std::min(split.queued_pieces, most * kMaxPieces)));
    auto tiles =
        parallel::make_buffer<PieceTile>(exec, static_cast<std::size_t>(split.queued_tiles));
    auto counts = parallel::make_buffer<std::uint64_t>(exec, 3);
    const BySizeQueues queues{view_of(primitives), view_of(pieces), view_of(tiles), counts.data()};
    for (std::uint64_t first = scene.first_id(); first < end; first += split.batch) {
      throw_if_stopped();
      ++batches_;
      const auto n = static_cast<std::size_t>(std::min(split.batch, end - first));
      parallel::clear(exec, counts);
      const BySizeBatch batch{
          {scene.geometry(), first, surface.samples}, surface, queues, small_px, skip, left, sums};
      if (has_fast_path) {
        const DrawUnclipped triangles{batch, n, DrawUnclipped::each_of(n)};
        parallel::for_each_team_strided<BySizeLocal, TeamTriangles, TeamTriangles::kCount>(
            exec, triangles.teams(), triangles);
      }
      parallel::for_each_strided<BySizeLocal>(
          exec, has_fast_path ? parallel::LoopCount{n, &queues.count[0]} : n, DrawAny{batch});
      parallel::for_each_team<std::uint64_t, 32>(
          exec, {pieces.size(), &queues.count[1]},
          DrawLarger{surface, queues, sizes_.large_px, sums});
      parallel::for_each_team<char, 128>(exec, {tiles.size(), &queues.count[2]},
                                         DrawTile{surface, queues, sums});
    }
  }

  void begin_frame() override { batches_ = larger_pieces_ = tiles_ = 0; }
  void end_band(const BandSums& sums) override {
    larger_pieces_ += sums[kLargerSum];
    tiles_ += sums[kTilesSum];
  }
  void end_frame(FrameStats& stats) const override {
    stats.counters.insert(
        stats.counters.end(),
        {{"batches", batches_}, {"larger pieces", larger_pieces_}, {"tile pairs", tiles_}});
  }

 private:
  const DeviceSizes sizes_;
  std::uint64_t batches_ = 0, larger_pieces_ = 0, tiles_ = 0;
};

}  // namespace rastrum::raster
