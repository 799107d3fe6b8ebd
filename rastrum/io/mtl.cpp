// MTL through tinyobjloader, onto the metallic-roughness material: Kd and map_Kd are the base
// colour, d (or 1 − Tr) its alpha, map_d a cut-out mask, Ke emission; Ns becomes a roughness. An
// MTL surface is a dielectric: metallic 0.
#include <algorithm>
#include <cmath>
#include <exception>
#include <istream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <tiny_obj_loader.h>

#include <rastrum/io/io.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>

namespace rastrum::io {
namespace {

namespace fs = std::filesystem;

/// Textures of one .mtl file, each file read once.
class TextureReader {
 public:
  TextureReader(const fs::path& file, Scene& scene)
      : folder_(file.parent_path()), name_(file.string()), scene_(scene) {}

  std::int32_t operator()(const std::string& name, const tinyobj::texture_option_t& option) {
    if (name.empty()) return kNoTexture;
    const std::string key = name + (option.clamp ? "\n" : "");
    const auto [it, is_new] = known_.emplace(key, kNoTexture);
    if (is_new) it->second = read(name, option.clamp);
    return it->second;
  }

  void warn() {
    if (!substitutes_.empty())
      scene_.warnings.push_back(name_ + ": a .png or .jpg of the same name was read instead of " +
                                substitutes_);
  }

 private:
  std::int32_t read(const std::string& name, bool clamp) {
    std::string relative = name;
    std::replace(relative.begin(), relative.end(), '\\', '/');
    const fs::path file = find(folder_ / relative);
    try {
      Texture t;
      t.image = read_image(file);
      t.name = file.filename().string();
      if (clamp) t.wrap_u = t.wrap_v = Wrap::clamp_to_edge;
      scene_.textures.push_back(std::move(t));
      return static_cast<std::int32_t>(scene_.textures.size()) - 1;
    } catch (const Error& e) {
      if (e.code() == Errc::out_of_memory) throw;
      scene_.warnings.push_back(name_ + ": drawn without a texture: " + e.what());
      return kNoTexture;
    }
  }

  /// Libraries are often passed on with their pictures converted and their names not.
  fs::path find(const fs::path& file) {
    std::error_code ignored;
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    const bool readable = extension == ".png" || extension == ".jpg" || extension == ".jpeg";
    if (readable && fs::exists(file, ignored)) return file;
    for (const char* other : {".png", ".jpg", ".jpeg"}) {
      fs::path twin = file;
      twin.replace_extension(other);
      if (!fs::is_regular_file(twin, ignored)) continue;
      substitutes_ += (substitutes_.empty() ? "" : ", ") + file.filename().string();
      return twin;
    }
    return file;
  }

  fs::path folder_;
  std::string substitutes_;
  std::string name_;
  Scene& scene_;
  std::map<std::string, std::int32_t> known_;
};

float finite_or(double x, float otherwise) {
  return std::isfinite(x) ? static_cast<float>(x) : otherwise;
}

Material convert(const tinyobj::material_t& m, TextureReader& texture) {
  Material r;
  r.double_sided = true;  // MTL knows no sides
  r.name = m.name;
  const auto channel = [](double x) { return std::clamp(finite_or(x, 1), 0.0F, 1.0F); };
  r.base_color = {channel(m.diffuse[0]), channel(m.diffuse[1]), channel(m.diffuse[2]),
                  channel(m.dissolve)};
  r.metallic = 0;
  // The Blinn–Phong exponent whose lobe is as wide as a GGX lobe of this roughness (α = roughness²,
  // Ns = 2 / α² − 2).
  const float shininess = std::max(0.0F, finite_or(m.shininess, 0));
  r.roughness = std::sqrt(std::sqrt(2 / (shininess + 2)));
  r.emissive = {std::max(0.0F, finite_or(m.emission[0], 0)),
                std::max(0.0F, finite_or(m.emission[1], 0)),
                std::max(0.0F, finite_or(m.emission[2], 0))};
  r.base_color_texture = texture(m.diffuse_texname, m.diffuse_texopt);
  r.emissive_texture = texture(m.emissive_texname, m.emissive_texopt);
  r.alpha_texture = texture(m.alpha_texname, m.alpha_texopt);
  // A map without its factor: the factor is 1 (the loader does so for map_Kd).
  if (r.emissive_texture != kNoTexture && r.emissive == Vec3{0, 0, 0}) r.emissive = {1, 1, 1};
  if (r.alpha_texture != kNoTexture)
    r.alpha_mode = AlphaMode::mask;
  else if (r.base_color.w < 1)
    r.alpha_mode = AlphaMode::blend;
  return r;
}

}  // namespace

void read_mtl(const fs::path& file, Scene& scene,
              std::unordered_map<std::string, std::uint32_t>& by_name) {
  std::optional<MappedFile> mapped;
  try {
    mapped.emplace(file);
  } catch (const Error& e) {
    scene.warnings.push_back(std::string("drawn without these materials: ") + e.what());
    return;
  }
  parse_mtl(mapped->bytes(), file, scene, by_name);
}

void parse_mtl(Bytes bytes, const fs::path& file, Scene& scene,
               std::unordered_map<std::string, std::uint32_t>& by_name) {
  std::map<std::string, int> index_of;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  try {
    std::istringstream in{std::string(as_text(bytes))};
    tinyobj::LoadMtl(&index_of, &materials, &in, &warning, &error);
  } catch (const std::exception& e) {
    scene.warnings.push_back(file.string() + ": drawn without these materials: " + e.what());
    return;
  }
  for (std::string* s : {&warning, &error}) {
    if (s->empty()) continue;
    const auto lines = std::count(s->begin(), s->end(), '\n');
    scene.warnings.push_back(file.string() + ": " +
                             s->substr(0, std::min<std::size_t>(s->find('\n'), 200)) +
                             (lines > 1 ? " (and " + std::to_string(lines - 1) + " more)" : ""));
  }
  TextureReader texture(file, scene);
  for (const tinyobj::material_t& m : materials) {
    if (m.name.empty()) continue;  // the loader ends every file with one, even an empty file
    if (by_name.emplace(m.name, static_cast<std::uint32_t>(scene.materials.size())).second)
      scene.materials.push_back(convert(m, texture));
  }
  texture.warn();
}

}  // namespace rastrum::io
