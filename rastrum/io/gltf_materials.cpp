// Materials, samplers, textures and images of glTF. What a mesh carries is one set of texture
// coordinates; so KHR_texture_transform is applied to them when the mesh is read, and all textures
// of a material must agree on set and transform.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <rastrum/core/elementary.hpp>
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

Wrap wrap_of(std::size_t value) {
  return value == 33071   ? Wrap::clamp_to_edge
         : value == 33648 ? Wrap::mirrored_repeat
                          : Wrap::repeat;
}

}  // namespace

Materials::Materials(const Json& document, Buffers& buffers, Scene& scene)
    : document_(document), buffers_(buffers), scene_(scene) {
  scene_.materials.resize(length(document, "materials"));
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
  const auto pbr = m.get(kPbr);
  for (const char* key : {"baseColorTexture", "metallicRoughnessTexture"})
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
  if (const auto pbr = m.get(kPbr)) {
    (void)pbr->numbers("baseColorFactor", color);
    r.metallic = pbr->real("metallicFactor", 1);
    r.roughness = pbr->real("roughnessFactor", 1);
    r.base_color_texture = texture(*pbr, "baseColorTexture", expected);
    r.metallic_roughness_texture = texture(*pbr, "metallicRoughnessTexture", expected);
  }
  r.base_color = {static_cast<float>(color[0]), static_cast<float>(color[1]),
                  static_cast<float>(color[2]), static_cast<float>(color[3])};
  r.normal_texture = texture(m, "normalTexture", expected);
  if (const auto info = m.get("normalTexture")) r.normal_scale = info->real("scale", 1);
  r.occlusion_texture = texture(m, "occlusionTexture", expected);
  if (const auto info = m.get("occlusionTexture")) r.occlusion_strength = info->real("strength", 1);
  r.emissive_texture = texture(m, "emissiveTexture", expected);
  (void)m.numbers("emissiveFactor", emissive);
  double strength = 1;
  if (const auto e = m.extension("KHR_materials_emissive_strength"))
    strength = static_cast<double>(e->real("emissiveStrength", 1));
  r.emissive = {static_cast<float>(emissive[0] * strength),
                static_cast<float>(emissive[1] * strength),
                static_cast<float>(emissive[2] * strength)};
  const std::string mode = m.string("alphaMode", "OPAQUE");
  r.alpha_mode = mode == "MASK"    ? AlphaMode::mask
                 : mode == "BLEND" ? AlphaMode::blend
                                   : AlphaMode::opaque;
  r.alpha_cutoff = m.real("alphaCutoff", 0.5F);
  r.double_sided = m.boolean("doubleSided", false);
  r.unlit = m.extension("KHR_materials_unlit").has_value();
  scene_.materials[index] = std::move(r);
}

std::int32_t Materials::texture(const Json& owner, const char* key, const TextureUse& expected) {
  const auto info = owner.get(key);
  if (!info) return kNoTexture;
  if (use_of(*info) != expected)
    scene_.warnings.push_back(info->path() +
                              " has texture coordinates or a transform of its own; the "
                              "material's first texture's are taken");
  const std::size_t index = (*info)["index"].count();
  const auto known = textures_.find(index);
  if (known != textures_.end()) return known->second;
  return textures_[index] = load_texture(index);
}

std::int32_t Materials::load_texture(std::size_t index) {
  const Json t = document_["textures"].at(index);
  const auto source = t.get("source");
  if (!source) {
    scene_.warnings.push_back(t.path() + " has no source that is read here; drawn without it");
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
  const auto known = images_.find(image);
  const std::int32_t first =
      known != images_.end() ? known->second : load_image(document_["images"].at(image));
  if (first == kNoTexture) {
    images_[image] = kNoTexture;
    return kNoTexture;
  }
  const auto set_sampler = [&](Texture& to) {
    to.wrap_u = sampler.wrap_u;
    to.wrap_v = sampler.wrap_v;
    to.mag = sampler.mag;
    to.min = sampler.min;
    to.mipmaps = sampler.mipmaps;
  };
  if (known == images_.end()) {
    images_[image] = first;
    set_sampler(scene_.textures[static_cast<std::size_t>(first)]);
    return first;
  }
  // The image again, perhaps through another sampler.
  Texture copy = scene_.textures[static_cast<std::size_t>(first)];
  const Texture& old = scene_.textures[static_cast<std::size_t>(first)];
  set_sampler(copy);
  if (copy.wrap_u == old.wrap_u && copy.wrap_v == old.wrap_v && copy.mag == old.mag &&
      copy.min == old.min && copy.mipmaps == old.mipmaps)
    return first;
  picture_of_.push_back(picture_of_[static_cast<std::size_t>(first)]);
  pictures_.use_again(picture_of_.back());
  scene_.textures.push_back(std::move(copy));
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
      if (e.code() == Errc::out_of_memory) throw;
      if (!warned[picture])
        scene_.warnings.push_back(std::string("drawn without a texture: ") + e.what());
      warned[picture] = true;
      continue;
    }
    place[i] = static_cast<std::int32_t>(sound.size());
    sound.push_back(std::move(scene_.textures[i]));
  }
  scene_.textures = std::move(sound);
  for (Material& m : scene_.materials)
    for (std::int32_t* const t : {&m.base_color_texture, &m.metallic_roughness_texture,
                                  &m.normal_texture, &m.occlusion_texture, &m.emissive_texture})
      if (*t != kNoTexture) *t = place[static_cast<std::size_t>(*t)];
}

std::int32_t Materials::load_image(const Json& image) {
  try {
    std::optional<Bytes> bytes;
    if (const auto uri = image.get("uri"))
      bytes = buffers_.uri(uri->string(), *uri);
    else
      bytes = buffers_.view(image["bufferView"].count());
    if (!bytes) image.fail("has no bytes");
    Texture t;
    t.name = image.string("name", "");
    picture_of_.push_back(
        pictures_.add([at = *bytes, name = image.path()] { return decode_image(at, name); }));
    scene_.textures.push_back(std::move(t));
    return static_cast<std::int32_t>(scene_.textures.size()) - 1;
  } catch (const Error& e) {
    if (e.code() == Errc::out_of_memory) throw;
    scene_.warnings.push_back(std::string("drawn without a texture: ") + e.what());
    return kNoTexture;
  }
}

}  // namespace rastrum::io::gltf
