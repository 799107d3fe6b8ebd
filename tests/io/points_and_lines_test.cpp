// SPDX-License-Identifier: BSD-3-Clause
// Points and lines in files: PLY without faces, OBJ's p and l, glTF's modes 0 to 3.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/io/gltf_document.hpp"
#include "tests/io/scene_files.hpp"

namespace rastrum::test::points_and_lines_files_test {
namespace {

using Indices = std::vector<std::uint32_t>;

const Points& points_of(const Scene& s, std::size_t instance = 0) {
  return std::get<Points>(s.geometries.at(s.instances.at(instance).geometry.value()));
}
const Lines& lines_of(const Scene& s, std::size_t instance = 0) {
  return std::get<Lines>(s.geometries.at(s.instances.at(instance).geometry.value()));
}

constexpr const char* kCloud =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    "property float intensity\n";
constexpr const char* kTwo = "end_header\n1 2 3 0 0 1 255 0 0 7\n4 5 6 0 1 0 0 255 0 8\n";

TEST(PointFiles, PlyWithoutFacesIsACloud) {
  for (const char* const faces : {"", "element face 0\nproperty list uchar int vertex_indices\n"}) {
    const Scene s = read_file("cloud.ply", std::string(kCloud) + faces + kTwo);
    EXPECT_TRUE(s.meshes.empty());
    EXPECT_EQ(s.primitive_count(), 2U);
    EXPECT_EQ(s.triangle_count(), 0U);
    const Points& p = points_of(s);
    EXPECT_EQ(p.name, "cloud");
    EXPECT_EQ(p.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_EQ(p.normals, (std::vector<Vec3>{{0, 0, 1}, {0, 1, 0}}));
    EXPECT_EQ(p.colors, (std::vector<Vec4>{{1, 0, 0, 1}, {0, 1, 0, 1}}));
    EXPECT_TRUE(s.warnings.empty());
    ASSERT_EQ(p.scalars.size(), 1U);
    EXPECT_EQ(p.scalars[0].name, "intensity");
    EXPECT_EQ(p.scalars[0].values, (std::vector<double>{7, 8}));
  }
  // Without vertices it is an empty mesh.
  const Scene none = read_file("a.ply",
                               "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"
                               "property float y\nproperty float z\nend_header\n");
  EXPECT_EQ(none.meshes.size(), 1U);
  EXPECT_TRUE(none.geometries.empty());
}

TEST(PointFiles, CloudsAreWrittenAsTheyAreRead) {
  const TempFolder folder;
  Points p = points_of(read_file("a.ply", std::string(kCloud) + kTwo));
  io::write_ply(folder.path("b.ply"), p);
  const Scene again = io::read_scene(folder.path("b.ply"));
  EXPECT_EQ(points_of(again).positions, p.positions);
  EXPECT_EQ(points_of(again).normals, p.normals);
  EXPECT_EQ(points_of(again).colors, p.colors);
  ASSERT_EQ(points_of(again).scalars.size(), 1U);
  EXPECT_EQ(points_of(again).scalars[0].name, "intensity");
  EXPECT_EQ(points_of(again).scalars[0].values, p.scalars[0].values);
  EXPECT_TRUE(again.warnings.empty());
  Points few = p;
  few.scalars[0].values.pop_back();
  EXPECT_THROW(io::write_ply(folder.path("b.ply"), few), Error) << "scalars lost without a word";
  p.colors.pop_back();
  EXPECT_THROW(io::write_ply(folder.path("b.ply"), p), Error) << "colours lost without a word";
}

constexpr const char* kFour = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\n";

TEST(PointFiles, ObjHasPointsAndPolylines) {
  const Scene s =
      read_file("a.obj", std::string(kFour) + "p 1 -1\nl 1 2 3\nf 1 2 3\nl 4/1 1/2\np 3\nl 2\n");
  ASSERT_EQ(s.instances.size(), 3U);
  EXPECT_EQ(s.meshes[s.instances[0].mesh].indices, (Indices{0, 1, 2}));
  EXPECT_EQ(s.primitive_count(), 1U + 3U + 3U);
  EXPECT_EQ(points_of(s, 1).positions, (std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(points_of(s, 1).colors[1], (Vec4{1, 1, 1, 1}));
  const Lines& l = lines_of(s, 2);
  EXPECT_EQ(l.kind, LineKind::polylines);
  EXPECT_EQ(l.offsets, (Indices{0, 3, 5}));
  EXPECT_EQ(l.positions[3], (Vec3{0, 1, 0}));
  EXPECT_EQ(l.colors.size(), 5U);
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_TRUE(holds(s.warnings[0], "1 points and lines with too few vertices"));
  // Without faces there is no empty mesh.
  EXPECT_TRUE(read_file("a.obj", std::string(kFour) + "l 1 2\n").meshes.empty());
}

TEST(PointFiles, ObjElementsHaveTheirMaterials) {
  const TempFolder folder;
  (void)folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  const Scene s = io::read_scene(folder.write(
      "a.obj", std::string("mtllib m.mtl\n") + kFour +
                   "usemtl blue\nl 1 2\nusemtl red\nl 2 3\nusemtl blue\nl 3 4\np 1\n"));
  ASSERT_EQ(s.instances.size(), 3U);
  EXPECT_EQ(s.materials[lines_of(s, 0).material].name, "blue");
  EXPECT_EQ(lines_of(s, 0).offsets, (Indices{0, 2, 4}));
  EXPECT_EQ(s.materials[lines_of(s, 1).material].name, "red");
  EXPECT_EQ(s.materials[points_of(s, 2).material].name, "blue");
}

TEST(PointFiles, BadObjElementsAreRefused) {
  for (const auto& [element, message] :
       {std::pair("p 0\n", "a.obj:5: the point refers to vertex 0"),
        {"l 1 9\n", "a.obj:5: the point or line refers to vertex 9, but the file has 4"},
        {"l 1 -5\n", "a.obj:5: the line refers to vertex -5"},
        {"p x\n", "a.obj:5"},
        {"p 1/2\n", "the point has a corner that is not v"},
        {"l 1//2 2\n", "the line has a corner that is not v or v/vt"}})
    expect_bad_file(message, "a.obj", std::string(kFour) + element);
}

std::string gltf(int mode, bool indexed, const std::string& indices_of = "[3,1,2,0]") {
  GltfDocument d;
  const std::size_t position = d.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  const std::size_t normal = d.floats({0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, 1}, "VEC3");
  const std::size_t color = d.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, "VEC3");
  const bool odd = indices_of == "odd", bad = indices_of == "bad";
  const std::size_t indices =
      d.add(odd ? std::vector<std::uint16_t>{3, 1, 2}
                : std::vector<std::uint16_t>{3, 1, 2, static_cast<std::uint16_t>(bad ? 4 : 0)},
            "SCALAR", 5123);
  return d.text(R"("materials":[{"name":"m"}],"meshes":[{"name":"n","primitives":[{"mode":)" +
                std::to_string(mode) + R"(,"material":0,"attributes":{"POSITION":)" +
                std::to_string(position) + R"(,"NORMAL":)" + std::to_string(normal) +
                R"(,"COLOR_0":)" + std::to_string(color) + "}" +
                (indexed ? R"(,"indices":)" + std::to_string(indices) : "") +
                R"(}]}],"nodes":[{"mesh":0,"translation":[5,0,0]},{"mesh":0}])");
}

TEST(PointFiles, GltfHasAllModes) {
  const Scene p = read_file("a.gltf", gltf(0, true));
  EXPECT_EQ(points_of(p).positions,
            (std::vector<Vec3>{{0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}}));
  EXPECT_EQ(points_of(p).normals[1], (Vec3{0, 1, 0}));
  EXPECT_EQ(points_of(p).colors[3], (Vec4{1, 0, 0, 1}));
  EXPECT_EQ(points_of(p).name, "n");
  ASSERT_EQ(p.instances.size(), 2U) << "two nodes share it";
  EXPECT_EQ(p.geometries.size(), 1U);
  EXPECT_EQ(p.instances[0].object_to_world.m[0][3], 5);
  EXPECT_EQ(p.materials.at(points_of(p).material).name, "m");
  EXPECT_TRUE(p.warnings.empty());

  struct Case {
    int mode;
    bool indexed;
    LineKind kind;
    Indices indices;
    std::size_t segments;
  };
  for (const Case& c : {Case{1, true, LineKind::segments, {3, 1, 2, 0}, 2},
                        Case{1, false, LineKind::segments, {0, 1, 2, 3}, 2},
                        Case{2, true, LineKind::polylines, {3, 1, 2, 0, 3}, 4},
                        Case{3, true, LineKind::polylines, {3, 1, 2, 0}, 3}}) {
    const Scene s = read_file("a.gltf", gltf(c.mode, c.indexed));
    EXPECT_EQ(lines_of(s).kind, c.kind) << c.mode;
    EXPECT_EQ(lines_of(s).indices, c.indices) << c.mode;
    EXPECT_EQ(lines_of(s).view().size(), c.segments) << c.mode;
    EXPECT_EQ(lines_of(s).colors.size(), 4U);
    EXPECT_TRUE(s.warnings.empty());
  }
  const Scene odd = read_file("a.gltf", gltf(1, true, "odd"));
  EXPECT_EQ(lines_of(odd).indices, (Indices{3, 1}));
  ASSERT_EQ(odd.warnings.size(), 1U);
  EXPECT_TRUE(holds(odd.warnings[0], "do not make up whole lines"));
  expect_bad_file("refers to vertex 4 of 4", "a.gltf", gltf(3, true, "bad"));
}

TEST(PointFiles, ScenesAreAppendedPlacedAndDescribed) {
  Scene s = read_file("a.obj", std::string(kFour) + "f 1 2 3\np 1\n");
  Scene other = read_file("b.gltf", gltf(3, true));
  s.append(std::move(other));
  ASSERT_EQ(s.instances.size(), 4U);
  EXPECT_EQ(s.primitive_count(), 1U + 1U + 3U + 3U);
  EXPECT_EQ(*s.instances[1].geometry, 0U);
  EXPECT_EQ(*s.instances[2].geometry, 1U);
  // The file has no materials, but its colours need one that blends.
  EXPECT_EQ(s.materials[points_of(s, 1).material].alpha_mode, AlphaMode::blend);
  EXPECT_EQ(s.materials[lines_of(s, 2).material].name, "m");
  const std::string text = io::describe(s);
  EXPECT_TRUE(holds(text, "1 triangle, 1 point, 6 line segments in 4 instances"));
  EXPECT_TRUE(holds(text, "points 0 a: 1 point, colours"));
  EXPECT_TRUE(holds(text, "lines 1 n: 3 segments, colours"));
  s.instances[2].geometry = 9;
  EXPECT_THROW((void)s.primitive_count(), Error);
  EXPECT_THROW((void)SceneBinding(s), Error);
}

}  // namespace
}  // namespace rastrum::test::points_and_lines_files_test
