// SPDX-License-Identifier: BSD-3-Clause
// Splits a device's frame into bands of rows and batches of primitives, so that its memory stays
// below a limit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/raster/cuda/cover.cuh>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/projection.hpp>
#include <rastrum/raster/setup/assemble.hpp>

namespace rastrum::raster {

struct DeviceSplit {
  bool project_first = true;
  int band_rows = 0;             ///< whole tiles
  std::uint64_t batch = 0;       ///< primitives set up at once
  std::uint64_t written = 0;     ///< those with larger pieces, whose pieces exist at once
  std::uint64_t turn_bytes = 0;  ///< for blocks and what makes them (SurfaceDrawer); 0: any
  /// Room of by-size's queues: pieces for teams, tiles of large ones.
  std::uint64_t queued_pieces = 0, queued_tiles = 0;
  std::uint64_t left_pieces = 0;  ///< room of LeftPieces
  std::uint64_t left_bytes = 0;   ///< for what is made of them, twice; 0: any

  /// `limit`: bytes, 0: any. `pixel_bytes`: kept for a pixel beside its key. `left`: the number of
  /// primitives with pieces left to others. Throws Error{out_of_memory} if even the least band does
  /// not fit.
  static DeviceSplit of(std::uint64_t limit, int width, int height, std::uint64_t primitives,
                        std::uint64_t vertices, std::uint64_t pixel_bytes, std::uint64_t left = 0) {
    constexpr std::uint64_t kLargestBatch = std::uint64_t{1} << 28;
    constexpr std::uint64_t kLeastShare = std::uint64_t{1} << 19;
    // Full queues cost time: the finding thread draws what does not fit. Few of a picture's pieces
    // are for teams, but in a picture of few pieces all may be.
    constexpr std::uint64_t kPieces = std::uint64_t{1} << 16, kTiles = std::uint64_t{1} << 20;
    // An outcome, its place and CUB's flags, or a place in by-size's queue of primitives; the
    // pieces of a primitive and their places.
    constexpr std::uint64_t kSetUpBytes = 24, kWrittenBytes = kMaxPieces * (sizeof(Piece) + 8) + 16;
    DeviceSplit p;
    p.band_rows = (height + kDeviceTile - 1) / kDeviceTile * kDeviceTile;
    p.batch = p.written = std::clamp<std::uint64_t>(primitives, 1, kLargestBatch);
    p.queued_pieces = kPieces + p.batch / 8;
    p.queued_tiles = kTiles;
    // Only clipped primitives have several pieces. 32 bits number the pieces.
    constexpr std::uint64_t kMostLeft = std::uint64_t{1} << 31;
    if (left > 0) p.left_pieces = std::min(left + left / 8 + 1024, kMostLeft);
    if (limit == 0) return p;
    const auto columns = static_cast<std::uint64_t>(block_columns({0, 0, width, 1}));
    const std::uint64_t least_band =
        columns * kBlockSize * kDeviceTile * (sizeof(std::uint64_t) + pixel_bytes);
    const std::uint64_t least = std::max(least_band, kLeastShare) + 3 * kLeastShare;
    if (limit < least)
      throw Error(Errc::out_of_memory,
                  std::string("a memory limit of ")
                      .append(std::to_string(limit))
                      .append(" bytes is less than the ")
                      .append(std::to_string(least))
                      .append(" that this frame needs at least on the device"));
    const std::uint64_t band_share = std::max(limit / 4, least_band);
    const std::uint64_t share = (limit - band_share) / 3;
    p.project_first = vertices * sizeof(ProjectedVertex) <= share;
    p.band_rows = static_cast<int>(std::min<std::uint64_t>(
        band_share / least_band * kDeviceTile, static_cast<std::uint64_t>(p.band_rows)));
    p.batch = std::min(p.batch, share / kSetUpBytes);
    p.written = std::min(p.written, share / 2 / kWrittenBytes);
    p.queued_pieces = std::min(p.queued_pieces, share / 2 / sizeof(Piece));
    p.queued_tiles = std::min(p.queued_tiles, share / 2 / sizeof(std::uint64_t));
    p.turn_bytes = share / 2;
    // While the queue is filled the batch takes a sixth of its share. While it is walked only the
    // vertices' share is in use.
    p.left_pieces = std::min(p.left_pieces, share / 2 / sizeof(Piece));
    p.left_bytes = share / 2;
    return p;
  }
};

}  // namespace rastrum::raster
