// SPDX-License-Identifier: BSD-3-Clause
// Files that name others, small files that would become large, and height maps.
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/terrain.hpp>

#include "tests/io/gltf_document.hpp"
#include "tests/io/scene_files.hpp"

namespace rastrum::test::document_troubles {
namespace {

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A document with these members.
Scene read_gltf(const std::string& members) {
  return read_file("a.gltf", R"({"asset":{"version":"2.0"},)" + members + "}");
}

/// Reads an OBJ file in `folder`: a triangle behind these lines.
Scene read_obj(const TempFolder& folder, const std::string& lines, const char* name = "a.obj",
               const io::ReadOptions& options = {}) {
  return io::read_scene(folder.write(name, lines + kTriangle), options);
}

// A word of ten megabytes where a number is expected. Right: a message that names the file and
// quotes the word's begin and end.
TEST(OddMessage, LinesOfTenMegabytes) {
  constexpr std::size_t kLong = 10'000'000, kMost = 2100;
  const std::string word(kLong, 'w');
  for (const auto& [text, format] : {std::pair{"v " + word + " 0 0\n", "obj"},
                                     {"ply\nformat ascii 1.0\nelement " + word + "\n", "ply"},
                                     {"OFF\n" + word + " 1 1\n", "off"},
                                     {R"({"asset":{"version":")" + word + "\"}}", "gltf"},
                                     {"{" + word, "gltf"},
                                     {R"({"asset":")" + word, "gltf"},
                                     {"solid x\nfacet " + word + "\n", "stl"}}) {
    const std::string said = refusal_of(
        [&text = text, &format = format] {
          (void)io::decode_scene(std::as_bytes(std::span(text)), format, "input");
        },
        Errc::bad_format);
    EXPECT_TRUE(said.starts_with("input")) << format;
    EXPECT_LE(said.size(), kMost) << format;
  }
}

std::string repeated(const std::string& text, int n) {
  std::string all = text;
  for (int i = 1; i < n; ++i) all += "," + text;
  return all;
}

// 1 kB of glTF has eight primitives on one accessor of 16 million elements without bytes.
// Right: an error, before it takes more than 64 bytes for each byte of the file and 1 GiB.
TEST(OddGltf, PrimitivesOnOneAccessorWithoutBytes) {
  // Whole triangles, so that nothing but positions is made of them.
  const auto read = [] {
    (void)read_gltf(R"("accessors":[{"componentType":5126,"count":16000002,"type":"VEC3"}],)"
                    R"("meshes":[{"primitives":[)" +
                    repeated(R"({"attributes":{"POSITION":0}})", 8) +
                    R"(]}],"nodes":[{"mesh":0}])");
  };
  const std::string what = refusal_of(read, Errc::out_of_memory);
  EXPECT_TRUE(holds(what, "a.gltf: ") && holds(what, "64 times") && holds(what, "--memory-limit"))
      << what;
}

std::string properties(const std::string& type, int count) {
  std::string s;
  for (int i = 0; i < count; ++i) s += "property " + type + " n" + std::to_string(i) + "\n";
  return s;
}

// Each of the many triangles, or edges, of a small PLY file has the same hundreds of numbers.
// Right: an error, before more is taken than 64 bytes for each of the file and the limit.
TEST(OddPly, NumbersTimesFaces) {
  constexpr int kNumbers = 200, kCorners = 20'000;
  const std::string vertices =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\n"
      "property uchar y\nproperty uchar z\n";
  const std::string strip = "element tristrips 1\nproperty list uint uchar vertex_indices\n";
  const std::string corners = raw(std::uint32_t{kCorners}) + std::string(kCorners, '\0');
  for (const std::string& file :
       {// numbers of a strip, which each of its triangles has
        vertices + strip + properties("uchar", kNumbers) + "end_header\n" + std::string(3, '\0') +
            corners + std::string(kNumbers, '\1'),
        // of faces behind it, which its triangles have not
        vertices + strip + "element face 0\nproperty list uchar uchar vertex_indices\n" +
            properties("uchar", kNumbers) + "end_header\n" + std::string(3, '\0') + corners,
        // of a vertex, which each edge with a colour has
        vertices + properties("uchar", kNumbers) + "element edge 10000\n" +
            "property uchar vertex1\nproperty uchar vertex2\nproperty uchar red\n" +
            "property uchar green\nproperty uchar blue\nend_header\n" +
            std::string(3 + kNumbers + 5 * 10'000, '\0')}) {
    const std::string what = refusal_of(
        [&] { (void)read_file("a.ply", file, {.memory_limit = 1 << 20}); }, Errc::out_of_memory);
    EXPECT_TRUE(holds(what, "a.ply: ") && holds(what, "1 MiB on top")) << what;
  }
}

// Thirty images of a glTF file are one and the same buffer view. Right: it is decoded once: one
// texture, which thirty materials share.
TEST(OddGltf, ImagesOnOneView) {
  const TempFolder folder;
  io::write_png(folder.path("p.png"), Image<Rgba8>(16, 16).view());
  const std::string png = slurp(folder.path("p.png"));
  const std::string positions = raw(0.F) + raw(0.F) + raw(0.F) + raw(1.F) + raw(0.F) + raw(0.F) +
                                raw(0.F) + raw(1.F) + raw(0.F);
  std::string textures, materials, primitives;
  for (int i = 0; i < 30; ++i) {
    const std::string n = std::to_string(i), comma = i == 0 ? "" : ",";
    textures += comma + R"({"source":)" + n + "}";
    materials += comma + R"({"emissiveTexture":{"index":)" + n + "}}";
    primitives += comma + R"({"attributes":{"POSITION":0},"material":)" + n + "}";
  }
  const Scene scene = read_gltf(
      R"("buffers":[{"byteLength":)" + std::to_string(36 + png.size()) +
      R"(,"uri":"data:;base64,)" + base64(positions + png) +
      R"("}],"bufferViews":[{"buffer":0,"byteLength":36},)" +
      R"({"buffer":0,"byteOffset":36,"byteLength":)" + std::to_string(png.size()) +
      R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)" +
      R"("images":[)" + repeated(R"({"bufferView":1,"mimeType":"image/png"})", 30) +
      R"(],"textures":[)" + textures + R"(],"materials":[)" + materials +
      R"(],"meshes":[{"primitives":[)" + primitives + R"(]}],"nodes":[{"mesh":0}])");
  EXPECT_EQ(scene.textures.size(), 1U);
  EXPECT_EQ(scene.materials.at(29).emissive_texture, 0);
}

// An OBJ file's mtllib is a pipe to which nobody writes. Right: a warning, at once: only
// regular files are read.
TEST(OddObj, LibraryIsAPipe) {
  const TempFolder folder;
  ASSERT_EQ(::mkfifo(folder.path("m.mtl").c_str(), 0600), 0);
  const Scene scene = read_obj(folder, "mtllib m.mtl\n");
  EXPECT_EQ(scene.triangle_count(), 1U);
  expect_warning("is no regular file", scene);
}

// A material's picture is a pipe to which nobody writes. Right: a warning, at once.
TEST(OddObj, TextureIsAPipe) {
  const TempFolder folder;
  ASSERT_EQ(::mkfifo(folder.path("p.png").c_str(), 0600), 0);
  folder.write("m.mtl", "newmtl a\nmap_Kd p.png\n");
  expect_warning("is no regular file", read_obj(folder, "mtllib m.mtl\nusemtl a\n"));
}

// A glTF buffer's uri is /dev/null. Right: an error that says that it is no regular file.
TEST(OddGltf, BufferIsADevice) {
  expect_refused("/dev/null: is no regular file", Errc::io, [] {
    (void)read_gltf(
        R"("buffers":[{"byteLength":36,"uri":"/dev/null"}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
        R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}])");
  });
}

// An OBJ file's mtllib is a text file of another folder. Right: a warning that names the line
// and quotes nothing of it.
TEST(OddObj, LibraryOfAnotherFolder) {
  const TempFolder folder;
  folder.write("secret.txt", "newmtl a\nKd hunter2\n");
  std::filesystem::create_directory(folder.path("in"));
  const Scene scene = read_obj(folder, "mtllib ../secret.txt\n", "in/a.obj");
  expect_warning("secret.txt:2: ", scene);
  EXPECT_FALSE(holds(io::describe(scene), "hunter2"));
}

// An OBJ file's mtllib leads out of its folder, by name or by a link, and that is not allowed.
// Right: a warning names the file, which is not read; files inside the folder are.
TEST(OddObj, NamesLeadOutOfItsFolder) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path("in"));
  folder.write("m.mtl", "newmtl a\nKd 1 0 0\n");
  folder.write("in/n.mtl", "newmtl b\nKd 1 0 0\n");
  const std::string lines = "mtllib ../m.mtl\nmtllib n.mtl\nusemtl b\n";
  EXPECT_TRUE(read_obj(folder, lines, "in/a.obj").warnings.empty());
  expect_warning("m.mtl: lies outside of the folder",
                 read_obj(folder, lines, "in/a.obj", {.allow_outside = false}));
  std::filesystem::create_symlink(folder.path("m.mtl"), folder.path("in/link.mtl"));
  expect_warning("link.mtl",
                 read_obj(folder, "mtllib link.mtl\n", "in/b.obj", {.allow_outside = false}));
}

// A PNG of one colour is read as light. Right: an error, before its pixels, or their light, take
// more than the limit.
TEST(OddPng, IsSmallAndItsLightIsLarge) {
  const TempFolder folder;
  const auto file = folder.path("p.png");
  io::write_png(file, Image<Rgba8>(500, 400).view());
  // 0.8 MB of pixels, 2.4 MB of light.
  expect_refused("p.png: ", Errc::out_of_memory,
                 [&] { (void)io::read_image(file, {.memory_limit = 1 << 16}); });
  EXPECT_EQ(io::read_image(file, {.memory_limit = 1 << 20}).width(), 500);
  const std::string what = refusal_of(
      [&] { (void)io::read_light(file, {.memory_limit = 1 << 20}); }, Errc::out_of_memory);
  EXPECT_TRUE(holds(what, "p.png: ") && holds(what, "1 MiB on top")) << what;
  EXPECT_EQ(io::read_light(file).width(), 500);
}

// Another program cuts the file off while it is read. Right: the whole scene or an error that
// names the file, never SIGBUS.
TEST(OddObj, ShrinksWhileItIsRead) {
  const TempFolder folder;
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += kTriangle;
  for (int ms = 1; ms < 100; ms *= 3) {
    const auto file = folder.write("a.obj", text);
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(ms));
      // To whole triangles: where reading begins late, that is a sound file.
      std::filesystem::resize_file(file, 3 * std::strlen(kTriangle));
    });
    try {
      (void)io::read_scene(file);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::io);
      EXPECT_TRUE(holds(e.what(), "a.obj: has become shorter while it was read")) << e.what();
    }
    other.join();
  }
}

/// A triangle with these other attributes and members.
std::string triangle(GltfDocument& document, const std::string& attributes,
                     const std::string& primitive, const std::string& rest) {
  const std::size_t positions = document.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  return document.text(R"("meshes":[{"primitives":[{"attributes":{"POSITION":)" +
                       std::to_string(positions) + attributes + "}" + primitive + "}]}]," + rest);
}

Scene read_text(const std::string& text) {
  return read_file("a.gltf", text);
}

std::string picture(const TempFolder& folder, Rgba8 color) {
  write_pixel(folder.path("p.png"), color);
  return R"({"uri":"data:image/png;base64,)" + base64(slurp(folder.path("p.png"))) + R"("})";
}

// A material's occlusion has a set of texture coordinates of its own. Right: left out, and a
// warning names it; never drawn with the other's coordinates.
TEST(OddGltf, TexturesOfTwoSets) {
  const TempFolder folder;
  GltfDocument document;
  const std::string sets =
      R"(,"TEXCOORD_0":)" + std::to_string(document.floats({0, 0, 1, 0, 0, 1}, "VEC2")) +
      R"(,"TEXCOORD_1":)" + std::to_string(document.floats({0.5F, 0, 0.5F, 0, 0, 1}, "VEC2"));
  const Scene scene = read_text(triangle(
      document, sets, R"(,"material":0)",
      R"("images":[)" + picture(folder, {9, 9, 9, 255}) +
          R"(],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":)" +
          R"({"baseColorTexture":{"index":0}},"occlusionTexture":{"index":0,"texCoord":1}}],)" +
          R"("nodes":[{"mesh":0}])"));
  EXPECT_EQ(scene.materials.at(0).base_color_texture, 0);
  EXPECT_EQ(scene.materials.at(0).occlusion_texture, kNoTexture);
  EXPECT_EQ(scene.meshes.at(0).texcoords.values.at(1), (Vec2{1, 0}));
  expect_warning("materials[0].occlusionTexture", scene);
}

// COLOR_0 has an alpha below 1, and there is no material. Right: glTF's own material is opaque:
// alpha is 1.
TEST(OddGltf, ColorsWithoutMaterial) {
  GltfDocument document;
  const std::string colors =
      R"(,"COLOR_0":)" +
      std::to_string(document.floats({1, 0, 0, 0.5F, 1, 0, 0, 0, 1, 0, 0, 1}, "VEC4"));
  const Scene scene = read_text(triangle(document, colors, "", R"("nodes":[{"mesh":0}])"));
  for (const Vec4& c : scene.meshes.at(0).colors.values) EXPECT_EQ(c, (Vec4{1, 0, 0, 1}));
}

// A node has EXT_mesh_gpu_instancing. Right: one instance for each entry: node · translation ·
// rotation · scale.
TEST(OddGltf, InstancesOfTheGpu) {
  GltfDocument document;
  const std::string t = std::to_string(document.floats({1, 2, 3, 4, 5, 6}, "VEC3"));
  const std::string s = std::to_string(document.floats({2, 2, 2, 1, 1, 1}, "VEC3"));
  const std::string r = std::to_string(document.floats({0, 0, 0, 1, 0, 0, 1, 0}, "VEC4"));
  const Scene scene = read_text(triangle(
      document, "", "",
      R"("extensionsRequired":["EXT_mesh_gpu_instancing"],"nodes":[{"mesh":0,"translation":)"
      R"([10,0,0],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" +
          t + R"(,"SCALE":)" + s + R"(,"ROTATION":)" + r + "}}}}]"));
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.meshes.size(), 1U);
  ASSERT_EQ(scene.instances.size(), 2U);
  const auto corner = [&](std::size_t i) {  // where (1, 0, 0) is
    const Mat4d& m = scene.instances[i].object_to_world;
    return Vec3d{m.m[0][0] + m.m[0][3], m.m[1][0] + m.m[1][3], m.m[2][0] + m.m[2][3]};
  };
  EXPECT_EQ(corner(0), (Vec3d{13, 2, 3}));
  EXPECT_NEAR(corner(1).x, 13, 1e-12);  // half a turn about z
  EXPECT_NEAR(corner(1).y, 5, 1e-12);
}

// Materials are of KHR_materials_pbrSpecularGlossiness. Right: the metallic-roughness material
// that reflects the same, pixel by pixel where there are pictures.
TEST(OddGltf, SpecularGlossiness) {
  const auto read = [](const std::string& images, const std::string& extension) {
    GltfDocument document;
    return read_text(triangle(
        document, "", R"(,"material":0)",
        images + R"("materials":[{"extensions":{"KHR_materials_pbrSpecularGlossiness":{)" +
            extension + R"(}}}],"extensionsUsed":["KHR_materials_pbrSpecularGlossiness"],)" +
            R"("nodes":[{"mesh":0}])"));
  };
  const Scene plastic =
      read("", R"("diffuseFactor":[0.5,0,0,1],"specularFactor":[0,0,0],"glossinessFactor":0.25)");
  const Material& p = plastic.materials.at(0);
  EXPECT_TRUE(plastic.warnings.empty());
  EXPECT_NEAR(p.base_color.x, 0.5 / 0.96, 1e-6);
  EXPECT_EQ(p.metallic, 0);
  EXPECT_EQ(p.roughness, 0.75F);
  const Material gold =
      read("", R"("diffuseFactor":[0,0,0,1],"specularFactor":[1,0.8,0.2])").materials.at(0);
  EXPECT_NEAR(gold.metallic, 1, 1e-5);
  EXPECT_NEAR(gold.base_color.y, 0.8, 1e-5);
  EXPECT_EQ(gold.roughness, 0);

  const TempFolder folder;
  const Scene textured = read(
      R"("images":[)" + picture(folder, {0, 0, 0, 200}) + "," +
          picture(folder, {255, 231, 124, 128}) + R"(],"textures":[{"source":0},{"source":1}],)",
      R"("diffuseTexture":{"index":0},"specularGlossinessTexture":{"index":1})");
  const Material& t = textured.materials.at(0);
  ASSERT_TRUE(t.base_color_texture >= 0 && t.metallic_roughness_texture >= 0);
  const auto texel = [&](std::int32_t i) {
    return textured.textures.at(static_cast<std::size_t>(i)).image(0, 0);
  };
  EXPECT_EQ(texel(t.base_color_texture), (Rgba8{255, 231, 124, 200}));
  EXPECT_EQ(texel(t.metallic_roughness_texture), (Rgba8{255, 127, 255, 255}));
  EXPECT_TRUE(t.metallic == 1 && t.roughness == 1 && t.base_color == (Vec4{1, 1, 1, 1}));
  // 0x80 is 0.2159 of light; 1 / 0.96 of that is 130.
  const Scene grey = read(
      R"("images":[)" + picture(folder, {128, 128, 128, 255}) + R"(],"textures":[{"source":0}],)",
      R"("diffuseTexture":{"index":0},"specularFactor":[0,0,0])");
  const std::int32_t base = grey.materials.at(0).base_color_texture;
  EXPECT_EQ(grey.textures.at(static_cast<std::size_t>(base)).image(0, 0),
            (Rgba8{130, 130, 130, 255}));
}

// Textures are of EXT_texture_webp and KHR_texture_basisu. Right: the first is read; the second
// is left out, and a warning names it.
TEST(OddGltf, WebpAndBasisu) {
  const auto read = [](const std::string& texture) {
    GltfDocument document;
    return read_text(triangle(
        document, "", R"(,"material":0)",
        R"("images":[{"uri":"data:image/webp;base64,)"
        R"(UklGRiYAAABXRUJQVlA4TBoAAAAvAQAAEA9wAeNNIMi2DW07xv8HGOyHjOh/AA=="}],"textures":[)" +
            texture + R"(],"materials":[{"emissiveTexture":{"index":0}}],"nodes":[{"mesh":0}])"));
  };
  const Scene webp = read(R"({"extensions":{"EXT_texture_webp":{"source":0}}})");
  if (!io::has_webp()) {
    expect_warning("Debian: libwebp-dev", webp);
  } else if (webp.warnings.empty()) {
    ASSERT_EQ(webp.textures.size(), 1U);
    EXPECT_EQ(webp.textures[0].image(0, 0), (Rgba8{10, 200, 30, 255}));
    EXPECT_EQ(webp.textures[0].image(1, 0), (Rgba8{1, 2, 3, 128}));
  } else {
    expect_warning("which this machine lacks", webp);
  }
  const Scene basisu = read(R"({"extensions":{"KHR_texture_basisu":{"source":0}}})");
  EXPECT_TRUE(basisu.textures.empty());
  expect_warning("KHR_texture_basisu", basisu);
}

// A PNG of heights has pixels of alpha 0. Right: they are holes, whatever their colour.
TEST(OddHeights, TransparentPixels) {
  const TempFolder folder;
  Image<Rgba8> heights(3, 1);
  heights(0, 0) = {7, 7, 7, 255};
  heights(1, 0) = {9, 0, 200, 0};
  heights(2, 0) = {5, 5, 5, 1};
  io::write_png(folder.path("h.png"), heights.view());
  const io::HeightGrid grid = io::read_heights(folder.path("h.png"));
  EXPECT_EQ(grid.heights(0, 0), 7);
  EXPECT_TRUE(std::isnan(grid.heights(1, 0)));
  EXPECT_EQ(grid.heights(2, 0), 5);
}

// A camera looks over the edge of a map that ends (none). Right: the sky is behind it, with
// every filter. Three cells ahead of the camera are ground, and behind them is sky, not ground
// again.
TEST(OddHeights, TerrainEndsAtItsEdge) {
  for (const auto filter :
       {terrain::MapFilter::none, terrain::MapFilter::bilinear, terrain::MapFilter::mip}) {
    terrain::HeightMap map{Image<float>(7, 3), Image<Rgba8>(7, 3)};
    for (Rgba8& c : map.colors.pixels()) c = {255, 0, 0, 255};
    terrain::TerrainOptions options{.width = 1,
                                    .height = 60,
                                    .distance = 40,
                                    .scale_px = 40,
                                    .filter = filter,
                                    .tiling = terrain::Tiling::none};
    const terrain::Terrain ground(std::move(map));
    Image<float> depth(1, 60), plain(1, 60);
    for (const auto& [device, to] :
         {std::pair(Device::threads, &depth), std::pair(Device::serial, &plain)}) {
      Image<Rgba8> picture(1, 60);
      terrain::TerrainRenderer({.device = device})
          .render(ground, {.x = 3.5, .y = 3, .altitude = 2, .horizon_px = 10}, options,
                  {.color8 = picture, .depth = *to});
    }
    EXPECT_TRUE(std::ranges::equal(depth.pixels(), plain.pixels()));
    float farthest = 0;
    for (const float z : depth.pixels())
      if (std::isfinite(z)) farthest = std::max(farthest, z);
    EXPECT_GT(farthest, 2);
    EXPECT_LE(farthest, 3);
  }
}

}  // namespace

}  // namespace rastrum::test::document_troubles
