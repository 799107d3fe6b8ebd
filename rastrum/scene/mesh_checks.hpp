// What can be wrong with the arrays of a mesh, for who knows whose mesh it is.
#pragma once

#include <cstddef>
#include <string>

#include <rastrum/mesh.hpp>

namespace rastrum {

/// What is wrong with the faces or the number of positions; empty: nothing. O(offsets).
[[nodiscard]] std::string faces_problem(const MeshView& mesh);

/// The place of the first index that is not < `size`; indices.size() where all are. O(indices).
[[nodiscard]] std::size_t first_beyond(const IndexView& indices, std::size_t size);

}  // namespace rastrum
