// SPDX-License-Identifier: BSD-3-Clause
// Quads that fill a small picture, and textures for them.
#pragma once

#include <cstdint>
#include <utility>

#include <rastrum/scene.hpp>

#include "tests/support/colors.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test {

inline Texture texture(int width, int height, auto&& color_of) {
  Texture t{.image = Image<Rgba8>(width, height)};
  for (const auto& [x, y] : pixels(width, height)) t.image(x, y) = color_of(x, y);
  return t;
}
inline Rgba8 grey(int code) {
  const auto c = static_cast<std::uint8_t>(code);
  return {c, c, c, 255};
}

/// Numbers from a seed, the same on every machine.
class Numbers {
 public:
  std::uint32_t operator()(std::uint32_t below) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::uint32_t>((state_ >> 33) % below);
  }

 private:
  std::uint64_t state_ = 7;
};

/// Materials of all kinds on triangles of all sizes; every second one is a mask.
inline Scene everything() {
  Numbers numbers;
  Scene scene;
  const auto noise = [&](int size) {
    return texture(size, size, [&](int, int) {
      return Rgba8{static_cast<std::uint8_t>(numbers(256)), static_cast<std::uint8_t>(numbers(256)),
                   static_cast<std::uint8_t>(128 + numbers(128)),
                   static_cast<std::uint8_t>(numbers(256))};
    });
  };
  for (const int size : {37, 64, 128}) scene.textures.push_back(noise(size));
  scene.textures[1].wrap_u = Wrap::mirrored_repeat;
  scene.textures[2].wrap_v = Wrap::clamp_to_edge;
  for (int i = 0; i < 4; ++i) {
    Material m{.base_color_texture = i % 3,
               .metallic_roughness_texture = (i + 1) % 3,
               .normal_texture = i == 1 ? kNoTexture : 2,
               .occlusion_texture = 1,
               .emissive = {0.1F, 0, 0.1F},
               .emissive_texture = 0,
               .unlit = i == 2};
    if (i % 2 == 1) m.alpha_mode = AlphaMode::mask;
    if (i == 3) m.alpha_texture = 1;
    scene.materials.push_back(m);
  }
  const auto coordinate = [&](float range) {
    return (static_cast<float>(numbers(2000)) / 1000 - 1) * range;
  };
  Mesh mesh;
  for (std::uint32_t i = 0; i < 150; ++i) {
    const Vec3 centre{coordinate(1), coordinate(1), coordinate(1.2F)};
    const float size = i % 7 == 0 ? 2.0F : 0.3F;
    for (std::uint32_t c = 0; c < 3; ++c) {
      mesh.positions.push_back(centre + Vec3{coordinate(size), coordinate(size), coordinate(size)});
      mesh.normals.values.push_back({coordinate(1), coordinate(1), coordinate(1)});
      mesh.texcoords.values.push_back({coordinate(3), coordinate(3)});
      mesh.colors.values.push_back({1, 0.5F + coordinate(0.5F), 1, 0.75F + coordinate(0.25F)});
      mesh.indices.push_back(3 * i + c);
    }
    mesh.face_materials.push_back(i % 4);
  }
  scene.meshes.push_back(std::move(mesh));
  scene.instances = {{0, Mat4d::identity()}};
  return scene;
}

/// A quad over a whole size² image at `depth`, for pixel_camera. Texture coordinates go from `low`
/// at the top left to `high` at the bottom right.
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
  Material m{.base_color_texture = 0, .unlit = true};
  scene.materials.push_back(m);
  return scene;
}

}  // namespace rastrum::test
