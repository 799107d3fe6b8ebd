// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/io/scene_files.hpp"

namespace rastrum::test::ply_test {
namespace {

using Indices = std::vector<std::uint32_t>;

Scene read(const std::string& bytes) {
  return read_file("a.ply", bytes);
}

constexpr const char* kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string header(const std::string& format, int vertices, const std::string& properties,
                   int faces, const std::string& list) {
  return "ply\nformat " + format + " 1.0\ncomment made here\nelement vertex " +
         std::to_string(vertices) + "\n" + properties + "element face " + std::to_string(faces) +
         "\n" + list + "end_header\n";
}

TEST(Ply, AsciiWithEverything) {
  const Scene s =
      read(header("ascii", 4,
                  std::string(kXyz) +
                      "property float nx\nproperty float ny\nproperty float nz\n"
                      "property float s\nproperty float t\nproperty uchar red\n"
                      "property uchar green\nproperty uchar blue\nproperty float quality\n",
                  2, "property list uchar int vertex_indices\n") +
           "0 0 0 0 0 1 0 0 255 0 51 7\n1 0 0 0 0 1 1 0.25 0 0 0 7\n"
           "1 1 0 0 0 1 1 1 0 0 0 7\n0 1 0 0 1 0 0 1 0 0 0 7\n4 0 1 2 3\n2 0 1\n");
  const Mesh& m = s.meshes[0];
  EXPECT_EQ(m.indices, (Indices{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(m.normals.values[3].y, 1.0F);
  EXPECT_EQ(m.texcoords.values[1].y, 0.75F);
  EXPECT_EQ(m.colors.values[0].x, 1.0F);
  EXPECT_FLOAT_EQ(m.colors.values[0].z, 0.2F);
  EXPECT_EQ(m.colors.values[0].w, 1.0F);
  EXPECT_EQ(s.warnings.size(), 1U) << "the face of 2 corners";
  ASSERT_EQ(m.scalars.size(), 1U);
  EXPECT_EQ(m.scalars[0].name, "quality");
  EXPECT_EQ(m.scalars[0].values, (std::vector<double>{7, 7, 7, 7}));
}

// Other properties are scalars, of vertices or of faces, whose triangles all have the face's value.
TEST(Ply, OtherPropertiesAreScalars) {
  const std::string vertices = std::string(kXyz) + "property double heat\nproperty uchar tag\n";
  const std::string faces =
      "property int part\nproperty list uchar int vertex_indices\nproperty float heat\n"
      "property list uchar float weights\n";
  const auto check = [](const Scene& s) {
    const Mesh& m = s.meshes.at(0);
    ASSERT_EQ(m.indices, (Indices{0, 1, 2, 0, 2, 3, 0, 1, 3}));
    ASSERT_EQ(m.scalars.size(), 4U);
    EXPECT_EQ(m.scalars[0].name, "heat");
    EXPECT_EQ(m.scalars[0].per, Per::vertex);
    EXPECT_EQ(m.scalars[0].values, (std::vector<double>{0.1, -1e300, 2, 3}));
    EXPECT_EQ(m.scalars[1].name, "tag");
    EXPECT_EQ(m.scalars[1].values, (std::vector<double>{0, 255, 7, 9}));
    EXPECT_EQ(m.scalars[2].name, "part");
    EXPECT_EQ(m.scalars[2].per, Per::face);
    EXPECT_EQ(m.scalars[2].values, (std::vector<double>{-4, -4, 5}));
    EXPECT_EQ(m.scalars[3].name, "face.heat");
    EXPECT_EQ(m.scalars[3].values, (std::vector<double>{0.5, 0.5, 0.25}));
    ASSERT_EQ(s.warnings.size(), 1U);
    EXPECT_TRUE(holds(s.warnings[0], "not drawn: face.weights"));
  };
  check(read(header("ascii", 4, vertices, 2, faces) +
             "0 0 0 0.1 0\n1 0 0 -1e300 255\n1 1 0 2 7\n0 1 0 3 9\n"
             "-4 4 0 1 2 3 0.5 0\n5 3 0 1 3 0.25 2 1 2\n"));
  for (const bool big : {false, true}) {
    std::string bytes =
        header(big ? "binary_big_endian" : "binary_little_endian", 4, vertices, 2, faces);
    const double heat[] = {0.1, -1e300, 2, 3};
    const std::uint8_t tag[] = {0, 255, 7, 9};
    for (int v = 0; v < 4; ++v)
      bytes += raw(v == 1 || v == 2 ? 1.0F : 0.0F, big) + raw(v >= 2 ? 1.0F : 0.0F, big) +
               raw(0.0F, big) + raw(heat[v], big) + raw(tag[v], big);
    bytes += raw(std::int32_t{-4}, big) + raw(std::uint8_t{4}, big);
    for (std::int32_t v = 0; v < 4; ++v) bytes += raw(v, big);
    bytes += raw(0.5F, big) + raw(std::uint8_t{0}, big);
    bytes += raw(std::int32_t{5}, big) + raw(std::uint8_t{3}, big);
    for (const std::int32_t v : {0, 1, 3}) bytes += raw(v, big);
    bytes += raw(0.25F, big) + raw(std::uint8_t{1}, big) + raw(8.0F, big);
    check(read(bytes));
  }
}

TEST(Ply, ScalarsAreWrittenAsTheyAreRead) {
  const TempFolder folder;
  Mesh m{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
         .indices = {0, 1, 2, 1, 3, 2},
         .scalars = {{"heat", {0.1, 1e300, -3, 4}, Per::vertex},
                     {"part of it", {7, -7}, Per::face},
                     {"left out", {1, 2, 3, 4, 5, 6}, Per::corner}}};
  io::write_ply(folder.path("b.ply"), m);
  const Mesh again = io::read_scene(folder.path("b.ply")).meshes.at(0);
  EXPECT_EQ(again.indices, m.indices);
  ASSERT_EQ(again.scalars.size(), 2U);
  EXPECT_EQ(again.scalars[0].name, "heat");
  EXPECT_EQ(again.scalars[0].values, m.scalars[0].values);
  EXPECT_EQ(again.scalars[1].name, "part_of_it");
  EXPECT_EQ(again.scalars[1].per, Per::face);
  EXPECT_EQ(again.scalars[1].values, m.scalars[1].values);
  m.scalars[1].values.pop_back();
  EXPECT_THROW(io::write_ply(folder.path("b.ply"), m), Error);
}

/// Expects the same mesh from the square in each combination of types and byte orders.
template <class Count, class Index, class Real>
void expect_square(const char* count, const char* index, const char* real, bool big) {
  SCOPED_TRACE(std::string(count) + " " + index + " " + real + (big ? " big" : " little"));
  const std::string r = std::string("property ") + real;
  std::string bytes =
      header(big ? "binary_big_endian" : "binary_little_endian", 4,
             r + " x\n" + r + " y\n" + r + " z\nproperty short weight\n", 2,
             "property list " + std::string(count) + " " + index + " vertex_index\n");
  const int corners[4][2] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  for (const auto& c : corners)
    bytes += raw(static_cast<Real>(c[0]), big) + raw(static_cast<Real>(c[1]), big) +
             raw(static_cast<Real>(-3), big) + raw(std::int16_t{258}, big);
  for (const int first : {0, 1}) {
    bytes += raw(Count{3}, big);
    for (int k = 0; k < 3; ++k) bytes += raw(static_cast<Index>(first + k), big);
  }
  const Scene s = read(bytes);
  EXPECT_EQ(s.meshes[0].indices, (Indices{0, 1, 2, 1, 2, 3}));
  EXPECT_EQ(s.meshes[0].positions[2].x, 2.0F);
  EXPECT_EQ(s.meshes[0].positions[3].y, 1.0F);
  EXPECT_EQ(s.meshes[0].positions[1].z, -3.0F);
}

TEST(Ply, BinaryOfAllTypesAndByteOrders) {
  for (const bool big : {false, true}) {
    expect_square<std::uint8_t, std::int32_t, float>("uchar", "int", "float", big);
    expect_square<std::uint8_t, std::uint32_t, double>("uint8", "uint32", "double", big);
    expect_square<std::int8_t, std::uint8_t, float>("char", "uchar", "float32", big);
    expect_square<std::uint32_t, std::int16_t, float>("uint", "short", "float", big);
    expect_square<std::uint16_t, std::uint16_t, std::int16_t>("ushort", "uint16", "short", big);
    expect_square<std::int32_t, std::int8_t, std::int8_t>("int", "char", "char", big);
  }
}

TEST(Ply, PlainTrianglesMayTurnIntoPolygons) {
  std::string bytes =
      header("binary_little_endian", 5, kXyz, 3, "property list uchar int vertex_indices\n");
  for (int i = 0; i < 5; ++i) bytes += raw(static_cast<float>(i)) + raw(0.0F) + raw(1.0F);
  const auto face = [&](std::initializer_list<int> corners) {
    bytes += static_cast<char>(corners.size());
    for (const int c : corners) bytes += raw(c);
  };
  face({0, 1, 2});
  face({4, 3, 2, 1});
  face({2, 3, 4});
  EXPECT_EQ(read(bytes).meshes[0].indices, (Indices{0, 1, 2, 4, 3, 2, 4, 2, 1, 2, 3, 4}));
}

TEST(Ply, StripsTurnEverySecondTriangleAndRestart) {
  const std::string strips = "property list int int vertex_indices\n";
  std::string text = header("ascii", 5, kXyz, 1, strips);
  text.replace(text.find("element face"), 12, "element tristrips");
  const Scene s = read(text + "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n10 0 1 2 3 4 -1 4 3 2 -1\n");
  EXPECT_EQ(s.meshes[0].indices, (Indices{0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 2}));
}

TEST(Ply, UnknownElementsAndListsAreSkipped) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement camera 2\nproperty double f\n"
      "property list uchar short path\nelement vertex 3\nproperty list uchar int friends\n" +
      std::string(kXyz) +
      "element face 1\nproperty uchar flags\nproperty list uchar int vertex_indices\n"
      "property list uchar float weights\nend_header\n";
  for (int i = 0; i < 2; ++i)
    bytes += raw(1.0, true) + '\2' + raw(std::int16_t{1}, true) + raw(std::int16_t{1}, true);
  for (int i = 0; i < 3; ++i)
    bytes +=
        '\1' + raw(7, true) + raw(static_cast<float>(i), true) + raw(1.0F, true) + raw(2.0F, true);
  bytes += '\5' + std::string(1, '\3') + raw(2, true) + raw(1, true) + raw(0, true) + '\1' +
           raw(1.0F, true);
  const Scene s = read(bytes);
  EXPECT_EQ(s.meshes[0].indices, (Indices{2, 1, 0}));
  EXPECT_EQ(s.meshes[0].positions[2].x, 2.0F);
}

TEST(Ply, LiesAreRefusedBeforeAnythingIsAllocated) {
  const std::string list = "property list uchar int vertex_indices\n",
                    vertex = raw(0.0F) + raw(0.0F) + raw(0.0F),
                    one = header("binary_little_endian", 1, kXyz, 1, list) + vertex;
  for (const auto& [bytes, says] :
       {std::pair{header("binary_little_endian", 2000000000, kXyz, 0, list), "2000000000"},
        {header("ascii", 2000000000, kXyz, 0, list), "2000000000"},
        {header("binary_little_endian", 1, kXyz, 2000000000, list) + vertex, "face"},
        // A list longer than the rest, a negative count, indices out of range.
        {one + '\xFF' + raw(0), "ends"},
        {header("binary_little_endian", 1, kXyz, 1, "property list char int vertex_indices\n") +
             vertex + '\xFF' + raw(0),
         "-1"},
        {one + '\3' + raw(0) + raw(0) + raw(1), "vertex 1"},
        {one + '\3' + raw(0) + raw(0) + raw(-1), "vertex -1"},
        {header("ascii", 1, kXyz, 1, list) + "0 0 x\n3 0 0 0\n", "a.ply:11: "}})
    expect_bad_file(says, "a.ply", bytes);
}

TEST(Ply, BadHeaders) {
  for (const auto& [text, says] :
       {std::pair{"plY\n", "ply"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n", "'half'"},
        {"ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "a.ply:3: "},
        {"ply\nformat ascii 1.0\n", "end_header"},
        {"ply\nelement vertex 0\nend_header\n", "format"},
        {"ply\nformat ascii 1.0\nproperty int x\nend_header\n", "before any"}})
    expect_bad_file(says, "a.ply", text);
}

}  // namespace
}  // namespace rastrum::test::ply_test
