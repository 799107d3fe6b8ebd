// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/shaded_scenes.hpp"

#include <utility>

#include <rastrum/transform.hpp>

#include "tests/support/layer_scenes.hpp"
#include "tests/support/random.hpp"

namespace rastrum::test {
namespace shaded_scenes {
namespace {

Vec3 vector(Random& r, double size) {
  const float x = r.real32(-size, size), y = r.real32(-size, size);
  return {x, y, r.real32(-size, size)};
}
Vec4 color(Random& r, double least_alpha) {
  const float red = r.real32(0, 1), green = r.real32(0, 1), blue = r.real32(0, 1);
  return {red, green, blue, r.chance(0.5) ? 1.0F : r.real32(least_alpha, 1)};
}
float one_of(Random& r, std::initializer_list<float> values) {
  return values.begin()[r.integer(0, static_cast<int>(values.size()) - 1)];
}

/// A value for each position, or for each corner through indices of its own.
template <class T, class Make>
void give(Random& r, const Mesh& mesh, Attribute<T>& attribute, const Make& make) {
  const bool own = r.chance(0.3);
  const std::size_t corners = 3 * mesh.triangle_count();
  attribute.values.resize(own ? 7 : mesh.positions.size());
  for (T& v : attribute.values) v = make();
  attribute.indices.clear();
  for (std::size_t i = 0; own && i < corners; ++i)
    attribute.indices.push_back(static_cast<std::uint32_t>(r.integer(0, 6)));
}

Texture texture(Random& r) {
  Texture t;
  const int height = r.integer(1, 20), width = r.integer(1, 20);
  t.image = Image<Rgba8>(width, height);
  for (Rgba8& p : t.image.pixels()) {
    const std::uint64_t bits = r.bits();
    p = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
         static_cast<std::uint8_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 24)};
  }
  t.wrap_u = static_cast<Wrap>(r.integer(0, 2));
  t.wrap_v = static_cast<Wrap>(r.integer(0, 2));
  t.mag = static_cast<TextureFilter>(r.integer(0, 1));
  t.min = static_cast<TextureFilter>(r.integer(0, 1));
  t.mipmaps = r.chance(0.7);
  return t;
}

Material material(Random& r, int textures) {
  const auto some = [&] { return r.chance(0.4) ? r.integer(0, textures) - 1 : kNoTexture; };
  Material m{.base_color = color(r, 0),
             .base_color_texture = some(),
             .metallic = one_of(r, {0, 1, 0.3F}),
             .roughness = one_of(r, {0, 1, 0.5F, 0.03F}),
             .metallic_roughness_texture = some(),
             .normal_texture = some(),
             .normal_scale = one_of(r, {1, 0.5F, -2}),
             .occlusion_texture = some(),
             .occlusion_strength = r.real32(0, 1)};
  if (r.chance(0.3)) m.emissive = {r.real32(0, 2), 0, r.real32(0, 0.5)};
  m.emissive_texture = some();
  m.alpha_texture = some();
  m.alpha_mode = static_cast<AlphaMode>(r.integer(0, 2));
  m.alpha_cutoff = r.real32(0, 1);
  m.double_sided = r.chance(0.5);
  m.unlit = r.chance(0.2);
  m.opacity = r.chance(0.7) ? 1.0F : r.real32(0, 1);
  return m;
}

/// Normals of all sizes, 0 among them.
Vec3 normal(Random& r) {
  const float size = one_of(r, {1, 1, 1, 1e-18F, 1e18F, 3e38F, 1e-38F, 0});
  return vector(r, 1) * size;
}

void dress(Random& r, Scene& scene) {
  const auto count = r.chance(0.6) ? r.integer(1, 4) : 0;
  for (int i = 0; count > 0 && i < 3; ++i) scene.textures.push_back(texture(r));
  scene.materials.clear();
  for (int i = 0; i < count; ++i) scene.materials.push_back(material(r, 3));
  for (Mesh& mesh : scene.meshes) {
    mesh.face_materials.clear();
    mesh.material = 0;
    if (count > 0 && r.chance(0.5))
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
        mesh.face_materials.push_back(static_cast<std::uint32_t>(r.integer(0, count - 1)));
    if (r.chance(0.6)) give(r, mesh, mesh.normals, [&] { return normal(r); });
    if (r.chance(0.5)) give(r, mesh, mesh.colors, [&] { return color(r, 0); });
    const double reach = static_cast<double>(one_of(r, {1, 5, 300}));
    if (r.chance(0.7))
      give(r, mesh, mesh.texcoords, [&] {
        const float u = r.real32(-reach, reach);
        return Vec2{u, r.real32(-reach, reach)};
      });
  }
  // Turned and scaled a little around the middle of the scene, so that it stays visible.
  if (!r.chance(0.3)) return;
  const Vec3 axis = vector(r, 1);
  const Mat4d turn = rotation(rotation_about(axis, r.real(-0.1, 0.1)));
  const float squeeze = one_of(r, {1, 0.9F, -1});
  for (Instance& i : scene.instances)
    i.object_to_world = i.object_to_world * turn * scaling({squeeze, 1, 1.1F});
}

FrameOptions frame(Random& r) {
  FrameOptions f{.width = r.integer(8, 64),
                 .height = r.integer(8, 64),
                 .shader = static_cast<Shader>(r.integer(1, 8))};
  if (r.chance(0.4)) f.shader = Shader::material;
  f.cull = static_cast<Cull>(r.chance(0.7) ? 0 : r.integer(1, 2));
  f.background = color(r, 0);
  f.opacity = r.chance(0.6) ? 1.0F : r.real32(0, 1);
  f.samples = r.chance(0.7) ? 1 : 1 << r.integer(2, 4);
  return f;
}

}  // namespace
}  // namespace shaded_scenes

ShadedScene generate_shaded(std::uint64_t seed) {
  using namespace shaded_scenes;
  Random r(seed ^ 0x5EEDC0108);
  ShadedScene s;
  s.frame = frame(r);
  if (r.chance(0.15)) {
    LayerScene layers = generate_layers(seed, s.frame.width, s.frame.height, 20000);
    s.kind = layers.kind;
    s.scene = single(std::move(layers.mesh));
    s.camera = layers.camera;
  } else {
    static_cast<GeneratedScene&>(s) = generate(seed, s.frame.width, s.frame.height);
  }
  dress(r, s.scene);
  return s;
}

}  // namespace rastrum::test
