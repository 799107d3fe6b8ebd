// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/io/scene_files.hpp"

namespace rastrum::test::stl_off_test {
namespace {

using Indices = std::vector<std::uint32_t>;

std::string binary_stl(std::string head, std::uint32_t count, const std::vector<Vec3>& corners) {
  head.resize(80, '\0');
  head += raw(count);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i % 3 == 0) head += std::string(12, '\xFF');
    head += raw(corners[i]);
    if (i % 3 == 2) head += std::string(2, '\0');
  }
  return head;
}

const std::vector<Vec3> kTwo = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

constexpr const char* kFacet =
    "facet normal 0 0 nan\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  VERTEX 0 1e0 0\n "
    "endloop\nendfacet\n";

TEST(Stl, BinaryMergesEqualVertices) {
  const Scene s = read_file("a.STL", binary_stl("made here", 2, kTwo));
  EXPECT_EQ(s.meshes[0].positions.size(), 4U);
  EXPECT_EQ(s.meshes[0].indices, (Indices{0, 1, 2, 1, 3, 2}));
  EXPECT_TRUE(s.meshes[0].normals.empty());
}

TEST(Stl, BinaryMayCallItselfSolid) {
  EXPECT_EQ(read_file("a.stl", binary_stl("solid thing\n", 2, kTwo)).triangle_count(), 2U);
}

TEST(Stl, VerticesAreMergedByTheirBits) {
  const Scene s = read_file("a.stl", binary_stl("", 1, {{0, 0, 0}, {-0.0F, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(s.meshes[0].positions.size(), 3U);
}

TEST(Stl, ManyVerticesMakeTheTableGrow) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 3 * 5000; ++i) corners.push_back({static_cast<float>(i % 4999), 1, 2});
  const Scene s = read_file("a.stl", binary_stl("", 5000, corners));
  ASSERT_EQ(s.meshes[0].positions.size(), 4999U);
  for (std::size_t i = 0; i < corners.size(); ++i)
    ASSERT_TRUE(s.meshes[0].positions[s.meshes[0].indices[i]] == corners[i]);
}

TEST(Stl, CountsThatLie) {
  for (const auto& [bytes, says] : {std::pair{binary_stl("", 3, kTwo), "says 3 triangles"},
                                    {binary_stl("", 0xFFFFFFFFU, kTwo), "4294967295"},
                                    {binary_stl("", 0, kTwo), "0 triangles"},
                                    {"short", "not STL"}})
    expect_bad_file(says, "a.stl", bytes);
  const Scene s = read_file("a.stl", binary_stl("", 2, kTwo) + "tail");
  EXPECT_EQ(s.triangle_count(), 2U);
  EXPECT_EQ(s.warnings.size(), 1U);
}

TEST(Stl, AsciiWithSeveralSolids) {
  const Scene s = read_file("a.stl", std::string("SOLID the first facet\n") + kFacet +
                                         "endsolid\nsolid\n" + kFacet + "endsolid x\n");
  EXPECT_EQ(s.meshes[0].indices, (Indices{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(s.meshes[0].positions.size(), 3U);
  EXPECT_TRUE(s.warnings.empty());
}

TEST(Stl, AsciiErrorsNameTheLine) {
  const std::string text = std::string("solid\n") + kFacet,
                    loop = "facet normal 0 0 0\nouter loop\n";
  for (const auto& [rest, says] : {std::pair{loop + "vertex 1 2\nendloop\n", "a.stl:12: "},
                                   {loop + "vertex 1 2 3\nendloop\n", "1 vertices instead of 3"},
                                   {loop, "ends inside"},
                                   {"fect\n", "'fect'"}})
    expect_bad_file(says, "a.stl", text + rest);
}

TEST(Off, PolygonsCommentsAndColours) {
  const Scene s = read_file(
      "a.off",
      "# a comment\nCOFF # more\n4 1 0\n0 0 0 255 0 0\n1 0 0 0 255 0 255\n1 1 0 0 0 51 # c\n"
      "\n0 1 0 0 0 0\n4 0 1 2 3 0.5 0.5 0.5\n");
  EXPECT_EQ(s.meshes[0].indices, (Indices{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(s.meshes[0].colors.values[0].x, 1.0F);
  EXPECT_FLOAT_EQ(s.meshes[0].colors.values[2].z, 0.2F);
  EXPECT_EQ(s.warnings.size(), 1U) << "the colour of the face";
}

TEST(Off, NormalsAndTextureCoordinates) {
  const Scene s = read_file(
      "a.off",
      "STNOFF 3 1 0\n0 0 0  0 0 1  0 0\n1 0 0  0 0 1  1 0\n0 1 0  0 1 0  0 0.75\n3 0 1 2\n");
  EXPECT_EQ(s.meshes[0].normals.values[2].y, 1.0F);
  EXPECT_EQ(s.meshes[0].texcoords.values[2].y, 0.25F);
}

TEST(Off, Errors) {
  for (const auto& [text, says, code] :
       {std::tuple{"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "a.off:6: ", Errc::bad_format},
        {"OFF\n4000000000 1 0\n0 0 0\n", "too short", Errc::bad_format},
        {"OFF BINARY\nxxxx", "binary", Errc::unsupported},
        {"4OFF\n1 0 0\n0 0 0 1\n", "three-dimensional", Errc::unsupported},
        {"hello\n", "not OFF", Errc::bad_format}})
    expect_bad_file(says, "a.off", text, code);
}

TEST(ReadScene, KnowsExtensionsAndNamesMissingFiles) {
  expect_bad_file("no kind of mesh", "a.xyz", "", Errc::unsupported);
  expect_refused("/nowhere/at/all.ply", Errc::not_found,
                 [&] { (void)io::read_scene("/nowhere/at/all.ply"); });
}

}  // namespace
}  // namespace rastrum::test::stl_off_test
