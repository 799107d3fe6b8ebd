// SPDX-License-Identifier: BSD-3-Clause
// A scene as one mesh, or one cloud of points, in world space, for a format that holds one.
#pragma once

#include <string>
#include <vector>

#include <rastrum/scene.hpp>

namespace rastrum::cli {

struct Flattened {
  Mesh mesh;
  Points points;                      ///< of a scene that has no triangles
  std::vector<std::string> warnings;  ///< the scene's, and what the mesh could not keep
};

/// All instances in order of submission: triangle t of the scene is triangle t of the mesh, and
/// vertices stay shared as they were. Attributes are kept where every mesh has them numbered as its
/// positions are. A scene without triangles becomes its points. Throws Error{unsupported} beyond
/// 2³² vertices.
[[nodiscard]] Flattened flatten(Scene scene);

}  // namespace rastrum::cli
