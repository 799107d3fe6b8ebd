// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/points_and_lines.hpp>

#include <rastrum/array.hpp>
#include <rastrum/core/enum.hpp>
#include <rastrum/error.hpp>
#include <rastrum/scene/mesh_checks.hpp>
#include <rastrum/scene/polylines.hpp>

namespace rastrum {
namespace {

/// A message unless there is one value per position, or none.
std::string each_problem(std::size_t values, const char* what, std::size_t positions) {
  return values == 0 ? std::string{} : count_problem(values, what, positions, "positions");
}

std::string first_problem(std::initializer_list<std::string> problems) {
  for (const std::string& p : problems)
    if (!p.empty()) return p;
  return {};
}

}  // namespace

std::size_t LinesView::size() const {
  const std::size_t corners = corner_count();
  if (kind == LineKind::segments) return corners / 2;
  if (offsets.empty()) return corners == 0 ? 0 : corners - 1;
  return polylines::segments_before(offsets, offsets.size() - 1);
}

std::size_t LinesView::begin(std::uint64_t segment) const {
  const auto s = static_cast<std::size_t>(segment);
  if (kind == LineKind::segments) return 2 * s;
  return offsets.empty() ? s : polylines::begin_of(offsets, s);
}

PointsView Points::view() const {
  PointsView v;
  v.positions = wide_positions.empty() ? ArrayView<Vec3>(positions) : wide_positions;
  v.normals = normals;
  v.colors = colors;
  v.color_space = color_space;
  v.point_size = point_size;
  v.round = round;
  v.material = material;
  return v;
}

LinesView Lines::view() const {
  LinesView v;
  v.positions = wide_positions.empty() ? ArrayView<Vec3>(positions) : wide_positions;
  v.indices = indices;
  v.kind = kind;
  v.offsets = offsets;
  v.colors = colors;
  v.color_space = color_space;
  v.line_width = line_width;
  v.material = material;
  return v;
}

std::string arrays_problem(const PointsView& points) {
  const std::size_t n = points.positions.size();
  return first_problem({positions_problem(n), each_problem(points.normals.size(), "normals", n),
                        each_problem(points.colors.size(), "colors", n),
                        each_problem(points.sizes.size(), "sizes", n),
                        each_problem(points.scalars.size(), "scalars", n)});
}

std::string arrays_problem(const LinesView& lines) {
  const std::size_t n = lines.positions.size(), corners = lines.corner_count();
  if (lines.kind > LineKind::polylines)
    return "kind is " + std::to_string(static_cast<int>(lines.kind)) +
           ", which is no value of its enum";
  if (std::string problem =
          first_problem({positions_problem(n), each_problem(lines.colors.size(), "colors", n),
                         each_problem(lines.scalars.size(), "scalars", n)});
      !problem.empty())
    return problem;
  const IndexView& offsets = lines.offsets;
  if (lines.kind == LineKind::segments) {
    if (!offsets.empty()) return "segments have no offsets";
    if (corners % 2 != 0) return "the number of corners, " + std::to_string(corners) + ", is odd";
    return {};
  }
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    const std::uint64_t begin = offsets.wide(i), end = offsets.wide(i + 1);
    if (end > corners || begin >= end)
      return "offsets: polyline " + std::to_string(i) + " has the corners " + offsets.text(i) +
             " to " + offsets.text(i + 1) + " of " + std::to_string(corners) +
             "; it must have one or more";
  }
  return {};
}

}  // namespace rastrum
