// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/material.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/material_kernels.hpp>
#include <rastrum/scene/mesh_checks.hpp>

namespace rastrum::raster {
namespace {

struct TextureReference {
  std::int32_t texture;
  TexelUse use;
  bool alpha;  ///< it has alpha
};

std::array<TextureReference, 6> references(const Material& m) {
  return {{{m.base_color_texture, TexelUse::color, true},
           {m.metallic_roughness_texture, TexelUse::data, false},
           {m.normal_texture, TexelUse::data, false},
           {m.occlusion_texture, TexelUse::data, false},
           {m.emissive_texture, TexelUse::color, false},
           {m.alpha_texture, TexelUse::data, true}}};
}

struct Factor {
  std::span<const float> values;
  const char* name;
};

std::array<Factor, 10> factors(const Material& m) {
  return {{{{&m.base_color.x, 4}, "base_color"},
           {{&m.metallic, 1}, "metallic"},
           {{&m.roughness, 1}, "roughness"},
           {{&m.normal_scale, 1}, "normal_scale"},
           {{&m.occlusion_strength, 1}, "occlusion_strength"},
           {{&m.emissive.x, 3}, "emissive"},
           {{&m.alpha_cutoff, 1}, "alpha_cutoff"},
           {{&m.classic.specular, 1}, "specular"},
           {{&m.classic.shininess, 1}, "shininess"},
           {{&m.classic.emission, 1}, "emission"}}};
}

}  // namespace

void MaterialDraw::set(const LitDraw& lit, const InstanceView& instance) {
  colors = lit.colors;
  color_space = lit.color_space;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      normal_matrix[i][j] = lit.normal_matrix[i][j];
      to_world[i][j] = static_cast<float>(instance.object_to_world.m[i][j]);
    }
}

MaterialDraw MaterialDraw::of(const InstanceView& instance) const {
  MaterialDraw own = *this;
  LitDraw lit;
  lit.colors = colors;
  lit.color_space = color_space;
  own.set(lit.of(instance), instance);
  return own;
}

MaterialScene::MaterialScene(const SceneView& scene, const Camera& camera, int width, int height,
                             const TextureSet& textures, bool as_classic)
    : classic(as_classic) {
  // The normal matrices are the lit shaders'.
  const LitScene lit(scene, camera, width, height);
  rays = lit.rays;
  draws.resize(lit.draws.size());
  for (std::size_t d = 0; d < draws.size(); ++d) {
    draws[d].mesh = lit.draws[d].mesh;
    draws[d].opacity = scene.instances[d].opacity;
    if (scene.materials.empty()) {
      draws[d].material = lit.draws[d].colors.empty() ? 0 : 1;
    } else {
      draws[d].face_materials = lit.draws[d].face_materials;
      draws[d].material = lit.draws[d].material;
    }
    draws[d].set(lit.draws[d], scene.instances[d]);
  }
  const auto bind_classic = [&](const Material& m) {
    BoundMaterial& b = materials.emplace_back();
    b.base = display_value(m.base_color);
    b.alpha_mode = m.alpha_mode;
    b.alpha_cutoff = m.alpha_cutoff;
    b.opacity = m.opacity;
    b.unlit = m.unlit;
    b.base_color = textures.find(m.base_color_texture, TexelUse::data);
    b.alpha = textures.find(m.alpha_texture, TexelUse::data);
    b.classic = m.classic;
    b.sixteenths = sixteenths(128 * m.classic.shininess);
  };
  const auto bind = [&](const Material& m) {
    if (classic) return bind_classic(m);
    materials.push_back({m.base_color, m.metallic, m.roughness, m.normal_scale,
                         m.occlusion_strength, m.emissive, m.alpha_mode, m.alpha_cutoff, m.opacity,
                         m.unlit, textures.find(m.base_color_texture, TexelUse::color),
                         textures.find(m.metallic_roughness_texture, TexelUse::data),
                         textures.find(m.normal_texture, TexelUse::data),
                         textures.find(m.occlusion_texture, TexelUse::data),
                         textures.find(m.emissive_texture, TexelUse::color),
                         textures.find(m.alpha_texture, TexelUse::data)});
  };
  for (const Material& m : scene.materials) bind(m);
  if (materials.empty())
    for (const bool has_colors : {false, true}) bind(plain_material(has_colors));
  bent = std::ranges::any_of(materials, [](const BoundMaterial& m) { return m.normal != nullptr; });
}

MaterialView MaterialScene::view() const {
  return {materials, draws, rays, lights, display_curve().data(), classic};
}

void check_materials(const InstanceRuns& runs) {
  const SceneView& scene = runs.firsts();
  const std::size_t textures = scene.textures.size();
  for (std::size_t i = 0; i < textures; ++i) {
    const Texture& t = scene.textures[i];
    const std::string name = "texture " + std::to_string(i);
    for (const Wrap wrap : {t.wrap_u, t.wrap_v})
      check_enum(wrap, Wrap::clamp_to_edge, name + ": its wrapping");
    for (const TextureFilter filter : {t.mag, t.min})
      check_enum(filter, TextureFilter::linear, name + ": its filter");
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    check_enum(scene.materials[i].alpha_mode, AlphaMode::blend,
               "material " + std::to_string(i) + ": its alpha mode");
    for (const auto& [values, what] : factors(scene.materials[i]))
      for (const float x : values)
        if (!std::isfinite(x))
          throw Error(Errc::invalid_argument, "material " + std::to_string(i) + ": its " + what +
                                                  " must be finite, not " + number_text(x));
    if (const float o = scene.materials[i].opacity; !(o >= 0 && o <= 1))
      throw Error(Errc::invalid_argument, "material " + std::to_string(i) +
                                              ": the opacity must lie in [0, 1], not " +
                                              number_text(o));
    if (const ClassicMaterial& c = scene.materials[i].classic;
        !(c.specular >= 0 && c.emission >= 0 && c.shininess >= 0 && c.shininess <= 1))
      throw Error(Errc::invalid_argument,
                  "material " + std::to_string(i) +
                      ": specular and emission must not be negative, and shininess must lie in "
                      "[0, 1]");
    for (const TextureReference& r : references(scene.materials[i]))
      if (r.texture != kNoTexture &&
          (r.texture < 0 || static_cast<std::size_t>(r.texture) >= textures))
        throw Error(Errc::invalid_argument,
                    "material " + std::to_string(i) + ": texture " + std::to_string(r.texture) +
                        " is out of range, there are " + std::to_string(textures));
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (scene.instances[i].mesh() == nullptr) continue;
    const MeshView& mesh = *scene.instances[i].mesh();
    const auto none = [&](const std::string& problem) {
      if (!problem.empty())
        throw Error(Errc::invalid_argument,
                    "instance " + std::to_string(runs.number(i)) + ": " + problem);
    };
    const auto& own = scene.instances[i].material;
    if (own || mesh.face_materials.empty()) {
      none(material_problem(own.value_or(mesh.material), scene.materials.size()));
    } else if (!scene.materials.empty()) {
      const bool triangles = mesh.faces.kind == FaceKind::triangles;
      none(count_problem(mesh.face_materials.size(), "face materials", mesh.face_count(),
                         triangles ? "triangles" : "faces"));
      const std::size_t at = first_beyond(mesh.face_materials, scene.materials.size());
      if (at != mesh.face_materials.size())
        none("material " + mesh.face_materials.text(at) + " is out of range, there are " +
             std::to_string(scene.materials.size()));
    }
  }
}

std::vector<std::uint8_t> texture_uses(const SceneView& scene, bool shading, bool blending,
                                       bool classic) {
  std::vector<std::uint8_t> uses(scene.textures.size());
  const auto use = [&](std::int32_t texture, TexelUse as) {
    uses[static_cast<std::size_t>(texture)] |= static_cast<std::uint8_t>(as);
  };
  for (const Material& m : scene.materials) {
    if (classic)
      for (const std::int32_t texture : {m.base_color_texture, m.alpha_texture})
        if (texture != kNoTexture) use(texture, TexelUse::data);
    const bool has_alpha =
        m.alpha_mode == AlphaMode::mask || (m.alpha_mode == AlphaMode::blend && blending);
    for (const TextureReference& r : references(m))
      if (r.texture != kNoTexture && (shading || (r.alpha && has_alpha))) use(r.texture, r.use);
  }
  return uses;
}

}  // namespace rastrum::raster
