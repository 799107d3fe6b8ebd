// by-size, the rasterizer of a device: a listing of keys.
//
//   project            a thread a vertex                                           geometry.cuh
//   set up, and draw   a thread a primitive: small pieces (a box up to small_px)   pieces.cuh,
//                      at once, the others are counted                             cover.cuh
//   write the others   scan, then a thread a primitive that has some
//   draw them          a warp a piece of the middle; a block of threads for each
//                      64 × 64 tile of a large one (a box from large_px on)
//   resolve            the caller's: a band of keys is ready
//
// Order does not matter to a maximum of keys, so neither the sizes nor the cut into bands of rows
// and batches of primitives, which a memory limit asks for, change a bit. Culling of boxes that
// miss every sample is setup's (make_piece). Sources: paper 1, hybrid; paper 2; decision 0014.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/cover.cuh>
#include <rastrum/raster/cuda/pieces.cuh>
#include <rastrum/raster/cuda/plan.cuh>
#include <rastrum/raster/cuda/surface_drawer.cuh>
#include <rastrum/stop.hpp>

namespace rastrum::raster {

/// Boxes in px² from which on a piece is for a warp, and for blocks of threads.
struct DeviceSizes {
  std::uint64_t small_px = 128, large_px = 4000;

  /// Asked for by a caller; 0: as above. A small piece's fragments are counted in 16 bits, at all
  /// samples.
  static DeviceSizes of(const Tuning& tuning, int samples = 1) {
    DeviceSizes s;
    if (tuning.small_px > 0)
      s.small_px = std::min(static_cast<std::uint64_t>(tuning.small_px),
                            std::uint64_t{4096} / static_cast<std::uint64_t>(samples));
    if (tuning.large_px > 0) s.large_px = static_cast<std::uint64_t>(tuning.large_px);
    return s;
  }
};

namespace cuda_detail {

/// Draws the small pieces of a primitive and counts the others.
struct DrawSmall {
  Assembly assembly;
  DeviceSurface surface;
  std::uint64_t small_px;
  std::uint32_t skip;
  RASTRUM_HD Outcome operator()(std::size_t i) const {
    int fragments = 0;
    std::uint8_t larger = 0;
    Outcome out = assembly.assemble(i, [&](const Piece& piece) {
      if ((piece.flags & skip) != 0) return;
      if (area_of(surface.bounds(piece)) > small_px)
        ++larger;
      else
        surface.each_sample(piece, surface.view, [&](int s, const Piece& seen, Rect box) {
          fragments += draw_by_thread(surface, seen, box, s);
        });
    });
    out.fragments = static_cast<std::uint16_t>(fragments);
    out.pieces = larger;
    return out;
  }
};
struct IsLarger {
  DeviceSurface surface;
  std::uint64_t than_px;
  RASTRUM_HD bool operator()(const Piece& piece) const {
    return area_of(surface.bounds(piece)) > than_px;
  }
};

struct DrawMiddle {
  std::span<const Piece> pieces;
  DeviceSurface surface;
  std::uint64_t large_px;
  std::uint64_t* fragments;
  template <class Team>
  RASTRUM_HD void operator()(std::size_t i, TeamMasks& shared, const Team& team) const {
    const Piece& piece = pieces[i];
    if (area_of(surface.bounds(piece)) >= large_px) return;
    surface.each_sample(piece, surface.view, [&](int s, const Piece& seen, Rect box) {
      draw_by_team(surface, seen, box, fragments, shared, team, s);
    });
  }
};

/// How many tiles a large piece touches; 0 of one that is not.
struct CountTiles {
  DeviceSurface surface;
  std::uint64_t large_px;
  RASTRUM_HD std::size_t operator()(const Piece& piece) const {
    const Rect box = surface.bounds(piece);
    if (area_of(box) < large_px) return 0;
    return static_cast<std::size_t>(area_of(tiles_of(box, surface.view)));
  }
};
template <class Places>
struct DrawTile {
  std::span<const Piece> pieces;
  DeviceSurface surface;
  Places places;
  std::uint64_t* fragments;
  template <class Team>
  RASTRUM_HD void operator()(std::size_t i, TeamMasks& shared, const Team& team) const {
    const std::size_t k = places.segment_of(i);
    const Piece& piece = pieces[k];
    const Rect view = surface.view;
    const Rect tiles = tiles_of(surface.bounds(piece), view);
    const int j = static_cast<int>(i - places.first(k)), columns = tiles.x1 - tiles.x0;
    const int x0 = view.x0 + (tiles.x0 + j % columns) * kDeviceTile;
    const int y0 = view.y0 + (tiles.y0 + j / columns) * kDeviceTile;
    const Rect tile = common_of(view, {x0, y0, x0 + kDeviceTile, y0 + kDeviceTile});
    surface.each_sample(piece, tile, [&](int s, const Piece& seen, Rect part) {
      if (may_touch(edges_of(seen), part))
        draw_by_team(surface, seen, part, fragments, shared, team, s);
    });
  }
};

}  // namespace cuda_detail

/// SurfaceDrawer, for one sample a pixel or several. Counters: "batches", "larger pieces", "tile
/// pairs".
class BySize final : public SurfaceDrawer {
 public:
  [[nodiscard]] Kind kind() const override {
    return {.rasterizer = "by-size",
            .visibility = "atomic",
            .why = "cuda has by-size: a thread, a warp or blocks of threads a triangle",
            .has_samples = true};
  }

  [[nodiscard]] DeviceCounts draw(parallel::Cuda& exec, const DeviceScene<parallel::Cuda>& scene,
                                  const DeviceSurface& surface, const DevicePlan& plan,
                                  const Tuning& tuning, std::uint32_t skip,
                                  const FragmentColors& /*colors*/) override {
    using parallel::view_of;
    const DeviceSizes sizes = DeviceSizes::of(tuning, surface.samples.count);
    DeviceCounts counts;
    const std::uint64_t end = scene.first_id() + scene.primitives();
    auto fragments = parallel::make_buffer<std::uint64_t>(exec, 1);
    parallel::tabulate(exec, fragments, parallel::range_detail::SameValue<std::uint64_t>{0});
    for (std::uint64_t first = scene.first_id(); first < end; first += plan.batch) {
      parallel::throw_if_stopped();
      ++batches_;
      const Assembly assembly{scene.geometry(), first, surface.samples};
      const auto n = static_cast<std::size_t>(std::min(plan.batch, end - first));
      auto outcomes = parallel::make_buffer<Outcome>(exec, n);
      parallel::tabulate(exec, outcomes,
                         cuda_detail::DrawSmall{assembly, surface, sizes.small_px, skip});
      const Outcomes sum = parallel::reduce(exec, outcomes, Outcomes{}, AddOutcomes{});
      check_valid(sum);
      counts.sum = AddOutcomes{}(counts.sum, sum);
      if (sum.pieces == 0) continue;

      const auto larger =
          parallel::filter(exec, parallel::counting<std::uint32_t>(n),
                           cuda_detail::HasPieces{view_of(std::as_const(outcomes))});
      for (std::size_t at = 0; at < larger.size(); at += plan.written) {
        const std::span<const std::uint32_t> which =
            view_of(larger).subspan(at, std::min(plan.written, larger.size() - at));
        const auto pieces = write_pieces(
            exec, assembly, which, parallel::permuted(view_of(std::as_const(outcomes)), which),
            cuda_detail::IsLarger{surface, sizes.small_px});
        draw_larger(exec, surface, sizes, view_of(pieces), fragments.data());
      }
    }
    counts.fragments = counts.sum.fragments + parallel::to_host(exec, fragments)[0];
    return counts;
  }

  void begin_frame() override { batches_ = larger_pieces_ = tiles_ = 0; }
  void end_frame(FrameStats& stats) const override {
    stats.counters.insert(
        stats.counters.end(),
        {{"batches", batches_}, {"larger pieces", larger_pieces_}, {"tile pairs", tiles_}});
  }

 private:
  void draw_larger(parallel::Cuda& exec, const DeviceSurface& surface, DeviceSizes sizes,
                   std::span<const Piece> pieces, std::uint64_t* fragments) {
    parallel::for_each_team<TeamMasks, 32>(
        exec, pieces.size(), cuda_detail::DrawMiddle{pieces, surface, sizes.large_px, fragments});
    const auto tiles =
        parallel::make_expansion(exec, pieces, cuda_detail::CountTiles{surface, sizes.large_px});
    parallel::for_each_team<TeamMasks, 128>(
        exec, tiles.size(),
        cuda_detail::DrawTile<decltype(tiles.view())>{pieces, surface, tiles.view(), fragments});
    larger_pieces_ += pieces.size();
    tiles_ += tiles.size();
  }

  std::uint64_t batches_ = 0, larger_pieces_ = 0, tiles_ = 0;
};

}  // namespace rastrum::raster
