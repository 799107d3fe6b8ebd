// SPDX-License-Identifier: BSD-3-Clause
// EXT_meshopt_compression and KHR_draco_mesh_compression: reads back what the libraries' own
// encoders packed, and refuses damaged streams.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/io/gltf_document.hpp"
#include "tests/io/scene_files.hpp"

#ifdef RASTRUM_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif
#ifdef RASTRUM_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif

namespace rastrum::test::gltf_packed_test {
namespace {

Scene read(const std::string& text) {
  const std::span<const char> bytes(text);
  return io::decode_scene(std::as_bytes(bytes), "gltf", "packed.gltf");
}

[[maybe_unused]] void refused(const std::string& part, const std::string& text,
                              Errc code = Errc::bad_format) {
  expect_refused(part, code, [&] { (void)read(text); });
}

std::string uri_buffer(const std::string& bytes) {
  return R"({"byteLength":)" + std::to_string(bytes.size()) +
         R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes) + R"("})";
}

/// A hilly square of n × n vertices with normals.
struct Hills {
  std::vector<float> positions, normals;  ///< xyz and xyzw
  std::vector<unsigned> indices;

  explicit Hills(unsigned n) {
    for (unsigned y = 0; y < n; ++y)
      for (unsigned x = 0; x < n; ++x) {
        const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
        positions.insert(positions.end(), {fx, fy, std::sin(fx) * std::cos(fy * 0.7F)});
        const Vec3 v = normalize(Vec3{-std::cos(fx), std::sin(fy), 1 + fx * 0.01F});
        normals.insert(normals.end(), {v.x, v.y, v.z, 0});
        if (x + 1 == n || y + 1 == n) continue;
        const unsigned i = y * n + x;
        indices.insert(indices.end(), {i, i + 1, i + n, i + n, i + 1, i + n + 1});
      }
  }
  [[nodiscard]] std::size_t count() const { return positions.size() / 3; }
  [[nodiscard]] Mesh mesh() const {
    Mesh m;
    m.indices.assign(indices.begin(), indices.end());
    for (std::size_t v = 0; v < positions.size(); v += 3)
      m.positions.push_back({positions[v], positions[v + 1], positions[v + 2]});
    return m;
  }
};

/// Damages the stream in one to four places. It must be refused, or read as a valid scene.
template <class MakeText>
void spoil(const std::string& stream, const MakeText& text_of) {
  std::mt19937 random(11);
  std::size_t refused = 0;
  constexpr std::size_t kTimes = 1000;
  for (std::size_t i = 0; i < kTimes; ++i) {
    std::string spoilt = stream;
    for (unsigned flips = random() % 4 + 1; flips != 0; --flips)
      spoilt[random() % spoilt.size()] ^= static_cast<char>(1U << random() % 8);
    if (i % 8 == 0) spoilt.resize(random() % spoilt.size() + 1);
    try {
      const Scene scene = read(text_of(spoilt));
      for (const Mesh& m : scene.meshes)
        for (const std::uint32_t v : m.indices) ASSERT_LT(v, m.positions.size());
    } catch (const Error& e) {
      EXPECT_TRUE(holds(e.what(), "packed.gltf"));
      ++refused;
    }
  }
  EXPECT_GT(refused, kTimes / 20);
}

/// A triangle that begins with its smallest vertex.
using Corners = std::array<Vec3, 3>;
[[maybe_unused]] std::vector<Corners> triangles(const Mesh& mesh) {
  const auto less = [](Vec3 a, Vec3 b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  };
  std::vector<Corners> r;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    Corners c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = mesh.positions[mesh.indices[3 * t + k]];
    std::rotate(c.begin(), std::ranges::min_element(c, less), c.end());
    r.push_back(c);
  }
  std::ranges::sort(r, [&](const Corners& a, const Corners& b) {
    return std::ranges::lexicographical_compare(a, b, less);
  });
  return r;
}

#ifdef RASTRUM_HAS_MESHOPTIMIZER

std::string pack_attributes(const void* values, std::size_t count, std::size_t stride) {
  std::string r(meshopt_encodeVertexBufferBound(count, stride), '\0');
  r.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(r.data()), r.size(), values,
                                      count, stride));
  return r;
}
std::string pack_triangles(const Hills& h) {
  std::string r(meshopt_encodeIndexBufferBound(h.indices.size(), h.count()), '\0');
  r.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(r.data()), r.size(),
                                     h.indices.data(), h.indices.size()));
  return r;
}
std::string pack_sequence(const Hills& h) {
  std::string r(meshopt_encodeIndexSequenceBound(h.indices.size(), h.count()), '\0');
  r.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(r.data()), r.size(),
                                       h.indices.data(), h.indices.size()));
  return r;
}

/// Packed views one behind the other in buffer 0, over a buffer without data.
class Packed {
 public:
  void add(const std::string& stream, std::size_t count, std::size_t stride,
           const std::string& mode, const std::string& filter = "NONE") {
    views_ += (views_.empty() ? "" : ",") + std::string(R"({"buffer":1,"byteOffset":)") +
              std::to_string(whole_) + R"(,"byteLength":)" + std::to_string(count * stride) +
              (mode == "ATTRIBUTES" ? R"(,"byteStride":)" + std::to_string(stride) : "") +
              R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":)" +
              std::to_string(bytes_.size()) + R"(,"byteLength":)" + std::to_string(stream.size()) +
              R"(,"byteStride":)" + std::to_string(stride) + R"(,"count":)" +
              std::to_string(count) + R"(,"mode":")" + mode + R"(","filter":")" + filter +
              R"("}}})";
    bytes_ += stream;
    whole_ += (count * stride + 3) / 4 * 4;
  }
  [[nodiscard]] std::string text(const std::string& rest) const {
    return R"({"asset":{"version":"2.0"},"extensionsRequired":["EXT_meshopt_compression"],)"
           R"("extensionsUsed":["EXT_meshopt_compression"],"buffers":[)" +
           uri_buffer(bytes_) + R"(,{"byteLength":)" + std::to_string(whole_) +
           R"(,"extensions":{"EXT_meshopt_compression":{"fallback":true}}}],"bufferViews":[)" +
           views_ + "]," + rest + "}";
  }

 private:
  std::string bytes_, views_;
  std::size_t whole_ = 0;
};

std::string hills_text(const Hills& h, const std::string& positions, const std::string& normals,
                       const std::string& indices, const std::string& mode) {
  const std::size_t n = h.count();
  Packed p;
  p.add(positions, n, 12, "ATTRIBUTES");
  p.add(normals, n, 4, "ATTRIBUTES", "OCTAHEDRAL");
  p.add(indices, h.indices.size(), 4, mode);
  const std::string count = R"("count":)" + std::to_string(n);
  return p.text(
      R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3",)" + count +
      R"(},{"bufferView":1,"componentType":5120,"normalized":true,"type":"VEC3",)" + count +
      R"(},{"bufferView":2,"componentType":5125,"type":"SCALAR","count":)" +
      std::to_string(h.indices.size()) +
      R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]}],)"
      R"("nodes":[{"mesh":0}])");
}

std::string packed_normals(const Hills& h) {
  std::vector<std::int8_t> octahedral(4 * h.count());
  meshopt_encodeFilterOct(octahedral.data(), h.count(), 4, 8, h.normals.data());
  return pack_attributes(octahedral.data(), h.count(), 4);
}

TEST(GltfMeshopt, AttributesTrianglesAndSequencesAreReadAsTheyWere) {
  const Hills h(20);
  const std::string positions = pack_attributes(h.positions.data(), h.count(), 12);
  EXPECT_LT(positions.size(), h.positions.size() * 4);
  const Mesh plain = h.mesh();

  const std::string normals = packed_normals(h);
  const Scene lists = read(hills_text(h, positions, normals, pack_triangles(h), "TRIANGLES"));
  ASSERT_EQ(lists.meshes.size(), 1U);
  const Mesh& mesh = lists.meshes[0];
  EXPECT_EQ(mesh.positions, plain.positions);
  EXPECT_EQ(triangles(mesh), triangles(plain));
  for (std::size_t v = 0; v < h.count(); ++v) {
    const Vec3 n = mesh.normals.values[v];
    const Vec3 was{h.normals[4 * v], h.normals[4 * v + 1], h.normals[4 * v + 2]};
    EXPECT_GT(dot(normalize(n), was), 0.999F);
  }
  const Scene sequences = read(hills_text(h, positions, normals, pack_sequence(h), "INDICES"));
  EXPECT_EQ(sequences.meshes[0].indices, plain.indices) << "in their very order";
}

TEST(GltfMeshopt, FiltersOfExponentsAndQuaternions) {
  const Hills h(9);
  std::vector<float> exponents(h.positions.size());
  meshopt_encodeFilterExp(exponents.data(), h.count(), 12, 20, h.positions.data());
  const float sine = std::sin(0.3F), cosine = std::cos(0.3F);
  const std::vector<float> turns = {0, 0, 0, 1, 0, sine, 0, cosine};
  std::vector<std::int16_t> quaternions(8);
  meshopt_encodeFilterQuat(quaternions.data(), 2, 8, 16, turns.data());
  const std::vector<float> times = {0, 1};
  Packed p;
  p.add(pack_attributes(exponents.data(), h.count(), 12), h.count(), 12, "ATTRIBUTES",
        "EXPONENTIAL");
  p.add(pack_attributes(quaternions.data(), 2, 8), 2, 8, "ATTRIBUTES", "QUATERNION");
  p.add(pack_attributes(times.data(), 2, 4), 2, 4, "ATTRIBUTES");
  Scene scene = read(
      p.text(R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
             std::to_string(h.count()) +
             R"(},{"bufferView":1,"componentType":5122,"normalized":true,"type":"VEC4","count":2},)"
             R"({"bufferView":2,"componentType":5126,"type":"SCALAR","count":2}],)"
             R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],)"
             R"("animations":[{"samplers":[{"input":2,"output":1}],)"
             R"("channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}}]}])"));
  for (std::size_t v = 0; v < h.count(); ++v)
    EXPECT_NEAR(scene.meshes[0].positions[v].z, h.positions[3 * v + 2], 1e-4F);
  pose(scene, 1);
  EXPECT_NEAR(scene.instances[0].object_to_world.m[0][2], std::sin(0.6), 1e-4);
}

TEST(GltfMeshopt, WhatDoesNotFitIsRefused) {
  const Hills h(20);
  const std::string positions = pack_attributes(h.positions.data(), h.count(), 12);
  const std::string text =
      hills_text(h, positions, packed_normals(h), pack_triangles(h), "TRIANGLES");
  const std::string place = "bufferViews[0].extensions.EXT_meshopt_compression",
                    length = R"("byteLength":)", size = length + std::to_string(positions.size());
  const struct {
    std::string from, to, says;
  } kMistakes[] = {
      {R"("count":400)", R"("count":401)", place + ": holds 401 times 12 bytes"},
      {R"("count":400)", R"("count":9007199254740992)", place + ": holds"},
      {"ATTRIBUTES", "POINTS", place + ".mode"},
      {"OCTAHEDRAL", "ROUND", ".filter"},
      {R"(,"filter":"NONE")", R"(,"filter":"QUATERNION")", ".byteStride: must be 8"},
      {size, length + "70", "cannot hold 4800"},
      {size, length + std::to_string(positions.size() - 1),
       place + ": is not a valid stream of ATTRIBUTES"},
      {size, length + "1000000", "beyond its buffer"},
  };
  for (const auto& [from, to, says] : kMistakes) refused(says, changed(text, from, to));
}

TEST(GltfMeshopt, SpoiltStreamsAreRefusedOrSound) {
  const Hills h(9);
  const std::string positions = pack_attributes(h.positions.data(), h.count(), 12);
  const std::string normals = packed_normals(h), indices = pack_triangles(h);
  spoil(indices,
        [&](const std::string& s) { return hills_text(h, positions, normals, s, "TRIANGLES"); });
  spoil(pack_sequence(h),
        [&](const std::string& s) { return hills_text(h, positions, normals, s, "INDICES"); });
  // Most bits of attributes are values, so headers are tested separately.
  std::string headers = positions;
  spoil(headers.substr(0, 64), [&](const std::string& s) {
    return hills_text(h, s + headers.substr(64), normals, indices, "TRIANGLES");
  });
}

#else
TEST(GltfMeshopt, NeedsTheLibrary) {
  GTEST_SKIP() << "built without meshoptimizer";
}
#endif

#ifdef RASTRUM_HAS_DRACO

struct Stream {
  std::string bytes;
  std::size_t vertices = 0, triangles = 0;
};

/// Positions, colours (RGBA8: the place in the grid) and joints of the hills.
Stream pack(const Hills& h, int method, bool quantize = false) {
  draco::TriangleSoupMeshBuilder builder;
  const std::size_t faces = h.indices.size() / 3;
  builder.Start(static_cast<int>(faces));
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int color = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8, true);
  for (std::size_t f = 0; f < faces; ++f) {
    std::array<std::array<std::uint8_t, 4>, 3> colors{};
    const float* p[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t v = h.indices[3 * f + c];
      p[c] = &h.positions[3 * v];
      colors[c] = {static_cast<std::uint8_t>(v % 256), static_cast<std::uint8_t>(v / 256), 7, 255};
    }
    const auto face = draco::FaceIndex(static_cast<std::uint32_t>(f));
    builder.SetAttributeValuesForFace(position, face, p[0], p[1], p[2]);
    builder.SetAttributeValuesForFace(color, face, colors[0].data(), colors[1].data(),
                                      colors[2].data());
  }
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetTrackEncodedProperties(true);
  if (quantize) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {std::string(buffer.data(), buffer.size()), encoder.num_encoded_points(),
          encoder.num_encoded_faces()};
}

/// `more`: of the primitive.
std::string draco_text(const std::string& stream, std::size_t vertices, std::size_t faces,
                       const std::string& more = "") {
  const std::string count = std::to_string(vertices);
  return R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],)"
         R"("extensionsUsed":["KHR_draco_mesh_compression"],"buffers":[)" +
         uri_buffer(stream) + R"(],"bufferViews":[{"buffer":0,"byteLength":)" +
         std::to_string(stream.size()) +
         R"(}],"accessors":[{"componentType":5126,"type":"VEC3","count":)" + count +
         R"(},{"componentType":5121,"normalized":true,"type":"VEC4","count":)" + count +
         R"(},{"componentType":5125,"type":"SCALAR","count":)" + std::to_string(3 * faces) +
         R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":1},"indices":2,)"
         R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0,)"
         R"("attributes":{"POSITION":0,"COLOR_0":1}}})" +
         more + R"(}]}],"nodes":[{"mesh":0}]})";
}

TEST(GltfDraco, MeshesAreReadAsTheyWere) {
  const Hills h(20);
  const Mesh plain = h.mesh();
  std::map<std::array<float, 3>, std::size_t> number;
  for (std::size_t v = 0; v < h.count(); ++v) {
    const Vec3 p = plain.positions[v];
    number[{p.x, p.y, p.z}] = v;
  }
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const Stream s = pack(h, method);
    const Scene scene = read(draco_text(s.bytes, s.vertices, s.triangles));
    ASSERT_EQ(scene.meshes.size(), 1U);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(triangles(mesh), triangles(plain));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 p = mesh.positions[v];
      const Vec4 c = mesh.colors.values[v];
      EXPECT_EQ(std::lround(c.x * 255) + 256 * std::lround(c.y * 255),
                static_cast<long>(number.at({p.x, p.y, p.z})));
      EXPECT_EQ(c.w, 1.0F);
    }
  }
  const Stream s = pack(h, draco::MESH_EDGEBREAKER_ENCODING, true);
  EXPECT_LT(s.bytes.size(), 2500U);
  const Scene scene = read(draco_text(s.bytes, s.vertices, s.triangles));
  for (const Vec3 p : scene.meshes[0].positions)
    EXPECT_NEAR(p.z, std::sin(p.x) * std::cos(p.y * 0.7F), 0.01F);
}

TEST(GltfDraco, WhatDoesNotFitIsRefused) {
  const Hills h(9);
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const Stream s = pack(h, method);
    const auto text = [&](const std::string& bytes) {
      return draco_text(bytes, s.vertices, s.triangles);
    };
    refused("KHR_draco_mesh_compression: its stream has 128 triangles",
            draco_text(s.bytes, s.vertices, s.triangles + 1));
    refused("vertices, but", draco_text(s.bytes, s.vertices - 1, s.triangles));
    refused("cut off", text(s.bytes.substr(0, 11)));
    refused("is not a valid stream", text(s.bytes.substr(0, s.bytes.size() / 2)));
    refused("is no stream", text("PK" + s.bytes));
    std::string old = s.bytes;
    old[6] = 1;
    refused("version 2.1", text(old), Errc::unsupported);
    const std::string ids = R"("attributes":{"POSITION":0,"COLOR_0":1}}})";
    refused("attributes.POSITION: is not in the stream",
            changed(text(s.bytes), ids, R"("attributes":{"POSITION":9}}})"));
    refused("has 4 components", changed(text(s.bytes), ids, R"("attributes":{"POSITION":1}}})"));
    refused("lists of triangles", draco_text(s.bytes, s.vertices, s.triangles, R"(,"mode":5)"),
            Errc::unsupported);
  }
  // A header that claims 2³² − 1 triangles, with a document that agrees.
  const std::string head(
      "DRACO\x02\x02\x01\x00\x00\x00\xFF\xFF\xFF\xFF\x0F\xFF\xFF\xFF\xFF\x0F\0\0", 23);
  refused("would take", draco_text(head, 4294967295U, 4294967295U), Errc::out_of_memory);
}

TEST(GltfDraco, SpoiltStreamsAreRefusedOrSound) {
  const Hills h(9);
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const Stream s = pack(h, method, true);
    spoil(s.bytes,
          [&](const std::string& bytes) { return draco_text(bytes, s.vertices, s.triangles); });
  }
}

#else
TEST(GltfDraco, NeedsTheLibrary) {
  GTEST_SKIP() << "built without Draco";
}
#endif

}  // namespace
}  // namespace rastrum::test::gltf_packed_test
