// SPDX-License-Identifier: BSD-3-Clause
// Checks of arrays of meshes, points and lines. They return a message, to which callers add the
// array's owner; empty: no problem.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <rastrum/mesh.hpp>
#include <rastrum/points_and_lines.hpp>

namespace rastrum {

/// For an array that does not have `wanted` values.
[[nodiscard]] std::string count_problem(std::size_t values, const std::string& array,
                                        std::size_t wanted, const char* elements);

/// For more positions than can be numbered.
[[nodiscard]] std::string positions_problem(std::size_t positions);

/// For a material's number out of range. Without materials only 0 is valid.
[[nodiscard]] std::string material_problem(std::uint32_t material, std::size_t materials);

/// For bad faces or a bad number of positions or corners. O(offsets).
[[nodiscard]] std::string faces_problem(const MeshView& mesh);

/// For bad sizes of arrays or bad offsets, not for indices of positions. O(offsets).
[[nodiscard]] std::string arrays_problem(const PointsView& points);
[[nodiscard]] std::string arrays_problem(const LinesView& lines);

/// The place of the first index that is not < `size`; indices.size() if all are. O(indices).
[[nodiscard]] std::size_t first_beyond(const IndexView& indices, std::size_t size);
/// Likewise for the indices [begin, end); `end` if there is none.
[[nodiscard]] std::size_t first_beyond(const IndexView& indices, std::size_t size,
                                       std::size_t begin, std::size_t end);

}  // namespace rastrum
