// SPDX-License-Identifier: BSD-3-Clause
// The scenes of the benchmarks. Each is one mesh without materials, and its area-weighted vertex
// normals share the positions' indices, so that every peer takes the same arrays.
#pragma once

#include <string_view>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::bench {

struct SceneInfo {
  std::string_view name;
  /// A file under the shared data, or a procedural shape's specification.
  std::string_view file, shape;
  int subdivide = 0;  ///< times each triangle is split in 4
  bool soup = false;  ///< triangles that share no edges
};

/// The scenes of `bench peers`, small to large.
[[nodiscard]] const std::vector<SceneInfo>& peer_scenes();
/// The scenes of `bench transparency`, small to large: those of paper 4 that are available, then
/// scientific ones.
[[nodiscard]] const std::vector<SceneInfo>& transparency_scenes();
/// Scenes that replace the shared data if it is absent.
[[nodiscard]] const std::vector<SceneInfo>& procedural_scenes();
/// Scenes so large that they are drawn only by name.
[[nodiscard]] const std::vector<SceneInfo>& largest_scenes();
/// Throws Error{invalid_argument}, which lists the names.
[[nodiscard]] const SceneInfo& scene_by_name(std::string_view name);

/// The geometry of a scene's instances as one mesh, in order of submission, without attributes.
/// Throws Error{unsupported} beyond 2³² vertices.
[[nodiscard]] Mesh flatten(const Scene& scene);

/// Whether the scene's data is here; always true for shapes.
[[nodiscard]] bool available(const SceneInfo& scene);
/// Reads or makes the scene. Throws Error if its file is absent or broken.
[[nodiscard]] Mesh load(const SceneInfo& scene);
/// The same with all that the file has: instances, materials, textures, its own normals.
[[nodiscard]] Scene load_whole(const SceneInfo& scene);

/// Cameras inside a hall, along the longer side of its box at a third of its height, looking ahead
/// and around.
[[nodiscard]] std::vector<Camera> walk(const SceneView& scene, int steps);

}  // namespace rastrum::bench
