// SPDX-License-Identifier: BSD-3-Clause
// Rules that depend on the whole file, not on a selection of its triangles: whether positions stay
// float64, the unit of colours, whether STL attributes are colours.
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>

#include "tests/out_of_core/large_files.hpp"

namespace rastrum::test::whole_file_test {
namespace {

FrameOptions frame_of(Shader shader) {
  return FrameOptions{.width = 70, .height = 60, .shader = shader};
}

TEST(OutOfCoreWholeFile, PositionsFarAwayStayFloat64) {
  const TempFolder folder;
  const Mesh mesh = tangled(13);
  for (const double away : {0.0, 40.0, 5.2e6})
    for (const bool ply : {false, true}) {
      const Vec3d at{away, 0, 0};
      const auto file = ply ? folder.write("a.ply", ply_of(mesh, {.normals = true, .wide_at = at}))
                            : folder.write("a.npy", npy_of(mesh, true, true, at));
      EXPECT_EQ(io::read_scene(file).meshes.at(0).view().positions.is_wide(), away > 30) << away;
      OutOfCoreOptions options{.chunk_triangles = 40};
      for (const bool fitted : {false, true})
        expect_same(file, outside(at), frame_of(Shader::phong), options, std::to_string(away),
                    fitted);
      options.neighbours = true;
      options.prepare = crease;
      expect_same(file, outside(at), frame_of(Shader::phong), options, "creases");
      options = {.chunk_triangles = 40, .band_triangles = 120};
      FrameOptions sampled = frame_of(Shader::phong);
      sampled.samples = 4;
      expect_same(file, outside(at), sampled, options, "bands");
    }
}

/// In float32 everything visible would collapse to one place.
TEST(OutOfCoreWholeFile, WhatIsSeenOfAFarFileMayBeSmall) {
  const TempFolder folder;
  Mesh mesh = tangled(13);
  for (Vec3& p : mesh.positions) p = p * 0.01F;
  mesh.positions.push_back({3, 2, 1});
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  mesh.indices.insert(mesh.indices.end(), {last, last, last});
  const Vec3d at{5.2e6, 5.2e6, 5.2e6};
  Camera camera = outside();
  camera.eye = at + camera.eye * 0.01;
  camera.target = at;
  camera.near_plane = 1e-4F;
  for (const auto& file : {folder.write("a.ply", ply_of(mesh, {.wide_at = at})),
                           folder.write("a.npy", npy_of(mesh, true, true, at))})
    EXPECT_GT(expect_same(file, camera, frame_of(Shader::phong), {}, file.string()).pixels_covered,
              300U);
}

TEST(OutOfCoreWholeFile, AttributesOfStlAreColoursWhereAnyIs) {
  const TempFolder folder;
  const Mesh mesh = tangled(11);
  const std::string plain = stl_of(mesh);
  // Only the last facet, a copy of an early one, has a colour.
  for (const std::string_view header : {"", "COLOR=\x10\x20\xF0\xFF"}) {
    std::string bytes = plain;
    bytes.replace(0, header.size(), header);
    for (std::size_t t = 0; t < mesh.triangle_count(); t += 3) bytes[84 + 50 * t + 48] = '\x5A';
    bytes[bytes.size() - 1] = '\x83';
    const auto file = folder.write("a.stl", bytes);
    EXPECT_FALSE(io::read_scene(file).meshes.at(0).colors.empty());
    for (const Shader shader : {Shader::flat, Shader::phong})
      expect_same(file, outside(), frame_of(shader), {.chunk_triangles = 40}, std::string(header));
  }
}

/// Each vertex has a colour of three channels of this type, each face one of `uchar`.
template <class T>
std::string colored_ply(const Mesh& mesh, const std::string& type, double most, bool of_faces,
                        std::uint8_t alpha = 255) {
  std::string s = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                  std::to_string(mesh.positions.size()) +
                  "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!of_faces)
    for (const char* c : {"red", "green", "blue"}) s += "property " + type + " " + c + "\n";
  s += "element face " + std::to_string(mesh.triangle_count()) +
       "\nproperty list uchar int vertex_indices\n";
  if (of_faces)
    for (const char* c : {"red", "green", "blue", "alpha"})
      s += "property " + type + " " + c + "\n";
  s += "end_header\n";
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    s += raw(mesh.positions[v]);
    // The last vertex has the largest value.
    if (!of_faces)
      s += raw(static_cast<T>(v + 1 == mesh.positions.size() ? most : 1)) +
           raw(static_cast<T>(v % 2)) + raw(T{0});
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    s += '\3';
    for (std::size_t c = 0; c < 3; ++c) s += raw(mesh.indices[3 * t + c]);
    if (of_faces)
      s += raw(static_cast<T>(t % 2 * 200)) + raw(static_cast<T>(t % 7 * 30)) +
           raw(static_cast<T>(t + 1 == mesh.triangle_count() ? most : 0)) +
           raw(static_cast<T>(t == 5 ? alpha : 255));
  }
  return s;
}

TEST(OutOfCoreWholeFile, TheLargestColourSaysWhatAllArePartsOf) {
  const TempFolder folder;
  const Mesh mesh = tangled(11);
  const auto same = [&](const std::string& bytes, const std::string& what) {
    expect_same(folder.write("a.ply", bytes), outside(), frame_of(Shader::flat),
                {.chunk_triangles = 40}, what);
  };
  same(colored_ply<float>(mesh, "float", 255, false), "float, 255");
  same(colored_ply<float>(mesh, "float", 1, false), "float, 1");
  same(colored_ply<std::int32_t>(mesh, "int", 60000, false), "int, 60,000");
  same(colored_ply<std::uint8_t>(mesh, "uchar", 255, true), "faces");
  same(colored_ply<std::uint16_t>(mesh, "ushort", 65535, true, 255), "faces, ushort");
  const auto file = folder.write("b.ply", colored_ply<std::uint8_t>(mesh, "uchar", 9, true, 100));
  EXPECT_THROW(same(slurp(file), "translucent"), Error);
}

}  // namespace
}  // namespace rastrum::test::whole_file_test
