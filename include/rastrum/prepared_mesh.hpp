// SPDX-License-Identifier: BSD-3-Clause
// A mesh made ready for many frames: clusters of neighbouring triangles, which a frame leaves out
// where nothing of them can be seen. No picture changes by a bit.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/held.hpp>
#include <rastrum/mesh.hpp>

namespace RASTRUM_API rastrum {

/// Draws like the mesh that it was made of, with the same bits, ids and order of submission. A
/// frame pays for the clusters that may be seen; docs/performance.md has the costs.
///
/// It keeps a copy of positions and triangles (about 20 bytes a triangle) for coverage, and borrows
/// the caller's arrays for shading. They must outlive it. Attributes may change, but after a change
/// of positions or indices the mesh must be prepared again. A frame compares the addresses, the
/// sizes and a few values of the arrays with what was prepared (all values in a library built
/// without NDEBUG, as check()), and throws Error{invalid_argument} where they differ. Copies share
/// the clusters, and a move is a copy; any number of threads may draw it.
class PreparedMesh {
 public:
  PreparedMesh(const PreparedMesh&) = default;
  PreparedMesh& operator=(const PreparedMesh&) = default;
  /// `threads`: 0: all. Cost: about two frames of the mesh. Throws Error{invalid_argument} for an
  /// index out of range, Error{out_of_memory}.
  explicit PreparedMesh(const MeshView& mesh, int threads = 0);

  /// Compares all positions and indices with those that were prepared. Throws
  /// Error{invalid_argument} that names the first triangle, in the order of clusters, that has
  /// changed. O(triangles).
  void check() const;

  /// The mesh, to be drawn by clusters: for instances that this outlives, where it is. A copy of
  /// the view is valid as long as this or a copy.
  [[nodiscard]] const MeshView& view() const& { return view_; }
  const MeshView& view() const&& = delete;
  [[nodiscard]] std::size_t cluster_count() const;
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  Shared<const MeshClusters> clusters_;
  MeshView view_;
};

}  // namespace rastrum
