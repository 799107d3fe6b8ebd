// SPDX-License-Identifier: BSD-3-Clause
// Checks of the arrays of meshes, points and lines. They return messages, to which callers add the
// owner of the array.
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

/// A message for more positions than have a number; empty: they have.
[[nodiscard]] std::string positions_problem(std::size_t positions);

/// A message for a material's number that is out of range; empty: it is valid. In a scene without
/// materials only number 0 is.
[[nodiscard]] std::string material_problem(std::uint32_t material, std::size_t materials);

/// A message for bad faces or a bad number of positions or corners; empty: all are valid.
/// O(offsets).
[[nodiscard]] std::string faces_problem(const MeshView& mesh);

/// A message for bad sizes of arrays or bad offsets; empty: all are valid. Indices of positions are
/// not checked. O(offsets).
[[nodiscard]] std::string arrays_problem(const PointsView& points);
[[nodiscard]] std::string arrays_problem(const LinesView& lines);

/// The place of the first index that is not < `size`; indices.size() if all are. O(indices).
[[nodiscard]] std::size_t first_beyond(const IndexView& indices, std::size_t size);
/// The same for the indices [begin, end); returns `end` if there is none.
[[nodiscard]] std::size_t first_beyond(const IndexView& indices, std::size_t size,
                                       std::size_t begin, std::size_t end);

}  // namespace rastrum
