// The doors of io.hpp: which reader for which file.
#include <rastrum/io/io.hpp>

#include <array>
#include <new>
#include <string>
#include <utility>

#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>

namespace rastrum::io {
namespace {

struct Reader {
  const char* extension;
  Scene (*parse)(Bytes, const std::filesystem::path&);
};
constexpr Reader kReaders[] = {
    {".obj", parse_obj}, {".ply", parse_ply},   {".stl", parse_stl},
    {".off", parse_off}, {".gltf", parse_gltf}, {".glb", parse_gltf},
};

std::string lower(std::string s) {
  for (char& c : s)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return s;
}

[[noreturn]] void fail_memory(const std::string& name, std::size_t bytes) {
  throw Error(Errc::out_of_memory, name + ": there is not enough memory to read it (" +
                                       std::to_string(bytes) + " bytes in the file)");
}

}  // namespace

Scene scene_of(Mesh mesh) {
  // Without indices the positions would be drawn in order, and a cloud of points is no triangles.
  if (mesh.indices.empty()) mesh = {};
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({0, Mat4d::identity()});
  return scene;
}

Scene read_scene(const std::filesystem::path& file) {
  const std::string extension = lower(file.extension().string());
  for (const Reader& r : kReaders) {
    if (extension != r.extension) continue;
    const MappedFile mapped(file);
    try {
      return r.parse(mapped.bytes(), file);
    } catch (const std::bad_alloc&) {
      fail_memory(file.string(), mapped.bytes().size());
    }
  }
  throw Error(Errc::unsupported, file.string() +
                                     ": is no kind of mesh file that is read here (.obj, .ply, "
                                     ".stl, .off, .gltf, .glb)");
}

Image<Rgba8> decode_image(std::span<const std::byte> bytes, const std::string& name) {
  const auto begins_with = [&](std::string_view magic) {
    return as_text(bytes).substr(0, magic.size()) == magic;
  };
  try {
    if (begins_with("\x89PNG")) return decode_png(bytes, name);
    if (begins_with("\xFF\xD8\xFF")) return decode_jpeg(bytes, name);
  } catch (const std::bad_alloc&) {
    fail_memory(name, bytes.size());
  }
  throw Error(Errc::unsupported, name + ": is neither PNG nor JPEG");
}

Image<Rgba8> read_image(const std::filesystem::path& file) {
  const MappedFile mapped(file);
  return decode_image(mapped.bytes(), file.string());
}

}  // namespace rastrum::io
