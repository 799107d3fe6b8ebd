// SPDX-License-Identifier: BSD-3-Clause
// Triangles of a frame to pieces, by batches: vertices (projected here or before), the SIMD setup
// kernel, and the clipper for the few that need it.
#pragma once

#include <cstdint>
#include <span>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/context/frame_context.hpp>
#include <rastrum/raster/setup/quadric_store.hpp>

namespace rastrum::raster {

/// Whether a draw's vertices are projected all at once when its triangles are set up. A million
/// instances of a small mesh then keep no vertices.
[[nodiscard]] inline bool is_projected_at_once(const Draw& draw) {
  return draw.has_kernel() && draw.source.has_positions() && draw.own_primitives() <= kSetupBatch &&
         draw.own_vertices() <= 3 * draw.own_primitives();
}
/// Whether vertices are projected in setup, not before. Points' vertices are, since each is read
/// once.
[[nodiscard]] inline bool is_projected_in_setup(const Draw& draw) {
  return draw.points != nullptr || is_projected_at_once(draw);
}

/// The pieces of a run of triangles, in submission order, but a batch's clipped triangles come
/// last.
struct Pieces {
  explicit Pieces(MemoryAccount& memory) : data(memory), quadrics(memory) {}

  ScratchBuffer<Piece> data;
  QuadricStore quadrics;  ///< the pieces refer to them
  std::uint32_t count = 0;
  FrameStats::Triangles triangles;

  [[nodiscard]] std::span<const Piece> span() const { return {data.data(), count}; }
  void restart() {
    count = 0;
    triangles = {};
    quadrics.restart();
  }
  /// Adds a piece, and keeps its quadric.
  void add(const Piece& piece);
  /// Bytes of the pieces' quadrics.
  [[nodiscard]] std::size_t quadric_bytes() const;
};

/// Takes fragments of micro triangles, by batches of setup.
class MicroSink {
 public:
  virtual ~MicroSink() = default;
  /// Room for `n` fragments; call `written` with the number written.
  virtual BinFragment* room(std::size_t n) = 0;
  virtual void written(std::size_t n) = 0;
  /// The same for small triangles, with room for four of each of kSetupBatch; null: they become
  /// pieces.
  virtual BinTriangle* small_room() { return nullptr; }
  virtual void small_written(std::size_t) {}
};

struct SetupRun {
  static constexpr std::uint32_t kPlain = ~0U;
  /// The id of the first of `count` consecutive triangles. For a cluster: the id of triangle 0 of
  /// its copy of the mesh.
  std::uint64_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t cluster = kPlain;
};

struct SetUpWay {
  MicroSink* micro = nullptr;  ///< takes fragments of micro triangles and points
  BinNumbers bins;             ///< of small triangles
  bool defers = false;         ///< quadrics become deferred pieces where possible
  /// With several samples: a triangle without clipping becomes one piece for all (kAllSamples) and
  /// no fragments; fragments of points are for all samples.
  bool together = false;
};

/// Sets up triangles [first, last), maybe of several draws, behind those in `pieces`: a piece for
/// each sample. Returns whether all indices were in range; if not, pieces are missing.
[[nodiscard]] bool set_up(const FrameContext& frame, std::uint64_t first, std::uint64_t last,
                          Pieces& pieces, const SetUpWay& way = {});
/// For runs. Runs of clusters put projected vertices where shading finds them.
[[nodiscard]] bool set_up(const FrameContext& frame, std::span<const SetupRun> runs, Pieces& pieces,
                          const SetUpWay& way = {});

/// Adds the counts of a group to the frame's statistics, once for all bands.
void count_triangles(FrameContext& frame, const FrameStats::Triangles& triangles);

}  // namespace rastrum::raster
