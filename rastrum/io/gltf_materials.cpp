// SPDX-License-Identifier: BSD-3-Clause
// Materials, samplers, textures and images of glTF. A mesh has one set of texture coordinates, to
// which KHR_texture_transform is applied when it is read. A texture that disagrees with the
// material's first one is left out, with a warning.
#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/srgb.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/gltf_internal.hpp>

namespace rastrum::io::gltf {
namespace {

constexpr const char* kPbr = "pbrMetallicRoughness";

TextureUse use_of(const Json& info) {
  TextureUse use;
  use.set = info.count("texCoord", 0);
  const auto transform = info.extension("KHR_texture_transform");
  if (!transform) return use;
  use.set = transform->count("texCoord", use.set);
  double offset[2] = {0, 0}, scale[2] = {1, 1};
  (void)transform->numbers("offset", offset);
  (void)transform->numbers("scale", scale);
  const double angle = static_cast<double>(transform->real("rotation", 0));
  const auto [s, c] = elementary::sin_cos(angle);
  // translation · rotation · scale, the rotation counter-clockwise in a space whose v points down
  use.m[0][0] = static_cast<float>(c * scale[0]);
  use.m[0][1] = static_cast<float>(s * scale[1]);
  use.m[0][2] = static_cast<float>(offset[0]);
  use.m[1][0] = static_cast<float>(-s * scale[0]);
  use.m[1][1] = static_cast<float>(c * scale[1]);
  use.m[1][2] = static_cast<float>(offset[1]);
  return use;
}

auto sampler_of(const Texture& t) {
  return std::tuple(t.wrap_u, t.wrap_v, t.mag, t.min, t.mipmaps);
}

Wrap wrap_of(std::size_t value) {
  return value == 33071   ? Wrap::clamp_to_edge
         : value == 33648 ? Wrap::mirrored_repeat
                          : Wrap::repeat;
}

/// Base colour and metallic factor for a diffuse and a specular colour.
struct Metal {
  Vec3 base;
  float metallic;
};

/// By the Khronos group's conversion: the metallic factor whose base colour reflects both.
Metal metal_of(Vec3 diffuse, Vec3 specular) {
  constexpr float kDielectric = 0.04F;
  const auto brightness = [](Vec3 c) {
    return std::sqrt(0.299F * c.x * c.x + 0.587F * c.y * c.y + 0.114F * c.z * c.z);
  };
  const float left = 1 - std::max({specular.x, specular.y, specular.z});
  const float d = brightness(diffuse), s = brightness(specular);
  float metallic = 0;
  if (s >= kDielectric) {
    const float b = d * left / (1 - kDielectric) + s - 2 * kDielectric, c = kDielectric - s;
    const float root = std::sqrt(std::max(b * b - 4 * kDielectric * c, 0.0F));
    metallic = std::clamp((root - b) / (2 * kDielectric), 0.0F, 1.0F);
  }
  const auto channel = [&](float diffuse_channel, float specular_channel) {
    const float a = diffuse_channel * left / (1 - kDielectric) / std::max(1 - metallic, 1e-6F);
    const float b = (specular_channel - kDielectric * (1 - metallic)) / std::max(metallic, 1e-6F);
    const float t = metallic * metallic;
    return std::clamp(a * (1 - t) + b * t, 0.0F, 1.0F);
  };
  return {{channel(diffuse.x, specular.x), channel(diffuse.y, specular.y),
           channel(diffuse.z, specular.z)},
          metallic};
}

Vec3d to_vec3d(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}
Vec4 to_vec4(const double (&v)[4]) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]),
          static_cast<float>(v[3])};
}

std::uint8_t byte(float share) {
  return static_cast<std::uint8_t>(std::clamp(share, 0.0F, 1.0F) * 255 + 0.5F);
}

}  // namespace

Materials::Materials(const Json& document, Buffers& buffers, Scene& scene)
    : document_(document), buffers_(buffers), scene_(scene), pictures_(buffers.budget()) {
  buffers.budget().resize(scene_.materials, length(document, "materials"));
  converted_.resize(scene_.materials.size());
}

std::uint32_t Materials::use(std::optional<std::size_t> material) {
  if (material) {
    if (!converted_[*material]) convert(*material);
    converted_[*material] = true;
    return static_cast<std::uint32_t>(*material);
  }
  if (converted_.empty()) return 0;  // a file without materials stays without
  if (!default_) {
    default_ = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.emplace_back().name = "default";
  }
  return *default_;
}

TextureUse Materials::texture_use(std::optional<std::size_t> material) const {
  if (!material) return {};
  const Json m = document_["materials"].at(*material);
  const auto glossy = m.extension(kSpecularGlossiness);
  const auto pbr = glossy ? glossy : m.get(kPbr);
  for (const char* key : {"baseColorTexture", "metallicRoughnessTexture", "diffuseTexture",
                          "specularGlossinessTexture"})
    if (pbr)
      if (const auto info = pbr->get(key)) return use_of(*info);
  for (const char* key : {"normalTexture", "emissiveTexture", "occlusionTexture"})
    if (const auto info = m.get(key)) return use_of(*info);
  return {};
}

void Materials::convert(std::size_t index) {
  const Json m = document_["materials"].at(index);
  const TextureUse expected = texture_use(index);
  Material r;
  r.name = m.string("name", "");
  double color[4] = {1, 1, 1, 1}, emissive[3] = {0, 0, 0};
  if (const auto glossy = m.extension(kSpecularGlossiness)) {
    convert_glossy(index, *glossy, expected, r);
  } else if (const auto pbr = m.get(kPbr)) {
    (void)pbr->numbers("baseColorFactor", color);
    r.metallic = pbr->real("metallicFactor", 1);
    r.roughness = pbr->real("roughnessFactor", 1);
    r.base_color_texture = texture(*pbr, "baseColorTexture", expected);
    r.metallic_roughness_texture = texture(*pbr, "metallicRoughnessTexture", expected);
  }
  r.base_color = to_vec4(color);
  r.normal_texture = texture(m, "normalTexture", expected);
  if (const auto info = m.get("normalTexture")) r.normal_scale = info->real("scale", 1);
  r.occlusion_texture = texture(m, "occlusionTexture", expected);
  if (const auto info = m.get("occlusionTexture")) r.occlusion_strength = info->real("strength", 1);
  r.emissive_texture = texture(m, "emissiveTexture", expected);
  (void)m.numbers("emissiveFactor", emissive);
  double strength = 1;
  if (const auto e = m.extension("KHR_materials_emissive_strength"))
    strength = static_cast<double>(e->real("emissiveStrength", 1));
  r.emissive = Vec3(to_vec3d(emissive) * strength);
  const std::string mode = m.string("alphaMode", "OPAQUE");
  r.alpha_mode = mode == "MASK"    ? AlphaMode::mask
                 : mode == "BLEND" ? AlphaMode::blend
                                   : AlphaMode::opaque;
  r.alpha_cutoff = m.real("alphaCutoff", 0.5F);
  r.double_sided = m.boolean("doubleSided", false);
  r.unlit = m.extension("KHR_materials_unlit").has_value();
  scene_.materials[index] = std::move(r);
}

void Materials::convert_glossy(std::size_t index, const Json& extension, const TextureUse& expected,
                               Material& to) {
  Glossy g{index};
  double diffuse[4] = {1, 1, 1, 1}, specular[3] = {1, 1, 1};
  (void)extension.numbers("diffuseFactor", diffuse);
  (void)extension.numbers("specularFactor", specular);
  g.diffuse = to_vec4(diffuse);
  g.specular = Vec3(to_vec3d(specular));
  g.glossiness = extension.real("glossinessFactor", 1);
  g.texture = texture(extension, "specularGlossinessTexture", expected);
  to.base_color_texture = texture(extension, "diffuseTexture", expected);
  glossy_.push_back(g);
}

/// Per pixel if there are pictures: only both colours together tell what is metal.
void Materials::finish(const Glossy& g) {
  Material& m = scene_.materials[g.material];
  const Vec3 diffuse{g.diffuse.x, g.diffuse.y, g.diffuse.z};
  const auto picture = [&](std::int32_t t) {
    return t == kNoTexture ? nullptr : &scene_.textures[static_cast<std::size_t>(t)];
  };
  const Texture* const colors = picture(m.base_color_texture);
  const Texture* const glosses = picture(g.texture);
  if (colors == nullptr && glosses == nullptr) {
    const auto [base, metallic] = metal_of(diffuse, g.specular);
    m.base_color = {base.x, base.y, base.z, g.diffuse.w};
    m.metallic = metallic;
    m.roughness = 1 - g.glossiness;
    return;
  }
  const auto larger = [&](auto size) {
    return std::max(colors ? size(colors->image) : 1, glosses ? size(glosses->image) : 1);
  };
  const int width = larger([](const Image<Rgba8>& i) { return i.width(); });
  const int height = larger([](const Image<Rgba8>& i) { return i.height(); });
  buffers_.budget().take(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height),
                         2 * sizeof(Rgba8));
  float linear[256], between[255];
  for (int i = 0; i < 256; ++i) linear[i] = static_cast<float>(linear_from_srgb(i / 255.0));
  for (int i = 0; i < 255; ++i) between[i] = (linear[i] + linear[i + 1]) / 2;
  const auto display = [&](float light) {
    return static_cast<std::uint8_t>(std::upper_bound(between, between + 255, light) - between);
  };
  const auto at = [&](const Texture* t, int x, int y) {
    if (t == nullptr) return Rgba8{255, 255, 255, 255};
    return t->image(static_cast<int>(std::int64_t{x} * t->image.width() / width),
                    static_cast<int>(std::int64_t{y} * t->image.height() / height));
  };
  Texture base = colors ? *colors : *glosses, rough = base;
  base.image = Image<Rgba8>(width, height);
  rough.image = Image<Rgba8>(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Rgba8 d = at(colors, x, y), s = at(glosses, x, y);
      const Metal metal = metal_of(
          {diffuse.x * linear[d.r], diffuse.y * linear[d.g], diffuse.z * linear[d.b]},
          {g.specular.x * linear[s.r], g.specular.y * linear[s.g], g.specular.z * linear[s.b]});
      base.image(x, y) = {display(metal.base.x), display(metal.base.y), display(metal.base.z), d.a};
      rough.image(x, y) = {255, byte(1 - g.glossiness * (static_cast<float>(s.a) / 255)),
                           byte(metal.metallic), 255};
    }
  m.base_color = {1, 1, 1, g.diffuse.w};
  m.metallic = m.roughness = 1;
  m.base_color_texture = static_cast<std::int32_t>(scene_.textures.size());
  m.metallic_roughness_texture = m.base_color_texture + 1;
  scene_.textures.push_back(std::move(base));
  scene_.textures.push_back(std::move(rough));
}

std::int32_t Materials::texture(const Json& owner, const char* key, const TextureUse& expected) {
  const auto info = owner.get(key);
  if (!info) return kNoTexture;
  if (use_of(*info) != expected) {
    scene_.warnings.push_back(info->path() +
                              " has other texture coordinates or another transform than the "
                              "material's first texture; drawn without it");
    return kNoTexture;
  }
  const std::size_t index = (*info)["index"].count();
  const auto known = textures_.find(index);
  if (known != textures_.end()) return known->second;
  return textures_[index] = load_texture(index);
}

std::int32_t Materials::load_texture(std::size_t index) {
  const Json t = document_["textures"].at(index);
  auto source = t.get("source");
  const auto webp = t.extension(kWebp);
  if (webp && has_webp()) source = webp->get("source");
  if (!source) {
    const char* const why = webp ? "needs EXT_texture_webp, but this rastrum was built without "
                                   "libwebp (Debian: libwebp-dev)"
                            : t.extension(kBasisu)
                                ? "needs KHR_texture_basisu, which is not read here"
                                : "has no source that is read here";
    scene_.warnings.push_back(t.path() + " " + why + "; drawn without it");
    return kNoTexture;
  }
  Texture sampler;
  if (const auto s = t.get("sampler")) {
    const Json values = document_["samplers"].at(s->count());
    sampler.wrap_u = wrap_of(values.count("wrapS", 10497));
    sampler.wrap_v = wrap_of(values.count("wrapT", 10497));
    sampler.mag =
        values.count("magFilter", 9729) == 9728 ? TextureFilter::nearest : TextureFilter::linear;
    const std::size_t min = values.count("minFilter", 9987);
    sampler.min =
        min == 9728 || min == 9984 || min == 9986 ? TextureFilter::nearest : TextureFilter::linear;
    sampler.mipmaps = min >= 9984;
  }
  const std::size_t image = source->count();
  const auto [known, is_new] = images_.try_emplace(image);
  if (is_new) known->second = load_image(document_["images"].at(image));
  if (!known->second) return kNoTexture;
  const std::size_t picture = *known->second;
  bool is_first = true;
  for (std::size_t i = 0; i < picture_of_.size(); ++i) {
    if (picture_of_[i] != picture) continue;
    if (sampler_of(scene_.textures[i]) == sampler_of(sampler)) return static_cast<std::int32_t>(i);
    is_first = false;
  }
  if (!is_first) pictures_.use_again(picture);  // through another sampler
  sampler.name = document_["images"].at(image).string("name", "");
  picture_of_.push_back(picture);
  scene_.textures.push_back(std::move(sampler));
  return static_cast<std::int32_t>(scene_.textures.size()) - 1;
}

/// A picture that cannot be read costs the texture, not the scene.
void Materials::decode_images() {
  pictures_.decode_all();
  std::vector<std::int32_t> place(scene_.textures.size(), kNoTexture);
  std::vector<bool> warned(scene_.textures.size());
  std::vector<Texture> sound;
  for (std::size_t i = 0; i < place.size(); ++i) {
    const std::size_t picture = picture_of_[i];
    try {
      scene_.textures[i].image = pictures_.take(picture);
    } catch (const Error& e) {
      if (is_of_the_call(e)) throw;
      if (!warned[picture])
        scene_.warnings.push_back(std::string("drawn without a texture: ") + e.what());
      warned[picture] = true;
      continue;
    }
    place[i] = static_cast<std::int32_t>(sound.size());
    sound.push_back(std::move(scene_.textures[i]));
  }
  scene_.textures = std::move(sound);
  const auto move = [&](std::int32_t& t) {
    if (t != kNoTexture) t = place[static_cast<std::size_t>(t)];
  };
  for (Material& m : scene_.materials)
    for (std::int32_t* const t : {&m.base_color_texture, &m.metallic_roughness_texture,
                                  &m.normal_texture, &m.occlusion_texture, &m.emissive_texture})
      move(*t);
  for (Glossy& g : glossy_) {
    move(g.texture);
    finish(g);
  }
}

std::optional<std::size_t> Materials::load_image(const Json& image) {
  try {
    std::optional<Bytes> bytes;
    if (const auto uri = image.get("uri"))
      bytes = buffers_.uri(uri->string(), *uri);
    else
      bytes = buffers_.view(image["bufferView"].count());
    if (!bytes) image.fail("has no bytes");
    const auto [known, is_new] = picture_at_.try_emplace({bytes->data(), bytes->size()});
    if (is_new)
      known->second =
          pictures_.add([&budget = buffers_.budget(), at = *bytes, name = image.path()] {
            return decode_picture(at, name, budget);
          });
    return known->second;
  } catch (const Error& e) {
    if (is_of_the_call(e)) throw;
    scene_.warnings.push_back(std::string("drawn without a texture: ") + e.what());
    return std::nullopt;
  }
}

}  // namespace rastrum::io::gltf
