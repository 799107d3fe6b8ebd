// SPDX-License-Identifier: BSD-3-Clause
// The entry points of io.hpp: which reader for which file.
#include <rastrum/io.hpp>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <new>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/lower.hpp>
#include <rastrum/core/srgb.hpp>
#include <rastrum/io/binary_stl.hpp>
#include <rastrum/io/files.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::io {
namespace {

struct Reader {
  const char* extension;
  Scene (*parse)(Bytes, const std::filesystem::path&, Reading&);
};
constexpr Reader kReaders[] = {
    {".obj", parse_obj},   {".ply", parse_ply},  {".stl", parse_stl}, {".off", parse_off},
    {".gltf", parse_gltf}, {".glb", parse_gltf}, {".npy", parse_npy},
};

[[noreturn]] void fail_memory(const std::string& name, std::size_t bytes) {
  throw Error(Errc::out_of_memory, name + ": there is not enough memory to read it (" +
                                       std::to_string(bytes) + " bytes in the file)");
}

bool begins_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
}

/// Returns read(). Shortens the messages of its errors, which quote the file.
template <class Read>
auto in_short(const Read& read) {
  try {
    return read();
  } catch (const Stopped&) {
    throw;
  } catch (const Error& e) {
    throw Error(e.code(), shortened(e.what()));
  }
}

/// `extension`: with its dot, any case.
const Reader& reader_of(const std::string& extension, const std::filesystem::path& name) {
  std::string known;
  for (const Reader& r : kReaders) {
    if (lower(extension) == r.extension) return r;
    known.append(known.empty() ? "" : ", ").append(r.extension);
  }
  throw Error(Errc::unsupported,
              name.string() + ": is no kind of mesh file that is read here (" + known + ")");
}

/// The format that the first bytes suggest, or the size of a binary STL; empty: none.
std::string_view begins_as(Bytes bytes) {
  std::string_view text = as_text(bytes);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (const auto& [begin, extension] :
       {std::pair<std::string_view, std::string_view>{"ply\n", ".ply"},
        {"ply\r", ".ply"},
        {"OFF", ".off"},
        {"glTF", ".glb"},
        {"\x93NUMPY", ".npy"}})
    if (text.starts_with(begin)) return extension;
  if (stl::is_exact(bytes.last(text.size())) || text.starts_with("solid")) return ".stl";
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{' ? ".gltf" : "";
}

/// A hint for a file with a wrong name; empty if there is none.
std::string wrong_name(Bytes bytes, const Reader& reader) {
  const std::string_view is = begins_as(bytes);
  if (is.empty() || reader_of(std::string(is), {}).parse == reader.parse) return {};
  return "it begins as a " + std::string(is) + " file does: give it that name";
}

/// How many corners of triangles with an area have a normal that is zero or not finite.
std::size_t silent_normals(const Mesh& mesh) {
  const auto is_silent = [](const Vec3& n) {
    return !is_finite(n) || (n.x == 0 && n.y == 0 && n.z == 0);
  };
  const std::vector<Vec3>& values = mesh.normals.values;
  if (std::ranges::none_of(values, is_silent)) return 0;
  const std::vector<std::uint32_t>& normal_of_corner =
      mesh.normals.indices.empty() ? mesh.indices : mesh.normals.indices;
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::size_t silent = 0;
    Vec3d corner[3];
    for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
      const std::size_t normal = normal_of_corner.empty() ? c : normal_of_corner[c];
      if (normal < values.size() && is_silent(values[normal])) ++silent;
      corner[c % 3] = Vec3d(mesh.positions[mesh.indices.empty() ? c : mesh.indices[c]]);
    }
    const Vec3d across = cross(corner[1] - corner[0], corner[2] - corner[0]);
    if (dot(across, across) > 0) count += silent;
  }
  return count;
}

void warn_of_normals(Scene& scene, const std::string& name) {
  std::size_t count = 0;
  for (const Mesh& mesh : scene.meshes) count += silent_normals(mesh);
  if (count != 0)
    scene.warnings.push_back(name + ": the normals of " + std::to_string(count) +
                             " corners are zero or no numbers; these corners have their face's");
}

Scene parse(const Reader& reader, Bytes bytes, const std::filesystem::path& name,
            const ReadOptions& options) {
  try {
    Reading reading(name, bytes.size(), options);
    Scene scene = in_short(
        [&] { return read_whole(reading, [&] { return reader.parse(bytes, name, reading); }); });
    warn_of_normals(scene, name.string());
    if (scene.primitive_count() == 0)
      if (const std::string hint = wrong_name(bytes, reader); !hint.empty())
        // Other warnings of the wrong reader say nothing about the file.
        scene.warnings = {name.string() + ": no triangles as " + reader.extension + "; " + hint};
    for (std::string& warning : scene.warnings) warning = shortened(std::move(warning));
    return scene;
  } catch (const std::bad_alloc&) {
    fail_memory(name.string(), bytes.size());
  } catch (const Error& e) {
    const std::string hint = wrong_name(bytes, reader);
    if (e.code() != Errc::bad_format || hint.empty()) throw;
    throw Error(e.code(), std::string(e.what()) + "; " + hint);
  }
}

[[noreturn]] void fail_folder(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::set<fs::path> meshes;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (std::ranges::any_of(kReaders, [&](const Reader& r) {
          // An array is more often a picture.
          return r.extension != std::string_view(".npy") &&
                 lower(at->path().extension().string()) == r.extension;
        }))
      meshes.insert(at->path());
  std::string what = folder.string() + ": is a folder; ";
  if (meshes.empty())
    what += "no mesh file lies in it";
  else if (meshes.size() == 1)
    what += "give the file in it, " + meshes.begin()->string();
  else
    what += "give files in it, such as " + meshes.begin()->string() + " (of " +
            std::to_string(meshes.size()) + ")";
  throw Error(Errc::io, what);
}

}  // namespace

void add_mesh(Scene& scene, Mesh mesh) {
  // Without indices the positions would be drawn in order, but a point cloud is no triangles.
  if (mesh.indices.empty()) mesh = {.name = std::move(mesh.name)};
  scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size()), Mat4d::identity()});
  scene.meshes.push_back(std::move(mesh));
}

Scene scene_of(Mesh mesh) {
  Scene scene;
  add_mesh(scene, std::move(mesh));
  return scene;
}

void set_materials(Mesh& mesh, std::vector<std::uint32_t> of_triangles) {
  if (std::ranges::adjacent_find(of_triangles, std::not_equal_to<>()) != of_triangles.end())
    mesh.face_materials = std::move(of_triangles);
  else if (!of_triangles.empty())
    mesh.material = of_triangles.front();
}

void add_geometry(Scene& scene, Geometry geometry) {
  const auto number = static_cast<std::uint32_t>(scene.geometries.size());
  scene.geometries.push_back(std::move(geometry));
  scene.instances.push_back({0, Mat4d::identity(), number});
}

std::string shortened(std::string message) {
  constexpr std::size_t kMost = 2000, kBegin = 1400, kEnd = 500, kLongestCharacter = 4;
  if (message.size() <= kMost) return message;
  std::size_t begin = kBegin, end = message.size() - kEnd;
  while (begin > kBegin - kLongestCharacter && !begins_character(message[begin])) --begin;
  while (end < message.size() - kEnd + kLongestCharacter && !begins_character(message[end])) ++end;
  message.replace(begin, end - begin,
                  " ... (" + std::to_string(end - begin) + " bytes left out) ... ");
  return message;
}

Scene decode_scene(std::span<const std::byte> bytes, std::string_view format, PathView name,
                   const ReadOptions& options) {
  const FloatScope floats;
  const std::filesystem::path file(name.text());
  std::string extension(format);
  if (!extension.starts_with('.')) extension.insert(0, 1, '.');
  return parse(reader_of(extension, file), bytes, file, options);
}

std::vector<std::string_view> scene_formats() {
  std::vector<std::string_view> names;
  for (const Reader& r : kReaders) names.emplace_back(r.extension + 1);
  return names;
}

Scene read_scene(PathView name, const ReadOptions& options) {
  const FloatScope floats;
  const std::filesystem::path file(name.text());
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) fail_folder(file);
  const Reader& reader = reader_of(file.extension().string(), file);
  return read_mapped(file, [&](Bytes bytes) { return parse(reader, bytes, file, options); });
}

Image<Rgba8> decode_picture(Bytes bytes, const std::string& name, Budget& budget) {
  const std::string_view text = as_text(bytes);
  try {
    if (text.starts_with("\x89PNG")) return decode_png(bytes, name, budget);
    if (text.starts_with("\xFF\xD8\xFF")) return decode_jpeg(bytes, name, budget);
    if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP"))
      return decode_webp(bytes, name, budget);
  } catch (const std::bad_alloc&) {
    fail_memory(name, bytes.size());
  }
  throw Error(Errc::unsupported, name + ": is neither PNG, JPEG nor WebP");
}

Image<Rgba8> decode_image(std::span<const std::byte> bytes, const std::string& name,
                          const ReadOptions& options) {
  Budget budget(name, bytes.size(), options);
  return decode_picture(bytes, name, budget);
}

Image<Vec3> decode_light(std::span<const std::byte> bytes, const std::string& name,
                         const ReadOptions& options) {
  const FloatScope floats;
  const std::string_view text = as_text(bytes);
  Budget budget(name, bytes.size(), options);
  try {
    if (text.starts_with("#?")) return decode_rgbe(bytes, name, budget);
    if (text.starts_with("\x76\x2f\x31\x01")) return decode_exr(bytes, name, budget);
    if (!text.starts_with("\x89PNG") && !text.starts_with("\xFF\xD8\xFF"))
      throw Error(Errc::unsupported,
                  name + ": is no picture that can be a light; give an .hdr, .exr, .png or .jpg");
    const Image<Rgba8> display = decode_picture(bytes, name, budget);
    float linear[256];
    for (int i = 0; i < 256; ++i) linear[i] = static_cast<float>(linear_from_srgb(i / 255.0));
    Image<Vec3> light = budget.image<Vec3>(display.width(), display.height());
    std::ranges::transform(display.pixels(), light.pixels().begin(), [&](const Rgba8& c) {
      return Vec3{linear[c.r], linear[c.g], linear[c.b]};
    });
    return light;
  } catch (const std::bad_alloc&) {
    fail_memory(name, bytes.size());
  }
}

Image<Vec3> read_light(PathView name, const ReadOptions& options) {
  const FloatScope floats;
  const std::filesystem::path file(name.text());
  return read_mapped(file, [&](Bytes bytes) {
    return in_short([&] { return decode_light(bytes, file.string(), options); });
  });
}

Image<Rgba8> read_image(PathView name, const ReadOptions& options) {
  const std::filesystem::path file(name.text());
  return read_mapped(file,
                     [&](Bytes bytes) { return decode_image(bytes, file.string(), options); });
}

}  // namespace rastrum::io
