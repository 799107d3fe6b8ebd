// SPDX-License-Identifier: BSD-3-Clause
// A prepared mesh: its triangles along a curve through space, cut into clusters with their own
// vertices and bounds of place and direction.
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

struct MeshCluster {
  /// With half as many, a frame tests twice as many boxes; with twice as many, it leaves out fewer
  /// (docs/log/prepared.md).
  static constexpr std::uint32_t kTriangles = 128;
  static constexpr std::uint32_t kVertices = 256;  ///< so that 8 bits tell them apart

  Vec3 min{}, max{};  ///< of its vertices, object space
  /// The triangles' unit normals lie within this angle of `axis`; cosine −1: any.
  Vec3 axis{};
  float cosine = -1, sine = 0;
  /// Bounds of the triangles' least height (twice the area over the longest edge; not of triangles
  /// with two equal corners) and longest edge.
  float least_height = 0, longest_edge = 0;
  std::uint32_t first_triangle = 0, first_vertex = 0;
  std::uint16_t triangles = 0, vertices = 0;
  bool finite = false;  ///< else nothing is known, and it is always drawn
};

struct MeshClusters {
  /// Clusters in a row that share a box.
  static constexpr std::size_t kNode = 32;

  /// For tests with small meshes.
  struct Way {
    std::uint32_t triangles = MeshCluster::kTriangles;  ///< of a cluster at most
    /// Draw by clusters also if a batch of setup holds the mesh, and look for hidden clusters in
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
  /// Boxes of kNode clusters each, and of all; not finite if a cluster is not.
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
  /// Whether `other` is the prepared mesh, by a few of its values (all without NDEBUG).
  [[nodiscard]] bool is_of(const MeshView& other) const;
  /// The place here of the first triangle that has changed; triangle.size(): none. O(triangles).
  [[nodiscard]] std::size_t first_changed() const;

 private:
  /// Whether the triangle at a place here still has its vertices and positions.
  [[nodiscard]] bool is_as_it_was(const MeshCluster& cluster, std::size_t place) const;
};

}  // namespace rastrum
