// A mesh made ready for many frames: clusters of neighbouring triangles, which a frame leaves out
// where nothing of them can be seen. No picture changes by a bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <rastrum/mesh.hpp>

namespace rastrum {

/// Draws as the mesh that it was made of: the same bits, ids and order of submission. Frames cost
/// what is near the picture and not behind anything; their whole cost is in docs/performance.md.
///
/// It keeps a copy of positions and triangles (about 20 bytes a triangle) for coverage, and borrows
/// the caller's arrays, which shading reads. They must outlive it and stay as they are: who changes
/// positions or indices prepares again, attributes may change. A frame compares where arrays lie,
/// their sizes and a few of their values with what was prepared, in a library built without NDEBUG
/// all of them (check()), and throws Error{invalid_argument} where they differ. Copies share what
/// was prepared, and a move is a copy; any number of threads may draw it.
class PreparedMesh {
 public:
  PreparedMesh(const PreparedMesh&) = default;
  PreparedMesh& operator=(const PreparedMesh&) = default;
  /// `threads`: 0: all. Cost: about two frames of the mesh. Throws Error{invalid_argument} for an
  /// index out of range, Error{out_of_memory}.
  explicit PreparedMesh(const MeshView& mesh, int threads = 0);

  /// Compares all positions and indices with those that were prepared, for who looks for a change
  /// that a frame has not seen. Throws Error{invalid_argument} that names the first triangle, in
  /// the order of clusters, that is another one now. O(triangles).
  void check() const;

  /// The mesh, to be drawn by clusters. Valid as long as this or a copy.
  [[nodiscard]] const MeshView& view() const { return view_; }
  [[nodiscard]] std::size_t cluster_count() const;
  /// Of the copy.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  std::shared_ptr<const MeshClusters> clusters_;
  MeshView view_;
};

}  // namespace rastrum
