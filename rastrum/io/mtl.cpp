// SPDX-License-Identifier: BSD-3-Clause
// MTL, the materials of OBJ files, as metallic-roughness materials. Kd and map_Kd are the base
// colour, d (or 1 − Tr) its alpha, map_d a cut-out mask, Ke and map_Ke emission. Ns becomes a
// roughness, unless the physically based extension (Pr, Pm, norm) gives it. Ambient and specular
// colours and illumination models, which most files have, are not drawn. A warning names other keys
// and the first line that cannot be read, which many files have.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <rastrum/core/lower.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/beside.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/pictures.hpp>
#include <rastrum/io/reading.hpp>
#include <rastrum/io/text_cursor.hpp>

namespace rastrum::io {
namespace {

namespace fs = std::filesystem;

/// The part of its picture that a map takes: colours, or one channel, which becomes red.
enum class Channel : std::uint8_t { colors, red, green, blue, alpha, luminance };

/// The file and options of map_Kd and the like. Without a name there is no map.
struct TextureMap {
  std::string name{};
  bool clamp = false;
  float multiplier = 1;              ///< -bm
  float base = 0, gain = 1;          ///< -mm
  std::optional<Channel> channel{};  ///< -imfchan
  TextureTransform transform{};      ///< -o and -s

  /// Textures of equal keys have the same pixels.
  [[nodiscard]] auto key(Channel which) const { return std::tuple(name, clamp, base, gain, which); }
};

bool has_alpha(const Image<Rgba8>& image) {
  return std::ranges::any_of(image.pixels(), [](const Rgba8& p) { return p.a != 255; });
}

void take_channel(Image<Rgba8>& image, Channel channel) {
  if (channel == Channel::colors || channel == Channel::red) return;
  for (Rgba8& p : image.pixels())
    p.r = channel == Channel::green  ? p.g
          : channel == Channel::blue ? p.b
          : channel == Channel::alpha
              ? p.a
              : static_cast<std::uint8_t>((54 * p.r + 183 * p.g + 19 * p.b + 128) / 256);
}

/// Maps colour channels x to base + gain · x.
void stretch(Image<Rgba8>& image, float base, float gain) {
  if (base == 0 && gain == 1) return;
  std::uint8_t to[256];
  for (int i = 0; i < 256; ++i)
    to[i] = static_cast<std::uint8_t>(
        std::clamp(255 * base + gain * static_cast<float>(i), 0.0F, 255.0F) + 0.5F);
  for (Rgba8& p : image.pixels()) p = {to[p.r], to[p.g], to[p.b], p.a};
}

struct MtlMaterial {
  std::string name{};
  std::optional<Vec3> diffuse{}, emission{};
  std::optional<float> dissolve{}, transparency{};  ///< d and Tr; the first wins
  float shininess = 1;
  std::optional<float> roughness{}, metallic{};
  TextureMap diffuse_map{}, emission_map{}, alpha_map{}, normal_map{};

  [[nodiscard]] std::array<const TextureMap*, 4> maps() const {
    return {&diffuse_map, &emission_map, &alpha_map, &normal_map};
  }
};

class TextureReader {
 public:
  TextureReader(const fs::path& file, Scene& scene, Reading& reading)
      : folder_(file.parent_path()),
        name_(file.string()),
        scene_(scene),
        reading_(reading),
        pictures_(reading.budget) {}

  void read(const std::vector<MtlMaterial>& materials) {
    for (const MtlMaterial& m : materials)
      for (const TextureMap* const map : m.maps()) add(*map);
    pictures_.decode_all();
  }

  /// Requires read() with the map's material.
  std::int32_t operator()(const TextureMap& map, Channel channel = Channel::colors) {
    if (map.name.empty()) return kNoTexture;
    const auto [it, is_new] = known_.emplace(map.key(channel), kNoTexture);
    if (is_new) it->second = make(map, channel);
    return it->second;
  }
  /// The channel of map_d: that of -imfchan, else the picture's alpha, if it has one.
  [[nodiscard]] Channel alpha_channel(const TextureMap& map) const {
    if (map.channel) return *map.channel == Channel::red ? Channel::colors : *map.channel;
    const auto file = files_.find(map.name);
    return file != files_.end() && file->second.has_alpha ? Channel::alpha : Channel::colors;
  }

  void warn() {
    if (!substitutes_.empty())
      scene_.warnings.push_back(name_ + ": a .png or .jpg of the same name was read instead of " +
                                substitutes_);
    if (!elsewhere_.empty())
      scene_.warnings.push_back(name_ + ": read from beside this file: " + elsewhere_);
  }

 private:
  struct File {
    fs::path path;
    std::size_t picture = 0;
    bool has_alpha = false;
  };

  void add(const TextureMap& map) {
    if (map.name.empty()) return;
    const auto [it, is_new] = files_.try_emplace(map.name);
    File& file = it->second;
    if (!is_new) return pictures_.use_again(file.picture);
    file.path = find(map.name);
    file.picture = pictures_.add([this, &file] {
      Image<Rgba8> image =
          decode_picture(reading_.open(file.path), file.path.string(), reading_.budget);
      file.has_alpha = has_alpha(image);
      return image;
    });
  }

  std::int32_t make(const TextureMap& map, Channel channel) {
    const File& file = files_.at(map.name);
    return add_texture(scene_.textures, scene_.warnings, name_, file.path, [&] {
      Texture t{.image = pictures_.take(file.picture)};
      take_channel(t.image, channel);
      stretch(t.image, map.base, map.gain);
      if (map.clamp) t.wrap_u = t.wrap_v = Wrap::clamp_to_edge;
      return t;
    });
  }

  /// Libraries are often passed on with converted pictures but old names.
  fs::path find(const std::string& name) {
    const FoundFile found = find_beside(folder_, name);
    const fs::path& file = found.path;
    std::error_code ignored;
    const std::string extension = lower(file.extension().string());
    const bool readable = extension == ".png" || extension == ".jpg" || extension == ".jpeg";
    if (readable && fs::exists(file, ignored)) {
      if (!found.as_named) note_name(elsewhere_, name);
      return file;
    }
    for (const char* other : {".png", ".jpg", ".jpeg"}) {
      fs::path twin(unquoted(name));
      twin.replace_extension(other);
      twin = find_beside(folder_, twin.string()).path;
      if (!fs::is_regular_file(twin, ignored)) continue;
      note_name(substitutes_, file.filename().string());
      return twin;
    }
    return file;
  }

  fs::path folder_;
  std::string substitutes_, elsewhere_;
  std::string name_;
  Scene& scene_;
  Reading& reading_;
  Pictures pictures_;
  std::map<std::string, File> files_;                             ///< by name
  std::map<decltype(TextureMap{}.key({})), std::int32_t> known_;  ///< textures of the scene
};

Material convert(const MtlMaterial& m, TextureReader& texture) {
  const auto channel = [](float x) { return std::clamp(x, 0.0F, 1.0F); };
  Material r;
  r.double_sided = true;  // MTL knows no sides
  r.name = m.name;
  // A map of diffuse colours without a factor gets 0.6, as in most readers of MTL.
  const float factor = m.diffuse_map.name.empty() ? 0 : 0.6F;
  const Vec3 diffuse = m.diffuse.value_or(Vec3{factor, factor, factor});
  const float alpha = m.dissolve.value_or(1 - m.transparency.value_or(0));
  r.base_color = {channel(diffuse.x), channel(diffuse.y), channel(diffuse.z), channel(alpha)};
  r.metallic = channel(m.metallic.value_or(0));  // a surface is a dielectric if not told otherwise
  // The Blinn–Phong exponent whose lobe is as wide as a GGX lobe of this roughness (α = roughness²,
  // Ns = 2 / α² − 2).
  r.roughness = m.roughness ? channel(*m.roughness)
                            : std::sqrt(std::sqrt(2 / (std::max(0.0F, m.shininess) + 2)));
  const Vec3 emission = m.emission.value_or(Vec3{0, 0, 0});
  r.emissive = {std::max(0.0F, emission.x), std::max(0.0F, emission.y), std::max(0.0F, emission.z)};
  r.base_color_texture = texture(m.diffuse_map);
  r.emissive_texture = texture(m.emission_map);
  const Channel alpha_channel = texture.alpha_channel(m.alpha_map);
  // The base colour's picture already has this alpha, which must not count twice.
  const bool has_alpha = r.base_color_texture != kNoTexture && alpha_channel == Channel::alpha &&
                         m.alpha_map.name == m.diffuse_map.name;
  if (!has_alpha) r.alpha_texture = texture(m.alpha_map, alpha_channel);
  r.normal_texture = texture(m.normal_map);
  r.normal_scale = m.normal_map.multiplier;
  // A map without its factor has the factor 1.
  if (r.emissive_texture != kNoTexture && r.emissive == Vec3{0, 0, 0}) r.emissive = {1, 1, 1};
  if (r.alpha_texture != kNoTexture || has_alpha)
    r.alpha_mode = AlphaMode::mask;
  else if (r.base_color.w < 1)
    r.alpha_mode = AlphaMode::blend;
  return r;
}

class MtlReader {
 public:
  MtlReader(Bytes bytes, const fs::path& file, Scene& scene,
            std::unordered_map<std::string, std::uint32_t>& by_name, Reading& reading)
      : name_(file.string()),
        is_secret_(reading.is_outside(file)),
        text_(as_text(bytes), name_),
        in_(text_.cursor()),
        texture_(file, scene, reading),
        scene_(scene),
        by_name_(by_name) {}

  /// `transforms` gets one per material of the scene.
  void read(std::vector<TextureTransform>& transforms) {
    while (!in_.at_end()) {
      start_ = in_.offset();
      const std::string_view line = in_.line();
      TextCursor words(line, name_);
      if (!words.at_line_end() && words.peek() != '#') statement(words);
    }
    finish_material();
    texture_.read(materials_);
    bool nothing_is_seen = !materials_.empty();
    for (const MtlMaterial& m : materials_) {
      scene_.materials.push_back(convert(m, texture_));
      const Material& made = scene_.materials.back();
      nothing_is_seen = nothing_is_seen && made.base_color.w == 0;
      transforms.resize(scene_.materials.size());
      transforms.back() = transform_of(m);
    }
    if (unequal_ != 0)
      scene_.warnings.push_back(
          first_unequal_ +
          (unequal_ > 1 ? " (and so of " + std::to_string(unequal_ - 1) + " more)" : ""));
    if (nothing_is_seen)
      say("all its materials have d 0 or Tr 1, so nothing is seen "
          "(some programs write that for opaque ones)");
    if (!unknown_.empty()) {
      std::string keys;
      for (const auto& [key, count] : unknown_)
        keys += (keys.empty() ? "" : ", ") + std::to_string(count) + " × " + key;
      say("statements that are not drawn: " + keys);
    }
    if (wrong_ != 0)
      scene_.warnings.push_back(
          first_wrong_ + (wrong_ > 1 ? " (and " + std::to_string(wrong_ - 1) + " more)" : ""));
    texture_.warn();
  }

 private:
  void statement(TextCursor& words) {
    const std::string_view key = words.token();
    if (key == "newmtl") {
      finish_material();
      material_ = {};
      words.skip_blanks();
      material_.name = words.line();
      if (material_.name.empty()) wrong("newmtl without a name");
    } else if (key == "Kd") {
      color(words, key, material_.diffuse);
    } else if (key == "Ke") {
      color(words, key, material_.emission);
    } else if (key == "Ns") {
      if (const auto x = number(words, key)) material_.shininess = *x;
    } else if (key == "d") {
      if (TextCursor at = words; at.token() == "-halo")
        words = at;  // alpha by the angle: not drawn
      assign(material_.dissolve, number(words, key));
      compare_alphas();
    } else if (key == "Tr") {
      assign(material_.transparency, number(words, key));
      compare_alphas();
    } else if (key == "Pr") {
      assign(material_.roughness, number(words, key));
    } else if (key == "Pm") {
      assign(material_.metallic, number(words, key));
    } else if (key == "map_Kd") {
      map(words, key, material_.diffuse_map);
    } else if (key == "map_Ke") {
      map(words, key, material_.emission_map);
    } else if (key == "map_d") {
      map(words, key, material_.alpha_map);
    } else if (key == "norm") {
      map(words, key, material_.normal_map);
    } else if (std::ranges::find(kSilent, key) == kSilent.end() && !material_.name.empty()) {
      const std::string name = printable(key.substr(0, 24));
      if (unknown_.size() < 8 || unknown_.contains(name)) ++unknown_[name];
    }
  }

  /// Keys without a warning, because most files have them and look right without: ambient light,
  /// highlights (roughness decides), refraction, illumination models.
  static constexpr std::array<std::string_view, 8> kSilent = {"Ka",     "Ks", "Ni", "illum",
                                                              "map_Ka", "Tf", "Km", "sharpness"};

  /// The transform of the material's first map, used for all its maps.
  TextureTransform transform_of(const MtlMaterial& m) {
    const TextureMap* first = nullptr;
    for (const TextureMap* const map : m.maps()) {
      if (map->name.empty()) continue;
      if (first == nullptr) first = map;
      if (map->transform == first->transform) continue;
      if (unequal_++ == 0)
        first_unequal_ = name_ + ": the maps of " + io::quoted(m.name) +
                         " have -s or -o of their own: all are drawn with those of " +
                         printable(first->name.substr(0, 60));
      break;
    }
    return first == nullptr ? TextureTransform{} : first->transform;
  }

  std::optional<float> number(TextCursor& words, std::string_view key) {
    const std::optional<float> x = words.optional_word<float>();
    if (x && std::isfinite(*x)) return x;
    wrong(x ? std::string(key) + " is not finite" : missing(words, key, "a number"));
    return {};
  }

  static void assign(std::optional<float>& to, std::optional<float> x) {
    if (x) to = x;
  }

  /// One number stands for all three.
  void color(TextCursor& words, std::string_view key, std::optional<Vec3>& to) {
    const auto r = number(words, key);
    if (!r) return;
    if (words.at_line_end()) {
      to = {*r, *r, *r};
      return;
    }
    const auto g = number(words, key);
    const auto b = g ? number(words, key) : g;
    if (b) to = {*r, *g, *b};
  }

  /// Most files write 1 − d as Tr, some d. Warns if they differ by more than their digits.
  void compare_alphas() {
    const auto [d, tr] = std::pair(material_.dissolve, material_.transparency);
    if (d && tr && std::abs(*d - (1 - *tr)) > 0.005F)
      wrong("d and Tr of " + io::quoted(material_.name) + " differ: d is taken");
  }

  /// Reads options, then a name to the end of the line, which may hold spaces.
  void map(TextCursor& words, std::string_view key, TextureMap& to) {
    TextureMap map;
    while (!words.at_line_end() && words.peek() == '-' && option(words, map)) continue;
    if (words.at_line_end()) return wrong(missing(words, key, "the name of a picture"));
    map.name = unquoted(words.line());
    to = std::move(map);
  }

  /// Reads at most `N` finite numbers; the others keep their values.
  template <std::size_t N>
  static void numbers(TextCursor& words, const std::array<float*, N>& to) {
    for (float* const x : to) {
      const auto read = words.optional_word<float>();
      if (!read) return;
      if (std::isfinite(*read)) *x = *read;
    }
  }

  /// False, with `words` unchanged, if a name begins with a dash.
  static bool option(TextCursor& words, TextureMap& map) {
    static constexpr std::array<std::string_view, 7> kOneWord = {
        "-blendu", "-blendv", "-boost", "-cc", "-colorspace", "-texres", "-type"};
    TextCursor at = words;
    const std::string_view name = at.token();
    float unused = 0;
    if (name == "-o") {
      numbers<3>(at, {&map.transform.offset.x, &map.transform.offset.y, &unused});
    } else if (name == "-s") {
      numbers<3>(at, {&map.transform.scale.x, &map.transform.scale.y, &unused});
    } else if (name == "-t") {  // turbulence, which is not drawn
      numbers<3>(at, {&unused, &unused, &unused});
    } else if (name == "-mm") {
      numbers<2>(at, {&map.base, &map.gain});
    } else if (name == "-imfchan") {
      constexpr std::string_view kNames = "rgbml";
      const std::string_view which = at.token();
      if (const std::size_t i = kNames.find(which); which.size() == 1 && i != kNames.npos)
        map.channel = static_cast<Channel>(i + 1);
    } else if (name == "-bm") {
      if (const auto x = at.optional_word<float>(); x && std::isfinite(*x)) map.multiplier = *x;
    } else if (name == "-clamp") {
      map.clamp = at.token() != "off";
    } else if (std::find(kOneWord.begin(), kOneWord.end(), name) != kOneWord.end()) {
      at.token();
    } else {
      return false;
    }
    words = at;
    return true;
  }

  static std::string missing(TextCursor& words, std::string_view key, const char* what) {
    const bool at_end = words.at_line_end();
    return std::string(key) + " wants " + what + ", found " +
           (at_end ? "the end of the line" : io::quoted(words.token()));
  }

  void say(const std::string& what) { scene_.warnings.push_back(name_ + ": " + what); }

  /// Counts instead of throwing, because a large file may be wrong in all its lines.
  void wrong(const std::string& message) {
    if (wrong_++ == 0)
      first_wrong_ = name_ + ":" + std::to_string(in_.line_of(start_)) + ": " +
                     (is_secret_ ? "cannot be read as a material's" : message);
  }

  /// The first material of a name wins. Statements before any name are dropped.
  void finish_material() {
    if (material_.name.empty()) return;
    const auto index = static_cast<std::uint32_t>(scene_.materials.size() + materials_.size());
    if (by_name_.emplace(material_.name, index).second) materials_.push_back(std::move(material_));
  }

  std::string name_;
  bool is_secret_;  ///< outside of the document's folder: messages must not quote it
  TextFile text_;
  TextCursor in_;
  TextureReader texture_;
  Scene& scene_;
  std::unordered_map<std::string, std::uint32_t>& by_name_;
  MtlMaterial material_{};              ///< being read
  std::vector<MtlMaterial> materials_;  ///< finished
  std::size_t start_ = 0;               ///< of the statement being read
  std::size_t wrong_ = 0, unequal_ = 0;
  std::string first_wrong_{}, first_unequal_{};
  std::map<std::string, std::size_t> unknown_{};  ///< keys that are not drawn
};

}  // namespace

void read_mtl(const fs::path& file, Scene& scene,
              std::unordered_map<std::string, std::uint32_t>& by_name,
              std::vector<TextureTransform>& transforms, Reading& reading) {
  Bytes bytes;
  try {
    bytes = reading.open(file);
  } catch (const Error& e) {
    scene.warnings.push_back(std::string("drawn without these materials: ") + e.what());
    return;
  }
  MtlReader(bytes, file, scene, by_name, reading).read(transforms);
}

void parse_mtl(Bytes bytes, const fs::path& file, Scene& scene,
               std::unordered_map<std::string, std::uint32_t>& by_name) {
  Reading reading(file, bytes.size(), {});
  std::vector<TextureTransform> unused;
  MtlReader(bytes, file, scene, by_name, reading).read(unused);
}

}  // namespace rastrum::io
