// SPDX-License-Identifier: BSD-3-Clause
// Which triangles of a frame are set up: all of what is drawn as it comes, and of prepared meshes
// the clusters of which something may be seen.
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

/// A run that passed, and what the test against depths asks of it.
struct Candidate {
  static constexpr std::uint64_t kNoSlot = ~std::uint64_t{0};

  SetupRun run;
  std::uint64_t slot = kNoSlot;  ///< which cluster of the frame it is, or copy of a small mesh
  float highest = 0;             ///< no sample is nearer; infinity: not known
  bool leans_away = false;       ///< as a hint: of a closed surface it is likely to be hidden
  bool leans = true;             ///< copies do not: leans_away says nothing of them
  std::uint16_t bx0 = 0, by0 = 0, bx1 = 0, by1 = 0;  ///< the blocks that it may touch; none: all

  /// False: it is drawn in any case.
  [[nodiscard]] bool has_slot() const { return slot != kNoSlot; }
};

/// Puts `next` into the run before it where it goes on with the same, as far as plain runs go.
/// Returns whether it did.
[[nodiscard]] bool join(SetupRun& before, const SetupRun& next);

/// Chooses the triangles to set up: those outside of the picture or facing away are left out,
/// instances first.
class Selection {
 public:
  explicit Selection(MemoryAccount& memory);
  Selection(Selection&&) = delete;
  ~Selection();

  /// Takes the frame's triangles [first, last). slots(), always() and fingerprint() are known then.
  void begin(const FrameContext& frame, std::uint64_t first, std::uint64_t last);
  /// Chooses among them. Counts the triangles that were left out. `copies`: copies of small meshes
  /// are candidates of their own, since some may be hidden.
  void choose(FrameContext& frame, bool copies);
  /// Projects all vertices of a draw where vertices are kept and so many triangles are drawn, a
  /// `part` of those that were chosen, that it is sooner than cluster by cluster.
  void project(const FrameContext& frame, double part) const;
  /// In the order of draws, copies and clusters.
  [[nodiscard]] std::span<const Candidate> candidates() const {
    return {candidates_.data(), count_};
  }
  /// The runs of all of them.
  [[nodiscard]] std::span<const SetupRun> runs();
  /// How many triangles the candidates have.
  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
  /// How many clusters, or copies of small meshes, the draws have.
  [[nodiscard]] std::uint64_t slots() const { return slots_; }
  /// Whether some mesh wants to be looked behind (MeshClusters::Way).
  [[nodiscard]] bool always() const { return always_; }
  /// Tells frames of other meshes apart, as far as a hint has to.
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

/// Whether some draw goes by clusters.
[[nodiscard]] bool has_clusters(const FrameRequest& request);
/// Takes the clusters from draws that cannot go by them.
void keep_clusters(std::span<Draw> draws, bool by_clusters);

}  // namespace rastrum::raster
