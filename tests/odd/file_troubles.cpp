// Mesh files that are valid but rare.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

#include "tests/io/files.hpp"
#include "tests/odd/trouble.hpp"

namespace rastrum::odd {
namespace {

using test::raw;
using test::TempFolder;

Scene read(const std::string& name, const std::string& bytes) {
  const TempFolder folder;
  return io::read_scene(folder.write(name, bytes));
}

/// The colour of triangle t of the scene's first mesh, at its first corner.
Vec4 color(const Scene& scene, std::size_t t) {
  const MeshView m = scene.meshes.at(0).view();
  const TrianglePlace place = m.place(t);
  std::uint32_t vertex[3];
  m.read_triangles(t, 1, vertex);
  return m.colors.empty() ? Vec4{} : m.colors.at(place, vertex, 0);
}

void expect_color(const Scene& scene, std::size_t t, Vec4 c) {
  const Vec4 is = color(scene, t);
  EXPECT_NEAR(is.x, c.x, 1e-6F) << t;
  EXPECT_NEAR(is.y, c.y, 1e-6F) << t;
  EXPECT_NEAR(is.z, c.z, 1e-6F) << t;
  EXPECT_NEAR(is.w, c.w, 1e-6F) << t;
}

/// Whether one of the warnings has this in it.
bool says(const Scene& scene, std::string_view what) {
  for (const std::string& w : scene.warnings)
    if (w.find(what) != std::string::npos) return true;
  return false;
}

void write_picture(const std::filesystem::path& file, Rgba8 pixel) {
  Image<Rgba8> image(1, 1);
  image(0, 0) = pixel;
  io::write_png(file, std::as_const(image).view());
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

void colours_of_faces() {
  const Scene s = read("a.ply", ply_square("", {}, rgb("uchar") + "property int part\n",
                                           {"255 0 0 7", "0 255 0 8"}));
  expect_color(s, 0, kRed);
  expect_color(s, 1, kGreen);
  ASSERT_EQ(s.meshes[0].scalars.size(), 1U);
  EXPECT_EQ(s.meshes[0].scalars[0].name, "part");
  EXPECT_TRUE(s.warnings.empty()) << s.warnings[0];
  const Scene both = read("a.ply", ply_square(rgb("uchar"), std::vector<std::string>(4, "0 0 255"),
                                              rgb("uchar"), {"255 0 0", "0 255 0"}));
  expect_color(both, 0, kBlue);
  EXPECT_TRUE(says(both, "colours of faces are left out"));
}

void picture_of_vertices() {
  const TempFolder folder;
  write_picture(folder.path("My Skin.png"), {255, 0, 0, 255});
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

void pictures_of_faces() {
  const TempFolder folder;
  write_picture(folder.path("a.png"), {255, 0, 0, 255});
  write_picture(folder.path("b.png"), {0, 255, 0, 255});
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

void colours_of_wide_numbers() {
  for (const char* type : {"int", "uint", "short", "ushort", "float", "double"}) {
    const Scene s =
        read("a.ply", ply_square(rgb(type), {"255 0 0", "0 0 0", "0 0 0", "0 51 0"}, "", {}));
    expect_color(s, 0, kRed);
    EXPECT_FLOAT_EQ(s.meshes[0].colors.values.at(3).y, 0.2F) << type;
    EXPECT_TRUE(says(s, "go up to 255: taken as parts of 255")) << type;
  }
  // Units that the type determines stay.
  const Scene wide =
      read("a.ply", ply_square(rgb("ushort"), {"65535 0 0", "0 0 0", "0 0 0", "0 0 0"}, "", {}));
  expect_color(wide, 0, kRed);
  EXPECT_TRUE(wide.warnings.empty());
  const Scene ones =
      read("a.ply", ply_square(rgb("float"), {"1 0.5 0", "0 0 0", "0 0 0", "0 0 0"}, "", {}));
  expect_color(ones, 0, {1, 0.5F, 0, 1});
  EXPECT_TRUE(ones.warnings.empty());
}

void edges() {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement edge 2\nproperty int vertex1\nproperty int vertex2\n";
  const Scene s = read("a.ply", head + "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1\n1 2\n");
  ASSERT_EQ(s.geometries.size(), 1U);
  const auto* lines = std::get_if<Lines>(&s.geometries[0]);
  ASSERT_NE(lines, nullptr);
  EXPECT_EQ(lines->view().size(), 2U);
  EXPECT_EQ(lines->indices, (std::vector<std::uint32_t>{0, 1, 1, 2}));
  EXPECT_TRUE(s.warnings.empty());
  const Scene colored = read(
      "a.ply", head + rgb("uchar") + "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 255 0 0\n1 2 0 255 0\n");
  EXPECT_EQ(std::get<Lines>(colored.geometries.at(0)).colors,
            (std::vector<Vec4>{kRed, kRed, kGreen, kGreen}));
  const Scene faces = read("a.ply", head +
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

void colours_of_viscam() {
  const Scene s = read("a.stl", binary_stl("made", {0xFC00, 0x83E0, 0x7FFF}));
  expect_color(s, 0, kRed);
  expect_color(s, 1, kGreen);
  expect_color(s, 2, {0.8F, 0.7F, 0.6F, 1});  // bit 15 is not set: the plain colour
  EXPECT_TRUE(read("a.stl", binary_stl("made", {0x7C00, 0})).meshes[0].colors.empty());
}

void colours_of_magics() {
  const std::string header = std::string("COLOR=") + "\x00\x00\xFF\xFF"[0] + '\0' + "\xFF\xFF";
  const Scene s = read("a.stl", binary_stl(header, {0x001F, 0x03E0, 0x8000}));
  expect_color(s, 0, kRed);  // red is in the lowest bits there
  expect_color(s, 1, kGreen);
  expect_color(s, 2, kBlue);  // bit 15: the colour of the whole
  expect_color(read("a.stl", binary_stl(header, {0, 0})), 1, kBlue);
}

std::string facet(int x, const std::string& before = "", const std::string& after = "") {
  const std::string a = std::to_string(x), b = std::to_string(x + 1);
  return "facet normal 0 0 1\n" + before + "outer loop\nvertex " + a + " 0 0\nvertex " + b +
         " 0 0\nvertex " + a + " 1 0\nendloop\n" + after + "endfacet\n";
}

void text_stl() {
  const std::string solid = "solid a part\n" + facet(0) + facet(1) + "endsolid a part\n";
  std::string cr = solid, one_line = solid;
  for (char& c : cr)
    if (c == '\n') c = '\r';
  for (char& c : one_line)
    if (c == '\n') c = ' ';
  for (const std::string& text :
       {"\n; made by hand\n" + solid, cr, one_line, one_line + one_line}) {
    const Scene s = read("a.stl", text);
    EXPECT_EQ(s.triangle_count(), text.size() > 2 * one_line.size() - 4 ? 4U : 2U) << text;
  }
  EXPECT_TRUE(says(read("a.stl", "made by hand\n" + solid), "1 lines before 'solid'"));
}

void color_lines_of_stl() {
  const Scene s =
      read("a.stl", "solid\n" + facet(0) + "color 1 0 0\n" + facet(1) +
                        facet(2, "", "color 0 1 0\n") + facet(3, "color 0 0 1\n") + "endsolid\n");
  expect_color(s, 0, {0.8F, 0.7F, 0.6F, 1});
  expect_color(s, 1, kRed);
  expect_color(s, 2, kGreen);
  expect_color(s, 3, kBlue);
}

// ---- OFF

std::string off_square(const std::string& first, const std::string& second) {
  return "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 " + first + "\n3 0 2 3 " + second + "\n";
}

void colours_of_off_faces() {
  for (const auto& [first, second] : {std::pair("255 0 0", "0 255 0"),
                                      {"255 0 0 255", "0 255 0 255"},
                                      {"1.0 0 0", "0 1 0"},
                                      {"1 0 0 1", "0 1 0 1.0"}}) {
    const Scene s = read("a.off", off_square(first, second));
    expect_color(s, 0, kRed);
    expect_color(s, 1, kGreen);
  }
  const Scene numbered = read("a.off", off_square("0", "1"));
  const ColorMap map = color_map("tab20");
  expect_color(numbered, 0, map.colors[0]);
  expect_color(numbered, 1, map.colors[1]);
  EXPECT_TRUE(says(numbered, "indices into a list that the file does not have"));
  const Scene some = read("a.off", off_square("255 0 0", ""));
  expect_color(some, 0, kRed);
  expect_color(some, 1, {0.8F, 0.7F, 0.6F, 1});
}

void coff_decides_once() {
  // "1 0 0 1" is red as its neighbours are.
  const Scene s =
      read("a.off", "COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 0.5 0.25 0 1\n0 1 0 0 1 0 1\n3 0 1 2\n");
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

void byte_order_mark() {
  for (const auto& [name, text] : texts()) {
    const Scene plain = read(name, text), marked = read(name, "\xEF\xBB\xBF" + text);
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

void utf16() {
  for (const auto& [name, text] : texts())
    for (const bool marked : {true, false}) {
      std::string wide = marked ? "\xFF\xFE" : "";
      for (const char c : text) {
        wide += c;
        wide += '\0';
      }
      try {
        read(name, wide);
        ADD_FAILURE() << name;
      } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("UTF-16"), std::string::npos) << e.what();
      }
    }
}

void cr_line_ends() {
  for (auto [name, text] : texts()) {
    const Scene plain = read(name, text);
    for (char& c : text)
      if (c == '\n') c = '\r';
    const Scene s = read(name, text);
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

void scale_and_offset() {
  const Square square;
  write_picture(square.folder.path("p.png"), {255, 255, 255, 255});
  const Scene s = square("map_Kd -s 2 4 1 -o 0.5 0.25 p.png\n");
  EXPECT_TRUE(s.warnings.empty()) << s.warnings[0];
  const MeshView m = s.meshes.at(0).view();
  std::uint32_t vertex[3];
  m.read_triangles(0, 1, vertex);
  // uv · scale + offset, from the bottom; ours count from the top.
  EXPECT_EQ(m.texcoords.at(m.place(0), vertex, 0), (Vec2{0.5F, 0.75F}));
  EXPECT_EQ(m.texcoords.at(m.place(0), vertex, 2), (Vec2{2.5F, 1 - 2.25F}));
}

void base_and_gain() {
  const Square square;
  write_picture(square.folder.path("p.png"), {100, 0, 255, 128});
  const Scene s = square("map_Kd -mm 0.2 0.5 p.png\n");
  EXPECT_EQ(s.textures.at(0).image(0, 0), (Rgba8{101, 51, 179, 128}));
}

void alpha_of_map_d() {
  const Square square;
  write_picture(square.folder.path("p.png"), {255, 10, 20, 77});
  write_picture(square.folder.path("grey.png"), {55, 55, 55, 255});
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

void nothing_is_seen() {
  const Square square;
  EXPECT_TRUE(says(square("Kd 1 0 0\nd 0\n"), "nothing is seen"));
  EXPECT_TRUE(says(square("Kd 1 0 0\nTr 1\n"), "nothing is seen"));
  EXPECT_FALSE(says(square("Kd 1 0 0\nTr 1\nnewmtl other\n"), "nothing is seen"));
}

void names_of_elsewhere() {
  const Square square;
  std::filesystem::create_directory(square.folder.path("Maps"));
  write_picture(square.folder.path("Skin One.png"), {255, 0, 0, 255});
  write_picture(square.folder.path("Maps/deep.png"), {0, 255, 0, 255});
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

void keys_that_are_not_drawn() {
  const Scene s = Square()(
      "Kd 1 1 1\nKa 1 1 1\nKs 0 0 0\nNi 1\nillum 2\nrefl -type sphere s.png\n"
      "bump -bm 2 b.png\nbump c.png\n");
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_TRUE(says(s, "not drawn: 2 × bump, 1 × refl")) << s.warnings[0];
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

struct Picture {
  Image<std::int64_t> ids{128, 128};
  Image<float> depth{128, 128};
};
Picture draw(const SceneView& scene) {
  Camera camera = fit_camera(scene, 0.6F, false);
  camera.target = {465127.85, 5247326.1, 400};
  camera.eye = {465127.85, 5247322.1, 412};
  camera.near_plane = 0.1F;
  FrameOptions frame{.width = 128, .height = 128, .shader = Shader::flat};
  Picture p;
  Targets targets{.depth = p.depth, .ids = p.ids};
  Renderer().render(scene, camera, frame, targets);
  return p;
}

void doubles_of_files() {
  const Relief r;
  MeshView mesh{.positions = r.positions, .indices = r.indices};
  const InstanceView instance{.geometry = mesh};
  SceneView arrays{.instances = {&instance, 1}};
  const Picture right = draw(arrays);

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
    const Scene scene = read(name, bytes);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    const Picture is = draw(SceneBinding(scene).view());
    EXPECT_EQ(digest(is.ids), digest(right.ids)) << name;
    EXPECT_EQ(digest(is.depth), digest(right.depth)) << name;
  }
}

void doubles_that_float32_holds_well() {
  // Float32 for a model about as far from 0 as it is large, in text and in doubles.
  const Scene obj = read("a.obj", "v 10.1 0.3 0\nv 11.1 0 0\nv 10 1.7 0\nf 1 2 3\n");
  EXPECT_FALSE(obj.meshes[0].view().positions.is_wide());
  EXPECT_EQ(obj.meshes[0].positions[0].x, 10.1F);
  const Scene ply = read("a.ply", ply_square("", {}, "", {}, "", "double"));
  EXPECT_FALSE(ply.meshes[0].view().positions.is_wide());
}

void face_of_two_corners() {
  const Scene scene = read("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n");
  EXPECT_EQ(scene.triangle_count(), 1U);
  EXPECT_EQ(scene.warnings.size(), 1U);
}

}  // namespace

std::vector<Trouble> file_troubles() {
  return {
      {"Off_FaceOfTwoCorners", "an OFF file has a face of two corners",
       "the face is left out with one warning, the others are drawn", face_of_two_corners},
      {"Ply_ColoursOfFaces", "the element face has red, green and blue",
       "each face has its colour; if vertices have colours, too, theirs are drawn, with a warning",
       colours_of_faces},
      {"Ply_PictureOfVertices", "MeshLab's `comment TextureFile`, texture_u and texture_v",
       "the picture is drawn, v counts from the bottom", picture_of_vertices},
      {"Ply_PicturesOfFaces", "lists texcoord of faces, texnumber, two TextureFile",
       "each corner has its own coordinate, each face its picture", pictures_of_faces},
      {"Ply_ColoursOfWideNumbers", "colours of int, uint, short, ushort, float or double up to 255",
       "255 is full intensity, with a warning; the type decides if the largest of the file is "
       "above "
       "255 or below 2",
       colours_of_wide_numbers},
      {"Ply_Edges", "an element edge with vertex1 and vertex2",
       "lines where there are no faces, else a warning", edges},
      {"Stl_ColoursOfViscam", "attributes of binary STL with bit 15, as VisCAM and SolidView write",
       "five bits a channel, red highest; facets without the bit are plain", colours_of_viscam},
      {"Stl_ColoursOfMagics", "a header with COLOR=, as Magics writes",
       "five bits a channel, red lowest; bit 15 is the colour of the whole", colours_of_magics},
      {"Stl_OddText", "a line before solid, lines that end in CR, all on one line",
       "all facets are read", text_stl},
      {"Stl_ColorLines", "`color r g b` in text, in a facet or before some",
       "the colour of that facet, or of those that follow", color_lines_of_stl},
      {"Off_ColoursOfFaces", "3 or 4 integers, floats, or one number behind the corners",
       "the face's colour; one number is an index into tab20, with a warning",
       colours_of_off_faces},
      {"Off_CoffDecidesOnce", "COFF with 1 0 0 beside 0.5 0.25 0",
       "one decimal point makes all of the file floats", coff_decides_once},
      {"Text_ByteOrderMark", "a text begins with the mark of UTF-8",
       "it is skipped: OBJ, MTL, PLY, OFF, STL", byte_order_mark},
      {"Text_Utf16", "a text is UTF-16", "an error that says so", utf16},
      {"Text_CrLineEnds", "lines end in CR alone", "lines all the same", cr_line_ends},
      {"Mtl_ScaleAndOffset", "map_Kd -s 2 4 1 -o 0.5 0.25",
       "uv · scale + offset, as in Blender and three.js", scale_and_offset},
      {"Mtl_BaseAndGain", "map_Kd -mm base gain", "base + gain · number, cut to 0 to 1",
       base_and_gain},
      {"Mtl_AlphaOfMapD", "map_d of a picture with alpha; -imfchan",
       "the picture's alpha, or red where it has none, or the channel that -imfchan names",
       alpha_of_map_d},
      {"Mtl_NothingIsSeen", "d 0 or Tr 1 for all materials", "a warning says that nothing is seen",
       nothing_is_seen},
      {"Mtl_NamesOfElsewhere", "C:\\..., /home/other/..., other letter case, quotes, backslashes",
       "the file beside the OBJ file is read; a warning names it, and files that are not found",
       names_of_elsewhere},
      {"Mtl_KeysThatAreNotDrawn", "refl, bump -bm", "one warning names them",
       keys_that_are_not_drawn},
      {"File_Doubles", "a relief at UTM coordinates in PLY, OBJ, OFF, STL, NPY",
       "the bits of the same arrays in float64", doubles_of_files},
      {"File_NearDoubles", "doubles that lie near 0", "float32, as always",
       doubles_that_float32_holds_well},
  };
}

}  // namespace rastrum::odd
