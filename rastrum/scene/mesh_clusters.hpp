// SPDX-License-Identifier: BSD-3-Clause
// The data of a prepared mesh: its triangles along a curve through space, cut into clusters that
// have vertices of their own, and for each cluster where it lies and which way it faces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <vector>

#include <rastrum/mesh.hpp>
#include <rastrum/scene/face_cuts.hpp>

namespace rastrum {

namespace parallel {
class Threads;
}

/// Neighbouring triangles of one material, with bounds that hold for all of them.
struct MeshCluster {
  /// The most triangles. With half as many, a frame tests twice as many boxes; with twice as many,
  /// it leaves out fewer (docs/log/prepared.md).
  static constexpr std::uint32_t kTriangles = 128;
  static constexpr std::uint32_t kVertices = 256;  ///< so that 8 bits tell them apart

  Vec3 min{}, max{};  ///< of its vertices, object space
  /// The unit normals of its triangles lie within the angle of these about `axis`; cosine −1: any.
  Vec3 axis{};
  float cosine = -1, sine = 0;
  /// No triangle's least height is smaller (twice its area over its longest edge, triangles of two
  /// equal corners left out), and no edge longer.
  float least_height = 0, longest_edge = 0;
  std::uint32_t first_triangle = 0, first_vertex = 0;
  std::uint16_t triangles = 0, vertices = 0;
  bool finite = false;  ///< else nothing is known of it, and it is never left out
};

/// The clusters of one mesh.
struct MeshClusters {
  /// How many clusters in a row share a box.
  static constexpr std::size_t kNode = 32;

  /// Options for tests with small meshes.
  struct Way {
    std::uint32_t triangles = MeshCluster::kTriangles;  ///< of a cluster at most
    /// Also draw by clusters if a batch of setup holds the mesh, and look for hidden clusters in
    /// each frame, however few triangles there are.
    bool always = false;
  };

  /// Requires valid faces and indices (check_indices). `threads`: null: one.
  MeshClusters(const MeshView& of, parallel::Threads* threads, Way how);
  MeshClusters(const MeshView& of, parallel::Threads* threads) : MeshClusters(of, threads, Way{}) {}

  std::vector<MeshCluster> clusters;
  std::vector<std::uint32_t> triangle;  ///< of the mesh, by its place here
  std::vector<std::uint8_t> corners;    ///< three a triangle: vertices of its cluster
  std::vector<std::uint32_t> vertex;    ///< of the mesh, by its place here
  std::vector<Vec3> positions;          ///< by place; empty where they are float64:
  std::vector<Vec3d> wide;
  /// Boxes of kNode clusters each, and of all; not finite if one of them is not.
  struct Box {
    Vec3 min{}, max{};
    bool finite = false;
  };
  std::vector<Box> nodes;
  Box all;
  Way way;
  MeshView mesh;  ///< the mesh that was prepared, with its cuts
  std::list<FaceCuts> cuts;

  [[nodiscard]] std::uint64_t bytes() const;
  /// Whether `other` is the prepared mesh, by a few of its values (by all without NDEBUG).
  [[nodiscard]] bool is_of(const MeshView& other) const;
  /// The place here of the first triangle that has changed; triangle.size(): none. O(triangles).
  [[nodiscard]] std::size_t first_changed() const;

 private:
  /// The vertices of the triangle at a place here.
  [[nodiscard]] bool is_as_it_was(const MeshCluster& cluster, std::size_t place) const;
};

}  // namespace rastrum
