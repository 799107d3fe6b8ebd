// Files in and out, chosen by extension. Readers keep the file's order: triangle ids are the order
// of submission, polygons become fans from their first vertex, nothing is merged or reordered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <rastrum/core/image.hpp>
#include <rastrum/scene/scene.hpp>

namespace rastrum::io {

/// Reads .obj (with .mtl), .ply, .stl, .off, .gltf or .glb (by extension, any case).
/// Vertices with non-finite coordinates are kept (the renderer drops and counts their triangles);
/// degenerate triangles keep their numbers. Normals are the file's or none.
/// Throws Error{not_found | bad_format | unsupported | io} naming the file and the place in it.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file);

/// Decodes a PNG or JPEG (by its first bytes), from a file or from memory; `name` appears in
/// errors.
[[nodiscard]] Image<Rgba8> read_image(const std::filesystem::path& file);
[[nodiscard]] Image<Rgba8> decode_image(std::span<const std::byte> bytes, const std::string& name);

/// Writers write to a temporary name beside `file` and rename it, so that a file is whole or
/// absent. Throws Error{io} naming the file, Error{invalid_argument} for an empty image or rows
/// that overlap.
void write_png(const std::filesystem::path& file, ImageView<const Rgba8> image);
/// float32 RGBA, premultiplied: an RGBA EXR (32 bit), or NPY of shape (H, W, 4).
void write_exr(const std::filesystem::path& file, ImageView<const Vec4> image);
void write_npy(const std::filesystem::path& file, ImageView<const Vec4> image);
/// One channel: EXR channel "Z", or NPY of shape (H, W).
void write_exr(const std::filesystem::path& file, ImageView<const float> image);
void write_npy(const std::filesystem::path& file, ImageView<const float> image);
void write_npy(const std::filesystem::path& file, ImageView<const std::int64_t> image);
void write_npy(const std::filesystem::path& file, ImageView<const std::int32_t> image);

/// Binary little-endian PLY with positions, faces, and the normals, texture coordinates and colours
/// that share the positions' indices (those with indices of their own are left out). Throws
/// Error{invalid_argument} for an index out of range or fewer values than positions.
void write_ply(const std::filesystem::path& file, const Mesh& mesh);

}  // namespace rastrum::io
