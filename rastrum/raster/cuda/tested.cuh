// SPDX-License-Identifier: BSD-3-Clause
// Pieces with a fragment test on a device: keys of the fragments that pass, by the 8 × 8 blocks of
// a piece's box. A fragment behind the present key is not tested. A maximum of keys does not depend
// on order. Pieces come from a queue that the others' drawer filled (left_pieces.cuh), without the
// host waiting. Without a queue, or if it was too small, a listing makes them by batches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <rastrum/parallel/cuda/expand.cuh>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/cover.cuh>
#include <rastrum/raster/cuda/left_pieces.cuh>
#include <rastrum/raster/cuda/pieces.cuh>
#include <rastrum/raster/cuda/split.cuh>
#include <rastrum/raster/cuda/surface_drawer.cuh>
#include <rastrum/stop.hpp>

namespace rastrum::raster {
namespace cuda_detail {

/// Whether a piece is tested and touches `view`.
struct IsTestedIn {
  Rect view;
  std::uint32_t skip;
  RASTRUM_HD bool operator()(const Piece& piece) const {
    return (piece.flags & kMayDrop) != 0 && (piece.flags & skip) == 0 &&
           !piece_bounds(piece, view).empty();
  }
};
struct BlocksOfBox {
  Rect view;
  RASTRUM_HD std::size_t operator()(const Piece& piece) const {
    return static_cast<std::size_t>(BlocksOf(piece_bounds(piece, view)).count());
  }
};
/// Puts the fragments of block (bx, by) that the test keeps; `box`: the piece's in the view.
/// Returns their number before the test.
template <class Test>
RASTRUM_HD std::uint64_t draw_tested_block(const DeviceSurface& surface, const Test& test,
                                           const Piece& piece, Rect box, int bx, int by) {
  const std::uint64_t mask = cover_box(edges_of(piece), box, bx, by);
  for (std::uint64_t m = mask; m != 0; m &= m - 1) {
    const int i = parallel::lowest_bit(m);
    const std::size_t at = surface.keys.index(bx, by) * 64 + static_cast<std::size_t>(i);
    if (surface.overdraw != nullptr) parallel::atomic_add(surface.overdraw[at], 1U);
    const std::uint64_t key = DeviceSurface::key(piece, bx, by, i);
    // Others may raise it meanwhile: an old key only costs one more test.
    if (key > surface.keys.keys[at] &&
        test(key, bx * kBlockSize + i % kBlockSize, by * kBlockSize + i / kBlockSize))
      parallel::atomic_maximum(surface.keys.keys[at], key);
  }
  return static_cast<std::uint64_t>(parallel::popcount(mask));
}
template <class Test>
struct DrawTested {
  DeviceSurface surface;
  Test test;
  std::uint64_t* fragments;
  RASTRUM_HD void operator()(std::size_t, const Piece& piece, std::size_t j) const {
    const Rect box = piece_bounds(piece, surface.view);
    const BlocksOf blocks(box);
    const int bx = blocks.bx(static_cast<int>(j)), by = blocks.by(static_cast<int>(j));
    const std::uint64_t count = draw_tested_block(surface, test, piece, box, bx, by);
    if (count != 0) parallel::add_to_sum(*fragments, count);
  }
};

/// For visit_blocks.
template <class Test>
struct VisitTested {
  DeviceSurface surface;
  Test test;
  IsTestedIn keep;
  std::span<const Piece> pieces;
  std::uint64_t* fragments;

  struct Local {
    std::uint64_t fragments = 0;
  };
  RASTRUM_HD std::uint64_t blocks(std::uint32_t i) const {
    if (!keep(pieces[i])) return 0;
    return static_cast<std::uint64_t>(BlocksOf(piece_bounds(pieces[i], surface.view)).count());
  }
  RASTRUM_HD void operator()(std::uint32_t i, std::size_t j, Local& local) const {
    const Rect box = piece_bounds(pieces[i], surface.view);
    const BlocksOf blocks(box);
    const int bx = blocks.bx(static_cast<int>(j)), by = blocks.by(static_cast<int>(j));
    local.fragments += draw_tested_block(surface, test, pieces[i], box, bx, by);
  }
  RASTRUM_HD void end(const Local& local) const {
    parallel::add_to_sum(*fragments, local.fragments);
  }
};

}  // namespace cuda_detail

/// Draws the pieces of `scene` that have one of kMayDrop, and no flag of `skip`, onto the keys of
/// `surface` where test(key, x, y) holds. Returns the number of fragments before the test. The
/// SurfaceDrawer counts the primitives' fates and the frame checks them. Memory as for draw(). Work
/// O(primitives + blocks of boxes + fragments). Waits.
template <class Exec, class Test>
[[nodiscard]] std::uint64_t draw_tested(Exec& exec, const DeviceScene<Exec>& scene,
                                        const DeviceSurface& surface, const DeviceSplit& split,
                                        std::uint32_t skip, const Test& test) {
  using parallel::view_of;
  const std::uint64_t end = scene.first_id() + scene.primitives();
  const cuda_detail::IsTestedIn keep{surface.view, skip};
  auto fragments = parallel::make_buffer<std::uint64_t>(exec, 1);
  parallel::clear(exec, fragments);
  for (std::uint64_t first = scene.first_id(); first < end; first += split.batch) {
    throw_if_stopped();
    const Assembly assembly{scene.geometry(), first};
    const auto n = static_cast<std::size_t>(std::min(split.batch, end - first));
    auto outcomes = parallel::make_buffer<Outcome>(exec, n);
    parallel::tabulate(exec, outcomes,
                       cuda_detail::CountPieces<cuda_detail::IsTestedIn>{assembly, keep});
    const auto tested = parallel::filter(exec, parallel::counting<std::uint32_t>(n),
                                         cuda_detail::HasPieces{view_of(std::as_const(outcomes))});
    for (std::size_t at = 0; at < tested.size(); at += split.written) {
      const std::span<const std::uint32_t> which =
          view_of(tested).subspan(at, std::min(split.written, tested.size() - at));
      const auto pieces = write_pieces(
          exec, assembly, which, parallel::permuted(view_of(std::as_const(outcomes)), which), keep);
      const std::span<const Piece> drawn = view_of(pieces);
      const auto blocks =
          parallel::make_expansion(exec, drawn, cuda_detail::BlocksOfBox{surface.view});
      parallel::expand_each(exec, blocks, drawn,
                            cuda_detail::DrawTested<Test>{surface, test, fragments.data()});
    }
  }
  return parallel::to_host(exec, fragments)[0];
}

/// For the pieces of a queue: all of them, or none if some are missing. Adds to the BandSums at
/// `sums`. Does not wait.
template <class Test>
void draw_tested(parallel::Cuda& exec, const DeviceSurface& surface, const LeftPieces& left,
                 std::uint32_t skip, const Test& test, std::uint64_t* sums) {
  const std::span<const Piece> pieces = left.pieces;
  visit_blocks(exec, left,
               cuda_detail::VisitTested<Test>{
                   surface, test, {surface.view, skip}, pieces, sums + kFragmentsSum},
               sums + kRunsSum, sums + kHeldSum);
}

}  // namespace rastrum::raster
