// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/io/scene_files.hpp"

namespace rastrum::test::obj_test {
namespace {

using Indices = std::vector<std::uint32_t>;

Scene read(const std::string& text) {
  return read_file("a.obj", text);
}

constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, PolygonsBecomeFansFromTheirFirstVertex) {
  const Scene s = read(std::string(kSquare) + "v 0.5 2 0\nf 2 3 5 4 1\n");
  EXPECT_EQ(s.meshes[0].indices, (Indices{1, 2, 4, 1, 4, 3, 1, 3, 0}));
}

TEST(Obj, APolygonMayHaveMoreCornersThanAByteCounts) {
  std::ostringstream text;
  std::string face = "f";
  for (int i = 1; i <= 300; ++i) {
    text << "v " << std::cos(i * 0.02) << ' ' << std::sin(i * 0.02) << " 0\n";
    face.append(" ").append(std::to_string(i));
  }
  EXPECT_EQ(read(text.str() + face + "\n").triangle_count(), 298U);
}

TEST(Obj, NegativeIndicesCountFromTheEndSoFar) {
  const Scene s = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 9 9 9\nf -4 -3 -1\n");
  EXPECT_EQ(s.meshes[0].indices, (Indices{0, 1, 2, 0, 1, 3}));
}

TEST(Obj, FacesMayStandBeforeTheirVertices) {
  EXPECT_EQ(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangle_count(), 1U);
}

TEST(Obj, OrderIsTheFilesOverGroupsAndMaterials) {
  const TempFolder folder;
  folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  const Scene s =
      io::read_scene(folder.write("a.obj", "mtllib m.mtl\n" + std::string(kSquare) +
                                               "usemtl blue\ng one\nf 1 2 3\nusemtl red\ng two\nf "
                                               "1 3 4\nusemtl blue\ng one\nf 2 3 4\n"));
  ASSERT_EQ(s.meshes.size(), 1U);
  EXPECT_EQ(s.meshes[0].indices, (Indices{0, 1, 2, 0, 2, 3, 1, 2, 3}));
  EXPECT_EQ(s.meshes[0].face_materials, (Indices{1, 0, 1}));
  EXPECT_EQ(s.materials[1].base_color.z, 1.0F);
}

TEST(Obj, AttributesKeepTheirOwnIndicesAndVIsTurned) {
  const Scene s = read(std::string(kSquare) + "vt 0 0.25\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1\n");
  const Mesh& m = s.meshes[0];
  EXPECT_EQ(m.texcoords.indices, (Indices{0, 1, 0}));
  EXPECT_EQ(m.texcoords.values[0].y, 0.75F);
  EXPECT_EQ(m.normals.indices, (Indices{0, 0, 0}));
}

TEST(Obj, EqualIndicesAreShared) {
  const Scene s =
      read("v 0 0 0\nvn 0 0 1\nv 1 0 0\nvn 0 0 1\nv 0 1 0\nvn 0 1 0\nf 1//1 2//2 3//3\n");
  EXPECT_TRUE(s.meshes[0].normals.indices.empty());
  EXPECT_EQ(s.meshes[0].normals.values[2].y, 1.0F);
}

TEST(Obj, FacesWithoutNormalsAmongOthersGetTheirOwn) {
  const Scene s = read(std::string(kSquare) + "vn 1 0 0\nf 1//1 2//1 3//1\nf 1 3 4\n");
  const auto& n = s.meshes[0].normals;
  EXPECT_EQ(n.values[n.indices[0]].x, 1.0F);
  EXPECT_EQ(n.values[n.indices[3]].z, 1.0F);
  EXPECT_EQ(s.warnings.size(), 1U);
}

TEST(Obj, ColoursAndLineContinuation) {
  const Scene s = read("v 0 0 0 1 0 0.5\nv 1 0 \\\n 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  EXPECT_EQ(s.meshes[0].colors.values[0].z, 0.5F);
  EXPECT_EQ(s.meshes[0].colors.values[1].y, 1.0F);
  EXPECT_EQ(s.meshes[0].colors.values[2].w, 1.0F);
}

TEST(Obj, NumbersAreRoundedCorrectly) {
  // But for its last digit half way between two floats: rounding to float64 first would round it
  // down.
  const Scene s = read("v 1.00000005960464477540 +.5e1 1e-50\nv 1 0 0\nv 0 1 1e40\nf 1 2 3\n");
  EXPECT_EQ(s.meshes[0].positions[0].x, std::nextafter(1.0F, 2.0F));
  EXPECT_EQ(s.meshes[0].positions[0].y, 5.0F);
  EXPECT_EQ(s.meshes[0].positions[0].z, 0.0F);
  EXPECT_TRUE(std::isinf(s.meshes[0].positions[2].z));
}

TEST(Obj, ErrorsNameFileAndLine) {
  for (const auto& [text, says] :
       {std::pair{std::string(kSquare) + "f 1 2 9\n", "a.obj:5: "},
        {std::string(kSquare) + "\nf 1 0 2\n", "a.obj:6: "},
        {"v 0 0 0\nf -2 1 1\n", "a.obj:2: "},
        {"v 0 zero 0\n", "'zero'"},
        {"v 0 0\n", "a.obj:1: "},
        {std::string(kSquare) + "f 1 2 3x\n", "a.obj:5: "},
        {std::string(kSquare) + "f 1 99999999999999999999 3\n", "range"}})
    expect_bad_file(says, "a.obj", text);
  expect_warning("a.obj:5: the face refers to texture coordinate 2, but the file has 1",
                 read(std::string(kSquare) + "f 1/1 2/2 3/1\nf 1/1 2/1 3/1\nvt 0 0\n"));
}

TEST(Obj, MaterialsAndTextures) {
  const TempFolder folder;
  Image<Rgba8> image(1, 1);
  image(0, 0) = {9, 8, 7, 255};
  io::write_png(folder.path("a b.png"), std::as_const(image).view());
  folder.write("m.mtl",
               "newmtl leaf\nKd 0.5 0.25 1\nNs 30\nKe 0 2 0\nmap_Kd a b.png\nmap_d a b.png\n"
               "newmtl glass\nKd 1 1 1\nd 0.5\nnewmtl broken\nmap_Kd missing.png\n");
  const Scene s =
      io::read_scene(folder.write("a.obj", "mtllib m.mtl\n" + std::string(kSquare) +
                                               "usemtl leaf\nf 1 2 3\nusemtl glass\nf 1 3 4\n"));
  ASSERT_EQ(s.materials.size(), 3U);
  const Material& leaf = s.materials[0];
  EXPECT_EQ(leaf.base_color.y, 0.25F);
  EXPECT_EQ(leaf.metallic, 0.0F);
  EXPECT_FLOAT_EQ(leaf.roughness, 0.5F);  // (2 / 32)^(1/4)
  EXPECT_EQ(leaf.emissive.y, 2.0F);
  EXPECT_EQ(leaf.alpha_mode, AlphaMode::mask);
  ASSERT_EQ(leaf.base_color_texture, 0);
  EXPECT_EQ(leaf.alpha_texture, 0);
  EXPECT_EQ(s.textures[0].image(0, 0), (Rgba8{9, 8, 7, 255}));
  EXPECT_EQ(s.materials[1].alpha_mode, AlphaMode::blend);
  EXPECT_EQ(s.materials[1].base_color.w, 0.5F);
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_NE(s.warnings[0].find("missing.png"), std::string::npos);
}

TEST(Obj, LibrariesInTheirOrderHoweverMany) {
  const TempFolder folder;
  folder.write("b.mtl", "newmtl one\nKd 1 0 0\nnewmtl two\nKd 0 1 0\n");
  folder.write("c.mtl", "newmtl two\nKd 1 1 1\nnewmtl three\nKd 0 0 1\n");
  std::string names;
  for (int i = 0; i < 20'000; ++i) names += " no" + std::to_string(i) + ".mtl";
  // The file's first library and further ones, before or after the faces that use them.
  for (const char* first : {"b.mtl c.mtl", "no0.mtl b.mtl b.mtl c.mtl"}) {
    const Scene s = io::read_scene(folder.write(
        "a.obj", std::string("mtllib ") + first + "\n" + kSquare +
                     "usemtl three\nf 1 2 3\nusemtl two\nf 1 3 4\nmtllib" + names + "\n"));
    ASSERT_EQ(s.materials.size(), 3U);
    EXPECT_EQ(s.materials[1].base_color.x, 0);
    ASSERT_EQ(s.meshes[0].face_materials.size(), 2U);
    EXPECT_EQ(s.meshes[0].face_materials[0], 2U);
    EXPECT_EQ(s.meshes[0].face_materials[1], 1U);
    EXPECT_EQ(s.warnings.size(), 20'000U);
  }
}

TEST(Obj, MissingLibrariesAreWarnings) {
  const Scene s = read("mtllib none.mtl\nusemtl x\n" + std::string(kSquare) + "f 1 2 3\n");
  EXPECT_EQ(s.triangle_count(), 1U);
  EXPECT_TRUE(s.materials.empty());
  EXPECT_EQ(s.warnings.size(), 2U);
}

}  // namespace
}  // namespace rastrum::test::obj_test
