// SPDX-License-Identifier: BSD-3-Clause
// Points and lines whose size is in pixels, for instances of a scene: views over the caller's
// arrays, and the owning forms that readers return. A view copies nothing, so the arrays must
// outlive the render. docs/coverage.md and docs/colours.md have the rules. All have in common:
// positions are in object space; float64 is transformed in float64. There are at most 2³² − 1
// positions, and every index must be less than their number; the render checks this. A primitive
// with a position that is not finite is dropped and counted. `colors` are straight alpha, one a
// position, and multiply the material's colour; if they are empty, the material's or the plain
// colour stands. Textures are not read, because there are no coordinates. Points and lines without
// normals are not lit, but show their colour.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <rastrum/array.hpp>
#include <rastrum/color.hpp>
#include <rastrum/scalars.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

/// A primitive is a point: the samples in a square or disc of `point_size` px about its position,
/// at least one pixel. Its size is the same at any distance.
struct PointsView {
  ArrayView<Vec3> positions{};
  IndexView indices{};         ///< one a point; empty: positions in order
  ArrayView<Vec3> normals{};   ///< one a position, need not be of unit length; empty: not lit
  ArrayView<Vec4> colors{};    ///< one a position
  ArrayView<float> sizes{};    ///< px, one a position, cut to [1, 4096]; empty: `point_size`
  float point_size = 1;        ///< px, in (0, 4096]; less than 1 counts as 1
  bool round = false;          ///< a disc, from a size of 1.5 px on
  std::uint32_t material = 0;  ///< index into SceneView::materials
  ScalarView scalars{};        ///< one a position
  ColorSpace color_space = ColorSpace::display;  ///< that of `colors`

  [[nodiscard]] std::size_t size() const {
    return indices.empty() ? positions.size() : indices.size();
  }
  /// The index of a point's position.
  [[nodiscard]] std::uint32_t vertex(std::uint64_t point) const {
    const auto i = static_cast<std::size_t>(point);
    return indices.empty() ? static_cast<std::uint32_t>(i) : indices[i];
  }
};

/// How corners, one for each index, make segments.
enum class LineKind : std::uint8_t {
  segments,   ///< two corners each
  polylines,  ///< runs of corners, each joined to the next
};

/// A primitive is a segment of a line, `line_width` px wide across its minor axis. By the diamond
/// exit rule a polyline draws the pixel at a corner that two segments share once.
struct LinesView {
  ArrayView<Vec3> positions{};
  IndexView indices{};  ///< one a corner; empty: positions in order
  LineKind kind = LineKind::segments;
  /// For polylines, one offset more than there are: polyline i has the corners [offsets[i],
  /// offsets[i + 1]), at least one. Empty: all corners are one polyline.
  IndexView offsets{};
  ArrayView<Vec4> colors{};    ///< one a position, linear along a segment
  float line_width = 1;        ///< px, in (0, 4096], rounded to a whole number of at least 1
  std::uint32_t material = 0;  ///< index into SceneView::materials
  ScalarView scalars{};        ///< one a position, linear along a segment
  ColorSpace color_space = ColorSpace::display;  ///< that of `colors`

  [[nodiscard]] std::size_t corner_count() const {
    return indices.empty() ? positions.size() : indices.size();
  }
  /// The number of segments. O(1).
  [[nodiscard]] std::size_t size() const;
  /// The corner at which a segment begins; it ends at the next. O(log polylines).
  [[nodiscard]] std::size_t begin(std::uint64_t segment) const;
  /// The index of the position at a segment's end, 0 or 1.
  [[nodiscard]] std::uint32_t vertex(std::uint64_t segment, int end) const {
    const std::size_t corner = begin(segment) + static_cast<std::size_t>(end);
    return indices.empty() ? static_cast<std::uint32_t>(corner) : indices[corner];
  }
};

/// Points that own their arrays; PointsView says what each is.
struct Points {
  std::string name{};
  std::vector<Vec3> positions{};
  std::vector<Vec3> normals{};
  std::vector<Vec4> colors{};
  float point_size = 1;
  bool round = false;
  std::uint32_t material = 0;
  std::vector<NamedScalars> scalars{};
  ColorSpace color_space = ColorSpace::display;
  std::vector<Vec3d> wide_positions{};  ///< as Mesh::wide_positions

  [[nodiscard]] PointsView view() const;
};

/// Lines that own their arrays; LinesView says what each is.
struct Lines {
  std::string name{};
  std::vector<Vec3> positions{};
  std::vector<std::uint32_t> indices{};
  LineKind kind = LineKind::segments;
  std::vector<std::uint32_t> offsets{};
  std::vector<Vec4> colors{};
  float line_width = 1;
  std::uint32_t material = 0;
  std::vector<NamedScalars> scalars{};
  ColorSpace color_space = ColorSpace::display;
  std::vector<Vec3d> wide_positions{};  ///< as Mesh::wide_positions

  [[nodiscard]] LinesView view() const;
};

}  // namespace rastrum
