// What `rastrum info FILE` prints.
#pragma once

#include <string>

#include <rastrum/scene/scene.hpp>

namespace rastrum::io {

/// A text of several lines: meshes with their vertices and triangles, instances, bounds, materials,
/// textures, cameras; how many triangles have a vertex that is not finite (the renderer drops them)
/// or no area; the warnings. O(triangles of all instances).
/// Throws Error{invalid_argument} for an index out of range.
[[nodiscard]] std::string describe(const Scene& scene);

}  // namespace rastrum::io
