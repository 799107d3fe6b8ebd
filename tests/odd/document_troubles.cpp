// Files that name others, small files that would become large, and height maps.
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/terrain.hpp>

#include "tests/io/files.hpp"
#include "tests/io/gltf_document.hpp"
#include "tests/odd/trouble.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::odd {
namespace {

using test::raw;

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A document with `members` in a folder of its own.
Scene read_gltf(const test::TempFolder& folder, const std::string& members) {
  return io::read_scene(folder.write("a.gltf", R"({"asset":{"version":"2.0"},)" + members + "}"));
}

std::string repeated(const std::string& text, int n) {
  std::string all = text;
  for (int i = 1; i < n; ++i) all += "," + text;
  return all;
}

void primitives_on_one_accessor() {
  const test::TempFolder folder;
  const std::string what = test::refusal_of(
      [&] {
        (void)read_gltf(folder,
                        R"("accessors":[{"componentType":5126,"count":16000000,"type":"VEC3"}],)"
                        R"("meshes":[{"primitives":[)" +
                            repeated(R"({"attributes":{"POSITION":0}})", 8) +
                            R"(]}],"nodes":[{"mesh":0}])");
      },
      Errc::out_of_memory);
  EXPECT_TRUE(test::holds(what, "a.gltf: ") && test::holds(what, "64 times") &&
              test::holds(what, "--memory-limit"))
      << what;
}

std::string properties(const std::string& type, int count) {
  std::string s;
  for (int i = 0; i < count; ++i) s += "property " + type + " n" + std::to_string(i) + "\n";
  return s;
}

void numbers_times_faces() {
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
    const test::TempFolder folder;
    const std::string what = test::refusal_of(
        [&] { (void)io::read_scene(folder.write("a.ply", file), {.memory_limit = 1 << 20}); },
        Errc::out_of_memory);
    EXPECT_TRUE(test::holds(what, "a.ply: ") && test::holds(what, "1 MiB on top")) << what;
  }
}

void images_on_one_view() {
  const test::TempFolder folder;
  io::write_png(folder.path("p.png"), Image<Rgba8>(16, 16).view());
  const std::string png = test::slurp(folder.path("p.png"));
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
      folder,
      R"("buffers":[{"byteLength":)" + std::to_string(36 + png.size()) +
          R"(,"uri":"data:;base64,)" + test::base64(positions + png) +
          R"("}],"bufferViews":[{"buffer":0,"byteLength":36},)" +
          R"({"buffer":0,"byteOffset":36,"byteLength":)" + std::to_string(png.size()) +
          R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)" +
          R"("images":[)" + repeated(R"({"bufferView":1,"mimeType":"image/png"})", 30) +
          R"(],"textures":[)" + textures + R"(],"materials":[)" + materials +
          R"(],"meshes":[{"primitives":[)" + primitives + R"(]}],"nodes":[{"mesh":0}])");
  EXPECT_EQ(scene.textures.size(), 1U);
  EXPECT_EQ(scene.materials.at(29).emissive_texture, 0);
}

void pipe_as_library() {
  const test::TempFolder folder;
  ASSERT_EQ(::mkfifo(folder.path("m.mtl").c_str(), 0600), 0);
  const Scene scene =
      io::read_scene(folder.write("a.obj", std::string("mtllib m.mtl\n") + kTriangle));
  EXPECT_EQ(scene.triangle_count(), 1U);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(test::holds(scene.warnings[0], "is no regular file")) << scene.warnings[0];
}

void pipe_as_texture() {
  const test::TempFolder folder;
  ASSERT_EQ(::mkfifo(folder.path("p.png").c_str(), 0600), 0);
  folder.write("m.mtl", "newmtl a\nmap_Kd p.png\n");
  const Scene scene =
      io::read_scene(folder.write("a.obj", std::string("mtllib m.mtl\nusemtl a\n") + kTriangle));
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(test::holds(scene.warnings[0], "is no regular file")) << scene.warnings[0];
}

void device_as_buffer() {
  const test::TempFolder folder;
  const std::string what = test::refusal_of(
      [&] {
        (void)read_gltf(
            folder,
            R"("buffers":[{"byteLength":36,"uri":"/dev/null"}],)"
            R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
            R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
            R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
            R"("nodes":[{"mesh":0}])");
      },
      Errc::io);
  EXPECT_TRUE(test::holds(what, "/dev/null: is no regular file")) << what;
}

void words_of_others() {
  const test::TempFolder folder;
  folder.write("secret.txt", "newmtl a\nKd hunter2\n");
  std::filesystem::create_directory(folder.path("in"));
  const Scene scene =
      io::read_scene(folder.write("in/a.obj", std::string("mtllib ../secret.txt\n") + kTriangle));
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_FALSE(test::holds(scene.warnings[0], "hunter2")) << scene.warnings[0];
  EXPECT_TRUE(test::holds(scene.warnings[0], "secret.txt:2: ")) << scene.warnings[0];
}

void forbidden_folder() {
  const test::TempFolder folder;
  std::filesystem::create_directory(folder.path("in"));
  folder.write("m.mtl", "newmtl a\nKd 1 0 0\n");
  folder.write("in/n.mtl", "newmtl b\nKd 1 0 0\n");
  const auto file = folder.write(
      "in/a.obj", std::string("mtllib ../m.mtl\nmtllib n.mtl\nusemtl b\n") + kTriangle);
  EXPECT_EQ(io::read_scene(file).warnings.size(), 0U);
  const Scene scene = io::read_scene(file, {.allow_outside = false});
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(test::holds(scene.warnings[0], "m.mtl: lies outside of the folder"))
      << scene.warnings[0];
  std::filesystem::create_symlink(folder.path("m.mtl"), folder.path("in/link.mtl"));
  const Scene linked =
      io::read_scene(folder.write("in/b.obj", std::string("mtllib link.mtl\n") + kTriangle),
                     {.allow_outside = false});
  EXPECT_EQ(linked.warnings.size(), 1U);
}

void light_beyond_its_bytes() {
  const test::TempFolder folder;
  const auto file = folder.path("p.png");
  io::write_png(file, Image<Rgba8>(1000, 400).view());
  const std::string what = test::refusal_of(
      [&] { (void)io::read_light(file, {.memory_limit = 1 << 20}); }, Errc::out_of_memory);
  EXPECT_TRUE(test::holds(what, "p.png: ") && test::holds(what, "1 MiB on top")) << what;
  EXPECT_EQ(io::read_light(file).width(), 1000);
}

void shrinking_file() {
  const test::TempFolder folder;
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += kTriangle;
  for (int ms = 1; ms < 100; ms *= 3) {
    const auto file = folder.write("a.obj", text);
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(ms));
      std::filesystem::resize_file(file, 100);
    });
    try {
      (void)io::read_scene(file);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::io);
      EXPECT_TRUE(test::holds(e.what(), "a.obj: has become shorter while it was read")) << e.what();
    }
    other.join();
  }
}

/// A triangle with these other attributes and members.
std::string triangle(test::GltfDocument& document, const std::string& attributes,
                     const std::string& primitive, const std::string& rest) {
  const std::size_t positions = document.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  return document.text(R"("meshes":[{"primitives":[{"attributes":{"POSITION":)" +
                       std::to_string(positions) + attributes + "}" + primitive + "}]}]," + rest);
}

Scene read_text(const std::string& text) {
  const test::TempFolder folder;
  return io::read_scene(folder.write("a.gltf", text));
}

std::string picture(const test::TempFolder& folder, Rgba8 color) {
  Image<Rgba8> one(1, 1);
  one(0, 0) = color;
  io::write_png(folder.path("p.png"), one.view());
  return R"({"uri":"data:image/png;base64,)" + test::base64(test::slurp(folder.path("p.png"))) +
         R"("})";
}

void two_sets_of_coordinates() {
  const test::TempFolder folder;
  test::GltfDocument document;
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
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(test::holds(scene.warnings[0], "materials[0].occlusionTexture")) << scene.warnings[0];
}

void colors_without_material() {
  test::GltfDocument document;
  const std::string colors =
      R"(,"COLOR_0":)" +
      std::to_string(document.floats({1, 0, 0, 0.5F, 1, 0, 0, 0, 1, 0, 0, 1}, "VEC4"));
  const Scene scene = read_text(triangle(document, colors, "", R"("nodes":[{"mesh":0}])"));
  for (const Vec4& c : scene.meshes.at(0).colors.values) EXPECT_EQ(c, (Vec4{1, 0, 0, 1}));
}

void instances_of_the_gpu() {
  test::GltfDocument document;
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

void specular_and_glossiness() {
  const auto read = [](const std::string& images, const std::string& extension) {
    test::GltfDocument document;
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

  const test::TempFolder folder;
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
}

void pictures_of_other_kinds() {
  const auto read = [](const std::string& texture) {
    test::GltfDocument document;
    return read_text(triangle(
        document, "", R"(,"material":0)",
        R"("images":[{"uri":"data:image/webp;base64,)"
        R"(UklGRiYAAABXRUJQVlA4TBoAAAAvAQAAEA9wAeNNIMi2DW07xv8HGOyHjOh/AA=="}],"textures":[)" +
            texture + R"(],"materials":[{"emissiveTexture":{"index":0}}],"nodes":[{"mesh":0}])"));
  };
  const Scene webp = read(R"({"extensions":{"EXT_texture_webp":{"source":0}}})");
  if (webp.warnings.empty()) {
    ASSERT_EQ(webp.textures.size(), 1U);
    EXPECT_EQ(webp.textures[0].image(0, 0), (Rgba8{10, 200, 30, 255}));
    EXPECT_EQ(webp.textures[0].image(1, 0), (Rgba8{1, 2, 3, 128}));
  } else {
    EXPECT_TRUE(test::holds(webp.warnings[0], "libwebp")) << webp.warnings[0];
  }
  const Scene basisu = read(R"({"extensions":{"KHR_texture_basisu":{"source":0}}})");
  EXPECT_TRUE(basisu.textures.empty());
  ASSERT_EQ(basisu.warnings.size(), 1U);
  EXPECT_TRUE(test::holds(basisu.warnings[0], "KHR_texture_basisu")) << basisu.warnings[0];
}

void alpha_of_heights() {
  const test::TempFolder folder;
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

/// Three cells ahead of the camera are ground, and behind them is sky, not ground again.
void ground_that_ends() {
  for (const auto filter :
       {terrain::MapFilter::none, terrain::MapFilter::bilinear, terrain::MapFilter::mip}) {
    terrain::HeightMap map{Image<float>(7, 3), Image<Rgba8>(7, 3)};
    for (Rgba8& c : map.colors.pixels()) c = {255, 0, 0, 255};
    terrain::TerrainOptions options{.width = 1,
                                    .height = 60,
                                    .distance = 40,
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

std::vector<Trouble> document_troubles() {
  return {
      {"Gltf_PrimitivesOnOneAccessorWithoutBytes",
       "1 kB of glTF has eight primitives on one accessor of 16 million elements without bytes",
       "an error, before it takes more than 64 bytes for each byte of the file and 1 GiB",
       primitives_on_one_accessor},
      {"Ply_NumbersTimesFaces",
       "each of the many triangles, or edges, of a small PLY file has the same hundreds of numbers",
       "an error, before more is taken than 64 bytes for each of the file and the limit",
       numbers_times_faces},
      {"Gltf_ImagesOnOneView", "thirty images of a glTF file are one and the same buffer view",
       "it is decoded once: one texture, which thirty materials share", images_on_one_view},
      {"Obj_LibraryIsAPipe", "an OBJ file's mtllib is a pipe to which nobody writes",
       "a warning, at once: only regular files are read", pipe_as_library},
      {"Obj_TextureIsAPipe", "a material's picture is a pipe to which nobody writes",
       "a warning, at once", pipe_as_texture},
      {"Gltf_BufferIsADevice", "a glTF buffer's uri is /dev/null",
       "an error that says that it is no regular file", device_as_buffer},
      {"Obj_LibraryOfAnotherFolder", "an OBJ file's mtllib is a text file of another folder",
       "a warning that names the line and quotes nothing of it", words_of_others},
      {"Obj_NamesLeadOutOfItsFolder",
       "an OBJ file's mtllib leads out of its folder, by name or by a link, and that is not "
       "allowed",
       "a warning names the file, which is not read; files inside the folder are",
       forbidden_folder},
      {"Png_IsSmallAndItsLightIsLarge", "a PNG of one colour is read as light",
       "an error after its header, if it would take more than the limit", light_beyond_its_bytes},
      {"Obj_ShrinksWhileItIsRead", "another program cuts the file off while it is read",
       "the whole scene or an error that names the file, never SIGBUS", shrinking_file},
      {"Gltf_TexturesOfTwoSets",
       "a material's occlusion has a set of texture coordinates of its own",
       "left out, and a warning names it; never drawn with the other's coordinates",
       two_sets_of_coordinates},
      {"Gltf_ColorsWithoutMaterial", "COLOR_0 has an alpha below 1, and there is no material",
       "glTF's own material is opaque: alpha is 1", colors_without_material},
      {"Gltf_InstancesOfTheGpu", "a node has EXT_mesh_gpu_instancing",
       "one instance for each entry: node · translation · rotation · scale", instances_of_the_gpu},
      {"Gltf_SpecularGlossiness", "materials are of KHR_materials_pbrSpecularGlossiness",
       "the metallic-roughness material that reflects the same, pixel by pixel where there are "
       "pictures",
       specular_and_glossiness},
      {"Gltf_WebpAndBasisu", "textures are of EXT_texture_webp and KHR_texture_basisu",
       "the first is read; the second is left out, and a warning names it",
       pictures_of_other_kinds},
      {"Heights_TransparentPixels", "a PNG of heights has pixels of alpha 0",
       "they are holes, whatever their colour", alpha_of_heights},
      {"Heights_TerrainEndsAtItsEdge", "a camera looks over the edge of a map that ends (none)",
       "the sky is behind it, with every filter", ground_that_ends},
  };
}

}  // namespace rastrum::odd
