// SPDX-License-Identifier: BSD-3-Clause
// A mesh made ready for many frames: neighbouring triangles form clusters, and a frame leaves out
// the clusters that cannot be seen. No picture changes by a bit.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/held.hpp>
#include <rastrum/mesh.hpp>

namespace RASTRUM_API rastrum {

/// A mesh that draws like the one it was made of, with the same bits, ids and order of submission.
/// A frame pays for the clusters that may be seen; docs/performance.md has the costs.
///
/// It keeps a copy of positions and triangles (about 20 bytes a triangle) for coverage. For shading
/// it borrows the caller's arrays, which must outlive it. Attributes may change; after a change of
/// positions or indices the mesh must be prepared again. A frame compares the addresses, the sizes
/// and a few values of the arrays with what was prepared (all values in a library built without
/// NDEBUG, as check()), and throws Error{invalid_argument} where they differ. Copies share the
/// clusters, and a move is a copy. Any number of threads may draw it.
class PreparedMesh {
 public:
  PreparedMesh(const PreparedMesh&) = default;
  PreparedMesh& operator=(const PreparedMesh&) = default;
  /// `threads` 0: all. Cost: about two frames of the mesh. Throws Error{invalid_argument} for an
  /// index out of range, Error{out_of_memory}.
  explicit PreparedMesh(const MeshView& mesh, int threads = 0);

  /// Compares all positions and indices with those that were prepared. Throws
  /// Error{invalid_argument} that names the first triangle that differs, in the order of clusters.
  /// O(triangles).
  void check() const;

  /// The view that draws by clusters. An instance that refers to it needs this object, unmoved; a
  /// copy of the view is valid as long as this object or a copy of it.
  [[nodiscard]] const MeshView& view() const& { return view_; }
  const MeshView& view() const&& = delete;
  [[nodiscard]] std::size_t cluster_count() const;
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  Shared<const MeshClusters> clusters_;
  MeshView view_;
};

}  // namespace rastrum
