// glTF 2.0 metallic-roughness materials and the textures they read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <rastrum/core/image.hpp>
#include <rastrum/core/vec.hpp>

namespace rastrum {

enum class Wrap : std::uint8_t { repeat, mirrored_repeat, clamp_to_edge };
enum class TextureFilter : std::uint8_t { nearest, linear };  ///< linear minifies trilinearly
enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// A decoded picture as its file has it: 8 bit, straight alpha, row 0 at the top. Whether it holds
/// sRGB (base colour, emissive) or linear data (the others) is the use's business.
struct Texture {
  std::string name{};
  Image<Rgba8> image{};
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  TextureFilter mag = TextureFilter::linear, min = TextureFilter::linear;
  bool mipmaps = true;
};

inline constexpr std::int32_t kNoTexture = -1;

/// Factors are linear. A texture index refers to Scene::textures.
struct Material {
  std::string name{};
  Vec4 base_color{1, 1, 1, 1};
  std::int32_t base_color_texture = kNoTexture;
  float metallic = 1, roughness = 1;
  std::int32_t metallic_roughness_texture = kNoTexture;  ///< G roughness, B metallic
  std::int32_t normal_texture = kNoTexture;
  float normal_scale = 1;
  std::int32_t occlusion_texture = kNoTexture;
  float occlusion_strength = 1;
  Vec3 emissive{0, 0, 0};
  std::int32_t emissive_texture = kNoTexture;
  /// An additional mask whose red channel multiplies alpha (OBJ's map_d).
  std::int32_t alpha_texture = kNoTexture;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5F;  ///< mask: a fragment with alpha < cutoff is discarded
  bool double_sided = false;
  bool unlit = false;  ///< KHR_materials_unlit
  /// Of every surface that has this material, in [0, 1]: RenderOptions::opacity for a part of the
  /// scene. The two are multiplied.
  float opacity = 1;
};

}  // namespace rastrum
