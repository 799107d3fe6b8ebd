// SPDX-License-Identifier: BSD-3-Clause
// From triangles of a frame to pieces, batch by batch: vertices (projected beforehand or here),
// the SIMD setup kernel, and the clipper for the few that need it.
#pragma once

#include <cstdint>
#include <span>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/context/frame_context.hpp>
#include <rastrum/raster/setup/quadric_store.hpp>

namespace rastrum::raster {

/// Whether a draw's vertices are projected when its triangles are set up, all at once: a million
/// instances of a small mesh then keep no vertices.
[[nodiscard]] inline bool is_projected_at_once(const Draw& draw) {
  return draw.has_kernel() && draw.source.has_positions() && draw.own_primitives() <= kSetupBatch &&
         draw.own_vertices() <= 3 * draw.own_primitives();
}
/// Whether its vertices are projected there rather than before. So are those of points, each of
/// which is asked for once.
[[nodiscard]] inline bool is_projected_in_setup(const Draw& draw) {
  return draw.points != nullptr || is_projected_at_once(draw);
}

/// The pieces of a run of triangles, in submission order except that a batch's clipped triangles
/// come behind the others.
struct Pieces {
  explicit Pieces(MemoryAccount& memory) : data(memory), quadrics(memory) {}

  ScratchBuffer<Piece> data;
  QuadricStore quadrics;  ///< that the pieces refer to
  std::uint32_t count = 0;
  FrameStats::Triangles triangles;

  [[nodiscard]] std::span<const Piece> span() const { return {data.data(), count}; }
  void restart() {
    count = 0;
    triangles = {};
    quadrics.restart();
  }
  /// Adds a piece, and keeps what it refers to.
  void add(const Piece& piece);
  /// How many bytes the quadrics take that the pieces refer to.
  [[nodiscard]] std::size_t quadric_bytes() const;
};

/// Takes the fragments of micro triangles, a setup batch at a time.
class MicroSink {
 public:
  virtual ~MicroSink() = default;
  /// Room for `n` fragments; how many of them were written.
  virtual BinFragment* room(std::size_t n) = 0;
  virtual void written(std::size_t n) = 0;
  /// The same for small triangles, room for four of each of kSetupBatch; null: they become pieces.
  virtual BinTriangle* small_room() { return nullptr; }
  virtual void small_written(std::size_t) {}
};

/// Triangles that are set up together.
struct SetupRun {
  static constexpr std::uint32_t kPlain = ~0U;
  /// The id of the first triangle, which `count` less one follow. For a cluster, the id of triangle
  /// 0 of its copy of the mesh.
  std::uint64_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t cluster = kPlain;
};

struct SetUpWay {
  MicroSink* micro = nullptr;  ///< micro triangles and points become its fragments
  BinNumbers bins;             ///< of its small triangles
  bool defers = false;         ///< quadrics become deferred pieces where they can
  /// For several samples: triangles that are not clipped become one piece for all of them
  /// (kAllSamples), and none becomes fragments; fragments of points are of all samples.
  bool together = false;
};

/// Sets up triangles [first, last), which may span draws, behind those that `pieces` holds: a piece
/// for each sample. Returns whether all indices were in range; where not, the pieces are
/// incomplete.
[[nodiscard]] bool set_up(const FrameContext& frame, std::uint64_t first, std::uint64_t last,
                          Pieces& pieces, const SetUpWay& way = {});
/// The same for runs. Runs of clusters put their projected vertices where shading finds them.
[[nodiscard]] bool set_up(const FrameContext& frame, std::span<const SetupRun> runs, Pieces& pieces,
                          const SetUpWay& way = {});

/// Adds the counts of a group's triangles to the frame's statistics, once for all bands.
void count_triangles(FrameContext& frame, const FrameStats::Triangles& triangles);

}  // namespace rastrum::raster
