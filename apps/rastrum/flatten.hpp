// SPDX-License-Identifier: BSD-3-Clause
// A scene as one mesh, or one cloud of points, in world space.
#pragma once

#include <string>
#include <vector>

#include <rastrum/scene.hpp>

namespace rastrum::cli {

struct Flattened {
  Mesh mesh;
  Points points;                      ///< if the scene has no triangles
  std::vector<std::string> warnings;  ///< the scene's, and about what the mesh could not keep
};

/// All instances in order of submission: triangle t of the scene is triangle t of the mesh, and
/// vertices stay shared. An attribute is kept if every mesh numbers it as its positions. Throws
/// Error{unsupported} beyond 2³² vertices.
[[nodiscard]] Flattened flatten(Scene scene);

}  // namespace rastrum::cli
