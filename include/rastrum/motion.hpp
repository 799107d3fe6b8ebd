// SPDX-License-Identifier: BSD-3-Clause
// Animations of a file, and the scene as it is posed at a moment of them. A file is read once and
// posed as often as asked; parts that do not move are not touched.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <rastrum/held.hpp>
#include <rastrum/mat.hpp>

namespace RASTRUM_API rastrum {

struct RASTRUM_INSIDE Rig;  // nodes, skins, morph targets, key frames; as a reader left them
struct Scene;

struct Animation {
  std::string name{};
  double duration_s = 0;  ///< the time of the last key
};

/// How the part of a scene that came from one file moves. Readers make it; Scene::append and
/// Scene::place keep it right. Copies share the rig, which never changes.
struct Motion {
  std::vector<Animation> animations{};  ///< if empty, there is a pose at rest alone
  Shared<const Rig> rig{};
  Mat4d to_world = Mat4d::identity();  ///< places all of the file but its cameras
  /// Where the file's meshes, instances, cameras and lights begin in the scene.
  std::uint32_t first_mesh = 0, first_instance = 0, first_camera = 0, first_light = 0;
};

/// Poses what moves in `scene` as it is `seconds` into animation `animation` of its file, counted
/// from 0. Files that have fewer animations are posed at rest. An animation that has ended begins
/// again: its moment is `seconds` less whole durations, in (0, duration]. `seconds` ≤ 0 is its
/// start.
///
/// It writes matrices of instances, cameras, lights, and the positions and normals of meshes with
/// skins or morph targets, in float64 and rounded once: the same bits on every machine. Such a mesh
/// keeps its triangles and sizes; if its file has no normals, it has none afterwards. Views of the
/// scene's instances (SceneBinding) must be made again; views of its arrays stay valid.
///
/// Returns the indices of the meshes that were written, rising. Cost: O(nodes + tracks · log keys)
/// and, for each vertex of these meshes, its joints and the targets whose weight is not 0. Throws
/// Error{invalid_argument} if `seconds` is not finite, or if the scene moves but no file has this
/// animation.
std::vector<std::uint32_t> pose(Scene& scene, double seconds, std::size_t animation = 0);

/// Poses the scene at rest, without an animation: nodes and weights as they stand in the files. It
/// writes, returns and costs what pose() does.
std::vector<std::uint32_t> pose_at_rest(Scene& scene);

}  // namespace rastrum
