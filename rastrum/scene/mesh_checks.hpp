// What can be wrong with the arrays of a mesh, of points and of lines, for who knows whose they
// are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <rastrum/mesh.hpp>
#include <rastrum/points_and_lines.hpp>

namespace rastrum {

/// What is wrong where `values` of an array are not as many as what they are of; empty: nothing.
[[nodiscard]] std::string count_problem(std::size_t values, const std::string& array,
                                        std::size_t wanted, const char* of);

/// What is wrong with the number of a material where a scene has so many; empty: nothing. One that
/// has none has number 0: what is drawn without any.
[[nodiscard]] std::string material_problem(std::uint32_t material, std::size_t materials);

/// What is wrong with the faces or the number of positions or corners; empty: nothing.
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
