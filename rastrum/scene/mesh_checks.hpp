// What can be wrong with the arrays of a mesh, of points and of lines, for who knows whose they
// are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <rastrum/mesh.hpp>
#include <rastrum/points_and_lines.hpp>

namespace rastrum {

/// A message if an array does not have `wanted` values; empty: it has.
[[nodiscard]] std::string count_problem(std::size_t values, const std::string& array,
                                        std::size_t wanted, const char* elements);

/// A message for a material's number that is out of range; empty: it is valid. In a scene without
/// materials only number 0 is.
[[nodiscard]] std::string material_problem(std::uint32_t material, std::size_t materials);

/// A message for bad faces or a bad number of positions or corners; empty: all are valid.
/// O(offsets).
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
