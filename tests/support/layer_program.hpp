// SPDX-License-Identifier: BSD-3-Clause
// A LayerScene as a Program: vertices and colours are functions, and each run of opaque or
// translucent triangles is a draw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/program.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/raster/draws/hooks.hpp>

#include "tests/support/layer_scenes.hpp"
#include "tests/support/projection.hpp"

namespace rastrum::test {

class LayerProgram {
 public:
  /// Holds a reference to `scene`. Every clip coordinate must fit float32.
  LayerProgram(const LayerScene& scene, int width, int height)
      : scene_(scene),
        program_(VertexFunction{this}, ShadeFunction{&scene}, DiscardFunction{&scene}) {
    const Mat4d to_clip_matrix = object_to_clip(scene.camera, Mat4d::identity(), width, height);
    // One vertex per corner, so that each corner has its own colour.
    for (const std::uint32_t i : scene.mesh.indices) {
      const ClipVertex c = to_clip(to_clip_matrix, scene.mesh.positions[i]);
      clip_.push_back({static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z),
                       static_cast<float>(c.w)});
      corners_.push_back(static_cast<std::uint32_t>(corners_.size()));
    }
    for (std::size_t begin = 0; begin < scene.size();) {
      std::size_t end = begin;
      while (end < scene.size() && scene.opaque[end] == scene.opaque[begin]) ++end;
      raster::Draw draw =
          program_.draw(clip_.size(), std::span(corners_).subspan(3 * begin, 3 * (end - begin)));
      draw.flags = scene.holes ? kTested : 0U;
      if (scene.opaque[begin] == 0) draw.flags |= kTranslucent;
      draw.shading = {};  // tests pass shader() themselves
      draw.test = {};
      draws_.push_back(draw);
      begin = end;
    }
  }
  LayerProgram(const LayerProgram&) = delete;  // the functions hold its address
  LayerProgram& operator=(const LayerProgram&) = delete;

  [[nodiscard]] std::span<raster::Draw> draws() { return draws_; }
  [[nodiscard]] const raster::BlockShader& shader() const {
    return *raster::Shading(program_).own();
  }
  [[nodiscard]] const raster::FragmentTest* test() const {
    return scene_.holes ? raster::Testing(program_).own() : nullptr;
  }

 private:
  struct Color {
    Vec4 value;
    Color operator+(const Color& o) const { return {value + o.value}; }
    Color operator*(float s) const { return {value * s}; }
  };
  struct VertexFunction {
    const LayerProgram* self;
    VertexOutput<Color> operator()(std::uint32_t corner) const {
      const std::vector<Vec4>& colors = self->scene_.corner_colors;
      return {self->clip_[corner], {colors.empty() ? Vec4{} : colors[corner]}};
    }
  };
  struct ShadeFunction {
    const LayerScene* scene;
    Vec4 operator()(const Color& c, const rastrum::Fragment& f) const {
      if (scene->paint == Paint::gradient) return c.value;
      if (scene->paint == Paint::pixel) return scene->pixel_color(f.id, f.x, f.y);
      return scene->colors[static_cast<std::size_t>(f.id)];
    }
  };
  struct DiscardFunction {
    const LayerScene* scene;
    bool operator()(const Color&, const rastrum::Fragment& f) const {
      return scene->is_hole(f.id, f.x, f.y);
    }
  };

  const LayerScene& scene_;
  std::vector<Vec4> clip_;
  std::vector<std::uint32_t> corners_;
  std::vector<raster::Draw> draws_;
  Program<VertexFunction, ShadeFunction, DiscardFunction> program_;
};

}  // namespace rastrum::test
