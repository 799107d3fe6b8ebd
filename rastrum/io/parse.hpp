// SPDX-License-Identifier: BSD-3-Clause
// The readers behind read_scene, one per format, over bytes in memory: a file's, or a fuzzer's.
// `file` names the bytes in errors and need not exist. `reading` opens textures and the like; its
// budget counts arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::io {

using Bytes = std::span<const std::byte>;
class Budget;
class Reading;

[[nodiscard]] Scene parse_obj(Bytes bytes, const std::filesystem::path& file, Reading& reading);
[[nodiscard]] Scene parse_ply(Bytes bytes, const std::filesystem::path& file, Reading& reading);
[[nodiscard]] Scene parse_stl(Bytes bytes, const std::filesystem::path& file, Reading& reading);
[[nodiscard]] Scene parse_off(Bytes bytes, const std::filesystem::path& file, Reading& reading);
/// Triangles, (n, 3, 3) or (n, 9).
[[nodiscard]] Scene parse_npy(Bytes bytes, const std::filesystem::path& file, Reading& reading);
/// Tells .gltf and .glb apart by their first bytes.
[[nodiscard]] Scene parse_gltf(Bytes bytes, const std::filesystem::path& file, Reading& reading);

// Pictures. The budget counts their memory before it is allocated.
[[nodiscard]] Image<Rgba8> decode_png(Bytes bytes, const std::string& name, Budget& budget);
[[nodiscard]] Image<Rgba8> decode_jpeg(Bytes bytes, const std::string& name, Budget& budget);
/// By libwebp. Throws Error{unsupported} if that was missing at build time.
[[nodiscard]] Image<Rgba8> decode_webp(Bytes bytes, const std::string& name, Budget& budget);
[[nodiscard]] bool has_webp();
/// Any of these, by its first bytes.
[[nodiscard]] Image<Rgba8> decode_picture(Bytes bytes, const std::string& name, Budget& budget);

/// Pictures in linear light.
[[nodiscard]] Image<Vec3> decode_rgbe(Bytes bytes, const std::string& name, Budget& budget);
[[nodiscard]] Image<Vec3> decode_exr(Bytes bytes, const std::string& name, Budget& budget);

/// Height maps; GDAL opens files itself.
[[nodiscard]] HeightGrid decode_height_png(Bytes bytes, const std::string& name,
                                           const ReadOptions& options);
[[nodiscard]] HeightGrid decode_height_raw(Bytes bytes, const std::string& name, RawSize size);
[[nodiscard]] HeightGrid decode_height_npy(Bytes bytes, const std::string& name);
[[nodiscard]] HeightGrid decode_height_dem(Bytes bytes, const std::string& name,
                                           const ReadOptions& options);
[[nodiscard]] HeightGrid read_height_gdal(const std::filesystem::path& file,
                                          const ReadOptions& options);

/// The options -s and -o of MTL: scale · uv + offset, for coordinates that begin at the bottom.
struct TextureTransform {
  Vec2 scale{1, 1}, offset{};
  bool operator==(const TextureTransform&) const = default;
};

/// Adds an .mtl file's materials, in order, to `scene` and their names to `by_name` (the first of a
/// name wins). A missing file becomes a warning. `transforms` becomes as long as Scene::materials.
void read_mtl(const std::filesystem::path& file, Scene& scene,
              std::unordered_map<std::string, std::uint32_t>& by_name,
              std::vector<TextureTransform>& transforms, Reading& reading);

void parse_mtl(Bytes bytes, const std::filesystem::path& file, Scene& scene,
               std::unordered_map<std::string, std::uint32_t>& by_name);

/// A bad vertex index for messages: a negative number if the file means one.
[[nodiscard]] inline std::string vertex_text(std::uint32_t index) {
  const auto i = static_cast<std::int32_t>(index);
  return i < 0 ? std::to_string(i) : std::to_string(index);
}

/// Adds an instance of `mesh`. A mesh without indices is empty.
void add_mesh(Scene& scene, Mesh mesh);
[[nodiscard]] Scene scene_of(Mesh mesh);
/// Gives each triangle its material; gives it to the mesh if all have the same.
void set_materials(Mesh& mesh, std::vector<std::uint32_t> of_triangles);
/// Adds an instance of `geometry`, untransformed.
void add_geometry(Scene& scene, Geometry geometry);

}  // namespace rastrum::io
