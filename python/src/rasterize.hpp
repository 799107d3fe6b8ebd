// SPDX-License-Identifier: BSD-3-Clause
// Triangles in clip space as in nvdiffrast: four numbers per pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <rastrum/array.hpp>
#include <rastrum/image.hpp>
#include <rastrum/render.hpp>

namespace rastrum::python {

/// Triangles [first, first + count) of `triangles`, three indices each.
struct ClipTriangles {
  ArrayView<Vec4> positions{};  ///< OpenGL's clip space: −w ≤ z ≤ w
  IndexView triangles{};
  std::size_t first = 0, count = 0;
};

/// Reuses its memory from picture to picture.
class ClipRasterizer {
 public:
  /// Fills (u, v, z/w, number of the triangle + 1), with the weights of the first and the second
  /// corner; zeros where nothing is. Row 0 is at y = −w. Throws Error{invalid_argument} for an
  /// index without a position.
  void draw(Renderer& by, const ClipTriangles& what, ImageView<Vec4> into, StopToken stop);

 private:
  std::vector<std::uint32_t> corners_;
  std::vector<std::int64_t> ids_;
  std::vector<float> depth_;
  std::vector<Vec2> weights_;
};

}  // namespace rastrum::python
