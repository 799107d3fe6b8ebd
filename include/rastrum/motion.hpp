// SPDX-License-Identifier: BSD-3-Clause
// Motion in a scene: animations of a file, and poses at a moment of them. A file is read once and
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
  double duration_s = 0;  ///< the time of its last key
};

/// How the part of a scene that came from one file moves. Readers make it, Scene::append and
/// Scene::place keep it right. Copies share the rig, which never changes.
struct Motion {
  std::vector<Animation> animations{};  ///< may be empty: a pose at rest alone
  Shared<const Rig> rig{};
  Mat4d to_world = Mat4d::identity();  ///< of all that the file holds, its cameras apart
  /// Where the file's meshes, instances and cameras begin in the scene.
  std::uint32_t first_mesh = 0, first_instance = 0, first_camera = 0, first_light = 0;
};

/// Poses what moves in `scene` as it is `seconds` into animation `animation` of its file, counted
/// from 0; files that have fewer are posed at rest. An animation that has ended begins again: its
/// moment is `seconds` less whole durations, in (0, duration]; 0 and what is before is its start.
///
/// Written are matrices of instances, cameras, and positions and normals of meshes with skins or
/// morph targets: float64, rounded once, the same bits on every machine. Such a mesh keeps its
/// triangles and sizes; where its file has no normals, it has none afterwards. Views of the scene's
/// instances (SceneBinding) must be made again, those of its arrays stay.
///
/// Returns the numbers of the meshes that were written, rising. Cost: O(nodes + keys' logarithms)
/// and, for each vertex of these meshes, its joints and the targets whose weight is not 0. Throws
/// Error{invalid_argument} for `seconds` that are not finite, and where no file of a scene that
/// moves has such an animation.
std::vector<std::uint32_t> pose(Scene& scene, double seconds, std::size_t animation = 0);

/// The same at rest, as files are read: nodes and weights as they stand, without an animation.
std::vector<std::uint32_t> pose_at_rest(Scene& scene);

}  // namespace rastrum
