// SPDX-License-Identifier: BSD-3-Clause
// Points, lines or triangles of a program (program.hpp), and how they are drawn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/frame.hpp>
#include <rastrum/mesh.hpp>

namespace RASTRUM_API rastrum {

/// A kind of primitives; its value is the number of vertices of each.
enum class Topology : std::uint8_t { points = 1, lines = 2, triangles = 3 };

/// Values of Primitives::flags. kTested: fragments pass a fragment test (alpha mask, discard)
/// before the nearest is taken. kTranslucent: fragments are blended, with the shader's alpha.
inline constexpr std::uint32_t kTested = 1, kTranslucent = 8;

/// How many outputs a program may have beside its colour.
inline constexpr std::size_t kMaxExtraTargets = 7;

/// In px; wider lines and larger points are refused.
inline constexpr float kMaxLineWidth = 4096, kMaxPointSize = 4096;

/// Points, lines or triangles over vertices that are numbered from 0. Ids count primitives through
/// the draws of a frame in order.
struct Primitives {
  std::size_t vertex_count = 0;
  std::span<const std::uint32_t> indices{};  ///< empty: vertices in order
  std::uint64_t primitive_count = 0;         ///< at most as many as the indices or vertices make
  Topology topology = Topology::triangles;
  std::uint32_t flags = 0;
  Cull cull = Cull::none;  ///< which faces of triangles are left out
  Winding winding = Winding::counter_clockwise;
  float line_width = 1;  ///< px across the minor axis, rounded to a whole number of at least 1
  float point_size = 1;  ///< px, rounded to 1/256; less than 1 counts as 1
  /// depth_bias + depth_bias_slope · max(|zx|, |zy|) is added to the depth of every fragment before
  /// it is cut to [0, 1]; zx and zy are the change of depth per px. This is GL's polygon offset,
  /// but for all topologies and in units of reversed depth (more is nearer).
  float depth_bias = 0, depth_bias_slope = 0;
};

}  // namespace rastrum
