// Feeds made-up bytes to one reader (chosen when compiling). An Error is a right answer; anything
// else that is thrown, and every mesh that refers to what it does not have, is a find.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <unordered_map>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/parse.hpp>

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

void run(std::span<const std::byte> bytes) {
  // No such folder: textures and libraries that the bytes name are not there.
  [[maybe_unused]] const std::filesystem::path file = "/nonexistent/fuzz/input";
#if defined(RASTRUM_FUZZ_obj)
  require_sound(io::parse_obj(bytes, file));
#elif defined(RASTRUM_FUZZ_ply)
  require_sound(io::parse_ply(bytes, file));
#elif defined(RASTRUM_FUZZ_stl)
  require_sound(io::parse_stl(bytes, file));
#elif defined(RASTRUM_FUZZ_npy)
  require_sound(io::parse_npy(bytes, file));
#elif defined(RASTRUM_FUZZ_off)
  require_sound(io::parse_off(bytes, file));
#elif defined(RASTRUM_FUZZ_gltf)
  Scene scene = io::parse_gltf(bytes, file);
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
  const unsigned format = std::to_integer<unsigned>(bytes[0]) % 4;
  const io::HeightGrid grid = format == 0   ? io::decode_height_png(rest, "input")
                              : format == 1 ? io::decode_height_npy(rest, "input")
                              : format == 2 ? io::decode_height_dem(rest, "input")
                                            : io::decode_height_raw(rest, "input");
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
