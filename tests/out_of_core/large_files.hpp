// SPDX-License-Identifier: BSD-3-Clause
// Mesh files with everything that can go wrong when they are drawn in chunks, and their pictures
// both ways.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/io/npy_header.hpp>
#include <rastrum/out_of_core.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/shapes.hpp>

#include "tests/io/gltf_document.hpp"
#include "tests/io/scene_files.hpp"

#include "tests/ranks/parts_picture.hpp"
#include "tests/support/random.hpp"

namespace rastrum::test {

/// Triangles that cross and share vertices. Some occur twice, far apart in the file, so that two
/// chunks have equal depths.
inline Mesh tangled(std::uint64_t seed = 7) {
  Mesh mesh = shapes::sphere(9, 14);
  const Mesh soup = shapes::soup(120, 0.1F, 0.9F, seed);
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), soup.positions.begin(), soup.positions.end());
  for (std::size_t i = 0; i < soup.triangle_count() * 3; ++i)
    mesh.indices.push_back(base + soup.view().vertex(i));
  const std::vector<std::uint32_t> first(mesh.indices.begin(), mesh.indices.begin() + 90);
  mesh.indices.insert(mesh.indices.end(), first.begin(), first.end());
  mesh.normals = {};
  mesh.texcoords = {};
  return mesh;
}

/// A ball of small triangles in random order.
inline Mesh shuffled_ball() {
  Mesh mesh = shapes::sphere(30, 50);
  mesh.normals = {};
  mesh.texcoords = {};
  Random random(5);
  for (std::size_t i = mesh.indices.size() / 3 - 1; i > 0; --i) {
    const auto j = static_cast<std::size_t>(random.integer(0, static_cast<int>(i)));
    for (std::size_t c = 0; c < 3; ++c) std::swap(mesh.indices[3 * i + c], mesh.indices[3 * j + c]);
  }
  return mesh;
}

struct PlyParts {
  int small_faces = 0;  ///< of 2, 1, 0, … corners, before every fifth triangle and at the end
  bool normals = false, colors = false;
  std::uint8_t alpha = 255;        ///< of every fifth vertex
  std::string comment{};           ///< shifts what follows
  std::optional<Vec3d> wide_at{};  ///< positions are float64, offset by this
};

inline std::string ply_of(const Mesh& mesh, const PlyParts& parts = {}) {
  std::string s = "ply\nformat binary_little_endian 1.0\n";
  if (!parts.comment.empty()) s += "comment " + parts.comment + "\n";
  s += "element vertex " + std::to_string(mesh.positions.size()) +
       std::string(parts.wide_at ? "\nproperty double x\nproperty double y\nproperty double z\n"
                                 : "\nproperty float x\nproperty float y\nproperty float z\n");
  if (parts.normals) s += "property float nx\nproperty float ny\nproperty float nz\n";
  if (parts.colors)
    s += "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
  std::size_t faces = mesh.indices.size() / 3;
  if (parts.small_faces != 0)
    faces += (faces / 5 + 1) * static_cast<std::size_t>(parts.small_faces);
  const auto add_small_faces = [&] {
    for (int k = 0; k < parts.small_faces; ++k) {
      s += raw(static_cast<std::uint8_t>(2 - k % 3));
      for (int c = 0; c < 2 - k % 3; ++c) s += raw(std::uint32_t{9});
    }
  };
  s += "element face " + std::to_string(faces) +
       "\nproperty list uchar int vertex_indices\nend_header\n";
  Random random(3);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (parts.wide_at)
      s += raw(Vec3d(mesh.positions[v]) * (1 + 1e-9) + *parts.wide_at);
    else
      s += raw(mesh.positions[v]);
    if (parts.normals) {
      const double x = random.real(-1, 1);
      const double y = random.real(-1, 1);
      s += raw(Vec3{static_cast<float>(x), static_cast<float>(y), 0.5F});
    }
    if (!parts.colors) continue;
    for (int c = 0; c < 3; ++c) s += raw(static_cast<std::uint8_t>(random.integer(0, 255)));
    s += raw(v % 5 == 0 ? parts.alpha : std::uint8_t{255});
  }
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    if (i % 15 == 0 && i / 15 < mesh.indices.size() / 15) add_small_faces();
    if (i % 3 == 0) s += raw(std::uint8_t{3});
    s += raw(mesh.indices[i]);
  }
  add_small_faces();
  return s;
}

inline std::string stl_of(const Mesh& mesh) {
  std::string s(80, ' ');
  s += raw(static_cast<std::uint32_t>(mesh.indices.size() / 3));
  for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
    s += raw(Vec3{});
    for (std::size_t c = 0; c < 3; ++c) s += raw(mesh.positions[mesh.indices[3 * t + c]]);
    s += raw(std::uint16_t{0});
  }
  return s;
}

/// Interleaved positions and normals with a material, rotated by its node, or at the given nodes.
inline std::string glb_of(const Mesh& mesh, bool short_indices, const std::string& material,
                          const std::vector<std::string>& nodes = {
                              R"({"mesh":0,"translation":[0.1,0.2,0],"rotation":[0,0.6,0,0.8]})"}) {
  std::string bin;
  for (const Vec3& p : mesh.positions) bin += raw(p) + raw(Vec3{p.y, 0.3F, p.x});
  const std::size_t begin = bin.size();
  for (const std::uint32_t i : mesh.indices)
    bin += short_indices ? raw(static_cast<std::uint16_t>(i)) : raw(i);
  const std::size_t bytes = bin.size() - begin;
  bin.resize((bin.size() + 3) / 4 * 4);
  const auto n = [](std::size_t v) { return std::to_string(v); };
  std::string numbers, texts;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string comma = i == 0 ? "" : ",";
    numbers += comma + n(i);
    texts += comma + nodes[i];
  }
  std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + numbers +
                     R"(]}],"nodes":[)" + texts +
                     R"(],"meshes":[{"primitives":[{)"
                     R"("attributes":{"POSITION":0,"NORMAL":1},"indices":2)";
  if (!material.empty()) text += R"(,"material":0)";
  text += "}]}],";
  if (!material.empty()) text += "\"materials\":[" + material + "],";
  const std::string count = n(mesh.positions.size());
  text += R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" + count +
          R"(,"min":[-9,-9,-9],"max":[9,9,9]},{"bufferView":0,"byteOffset":12,)"
          R"("componentType":5126,"type":"VEC3","count":)" +
          count + R"(},{"bufferView":1,"type":"SCALAR","componentType":)" +
          (short_indices ? "5123" : "5125") + R"(,"count":)" + n(mesh.indices.size()) +
          R"(}],"bufferViews":[{"buffer":0,"byteStride":24,"byteLength":)" + n(begin) +
          R"(},{"buffer":0,"byteOffset":)" + n(begin) + R"(,"byteLength":)" + n(bytes) +
          R"(}],"buffers":[{"byteLength":)" + n(bin.size()) + "}]}";
  return glb(std::move(text), bin);
}

/// Three meshes: one at three nodes, one of two primitives with their own materials, one at no
/// node. `meshes` are the four primitives.
inline std::string many_glb_of(const std::vector<Mesh>& meshes, const std::string& materials) {
  const auto n = [](std::size_t v) { return std::to_string(v); };
  std::string bin, accessors, views;
  std::size_t count = 0;
  const auto add = [&](const std::string& bytes, const std::string& accessor) {
    const std::string comma = count == 0 ? "" : ",";
    views += comma + R"({"buffer":0,"byteOffset":)" + n(bin.size()) + R"(,"byteLength":)" +
             n(bytes.size()) + "}";
    accessors += comma + R"({"bufferView":)" + n(count++) + "," + accessor + "}";
    bin += bytes;
    bin.resize((bin.size() + 3) / 4 * 4);
  };
  std::string primitives[4];
  for (std::size_t k = 0; k < 4; ++k) {
    const Mesh& mesh = meshes[k];
    std::string positions, normals, indices;
    for (const Vec3& p : mesh.positions) {
      positions += raw(p);
      normals += raw(Vec3{p.y, 0.3F, p.x});
    }
    for (const std::uint32_t i : mesh.indices)
      indices += k == 1 ? raw(static_cast<std::uint16_t>(i)) : raw(i);
    const std::string of =
        R"("componentType":5126,"type":"VEC3","count":)" + n(mesh.positions.size());
    primitives[k] = R"({"attributes":{"POSITION":)" + n(count) + R"(,"NORMAL":)" + n(count + 1) +
                    R"(},"indices":)" + n(count + 2) +
                    (materials.empty() ? "" : R"(,"material":)" + n(k % 2)) + "}";
    add(positions, of + R"(,"min":[-9,-9,-9],"max":[9,9,9])");
    add(normals, of);
    add(indices, std::string(R"("type":"SCALAR","componentType":)") + (k == 1 ? "5123" : "5125") +
                     R"(,"count":)" + n(mesh.indices.size()));
  }
  std::string text =
      R"({"asset":{"version":"2.0"},"scene":1,"scenes":[{"nodes":[4]},{"nodes":[2,0]}],"nodes":[)"
      R"({"mesh":0,"translation":[0.1,0.2,0],"rotation":[0,0.6,0,0.8],"children":[3,1]},)"
      R"({"mesh":1,"scale":[0.6,0.7,-0.5],"translation":[0.5,0,0.4]},)"
      R"({"children":[5],"translation":[-0.4,0.1,0.2],"mesh":0},)"
      R"({"mesh":0,"scale":[0.3,0.3,0.3],"translation":[0.2,0.9,0.3]},)"
      R"({"mesh":2},{"mesh":1,"translation":[0,-0.6,0.5]}],"meshes":[{"primitives":[)" +
      primitives[0] + R"(]},{"primitives":[)" + primitives[1] + "," + primitives[2] +
      R"(]},{"primitives":[)" + primitives[3] + "]}],";
  if (!materials.empty()) text += "\"materials\":[" + materials + "],";
  text += "\"accessors\":[" + accessors + "],\"bufferViews\":[" + views +
          R"(],"buffers":[{"byteLength":)" + n(bin.size()) + "}]}";
  return glb(std::move(text), bin);
}

inline std::string json_of(const std::string& file) {
  std::uint32_t length = 0;
  std::memcpy(&length, file.data() + 12, sizeof(length));
  return file.substr(20, length);
}
/// The same GLB with this JSON.
inline std::string glb_with(const std::string& file, std::string text) {
  return glb(std::move(text), file.substr(28 + json_of(file).size()));
}

/// The triangles of a mesh as (n, 3, 3) or (n, 9), float32 or float64.
inline std::string npy_of(const Mesh& mesh, bool wide, bool nine, Vec3d at = {}) {
  const std::string count = std::to_string(mesh.indices.size() / 3);
  std::string s =
      io::npy_header_text(wide ? "<f8" : "<f4", "(" + count + (nine ? ", 9)" : ", 3, 3)"));
  for (const std::uint32_t i : mesh.indices) {
    const Vec3 p = mesh.positions[i];
    // float32 cannot represent these.
    s += wide ? raw(Vec3d(p) * (1 + 1e-9) + at) : raw(p);
  }
  return s;
}

/// A camera that sees the whole of tangled(), placed at `at`.
inline Camera outside(Vec3d at = {}) {
  return Camera{.eye = at + Vec3d{0.4, 0.7, 2.6}, .target = at};
}
inline FrameOptions frame_of(int width, int height, Shader shader = Shader::phong,
                             float opacity = 1) {
  return FrameOptions{.width = width,
                      .height = height,
                      .shader = shader,
                      .background = {0.2F, 0.3F, 0.1F, 0.5F},
                      .opacity = opacity};
}
inline void crease(Scene& scene) {
  for (Mesh& mesh : scene.meshes)
    mesh.normals = crease_normals(mesh.view().positions, mesh.indices, 40);
}

inline void expect_same(const Camera& a, const Camera& b) {
  EXPECT_EQ(a.eye, b.eye);
  EXPECT_EQ(a.target, b.target);
  EXPECT_EQ(a.near_plane, b.near_plane);
  EXPECT_EQ(a.far_plane, b.far_plane);
  EXPECT_EQ(a.orthographic_height, b.orthographic_height);
}

/// Compares a file's picture in memory with that out of core, in all targets.
inline OutOfCoreStats expect_same(const std::filesystem::path& file, const Camera& camera,
                                  const FrameOptions& frame, OutOfCoreOptions options,
                                  const std::string& what, bool fitted = false) {
  SCOPED_TRACE(what);
  Scene scene = io::read_scene(file);
  if (options.prepare) options.prepare(scene);
  const bool linear = shader_for(frame.shader, SceneBinding(scene).view()) == Shader::material;
  const AllTargets in_memory(frame.width, frame.height, linear),
      out_of_core(frame.width, frame.height, linear);
  const SceneBinding binding(scene);
  Renderer renderer({.threads = 2});
  const FrameStats stats = renderer.render(binding.view(), camera, frame, in_memory.targets());
  options.renderer.threads = 2;
  const OutOfCoreFile large(file);
  if (fitted) {
    FitOfFile fit(large, options.prepare);
    (void)fit_picture({}, camera, frame.width, frame.height, {.ranks = &fit});
  }
  const AllTargets band(frame.width, std::clamp(options.rows, 1, frame.height), linear);
  if (options.rows != 0)
    options.take_rows = [&](int first, int last) {
      ranks::each_target(band.targets(), [&](const auto& from, std::uint32_t bit) {
        ranks::each_target(out_of_core.targets(), [&](const auto& to, std::uint32_t of_to) {
          if constexpr (std::is_same_v<decltype(from), decltype(to)>)
            for (int y = first; bit == of_to && !to.empty() && y < last; ++y)
              std::copy_n(from.row(y - first), from.width, to.row(y));
        });
      });
    };
  const OutOfCoreStats out = large.render(
      camera, frame, options.rows == 0 ? out_of_core.targets() : band.targets(), options);
  EXPECT_TRUE(same_targets(in_memory.targets(), out_of_core.targets()));
  EXPECT_EQ(out.triangles, stats.triangles.input);
  EXPECT_EQ(out.dropped, stats.triangles.dropped);
  EXPECT_EQ(out.pixels_covered, stats.pixels_covered);
  return out;
}

}  // namespace rastrum::test
