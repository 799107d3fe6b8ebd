// SPDX-License-Identifier: BSD-3-Clause
// Mesh files that are valid but rare.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

#include "tests/io/scene_files.hpp"
#include "tests/support/frame.hpp"

namespace rastrum::test::file_troubles {
namespace {

/// The colour of triangle t of the scene's first mesh, at its first corner.
Vec4 color(const Scene& scene, std::size_t t) {
  const MeshView m = scene.meshes.at(0).view();
  const TrianglePlace place = m.place(t);
  std::uint32_t vertex[3];
  m.read_triangles(t, 1, vertex);
  return m.colors.empty() ? Vec4{} : m.colors.at(place, vertex, 0);
}

void expect_color(const Scene& scene, std::size_t t, Vec4 c) {
  const Vec4 d = color(scene, t) - c;
  EXPECT_LE(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z), std::abs(d.w)}), 1e-6F) << t;
}

/// Whether one of the warnings has this in it.
bool says(const Scene& scene, std::string_view what) {
  for (const std::string& w : scene.warnings)
    if (w.find(what) != std::string::npos) return true;
  return false;
}

constexpr Vec4 kRed{1, 0, 0, 1}, kGreen{0, 1, 0, 1}, kBlue{0, 0, 1, 1};

// ---- PLY

/// A square of two triangles, each a face.
std::string ply_square(const std::string& of_vertices, const std::vector<std::string>& vertices,
                       const std::string& of_faces, const std::vector<std::string>& faces,
                       const std::string& comments = "", const std::string& type = "float") {
  std::string s = "ply\nformat ascii 1.0\n" + comments + "element vertex 4\n";
  for (const char* c : {"x", "y", "z"}) s += "property " + type + " " + c + "\n";
  s += of_vertices + "element face 2\nproperty list uchar int vertex_indices\n" + of_faces +
       "end_header\n";
  const char* const corners[] = {"0 0 0", "1 0 0", "1 1 0", "0 1 0"};
  for (std::size_t v = 0; v < 4; ++v)
    s += std::string(corners[v]) + " " + (vertices.empty() ? "" : vertices[v]) + "\n";
  for (std::size_t f = 0; f < 2; ++f)
    s += std::string(f == 0 ? "3 0 1 2 " : "3 0 2 3 ") + (faces.empty() ? "" : faces[f]) + "\n";
  return s;
}
std::string rgb(const std::string& type) {
  return "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
}

// The element face has red, green and blue. Right: each face has its colour; if vertices have
// colours, too, theirs are drawn, with a warning.
TEST(OddPly, ColoursOfFaces) {
  const Scene s = read_file("a.ply", ply_square("", {}, rgb("uchar") + "property int part\n",
                                                {"255 0 0 7", "0 255 0 8"}));
  expect_color(s, 0, kRed);
  expect_color(s, 1, kGreen);
  ASSERT_EQ(s.meshes[0].scalars.size(), 1U);
  EXPECT_EQ(s.meshes[0].scalars[0].name, "part");
  EXPECT_TRUE(s.warnings.empty()) << s.warnings[0];
  const Scene both =
      read_file("a.ply", ply_square(rgb("uchar"), std::vector<std::string>(4, "0 0 255"),
                                    rgb("uchar"), {"255 0 0", "0 255 0"}));
  expect_color(both, 0, kBlue);
  EXPECT_TRUE(says(both, "colours of faces are left out"));
}

// MeshLab's `comment TextureFile`, texture_u and texture_v. Right: the picture is drawn, v
// counts from the bottom.
TEST(OddPly, PictureOfVertices) {
  const TempFolder folder;
  write_pixel(folder.path("My Skin.png"), {255, 0, 0, 255});
  const Scene s = io::read_scene(folder.write(
      "a.ply",
      ply_square("property float texture_u\nproperty float texture_v\n",
                 {"0 0", "1 0", "1 0.75", "0 1"}, "", {}, "comment TextureFile My Skin.png\n")));
  EXPECT_TRUE(s.warnings.empty()) << s.warnings[0];
  ASSERT_EQ(s.materials.size(), 1U);
  EXPECT_EQ(s.materials[0].base_color_texture, 0);
  EXPECT_EQ(s.textures.at(0).image(0, 0), (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(s.meshes[0].texcoords.values.at(2), (Vec2{1, 0.25F}));
}

// Lists texcoord of faces, texnumber, two TextureFile. Right: each corner has its own
// coordinate, each face its picture.
TEST(OddPly, PicturesOfFaces) {
  const TempFolder folder;
  write_pixel(folder.path("a.png"), {255, 0, 0, 255});
  write_pixel(folder.path("b.png"), {0, 255, 0, 255});
  const Scene s = io::read_scene(folder.write(
      "a.ply", ply_square("", {}, "property list uchar float texcoord\nproperty int texnumber\n",
                          {"6 0 0 1 0 1 0.75 1", "6 0.5 0 1 1 0 1 0"},
                          "comment TextureFile a.png\ncomment TextureFile b.png\n")));
  EXPECT_TRUE(s.warnings.empty()) << s.warnings[0];
  ASSERT_EQ(s.materials.size(), 2U);
  EXPECT_EQ(s.meshes[0].face_materials, (std::vector<std::uint32_t>{1, 0}));
  const MeshView m = s.meshes[0].view();
  std::uint32_t vertex[3];
  m.read_triangles(0, 1, vertex);
  EXPECT_EQ(m.texcoords.at(m.place(0), vertex, 2), (Vec2{1, 0.25F}));
  m.read_triangles(1, 1, vertex);
  EXPECT_EQ(m.texcoords.at(m.place(1), vertex, 0), (Vec2{0.5F, 1}));
}

// Colours of int, uint, short, ushort, float or double up to 255. Right: 255 is full intensity,
// with a warning; the type decides if the largest of the file is above 255 or below 2.
TEST(OddPly, ColoursOfWideNumbers) {
  for (const char* type : {"int", "uint", "short", "ushort", "float", "double"}) {
    const Scene s =
        read_file("a.ply", ply_square(rgb(type), {"255 0 0", "0 0 0", "0 0 0", "0 51 0"}, "", {}));
    expect_color(s, 0, kRed);
    EXPECT_FLOAT_EQ(s.meshes[0].colors.values.at(3).y, 0.2F) << type;
    EXPECT_TRUE(says(s, "go up to 255: taken as parts of 255")) << type;
  }
  // Units that the type determines stay.
  const Scene wide = read_file(
      "a.ply", ply_square(rgb("ushort"), {"65535 0 0", "0 0 0", "0 0 0", "0 0 0"}, "", {}));
  expect_color(wide, 0, kRed);
  EXPECT_TRUE(wide.warnings.empty());
  const Scene ones =
      read_file("a.ply", ply_square(rgb("float"), {"1 0.5 0", "0 0 0", "0 0 0", "0 0 0"}, "", {}));
  expect_color(ones, 0, {1, 0.5F, 0, 1});
  EXPECT_TRUE(ones.warnings.empty());
}

// An element edge with vertex1 and vertex2. Right: lines where there are no faces, else a
// warning.
TEST(OddPly, Edges) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement edge 2\nproperty int vertex1\nproperty int vertex2\n";
  const Scene s = read_file("a.ply", head + "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1\n1 2\n");
  ASSERT_EQ(s.geometries.size(), 1U);
  const auto* lines = std::get_if<Lines>(&s.geometries[0]);
  ASSERT_NE(lines, nullptr);
  EXPECT_EQ(lines->view().size(), 2U);
  EXPECT_EQ(lines->indices, (std::vector<std::uint32_t>{0, 1, 1, 2}));
  EXPECT_TRUE(s.warnings.empty());
  const Scene colored = read_file(
      "a.ply", head + rgb("uchar") + "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 255 0 0\n1 2 0 255 0\n");
  EXPECT_EQ(std::get<Lines>(colored.geometries.at(0)).colors,
            (std::vector<Vec4>{kRed, kRed, kGreen, kGreen}));
  const Scene faces =
      read_file("a.ply", head +
                             "element face 1\nproperty list uchar int vertex_indices\n"
                             "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1\n1 2\n3 0 1 2\n");
  EXPECT_EQ(faces.triangle_count(), 1U);
  EXPECT_TRUE(says(faces, "2 of 'edge' are left out"));
}

// ---- STL

std::string binary_stl(std::string header, const std::vector<std::uint16_t>& attributes) {
  header.resize(80, ' ');
  header += raw(static_cast<std::uint32_t>(attributes.size()));
  for (std::size_t t = 0; t < attributes.size(); ++t) {
    const auto x = static_cast<float>(t);
    for (const float f : {0.0F, 0.0F, 1.0F, x, 0.0F, 0.0F, x + 1, 0.0F, 0.0F, x, 1.0F, 0.0F})
      header += raw(f);
    header += raw(attributes[t]);
  }
  return header;
}

// Attributes of binary STL with bit 15, as VisCAM and SolidView write. Right: five bits a
// channel, red highest; facets without the bit are plain.
TEST(OddStl, ColoursOfViscam) {
  const Scene s = read_file("a.stl", binary_stl("made", {0xFC00, 0x83E0, 0x7FFF}));
  expect_color(s, 0, kRed);
  expect_color(s, 1, kGreen);
  expect_color(s, 2, {0.8F, 0.7F, 0.6F, 1});  // bit 15 is not set: the plain colour
  EXPECT_TRUE(read_file("a.stl", binary_stl("made", {0x7C00, 0})).meshes[0].colors.empty());
}

// A header with COLOR=, as Magics writes. Right: five bits a channel, red lowest; bit 15 is the
// colour of the whole.
TEST(OddStl, ColoursOfMagics) {
  const std::string header = std::string("COLOR=") + "\x00\x00\xFF\xFF"[0] + '\0' + "\xFF\xFF";
  const Scene s = read_file("a.stl", binary_stl(header, {0x001F, 0x03E0, 0x8000}));
  expect_color(s, 0, kRed);  // red is in the lowest bits there
  expect_color(s, 1, kGreen);
  expect_color(s, 2, kBlue);  // bit 15: the colour of the whole
  expect_color(read_file("a.stl", binary_stl(header, {0, 0})), 1, kBlue);
}

std::string facet(int x, const std::string& before = "", const std::string& after = "") {
  const std::string a = std::to_string(x), b = std::to_string(x + 1);
  return "facet normal 0 0 1\n" + before + "outer loop\nvertex " + a + " 0 0\nvertex " + b +
         " 0 0\nvertex " + a + " 1 0\nendloop\n" + after + "endfacet\n";
}

// A line before solid, lines that end in CR, all on one line. Right: all facets are read.
TEST(OddStl, OddText) {
  const std::string solid = "solid a part\n" + facet(0) + facet(1) + "endsolid a part\n";
  std::string cr = solid, one_line = solid;
  for (char& c : cr)
    if (c == '\n') c = '\r';
  for (char& c : one_line)
    if (c == '\n') c = ' ';
  for (const std::string& text :
       {"\n; made by hand\n" + solid, cr, one_line, one_line + one_line}) {
    const Scene s = read_file("a.stl", text);
    EXPECT_EQ(s.triangle_count(), text.size() > 2 * one_line.size() - 4 ? 4U : 2U) << text;
  }
  EXPECT_TRUE(says(read_file("a.stl", "made by hand\n" + solid), "1 lines before 'solid'"));
  expect_warning("holds no triangles", read_file("a.stl", "solid a part endsolid a part\n"));
}

// `color r g b` in text, in a facet or before some. Right: the colour of that facet, or of
// those that follow.
TEST(OddStl, ColorLines) {
  const Scene s = read_file("a.stl", "solid\n" + facet(0) + "color 1 0 0\n" + facet(1) +
                                         facet(2, "", "color 0 1 0\n") + facet(3, "color 0 0 1\n") +
                                         facet(4) + "endsolid\n");
  expect_color(s, 0, {0.8F, 0.7F, 0.6F, 1});
  expect_color(s, 1, kRed);
  expect_color(s, 2, kGreen);
  expect_color(s, 3, kBlue);
  expect_color(s, 4, kRed);  // those that facets have are theirs alone
}

// ---- OFF

std::string off_square(const std::string& first, const std::string& second) {
  return "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 " + first + "\n3 0 2 3 " + second + "\n";
}

// 3 or 4 integers, floats, or one number behind the corners. Right: the face's colour; one
// number is an index into tab20, with a warning.
TEST(OddOff, ColoursOfFaces) {
  for (const auto& [first, second] : {std::pair("255 0 0", "0 255 0"),
                                      {"255 0 0 255", "0 255 0 255"},
                                      {"1.0 0 0", "0 1 0"},
                                      {"1 0 0 1", "0 1 0 1.0"}}) {
    const Scene s = read_file("a.off", off_square(first, second));
    expect_color(s, 0, kRed);
    expect_color(s, 1, kGreen);
  }
  const Scene numbered = read_file("a.off", off_square("0", "1"));
  const ColorMap map = color_map("tab20");
  expect_color(numbered, 0, map.colors[0]);
  expect_color(numbered, 1, map.colors[1]);
  EXPECT_TRUE(says(numbered, "indices into a list that the file does not have"));
  const Scene some = read_file("a.off", off_square("255 0 0", ""));
  expect_color(some, 0, kRed);
  expect_color(some, 1, {0.8F, 0.7F, 0.6F, 1});
}

// COFF with 1 0 0 beside 0.5 0.25 0. Right: one decimal point makes all of the file floats.
TEST(OddOff, CoffDecidesOnce) {
  // "1 0 0 1" is red as its neighbours are.
  const Scene s = read_file(
      "a.off", "COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 0.5 0.25 0 1\n0 1 0 0 1 0 1\n3 0 1 2\n");
  EXPECT_EQ(s.meshes[0].colors.values.at(0), kRed);
  EXPECT_EQ(s.meshes[0].colors.values.at(2), kGreen);
}

// ---- text

const char* const kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::vector<std::pair<std::string, std::string>> texts() {
  return {{"a.obj", kObj},
          {"a.ply", ply_square("", {}, "", {})},
          {"a.off", off_square("", "")},
          {"a.stl", "solid\n" + facet(0) + "endsolid\n"}};
}

// A text begins with the mark of UTF-8. Right: it is skipped: OBJ, MTL, PLY, OFF, STL.
TEST(OddText, ByteOrderMark) {
  for (const auto& [name, text] : texts()) {
    const Scene plain = read_file(name, text), marked = read_file(name, "\xEF\xBB\xBF" + text);
    EXPECT_EQ(marked.meshes.at(0).positions, plain.meshes.at(0).positions) << name;
    EXPECT_EQ(marked.meshes[0].indices, plain.meshes[0].indices) << name;
    EXPECT_TRUE(marked.warnings.empty()) << name << marked.warnings[0];
  }
  const TempFolder folder;
  folder.write("m.mtl", "\xEF\xBB\xBFnewmtl red\nKd 1 0 0\n");
  const Scene s =
      io::read_scene(folder.write("a.obj", std::string("mtllib m.mtl\nusemtl red\n") + kObj));
  ASSERT_EQ(s.materials.size(), 1U);
  EXPECT_EQ(s.materials[0].base_color, kRed);
}

// A text is UTF-16. Right: an error that says so.
TEST(OddText, Utf16) {
  for (const auto& [name, text] : texts())
    for (const bool marked : {true, false}) {
      std::string wide = marked ? "\xFF\xFE" : "";
      for (const char c : text) {
        wide += c;
        wide += '\0';
      }
      expect_bad_file("UTF-16", name, wide, Errc::unsupported);
    }
}

// Lines end in CR alone. Right: lines all the same.
TEST(OddText, CrLineEnds) {
  for (auto [name, text] : texts()) {
    const Scene plain = read_file(name, text);
    for (char& c : text)
      if (c == '\n') c = '\r';
    const Scene s = read_file(name, text);
    EXPECT_EQ(s.meshes.at(0).positions, plain.meshes.at(0).positions) << name;
    EXPECT_EQ(s.meshes[0].indices, plain.meshes[0].indices) << name;
  }
}

// ---- MTL

/// The scene of a square that has material m, whose statements these are.
struct Square {
  TempFolder folder;
  Scene operator()(const std::string& statements, const std::string& library = "m.mtl") const {
    folder.write("m.mtl", "newmtl m\n" + statements);
    return io::read_scene(folder.write(
        "a.obj",
        "mtllib " + library +
            "\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 0.5\nf 1/1 2/2 3/3\n"));
  }
};

// `map_Kd -s 2 4 1 -o 0.5 0.25`. Right: uv · scale + offset, as in Blender and three.js.
TEST(OddMtl, ScaleAndOffset) {
  const Square square;
  write_pixel(square.folder.path("p.png"), {255, 255, 255, 255});
  const Scene s = square("map_Kd -s 2 4 1 -o 0.5 0.25 p.png\n");
  EXPECT_TRUE(s.warnings.empty()) << s.warnings[0];
  const MeshView m = s.meshes.at(0).view();
  std::uint32_t vertex[3];
  m.read_triangles(0, 1, vertex);
  // From the bottom; ours count from the top.
  EXPECT_EQ(m.texcoords.at(m.place(0), vertex, 0), (Vec2{0.5F, 0.75F}));
  EXPECT_EQ(m.texcoords.at(m.place(0), vertex, 2), (Vec2{2.5F, 1 - 2.25F}));
}

// `map_Kd -mm base gain`. Right: base + gain · number, cut to 0 to 1.
TEST(OddMtl, BaseAndGain) {
  const Square square;
  write_pixel(square.folder.path("p.png"), {100, 0, 255, 128});
  const Scene s = square("map_Kd -mm 0.2 0.5 p.png\n");
  EXPECT_EQ(s.textures.at(0).image(0, 0), (Rgba8{101, 51, 179, 128}));
  const Scene high = square("map_Kd -mm 0.5 1 p.png\n"), low = square("map_Kd -mm -0.5 1 p.png\n");
  EXPECT_EQ(high.textures.at(0).image(0, 0), (Rgba8{228, 128, 255, 128}));
  EXPECT_EQ(low.textures.at(0).image(0, 0), (Rgba8{0, 0, 128, 128}));
}

// `map_d` of a picture with alpha; `-imfchan`. Right: the picture's alpha, or red where it has
// none, or the channel that -imfchan names.
TEST(OddMtl, AlphaOfMapD) {
  const Square square;
  write_pixel(square.folder.path("p.png"), {255, 10, 20, 77});
  write_pixel(square.folder.path("grey.png"), {55, 55, 55, 255});
  const auto mask = [&](const std::string& statement) {
    const Scene s = square(statement);
    const std::int32_t texture = s.materials.at(0).alpha_texture;
    EXPECT_EQ(s.materials[0].alpha_mode, AlphaMode::mask);
    return texture < 0 ? -1 : int{s.textures.at(static_cast<std::size_t>(texture)).image(0, 0).r};
  };
  EXPECT_EQ(mask("map_d p.png\n"), 77);
  EXPECT_EQ(mask("map_d grey.png\n"), 55);
  EXPECT_EQ(mask("map_d -imfchan g p.png\n"), 10);
  EXPECT_EQ(mask("map_d -imfchan r p.png\n"), 255);
  EXPECT_EQ(mask("map_d -imfchan m p.png\n"), 77);
  // The base colour's own alpha is not counted twice.
  EXPECT_EQ(mask("map_Kd p.png\nmap_d p.png\n"), -1);
}

// `d 0` or `Tr 1` for all materials. Right: a warning says that nothing is seen.
TEST(OddMtl, NothingIsSeen) {
  const Square square;
  EXPECT_TRUE(says(square("Kd 1 0 0\nd 0\n"), "nothing is seen"));
  EXPECT_TRUE(says(square("Kd 1 0 0\nTr 1\n"), "nothing is seen"));
  EXPECT_FALSE(says(square("Kd 1 0 0\nTr 1\nnewmtl other\n"), "nothing is seen"));
}

// C:\..., /home/other/..., other letter case, quotes, backslashes. Right: the file beside the
// OBJ file is read; a warning names it, and files that are not found.
TEST(OddMtl, NamesOfElsewhere) {
  const Square square;
  std::filesystem::create_directory(square.folder.path("Maps"));
  write_pixel(square.folder.path("Skin One.png"), {255, 0, 0, 255});
  write_pixel(square.folder.path("Maps/deep.png"), {0, 255, 0, 255});
  for (const char* name : {"C:\\Users\\me\\Skin One.png", "/home/other/maps/Skin One.png",
                           "skin one.PNG", "\"Skin One.png\"", "../other/skin one.png"}) {
    const Scene s = square(std::string("map_Kd ") + name + "\n");
    ASSERT_EQ(s.textures.size(), 1U) << name;
    EXPECT_EQ(s.textures[0].name, "Skin One.png");
    EXPECT_EQ(s.warnings.size(), name[0] == '"' ? 0U : 1U) << name;
    EXPECT_EQ(says(s, "beside this file"), name[0] != '"') << name;
  }
  EXPECT_EQ(square("map_Kd D:/project/maps/Deep.png\n").textures.size(), 1U);
  EXPECT_TRUE(says(square("map_Kd gone.png\n"), "gone.png"));
  for (const char* library : {"\"m.mtl\"", "M.MTL", "C:\\work\\m.mtl"}) {
    const Scene s = square("Kd 1 0 0\n", library);
    ASSERT_EQ(s.materials.size(), 1U) << library;
    EXPECT_EQ(s.materials[0].base_color, kRed);
  }
}

// `refl`, `bump -bm`. Right: one warning names them.
TEST(OddMtl, KeysThatAreNotDrawn) {
  const Scene s = Square()(
      "Kd 1 1 1\nKa 1 1 1\nKs 0 0 0\nNi 1\nillum 2\nrefl -type sphere s.png\n"
      "bump -bm 2 b.png\nbump c.png\n");
  expect_warning("not drawn: 2 × bump, 1 × refl", s);
}

// ---- positions that float32 does not hold

/// A relief of 0.4 m cells where UTM has Zürich.
struct Relief {
  static constexpr int kSide = 24;
  std::vector<Vec3d> positions;
  std::vector<std::uint32_t> indices;
  Relief() {
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        positions.emplace_back(465123.25 + 0.4 * i, 5247321.5 + 0.4 * j,
                               400 + 0.125 * ((i * 7 + j * 5) % 11));
    for (std::uint32_t j = 0; j + 1 < kSide; ++j)
      for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
        const std::uint32_t v = j * kSide + i;
        for (const std::uint32_t k : {v, v + 1, v + kSide + 1, v, v + kSide + 1, v + kSide})
          indices.push_back(k);
      }
  }
};

std::string text_of(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}
std::string text_of(Vec3d p) {
  return text_of(p.x) + " " + text_of(p.y) + " " + text_of(p.z);
}

Frame draw(const SceneView& scene) {
  Camera camera = fit_camera(scene, 0.6F, false);
  camera.target = {465127.85, 5247326.1, 400};
  camera.eye = {465127.85, 5247322.1, 412};
  camera.near_plane = 0.1F;
  Renderer renderer;
  return test::draw(renderer, scene, camera, {.width = 128, .height = 128, .shader = Shader::flat},
                    kVisible);
}

// A relief at UTM coordinates in PLY, OBJ, OFF, STL, NPY. Right: the bits of the same arrays in
// float64.
TEST(OddFile, Doubles) {
  const Relief r;
  MeshView mesh{.positions = r.positions, .indices = r.indices};
  const InstanceView instance{.geometry = mesh};
  SceneView arrays{.instances = {&instance, 1}};
  const Frame right = draw(arrays);

  std::string ply =
      "ply\nformat FORMAT 1.0\nelement vertex 576\nproperty double x\n"
      "property double y\nproperty double z\nelement face 1058\n"
      "property list uchar int vertex_indices\nend_header\n";
  std::string ascii = ply, binary = ply, obj, off = "OFF\n576 1058 0\n", stl = "solid\n", faces;
  ascii.replace(ascii.find("FORMAT"), 6, "ascii");
  binary.replace(binary.find("FORMAT"), 6, "binary_little_endian");
  std::string npy = "\x93NUMPY\x01";
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1058, 3, 3), }";
  header.resize(117, ' ');
  npy += std::string("\0\x76\0", 3) + header + "\n";
  for (const Vec3d& p : r.positions) {
    ascii += text_of(p) + "\n";
    binary += raw(p.x) + raw(p.y) + raw(p.z);
    obj += "v " + text_of(p) + "\n";
    off += text_of(p) + "\n";
  }
  for (std::size_t t = 0; t < r.indices.size(); t += 3) {
    std::string face = "3";
    obj += "f";
    stl += "facet normal 0 0 1\nouter loop\n";
    binary += '\x03';
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = r.indices[t + c];
      const Vec3d p = r.positions[v];
      face += " " + std::to_string(v);
      obj += " " + std::to_string(v + 1);
      stl += "vertex " + text_of(p) + "\n";
      binary += raw(v);
      npy += raw(p.x) + raw(p.y) + raw(p.z);
    }
    ascii += face + "\n";
    off += face + "\n";
    obj += "\n";
    stl += "endloop\nendfacet\n";
  }
  for (const auto& [name, bytes] : {std::pair<std::string, std::string>("a.ply", ascii),
                                    {"b.ply", binary},
                                    {"a.obj", obj},
                                    {"a.off", off},
                                    {"a.stl", stl + "endsolid\n"},
                                    {"a.npy", npy}}) {
    const Scene scene = read_file(name, bytes);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    EXPECT_TRUE(same_images(draw(SceneBinding(scene).view()), right)) << name;
  }
}

// Doubles of a model about as far from 0 as it is large, and text. Right: float32, as always.
TEST(OddFile, NearDoubles) {
  const Scene obj = read_file("a.obj", "v 10.1 0.3 0\nv 11.1 0 0\nv 10 1.7 0\nf 1 2 3\n");
  EXPECT_FALSE(obj.meshes[0].view().positions.is_wide());
  EXPECT_EQ(obj.meshes[0].positions[0].x, 10.1F);
  const Scene ply = read_file("a.ply", ply_square("", {}, "", {}, "", "double"));
  EXPECT_FALSE(ply.meshes[0].view().positions.is_wide());
}

// An OFF file has a face of two corners. Right: the face is left out with one warning, the
// others are drawn.
TEST(OddOff, FaceOfTwoCorners) {
  const Scene scene = read_file("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n");
  EXPECT_EQ(scene.triangle_count(), 1U);
  EXPECT_EQ(scene.warnings.size(), 1U);
}

}  // namespace

}  // namespace rastrum::test::file_troubles
