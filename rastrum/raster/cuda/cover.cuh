// SPDX-License-Identifier: BSD-3-Clause
// Coverage on a device, by size. A thread finds a piece's samples by cover_8x8. A warp or block of
// threads tests its edges, a sample a thread. A warp draws small triangles together, which its
// threads set up one each. Keys are put by atomic maximum. The three sizes come from paper 1's
// hybrid, section 3.3, and paper 2's queue of large triangles.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/parallel/cuda/team.cuh>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/reduce_by_index.hpp>
#include <rastrum/raster/cuda/sample_pattern.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::raster {

/// Side of a tile of large triangles, px.
inline constexpr int kDeviceTile = 64;

/// Where keys go, in device memory. With several samples a pixel each has a plane of keys. Pieces
/// are relative to pixel centres and are moved for a sample when drawn (samples.hpp).
struct DeviceSurface {
  Rect view;  ///< the pixels to draw; starts at a tile's first pixel
  SurfaceView keys;
  std::uint32_t* overdraw =
      nullptr;            ///< fragments of each pixel, placed like the keys; may be null
  std::size_t plane = 0;  ///< from a sample's keys to the next's
  SamplePattern samples{};

  /// The key of `piece` at element i of block (bx, by).
  [[nodiscard]] RASTRUM_HD static std::uint64_t key(const Piece& piece, int bx, int by, int i) {
    const int x = bx * kBlockSize + i % kBlockSize, y = by * kBlockSize + i / kBlockSize;
    return make_key(depth_at(piece, x, y), piece.low);
  }
  /// Puts a fragment of `piece`, which is moved for that sample.
  RASTRUM_HD void put(const Piece& piece, int bx, int by, int i, int sample = 0) const {
    const std::size_t at = keys.index(bx, by) * 64 + static_cast<std::size_t>(i);
    parallel::atomic_maximum(plane_of(sample)[at], key(piece, bx, by, i));
    if (overdraw != nullptr) parallel::atomic_add(overdraw[at], 1U);
  }
  [[nodiscard]] RASTRUM_HD std::uint64_t* plane_of(int sample) const {
    return keys.keys + static_cast<std::size_t>(sample) * plane;
  }
  [[nodiscard]] RASTRUM_HD Rect bounds(const Piece& piece) const {
    return sampled_bounds(piece, view, samples);
  }
  /// Calls f(sample, piece, its box in `part`) for the samples that the piece may cover.
  template <class F>
  RASTRUM_HD void each_sample(const Piece& piece, Rect part, F&& f) const {
    for (int s = 0; s < samples.count; ++s) {
      const Piece seen = moved(piece, samples.at[s]);
      const Rect box = piece_bounds(seen, part);
      if (!box.empty()) f(s, seen, box);
    }
  }
};

[[nodiscard]] RASTRUM_HD inline std::uint64_t area_of(Rect r) {
  return r.empty()
             ? 0
             : static_cast<std::uint64_t>(r.x1 - r.x0) * static_cast<std::uint64_t>(r.y1 - r.y0);
}
[[nodiscard]] RASTRUM_HD inline Rect common_of(Rect a, Rect b) {
  return {a.x0 > b.x0 ? a.x0 : b.x0, a.y0 > b.y0 ? a.y0 : b.y0, a.x1 < b.x1 ? a.x1 : b.x1,
          a.y1 < b.y1 ? a.y1 : b.y1};
}

/// The samples of block (bx, by) inside of the edges and of `box`; tests no others.
[[nodiscard]] RASTRUM_HD inline std::uint64_t cover_box(const Edges& edges, Rect box, int bx,
                                                        int by) {
  const int x0 = bx * kBlockSize, y0 = by * kBlockSize;
  const Rect part = common_of(box, {x0, y0, x0 + kBlockSize, y0 + kBlockSize});
  return cover_8x8(edges, bx, by, {part.x0 - x0, part.y0 - y0, part.x1 - x0, part.y1 - y0});
}

/// The blocks of a box, which is not empty, row by row.
struct BlocksOf {
  int bx0, by0, columns, rows;

  RASTRUM_HD explicit BlocksOf(Rect box)
      : bx0(box.x0 / kBlockSize),
        by0(box.y0 / kBlockSize),
        columns((box.x1 - 1) / kBlockSize - bx0 + 1),
        rows((box.y1 - 1) / kBlockSize - by0 + 1) {}
  [[nodiscard]] RASTRUM_HD int count() const { return columns * rows; }
  [[nodiscard]] RASTRUM_HD int bx(int k) const { return bx0 + k % columns; }
  [[nodiscard]] RASTRUM_HD int by(int k) const { return by0 + k / columns; }
};

/// The tiles of a box, numbered from the view's first.
RASTRUM_HD inline Rect tiles_of(Rect box, Rect view) {
  return {(box.x0 - view.x0) / kDeviceTile, (box.y0 - view.y0) / kDeviceTile,
          (box.x1 - 1 - view.x0) / kDeviceTile + 1, (box.y1 - 1 - view.y0) / kDeviceTile + 1};
}
/// By one thread. Returns the number of fragments. `box`: the piece's in the view, not empty.
RASTRUM_HD inline int draw_by_thread(const DeviceSurface& surface, const Piece& piece, Rect box,
                                     int sample = 0) {
  const Edges edges = edges_of(piece);
  const BlocksOf blocks(box);
  int fragments = 0;
  for (int k = 0; k < blocks.count(); ++k) {
    const int bx = blocks.bx(k), by = blocks.by(k);
    const std::uint64_t mask = cover_box(edges, box, bx, by);
    fragments += parallel::popcount(mask);
    for (std::uint64_t m = mask; m != 0; m &= m - 1)
      surface.put(piece, bx, by, parallel::lowest_bit(m), sample);
  }
  return fragments;
}

/// By a team. Adds the number of fragments to *fragments. `box` as above, the same for all members.
/// A sample a member, so that neighbours write neighbouring keys.
template <class Team>
RASTRUM_HD void draw_by_team(const DeviceSurface& surface, const Piece& piece, Rect box,
                             std::uint64_t* fragments, const Team& team, int sample = 0) {
  const Edges edges = edges_of(piece);
  const BlocksOf blocks(box);
  const auto samples = static_cast<std::size_t>(blocks.count()) * 64;
  std::uint64_t mine = 0;
  for (std::size_t k = team.rank(); k < samples; k += team.size()) {
    const int block = static_cast<int>(k / 64), i = static_cast<int>(k % 64);
    const int bx = blocks.bx(block), by = blocks.by(block);
    const int x = bx * kBlockSize + i % kBlockSize, y = by * kBlockSize + i / kBlockSize;
    if (x < box.x0 || x >= box.x1 || y < box.y0 || y >= box.y1 || !covers_centre(edges, x, y))
      continue;
    surface.put(piece, bx, by, i, sample);
    ++mine;
  }
  parallel::add_to_sum(*fragments, mine);
}

/// Triangles that a team draws together. Their boxes' samples, triangle after triangle, are dealt
/// to the members one by one, so that none waits for the one with the largest.
struct TeamTriangles {
  static constexpr int kCount = 32;
  Piece piece[kCount];
  alignas(16) Edge edge[kCount][3];
  int x0[kCount], y0[kCount], width[kCount];
  /// The number of its box's samples; in draw() their prefix sums.
  std::uint32_t samples[kCount + 1];

  /// Sets triangle k, by one member. `box`: the piece's in the view; if empty, the piece is not
  /// read.
  RASTRUM_HD void set(int k, const Piece& p, Rect box) {
    samples[k] = static_cast<std::uint32_t>(area_of(box));
    if (box.empty()) return;
    piece[k] = p;
    for (int e = 0; e < 3; ++e) edge[k][e] = edge_function(p, e);
    x0[k] = box.x0;
    y0[k] = box.y0;
    width[k] = box.x1 - box.x0;
  }
  /// By all members, after all are set. Returns this member's number of fragments.
  template <class Team>
  RASTRUM_HD std::uint32_t draw(const DeviceSurface& surface, const Team& team) {
    parallel::team_prefix_sums(samples, kCount, team);
    const std::uint32_t all = samples[kCount];
    std::uint32_t fragments = 0;
    for (auto j = static_cast<std::uint32_t>(team.rank()); j < all;
         j += static_cast<std::uint32_t>(team.size())) {
      int k = 0;  // the last whose first sample is not after j
      for (int step = kCount / 2; step > 0; step /= 2)
        if (samples[k + step] <= j) k += step;
      const std::uint32_t at = j - samples[k], across = static_cast<std::uint32_t>(width[k]);
      const int x = x0[k] + static_cast<int>(at % across);
      const int y = y0[k] + static_cast<int>(at / across);
      bool inside = true;
      for (int e = 0; e < 3; ++e) {
        const Edge& of = edge[k][e];
        inside = inside && of.base + std::int64_t{of.a} * x + std::int64_t{of.b} * y >= 0;
      }
      if (!inside) continue;
      surface.put(piece[k], x / kBlockSize, y / kBlockSize,
                  y % kBlockSize * kBlockSize + x % kBlockSize);
      ++fragments;
    }
    return fragments;
  }
};

}  // namespace rastrum::raster
