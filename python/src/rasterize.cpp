// SPDX-License-Identifier: BSD-3-Clause
#include "rasterize.hpp"

#include <string>

#include <rastrum/error.hpp>
#include <rastrum/program.hpp>

namespace rastrum::python {
namespace {

struct Nothing {
  Nothing operator+(const Nothing&) const { return {}; }
  Nothing operator*(float) const { return {}; }
};

}  // namespace

void ClipRasterizer::draw(Renderer& by, const ClipTriangles& what, ImageView<Vec4> into,
                          StopToken stop) {
  // Rastrum's weights are those of the second and the third corner.
  constexpr std::size_t kCornerOf[3] = {2, 0, 1};
  corners_.resize(what.count * 3);
  for (std::size_t t = 0; t < what.count; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = (what.first + t) * 3 + kCornerOf[k];
      const std::uint32_t index = what.triangles[at];
      if (index >= what.positions.size())
        throw Error(Errc::invalid_argument, "tri: index " + what.triangles.text(at) +
                                                " of triangle " + std::to_string(what.first + t) +
                                                " has no position; there are " +
                                                std::to_string(what.positions.size()));
      corners_[t * 3 + k] = index;
    }

  const std::size_t pixels =
      static_cast<std::size_t>(into.width) * static_cast<std::size_t>(into.height);
  ids_.resize(pixels);
  depth_.resize(pixels);
  weights_.resize(pixels);
  // y is flipped, so that row 0 is the lowest; depth is reversed.
  const Program program(
      [&](std::uint32_t i) {
        const Vec4 p = what.positions[i];
        return VertexOutput<Nothing>{{p.x, -p.y, (p.w - p.z) * 0.5F, p.w}, {}};
      },
      [](const Nothing&, const Fragment&) { return Vec4{}; });
  ProgramDraw draw = program.draw(what.positions.size(), corners_);
  draw.primitive_count = what.count;  // without indices all vertices would be drawn in order
  FrameOptions frame;
  frame.width = into.width;
  frame.height = into.height;
  Targets targets;
  targets.ids = {ids_.data(), into.width, into.height};
  targets.depth = {depth_.data(), into.width, into.height};
  targets.barycentrics = {weights_.data(), into.width, into.height};
  by.draw({&draw, 1}, frame, targets, {}, stop);

  for (std::size_t i = 0; i < pixels; ++i) {
    // Fragments beyond the far plane are drawn at a depth of 0, behind all else.
    const bool seen = ids_[i] >= 0 && depth_[i] > 0;
    into.data[i] =
        seen ? Vec4{weights_[i].x, weights_[i].y, 1 - 2 * depth_[i],
                    static_cast<float>(what.first + static_cast<std::size_t>(ids_[i]) + 1)}
             : Vec4{0, 0, 0, 0};
  }
}

}  // namespace rastrum::python
