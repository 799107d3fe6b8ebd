// SPDX-License-Identifier: BSD-3-Clause
// Feeds made-up bytes to one reader (chosen when compiling). An Error is a right answer; anything
// else that is thrown, and every mesh that refers to what it does not have, is a find.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include <unistd.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>
#include <rastrum/out_of_core.hpp>
#include <rastrum/render.hpp>

namespace {

using namespace rastrum;

[[maybe_unused]] void require(bool sound) {
  if (!sound) std::abort();
}

template <class T>
[[maybe_unused]] void require_sound(const Attribute<T>& a, const Mesh& m) {
  if (a.indices.empty()) return require(a.empty() || a.values.size() == m.positions.size());
  require(a.indices.size() == m.indices.size());
  for (const std::uint32_t i : a.indices) require(i < a.values.size());
}

[[maybe_unused]] void require_sound(const Scene& scene) {
  for (const Instance& i : scene.instances)
    require(i.geometry ? *i.geometry < scene.geometries.size() : i.mesh < scene.meshes.size());
  for (const Mesh& m : scene.meshes) {
    require(m.indices.size() % 3 == 0);
    for (const std::uint32_t i : m.indices) require(i < m.positions.size());
    require_sound(m.normals, m);
    require_sound(m.texcoords, m);
    require_sound(m.colors, m);
    require(m.face_materials.empty() || m.face_materials.size() == m.triangle_count());
    for (const std::uint32_t i : m.face_materials) require(i < scene.materials.size());
  }
  require(!io::describe(scene).empty());
}

/// Writes `bytes` into a file of this name in a folder of this process.
[[maybe_unused]] std::filesystem::path written(std::span<const std::byte> bytes, const char* name) {
  static const std::filesystem::path folder = [] {
    auto path =
        std::filesystem::temp_directory_path() / ("rastrum_fuzz_" + std::to_string(::getpid()));
    std::filesystem::create_directories(path);
    return path;
  }();
  std::ofstream(folder / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  return folder / name;
}

void run(std::span<const std::byte> bytes) {
  // No such folder: textures and libraries that the bytes name are not there.
  [[maybe_unused]] const std::filesystem::path file = "/nonexistent/fuzz/input";
  [[maybe_unused]] io::Reading reading(file, bytes.size(), {});
#if defined(RASTRUM_FUZZ_large_ply) || defined(RASTRUM_FUZZ_large_stl) || \
    defined(RASTRUM_FUZZ_large_npy) || defined(RASTRUM_FUZZ_large_glb)
  // A picture drawn out of core is that of the reader's scene.
#if defined(RASTRUM_FUZZ_large_ply)
  const auto large = written(bytes, "large.ply");
#elif defined(RASTRUM_FUZZ_large_stl)
  const auto large = written(bytes, "large.stl");
#elif defined(RASTRUM_FUZZ_large_npy)
  const auto large = written(bytes, "large.npy");
#else
  const auto large = written(bytes, "large.glb");
#endif
  Image<std::int64_t> ids(16, 16), in_memory(16, 16);
  FrameOptions frame;
  frame.width = frame.height = 16;
  const Camera camera{.eye = {0, 0, 3}};
  OutOfCoreOptions options;
  options.renderer.threads = 1;
  options.memory_limit = std::uint64_t{64} << 20;
  const OutOfCoreFile mapped(large, options.memory_limit);
  (void)mapped.render(camera, frame, {.ids = ids}, options);
  const Scene read = io::read_scene(large);
  const SceneBinding binding(read);
  Renderer({.threads = 1}).render(binding.view(), camera, frame, {.ids = in_memory});
  require(std::ranges::equal(ids.pixels(), in_memory.pixels()));
#elif defined(RASTRUM_FUZZ_beside)
  // The first byte chooses what the rest is: the MTL of an OBJ, or a buffer or a picture of a glTF.
  if (bytes.empty()) return;
  const auto rest = bytes.subspan(1);
  const auto text = [](std::string_view t) { return std::as_bytes(std::span(t)); };
  if (std::to_integer<unsigned>(bytes[0]) % 2 == 0) {
    written(rest, "beside.mtl");
    require_sound(io::read_scene(written(
        text("mtllib beside.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n"),
        "beside.obj")));
  } else {
    written(rest, "beside.bin");
    const std::string size = std::to_string(rest.size());
    require_sound(io::read_scene(written(
        text(
            R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
            R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],)"
            R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"
            R"("textures":[{"source":0}],"images":[{"uri":"beside.bin"}],)"
            R"("buffers":[{"uri":"beside.bin","byteLength":)" +
            size + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + size +
            R"(}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
            std::to_string(rest.size() / 12) +
            R"(},{"bufferView":0,"componentType":5121,"type":"SCALAR","count":3}]})"),
        "beside.gltf")));
  }
#elif defined(RASTRUM_FUZZ_obj)
  require_sound(io::parse_obj(bytes, file, reading));
#elif defined(RASTRUM_FUZZ_ply)
  require_sound(io::parse_ply(bytes, file, reading));
#elif defined(RASTRUM_FUZZ_stl)
  require_sound(io::parse_stl(bytes, file, reading));
#elif defined(RASTRUM_FUZZ_npy)
  require_sound(io::parse_npy(bytes, file, reading));
#elif defined(RASTRUM_FUZZ_off)
  require_sound(io::parse_off(bytes, file, reading));
#elif defined(RASTRUM_FUZZ_gltf)
  Scene scene = io::parse_gltf(bytes, file, reading);
  require_sound(scene);
  if (!scene.motions.empty() && !scene.motions[0].animations.empty()) pose(scene, 0.5);
  require_sound(scene);
#elif defined(RASTRUM_FUZZ_mtl)
  Scene scene;
  std::unordered_map<std::string, std::uint32_t> by_name;
  io::parse_mtl(bytes, file, scene, by_name);
  for (const auto& [name, index] : by_name) require(index < scene.materials.size());
#elif defined(RASTRUM_FUZZ_image)
  (void)io::decode_image(bytes, "input");
#elif defined(RASTRUM_FUZZ_light)
  (void)io::decode_light(bytes, "input");
#elif defined(RASTRUM_FUZZ_height)
  // The first byte chooses the format.
  if (bytes.empty()) return;
  const auto rest = bytes.subspan(1);
  const char* const formats[] = {"png", "npy", "dem", "raw"};
  const char* const format = formats[std::to_integer<unsigned>(bytes[0]) % 4];
  const io::HeightGrid grid = io::decode_heights(rest, format, "input");
  require(!grid.heights.empty() && grid.units_per_cell > 0);
#else
#error "which reader?"
#endif
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    run(std::as_bytes(std::span(data, size)));
  } catch (const rastrum::Error&) {
    // The outside world's fault, and said so.
  }
  return 0;
}
