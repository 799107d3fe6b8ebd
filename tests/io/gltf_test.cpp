// SPDX-License-Identifier: BSD-3-Clause
// glTF documents that the tests write. Real files are in bad_files_test.cpp.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/stop.hpp>

#include "tests/io/gltf_document.hpp"
#include "tests/io/scene_files.hpp"
#include "tests/support/matrices.hpp"

namespace rastrum::test::gltf_test {
namespace {

using Indices = std::vector<std::uint32_t>;

std::string vec3(float x, float y, float z) {
  return raw(x) + raw(y) + raw(z);
}

/// Four corners of a square, then indices 0 1 2 3 as uint16: 48 + 8 bytes.
std::string square_bytes() {
  std::string s = vec3(0, 0, 0) + vec3(1, 0, 0) + vec3(0, 1, 0) + vec3(1, 1, 0);
  for (std::uint16_t i = 0; i < 4; ++i) s += raw(i);
  return s;
}

constexpr const char* kSquareAccessors =
    R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
    R"({"bufferView":0,"byteOffset":48,"componentType":5123,"count":4,"type":"SCALAR"}])";

std::string square(const std::string& primitive, const std::string& nodes = R"([{"mesh":0}])") {
  return document(square_bytes(), std::string(kSquareAccessors) + R"(,"meshes":[{"primitives":[)" +
                                      primitive + R"(]}],"nodes":)" + nodes);
}

Scene read(const std::string& text) {
  return read_file("a.gltf", text);
}

void refused(const std::string& part, const std::string& text, Errc code = Errc::bad_format) {
  expect_bad_file(part, "a.gltf", text, code);
}

TEST(Gltf, ListsStripsAndFans) {
  const auto indices = [](int mode) {
    const Scene s = read(
        square(R"({"attributes":{"POSITION":0},"indices":1,"mode":)" + std::to_string(mode) + "}"));
    return s.meshes.empty() ? Indices{} : s.meshes[0].indices;
  };
  EXPECT_EQ(indices(4), (Indices{0, 1, 2}));
  EXPECT_EQ(indices(5), (Indices{0, 1, 2, 1, 3, 2}));
  EXPECT_EQ(indices(6), (Indices{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(indices(0), Indices{});
  EXPECT_EQ(indices(1), Indices{});
}

TEST(Gltf, WithoutIndicesInOrder) {
  const Scene s = read(square(R"({"attributes":{"POSITION":0}})"));
  EXPECT_EQ(s.triangle_count(), 1U);
  EXPECT_EQ(s.meshes[0].positions.size(), 4U);
}

TEST(Gltf, NodesAreDepthFirstInDoublePrecision) {
  const Scene s = read(square(
      R"({"attributes":{"POSITION":0},"indices":1})",
      R"([{"children":[2,1],"translation":[1,0,0],"scale":[2,2,2]},)"
      R"({"mesh":0,"translation":[0,0,0.1]},)"
      R"({"mesh":0,"rotation":[0,0,0.7071067811865476,0.7071067811865476],"children":[3]},)"
      R"({"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]}],"scenes":[{"nodes":[0]}])"));
  ASSERT_EQ(s.meshes.size(), 1U) << "instances share their mesh";
  ASSERT_EQ(s.instances.size(), 3U);
  const auto& turned = s.instances[0].object_to_world.m;
  EXPECT_NEAR(turned[0][1], -2, 1e-15);
  EXPECT_NEAR(turned[1][0], 2, 1e-15);
  EXPECT_EQ(turned[0][3], 1);
  const auto& below = s.instances[1].object_to_world.m;
  EXPECT_NEAR(below[0][3], 1 - 12, 1e-14);
  EXPECT_NEAR(below[1][3], 10, 1e-14);
  EXPECT_EQ(s.instances[2].object_to_world.m[2][3], 0.2) << "in float64";
}

TEST(Gltf, SparseAccessorsOverZerosAndOverBytes) {
  // Element 1 becomes (7, 8, 9).
  const std::string bytes = square_bytes() + raw(std::uint32_t{1}) + vec3(7, 8, 9);
  const std::string sparse =
      R"("sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":56,"componentType":5125},)"
      R"("values":{"bufferView":0,"byteOffset":60}})";
  for (const bool over_zeros : {false, true}) {
    const std::string view = over_zeros ? "" : R"("bufferView":0,)";
    const Scene s = read(document(
        bytes, R"("accessors":[{)" + view + R"("componentType":5126,"count":4,"type":"VEC3",)" +
                   sparse + R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" +
                   R"("nodes":[{"mesh":0}])"));
    EXPECT_EQ(s.meshes[0].positions[1].y, 8.0F);
    EXPECT_EQ(s.meshes[0].positions[2].y, over_zeros ? 0.0F : 1.0F);
  }
}

// Attributes of applications: numbers become scalars by name, vectors are ignored.
TEST(Gltf, AttributesOfApplicationsAreScalars) {
  GltfDocument d;
  d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  d.floats({0.5F, -2, 7}, "SCALAR");
  d.add(std::vector<std::uint8_t>{3, 0, 255}, "SCALAR", 5121);
  d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  for (const int mode : {4, 0, 3}) {
    const Scene s =
        read(d.text(R"("meshes":[{"primitives":[{"mode":)" + std::to_string(mode) +
                    R"(,"attributes":{"POSITION":0,"_TEMPERATURE":1,"_PART":2,"_FLOW":3}}]}],)"
                    R"("nodes":[{"mesh":0}])"));
    const std::vector<NamedScalars>& scalars =
        mode == 4 ? s.meshes.at(0).scalars
                  : std::visit(
                        [](const auto& g) -> const auto& { return g.scalars; }, s.geometries.at(0));
    ASSERT_EQ(scalars.size(), 2U);
    EXPECT_EQ(scalars[0].name, "_PART");
    EXPECT_EQ(scalars[0].values, (std::vector<double>{3, 0, 255}));
    EXPECT_EQ(scalars[1].name, "_TEMPERATURE");
    EXPECT_EQ(scalars[1].values, (std::vector<double>{0.5, -2, 7}));
  }
}

TEST(Gltf, StridesAndNormalizedIntegers) {
  // Interleaved: normalized int16 positions, padded to 8 bytes, and colours of 4 × uint8.
  std::string bytes;
  const std::int16_t xs[3] = {32767, -32768, 0};
  for (const std::int16_t x : xs)
    bytes += raw(x) + raw(std::int16_t{0}) + raw(std::int16_t{16384}) + raw(std::int16_t{0}) +
             std::string("\xFF\0\x33\xFF", 4);
  const Scene s = read(
      R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_mesh_quantization"],)"
      R"("extensionsUsed":["KHR_mesh_quantization"],"buffers":[{"byteLength":36,"uri":"data:;base64,)" +
      base64(bytes) +
      R"("}],"bufferViews":[{"buffer":0,"byteLength":36,"byteStride":12}],"accessors":[)"
      R"({"bufferView":0,"componentType":5122,"normalized":true,"count":3,"type":"VEC3"},)"
      R"({"bufferView":0,"byteOffset":8,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":1}}]}],"nodes":[{"mesh":0}]})");
  const Mesh& m = s.meshes[0];
  EXPECT_EQ(m.positions[0].x, 1.0F);
  EXPECT_EQ(m.positions[1].x, -1.0F);
  EXPECT_FLOAT_EQ(m.positions[2].z, 16384 / 32767.0F);
  EXPECT_EQ(m.colors.values[1].x, 1.0F);
  EXPECT_FLOAT_EQ(m.colors.values[2].z, 0.2F);
}

TEST(Gltf, WholeNumbersMayHaveAPoint) {
  GltfDocument made;
  const std::size_t positions = made.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
  const std::size_t texcoords = made.floats({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2");
  const std::size_t colors =
      made.add(std::vector<std::uint8_t>{255, 0, 51, 255, 0, 0, 0, 255, 1, 2, 3, 4, 9, 9, 9, 9},
               "VEC4", 5121, true);
  const std::size_t indices =
      made.add(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, "SCALAR", 5123);
  const auto n = [](std::size_t v) { return std::to_string(v); };
  const std::string text = made.text(
      R"("images":[{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}],)"
      R"("samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728}],"textures":[{"source":0,"sampler":0}],)"
      R"("materials":[{},{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":0}}}],)"
      R"("meshes":[{"primitives":[{"mode":4,"material":1,"attributes":{"POSITION":)" +
      n(positions) + R"(,"TEXCOORD_0":)" + n(texcoords) + R"(,"COLOR_0":)" + n(colors) +
      R"(},"indices":)" + n(indices) +
      R"(}]}],"scene":1,"scenes":[{"nodes":[]},{"nodes":[1]}],)"
      R"("nodes":[{"mesh":0,"translation":[1,2,3]},{"children":[0]}])");
  const std::string pointed = with_points(text);
  ASSERT_TRUE(holds(pointed, R"("mode":4)"));
  ASSERT_FALSE(holds(pointed, R"("mode":4,)"));
  const Scene a = read(text), b = read(pointed);
  ASSERT_EQ(a.instances.size(), 1U);
  ASSERT_EQ(b.instances.size(), 1U);
  expect_near(a.instances[0].object_to_world, b.instances[0].object_to_world, 0);
  EXPECT_EQ(a.meshes[0].positions, b.meshes[0].positions);
  EXPECT_EQ(a.meshes[0].indices, b.meshes[0].indices);
  EXPECT_EQ(a.meshes[0].texcoords.values, b.meshes[0].texcoords.values);
  EXPECT_EQ(a.meshes[0].colors.values, b.meshes[0].colors.values);
  EXPECT_EQ(a.meshes[0].material, b.meshes[0].material);
  ASSERT_EQ(b.textures.size(), 1U);
  EXPECT_EQ(a.textures[0].wrap_u, b.textures[0].wrap_u);
  EXPECT_EQ(b.textures[0].wrap_v, Wrap::mirrored_repeat);
}

TEST(Gltf, MaterialsAndTextures) {
  const TempFolder folder;
  Image<Rgba8> image(2, 1);
  image(1, 0) = {1, 2, 3, 4};
  io::write_png(folder.path("a picture.png"), std::as_const(image).view());
  const Scene s = io::read_scene(folder.write(
      "a.gltf",
      document(
          square_bytes() + raw(0.0F) + raw(0.0F) + raw(1.0F) + raw(0.0F) + raw(0.0F) + raw(1.0F) +
              raw(1.0F) + raw(1.0F),
          R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
          R"({"bufferView":0,"byteOffset":56,"componentType":5126,"count":4,"type":"VEC2"}],)"
          R"("extensionsUsed":["KHR_materials_unlit","KHR_texture_transform"],)"
          R"("images":[{"uri":"a%20picture.png"}],"samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728,"minFilter":9729},{}],)"
          R"("textures":[{"source":0,"sampler":0},{"source":0,"sampler":1}],)"
          R"("materials":[{"name":"m","alphaMode":"MASK","alphaCutoff":0.25,"doubleSided":true,"emissiveFactor":[1,0.5,0],)"
          R"("extensions":{"KHR_materials_unlit":{},"KHR_materials_emissive_strength":{"emissiveStrength":4}},)"
          R"("normalTexture":{"index":1,"scale":0.5,"texCoord":1,"extensions":{"KHR_texture_transform":{"offset":[0.5,0],"scale":[2,3]}}},)"
          R"("pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.6,"roughnessFactor":0.7,)"
          R"("baseColorTexture":{"index":0,"texCoord":1,"extensions":{"KHR_texture_transform":{"offset":[0.5,0],"scale":[2,3]}}}}}],)"
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_1":1},"material":0},{"attributes":{"POSITION":0}}]}],)"
          R"("nodes":[{"mesh":0}])")));
  ASSERT_EQ(s.materials.size(), 2U) << "the second primitive draws with the default material";
  EXPECT_EQ(s.meshes[1].material, 1U);
  EXPECT_EQ(s.materials[1].metallic, 1.0F);
  const Material& m = s.materials[0];
  EXPECT_EQ(m.base_color.w, 0.4F);
  EXPECT_EQ(m.roughness, 0.7F);
  EXPECT_EQ(m.metallic, 0.6F);
  EXPECT_EQ(m.emissive.y, 2.0F);
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(m.alpha_cutoff, 0.25F);
  EXPECT_TRUE(m.double_sided && m.unlit);
  EXPECT_EQ(m.normal_scale, 0.5F);
  ASSERT_EQ(m.base_color_texture, 0);
  ASSERT_EQ(m.normal_texture, 1);
  EXPECT_EQ(s.textures[0].image(1, 0), (Rgba8{1, 2, 3, 4}));
  EXPECT_EQ(s.textures[0].wrap_u, Wrap::clamp_to_edge);
  EXPECT_EQ(s.textures[0].wrap_v, Wrap::mirrored_repeat);
  EXPECT_EQ(s.textures[0].mag, TextureFilter::nearest);
  EXPECT_FALSE(s.textures[0].mipmaps);
  EXPECT_EQ(s.textures[1].wrap_u, Wrap::repeat);
  EXPECT_TRUE(s.textures[1].mipmaps);
  // The transform is applied to the coordinates. The warning counts the 4 vertices of each list.
  EXPECT_EQ(s.meshes[0].texcoords.values[3].x, 2.5F);
  EXPECT_EQ(s.meshes[0].texcoords.values[3].y, 3.0F);
  EXPECT_EQ(s.warnings.size(), 2U) << io::describe(s);
}

// Pictures are decoded after all materials are converted.
TEST(Gltf, PicturesThatCannotBeReadTakeNoOthersPlace) {
  const TempFolder folder;
  for (const int code : {10, 20}) {
    Image<Rgba8> image(1, 1);
    image(0, 0) = {static_cast<std::uint8_t>(code), 0, 0, 255};
    io::write_png(folder.path(std::to_string(code) + ".png"), std::as_const(image).view());
  }
  folder.write("bad.png", "no picture");
  const Scene s = io::read_scene(folder.write(
      "a.gltf",
      document(
          square_bytes(),
          R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}],)"
          R"("images":[{"uri":"10.png"},{"uri":"bad.png"},{"uri":"20.png"}],"samplers":[{"wrapS":33071}],)"
          R"("textures":[{"source":1},{"source":2},{"source":0},{"source":1,"sampler":0},{"source":2,"sampler":0}],)"
          R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":1}},)"
          R"("normalTexture":{"index":2},"occlusionTexture":{"index":3},"emissiveTexture":{"index":4}}],)"
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)"
          R"("nodes":[{"mesh":0}])")));
  const Material& m = s.materials.at(0);
  EXPECT_EQ(m.base_color_texture, kNoTexture);
  EXPECT_EQ(m.occlusion_texture, kNoTexture);
  ASSERT_EQ(s.textures.size(), 3U);
  const auto code = [&](std::int32_t texture) {
    return int{s.textures.at(static_cast<std::size_t>(texture)).image(0, 0).r};
  };
  EXPECT_EQ(code(m.metallic_roughness_texture), 20);
  EXPECT_EQ(code(m.normal_texture), 10);
  EXPECT_EQ(code(m.emissive_texture), 20);
  EXPECT_NE(m.emissive_texture, m.metallic_roughness_texture) << "another sampler";
  EXPECT_EQ(std::ranges::count_if(
                s.warnings, [](const std::string& w) { return w.find("texture: ") != w.npos; }),
            1)
      << io::describe(s);
  // A stop is not a picture's error, so it ends the reading.
  std::stop_source source;
  source.request_stop();
  const std::stop_token token = source.get_token();
  const StopScope scope(token);
  EXPECT_THROW((void)io::read_scene(folder.path("a.gltf")), Stopped);
}

TEST(Gltf, Cameras) {
  const Scene s = read(square(
      R"({"attributes":{"POSITION":0}})",
      R"([{"mesh":0},{"camera":0,"translation":[1,2,3],"rotation":[0,1,0,0]},{"camera":1}],)"
      R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"aspectRatio":0.5,"znear":0.25,"zfar":9}},)"
      R"({"type":"orthographic","orthographic":{"xmag":3,"ymag":2,"znear":0,"zfar":5}}])"));
  ASSERT_EQ(s.cameras.size(), 2U);
  EXPECT_EQ(s.cameras[0].eye.z, 3.0F);
  EXPECT_NEAR(s.cameras[0].target.z, 4.0F, 1e-6F) << "turned about y: it looks along +z";
  EXPECT_FLOAT_EQ(s.cameras[0].fov_rad, 2 * std::atan(std::tan(0.5F) * 0.5F));
  EXPECT_EQ(s.cameras[0].far_plane, 9.0F);
  EXPECT_TRUE(s.cameras[1].orthographic);
  EXPECT_EQ(s.cameras[1].orthographic_height, 4.0F);
}

/// A square under lights, and nodes that place them.
std::string lit(const std::string& lights, const std::string& nodes) {
  return square(R"({"attributes":{"POSITION":0}})",
                R"([{"mesh":0},)" + nodes + R"(],"extensionsRequired":["KHR_lights_punctual"],)" +
                    R"("extensionsUsed":["KHR_lights_punctual"],)" +
                    R"("extensions":{"KHR_lights_punctual":{"lights":[)" + lights + "]}}");
}

TEST(Gltf, LightsStandWhereNodesAre) {
  const Scene s = read(lit(
      R"({"type":"directional","intensity":3},{"type":"point","color":[1,0.5,0],"range":4},)"
      R"({"type":"spot","intensity":2,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.3}})",
      R"({"rotation":[0,1,0,0],"extensions":{"KHR_lights_punctual":{"light":0}}},)"
      R"({"translation":[1,2,3],"scale":[2,2,2],"extensions":{"KHR_lights_punctual":{"light":1}}},)"
      R"({"translation":[4,5,6],"extensions":{"KHR_lights_punctual":{"light":2}}})"));
  EXPECT_FALSE(holds(io::describe(s), "KHR_lights"));
  ASSERT_EQ(s.lights.size(), 3U);
  const auto& sun = std::get<DirectionalLight>(s.lights[0].kind);
  EXPECT_NEAR(sun.direction.z, 1, 1e-6F) << "turned about y: it shines along +z";
  EXPECT_FLOAT_EQ(s.lights[0].intensity, 3 / 3.14159265F);
  const auto& lamp = std::get<PointLight>(s.lights[1].kind);
  EXPECT_EQ(lamp.position.y, 2);
  EXPECT_EQ(lamp.range, 4) << "a node's scale is not a light's";
  EXPECT_EQ(s.lights[1].color, (Vec3{1, 0.5F, 0}));
  const auto& spot = std::get<SpotLight>(s.lights[2].kind);
  EXPECT_EQ(spot.position.z, 6);
  EXPECT_EQ(spot.direction.z, -1);
  EXPECT_FLOAT_EQ(spot.outer_rad, 0.3F);
  EXPECT_TRUE(holds(io::describe(s), "light 2: spot"));

  Scene moved =
      read(lit(R"({"type":"point"})", R"({"extensions":{"KHR_lights_punctual":{"light":0}}})"));
  Mat4d to_world = Mat4d::identity();
  to_world.m[0][3] = 7;
  moved.place(to_world);
  EXPECT_EQ(std::get<PointLight>(moved.lights.at(0).kind).position.x, 7);
}

TEST(Gltf, LightsThatCannotBeMeantAreRefused) {
  const std::string on = R"({"extensions":{"KHR_lights_punctual":{"light":0}}})";
  for (const char* const bad :
       {R"({"intensity":1})", R"({"type":"point","intensity":-1})", R"({"type":"point","range":0})",
        R"({"type":"point","color":[1,1]})", R"({"type":"point","color":[1,-1,0]})",
        R"({"type":"spot"})",
        R"({"type":"spot","spot":{"innerConeAngle":0.4,"outerConeAngle":0.3}})",
        R"({"type":"spot","spot":{"outerConeAngle":1.6}})"})
    EXPECT_THROW((void)read(lit(bad, on)), Error) << bad;
  EXPECT_THROW((void)read(lit(R"({"type":"point"})",
                              R"({"extensions":{"KHR_lights_punctual":{"light":1}}})")),
               Error);
  const Scene unknown = read(lit(R"({"type":"laser"})", on));
  EXPECT_TRUE(unknown.lights.empty());
  EXPECT_TRUE(holds(io::describe(unknown), "has a kind that is not known"));
  EXPECT_NO_THROW((void)read(lit(R"({"type":"point"})", on)));
}

TEST(Gltf, BinaryContainer) {
  const std::string file = glb(
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":56}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":56}],)" +
          std::string(kSquareAccessors) +
          R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"nodes":[{"mesh":0}]})",
      square_bytes());
  const TempFolder folder;
  EXPECT_EQ(io::read_scene(folder.write("a.glb", file)).meshes[0].indices, (Indices{0, 1, 2}));
  for (std::size_t n = 0; n < file.size(); ++n)
    EXPECT_THROW((void)io::read_scene(folder.write("cut.glb", file.substr(0, n))), Error) << n;
}

TEST(Gltf, RefusesWhatItDoesNotKnow) {
  refused(
      "EXT_odd",
      R"({"asset":{"version":"2.0"},"extensionsUsed":["EXT_odd"],"extensionsRequired":["EXT_odd"]})",
      Errc::unsupported);
  refused("asset.version", R"({"asset":{"version":"1.0"}})", Errc::unsupported);
  refused("a.gltf", "{");
}

TEST(Gltf, ErrorsNameThePlace) {
  const struct {
    const char *from, *to, *says;
  } kMistakes[] = {
      {R"("indices":1)", R"("indices":2)", "meshes[0].primitives[0].indices"},
      {R"("count":4)", R"("count":9007199254740991)", "accessors[0]"},
      {R"("byteOffset":48)", R"("byteOffset":49)", "accessors[1]"},
      {R"("byteOffset":48)", R"("byteOffset":9007199254740991)", "accessors[1]"},
      {R"("byteOffset":48)", R"("byteOffset":-4)", "accessors[1].byteOffset"},
      {R"("byteOffset":48)", R"("byteOffset":12)", "refers to vertex"},
      {R"("byteLength":56)", R"("byteLength":57)", "buffers[0]"},
      {R"([{"mesh":0}])", R"([{"mesh":0,"children":[0]}])", "ancestors"},
      {R"([{"mesh":0}])", R"([{"mesh":0,"children":[1]},{"children":[2]},{"children":[1]}])",
       "parent"},
      {R"([{"mesh":0}])", R"([{"mesh":"0"}])", "nodes[0].mesh"},
      {R"("type":"VEC3")", R"("type":"VEC2")", "wrong type"},
  };
  for (const auto& [from, to, says] : kMistakes)
    refused(says, changed(square(R"({"attributes":{"POSITION":0},"indices":1})"), from, to));
}

TEST(Gltf, DeepHierarchiesAndDeepJsonDoNotOverflowTheStack) {
  std::string nodes = "[";
  for (int i = 0; i < 20000; ++i) nodes += R"({"children":[)" + std::to_string(i + 1) + "]},";
  const Scene s = read(square(R"({"attributes":{"POSITION":0}})", nodes + R"({"mesh":0}])"));
  EXPECT_EQ(s.instances.size(), 1U);
  refused("JSON", std::string(200000, '['));
  refused("object", std::string(200000, '[') + std::string(200000, ']'));
}

TEST(Gltf, ElementsWithoutBytesAreBounded) {
  refused(
      "64 times",
      R"({"asset":{"version":"2.0"},"accessors":[{"componentType":5126,"count":4000000000,"type":"VEC3"}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})",
      Errc::out_of_memory);
}

TEST(Describe, SaysWhatAFileHolds) {
  Scene s = read(square(R"({"attributes":{"POSITION":0},"indices":1,"mode":5})",
                        R"([{"mesh":0},{"mesh":0,"translation":[2,0,0]}])"));
  s.meshes[0].positions[3].x = std::numeric_limits<float>::quiet_NaN();
  s.meshes[0].indices.insert(s.meshes[0].indices.end(), {0, 1, 1});
  const std::string text = io::describe(s);
  EXPECT_TRUE(holds(text, "6 triangles in 2 instances of 1 mesh,"));
  EXPECT_TRUE(holds(text, "bounds: (0, 0, 0) to (3, 1, 0)"));
  EXPECT_TRUE(holds(text, "dropped: 2 triangles"));
  EXPECT_TRUE(holds(text, "without area: 2 triangles"));
}

}  // namespace
}  // namespace rastrum::test::gltf_test
