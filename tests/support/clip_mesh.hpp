// SPDX-License-Identifier: BSD-3-Clause
// A mesh whose vertices a function places in clip space.
#pragma once

#include <cstddef>
#include <utility>

#include <rastrum/mesh.hpp>
#include <rastrum/raster/draws/draw.hpp>

#include "tests/support/scenes.hpp"

namespace rastrum::test {

/// Keeps x and y; maps z from −2 to 2 to depths from 0 to 1.
class ClipMesh : public raster::VertexSource {
 public:
  explicit ClipMesh(Mesh mesh) : mesh_(indexed(std::move(mesh))) {}

  void project(std::size_t begin, std::size_t end, raster::Viewport viewport, Isa,
               raster::ProjectedVertex* out) const noexcept override {
    for (std::size_t i = begin; i < end; ++i) out[i - begin] = raster::project(at(i), viewport);
  }
  [[nodiscard]] raster::Vec4d clip_position(std::size_t i) const noexcept override {
    const Vec4 p = at(i);
    return {p.x, p.y, p.z, p.w};
  }
  [[nodiscard]] raster::Draw draw(std::uint32_t flags) const {
    raster::Draw d;
    d.source = this;
    d.vertex_count = mesh_.positions.size();
    d.indices = mesh_.indices;
    d.primitive_count = mesh_.triangle_count();
    d.flags = flags;
    return d;
  }

 private:
  [[nodiscard]] Vec4 at(std::size_t i) const {
    const Vec3 p = mesh_.positions[i];
    return {p.x, p.y, p.z * 0.25F + 0.5F, 1};
  }
  Mesh mesh_;
};

}  // namespace rastrum::test
