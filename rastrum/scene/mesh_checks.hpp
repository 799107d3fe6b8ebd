// What can be wrong with the arrays of a mesh, of points and of lines, for who knows whose they
// are.
#pragma once

#include <cstddef>
#include <string>

#include <rastrum/mesh.hpp>
#include <rastrum/points_and_lines.hpp>

namespace rastrum {

/// What is wrong with the faces or the number of positions; empty: nothing. O(offsets).
[[nodiscard]] std::string faces_problem(const MeshView& mesh);

/// What is wrong with the sizes of the arrays, or with offsets; empty: nothing. The indices of
/// positions are not looked at. O(offsets).
[[nodiscard]] std::string arrays_problem(const PointsView& points);
[[nodiscard]] std::string arrays_problem(const LinesView& lines);

/// The place of the first index that is not < `size`; indices.size() where all are. O(indices).
[[nodiscard]] std::size_t first_beyond(const IndexView& indices, std::size_t size);
/// The same of those from `begin` on and before `end`, which is what is returned if there is none.
[[nodiscard]] std::size_t first_beyond(const IndexView& indices, std::size_t size,
                                       std::size_t begin, std::size_t end);

}  // namespace rastrum
