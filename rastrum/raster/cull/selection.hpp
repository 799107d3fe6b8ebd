// SPDX-License-Identifier: BSD-3-Clause
// Which triangles of a frame are set up: all of plain draws, and of prepared meshes the clusters
// that may be visible.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/context/frame_context.hpp>
#include <rastrum/raster/cull/cluster_view.hpp>
#include <rastrum/raster/setup/set_up.hpp>

namespace rastrum::raster {

/// A chosen run, and what the depth test needs to know about it.
struct Candidate {
  static constexpr std::uint64_t kNoSlot = ~std::uint64_t{0};

  SetupRun run;
  std::uint64_t slot = kNoSlot;  ///< its cluster of the frame, or copy of a small mesh
  float highest = 0;             ///< no sample is nearer; infinity: unknown
  bool leans_away = false;       ///< a hint: in a closed surface it is likely hidden
  bool leans = true;             ///< copies do not: leans_away says nothing about them
  std::uint16_t bx0 = 0, by0 = 0, bx1 = 0, by1 = 0;  ///< blocks that it may touch; none: all

  /// False: always drawn.
  [[nodiscard]] bool has_slot() const { return slot != kNoSlot; }
};

/// Joins `next` to the run before it if it continues it, up to the size of a plain run. Returns
/// whether it did.
[[nodiscard]] bool join(SetupRun& before, const SetupRun& next);

/// Leaves out what is outside of the picture or faces away, instances first.
class Selection {
 public:
  explicit Selection(MemoryAccount& memory);
  Selection(Selection&&) = delete;
  ~Selection();

  /// Takes the frame's triangles [first, last). Then slots(), always() and fingerprint() are known.
  void begin(const FrameContext& frame, std::uint64_t first, std::uint64_t last);
  /// Chooses among them, and counts the triangles left out. `copies`: copies of small meshes are
  /// candidates of their own, since some may be hidden.
  void choose(FrameContext& frame, bool copies);
  /// Projects all vertices of a draw where that is faster than cluster by cluster: vertices are
  /// kept, and enough triangles are drawn. `part`: how much of the chosen is drawn.
  void project(const FrameContext& frame, double part) const;
  /// In the order of draws, copies and clusters.
  [[nodiscard]] std::span<const Candidate> candidates() const {
    return {candidates_.data(), count_};
  }
  [[nodiscard]] std::span<const SetupRun> runs();
  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
  /// Clusters, or copies of small meshes, of all draws.
  [[nodiscard]] std::uint64_t slots() const { return slots_; }
  /// Whether some mesh always wants depth tests (MeshClusters::Way).
  [[nodiscard]] bool always() const { return always_; }
  /// Differs for frames of other meshes, as well as a hint needs.
  [[nodiscard]] std::uint64_t fingerprint() const { return fingerprint_; }

 private:
  struct Part;
  struct Found;
  static void choose_of(const FrameContext& frame, Part& part, Found& found, bool copies);

  ScratchBuffer<Candidate> candidates_;
  ScratchBuffer<SetupRun> runs_;
  std::size_t count_ = 0;
  std::uint64_t triangles_ = 0, slots_ = 0, fingerprint_ = 0;
  bool always_ = false;
  std::vector<Part> parts_;
  parallel::ScratchPool<Found> found_;
};

[[nodiscard]] bool has_clusters(const FrameRequest& request);
/// Removes the clusters of draws that cannot be drawn by them.
void keep_clusters(std::span<Draw> draws, bool by_clusters);

}  // namespace rastrum::raster
