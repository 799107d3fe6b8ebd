// Quads that fill a small picture, and textures for them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <rastrum/scene/scene.hpp>

#include "tests/support/scenes.hpp"

namespace rastrum::test {

/// The transfer function, in float64.
inline double display(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}
inline double light_of(double display_value) {
  return display_value <= 0.04045 ? display_value / 12.92
                                  : std::pow((display_value + 0.055) / 1.055, 2.4);
}
inline double light(int code) {
  return light_of(code / 255.0);
}

inline Texture texture(int width, int height, auto&& color_of) {
  Texture t;
  t.image = Image<Rgba8>(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) t.image(x, y) = color_of(x, y);
  return t;
}
inline Rgba8 grey(int code) {
  const auto c = static_cast<std::uint8_t>(code);
  return {c, c, c, 255};
}

/// A quad over a whole size² image at `depth`, seen by pixel_camera; texture coordinates `low` at
/// its top left, `high` at its bottom right.
inline Mesh quad(int size, Vec2 low, Vec2 high, double depth = 0.5) {
  Mesh mesh;
  for (const int corner : {0, 1, 2, 3}) {
    const bool right = corner == 1 || corner == 2, bottom = corner >= 2;
    mesh.positions.push_back(at_pixel(right ? size : 0, bottom ? size : 0, depth, size, size));
    mesh.texcoords.values.push_back({right ? high.x : low.x, bottom ? high.y : low.y});
  }
  mesh.indices = {0, 3, 2, 0, 2, 1};
  return mesh;
}

/// The mesh with one texture as its unlit colour.
inline Scene unlit(Mesh mesh, Texture t) {
  Scene scene = single(std::move(mesh));
  scene.textures.push_back(std::move(t));
  Material m;
  m.unlit = true;
  m.base_color_texture = 0;
  scene.materials.push_back(m);
  return scene;
}

}  // namespace rastrum::test
