// SPDX-License-Identifier: BSD-3-Clause
// The budget of a document: what readers allocate for a file counts against it.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/npy_header.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>

#include "tests/io/files.hpp"
#include "tests/io/gltf_document.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::reading_test {
namespace {

template <class T>
std::uint64_t bytes(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}
template <class T>
std::uint64_t bytes(const Attribute<T>& a) {
  return bytes(a.values) + bytes(a.indices);
}
std::uint64_t bytes(const std::vector<NamedScalars>& all) {
  std::uint64_t sum = 0;
  for (const NamedScalars& s : all) sum += bytes(s.values);
  return sum;
}
/// Bytes of the arrays of a scene.
std::uint64_t bytes(const Scene& scene) {
  std::uint64_t sum = bytes(scene.materials);
  for (const Mesh& m : scene.meshes)
    sum += bytes(m.positions) + bytes(m.wide_positions) + bytes(m.indices) + bytes(m.normals) +
           bytes(m.texcoords) + bytes(m.colors) + bytes(m.face_materials) + bytes(m.scalars);
  for (const Geometry& g : scene.geometries) {
    if (const auto* const p = std::get_if<Points>(&g))
      sum += bytes(p->positions) + bytes(p->wide_positions) + bytes(p->normals) + bytes(p->colors) +
             bytes(p->scalars);
    if (const auto* const l = std::get_if<Lines>(&g))
      sum += bytes(l->positions) + bytes(l->wide_positions) + bytes(l->colors) + bytes(l->scalars) +
             bytes(l->indices) + bytes(l->offsets);
  }
  return sum;
}

/// Expects that everything allocated counts, and that an honest file stays far below the limit.
template <class Parse>
void expect_taken(const Parse& parse, const std::string& name, const std::string& file) {
  SCOPED_TRACE(name);
  const auto read = [&](std::uint64_t size, std::uint64_t limit) {
    io::Reading reading(name, size, {.memory_limit = limit});
    return parse(std::as_bytes(std::span(file)), name, reading);
  };
  const std::uint64_t made = bytes(read(file.size(), 0));
  EXPECT_GT(made, 1000U);
  // A limit below the bytes of its arrays is too low.
  const std::string said = refusal_of([&] { (void)read(0, made - 1); }, Errc::out_of_memory);
  EXPECT_TRUE(said.starts_with(name + ": would take ")) << said;
  EXPECT_TRUE(holds(said, "--memory-limit"));
}

std::string repeated(const std::string& element, int times) {
  std::string all = element;
  for (int i = 1; i < times; ++i) all += "," + element;
  return all;
}

constexpr int kQuads = 50;

/// Quads with vertices of their own; each line ends in `behind`. `far` places them away from 0.
std::string vertices(const std::string& before, const std::string& behind, bool far = false) {
  std::string s;
  for (int q = 0; q < kQuads; ++q)
    for (const char* const y : {"0", "0.5", "1", "2"})
      s += before + std::to_string(q + (far ? 5'000'000 : 0)) + ".25 " + y + " 0" + behind + "\n";
  return s;
}
std::string faces(int first, const std::string& before, const std::string& behind) {
  std::string s;
  for (int q = 0; q < kQuads; ++q) {
    s += before;
    for (int c = 0; c < 4; ++c) s += " " + std::to_string(4 * q + c + first);
    s += behind + "\n";
  }
  return s;
}
std::string stl_text(bool far) {
  std::string s = "solid a\n";
  for (int t = 0; t < kQuads; ++t) {
    const std::string x = std::to_string(t + (far ? 5'000'000 : 0));
    s += "color 0 0." + std::to_string(t) + " 0\nfacet normal 0 0 1\nouter loop\nvertex " + x +
         ".25 0 0\nvertex " + x + ".5 0 0\nvertex " + x + " 1 0\nendloop\nendfacet\n";
  }
  return s + "endsolid\n";
}

TEST(Reading, EveryReaderTakesWhatItMakesFromTheBudget) {
  const std::string count = std::to_string(4 * kQuads);
  for (const bool far : {false, true}) {
    expect_taken(io::parse_obj, "a.obj",
                 vertices("v ", " 1 0 0.5", far) + vertices("vt ", "") + vertices("vn ", "") +
                     "usemtl a\nf 1/1/1 3/2/3 2//2\nf 1 2 3\n" + faces(1, "f", "") +
                     faces(1, "l", "") + faces(1, "p", ""));
    expect_taken(io::parse_off, "a.off",
                 "STCNOFF\n" + count + " " + std::to_string(kQuads) + " 0\n" +
                     vertices("", " 0 0 1 1 0 0 0.5 0.5", far) + faces(0, "4", ""));
    expect_taken(io::parse_off, "faces.off",
                 "OFF\n" + count + " " + std::to_string(kQuads) + " 0\n" + vertices("", "", far) +
                     faces(0, "4", " 1 0.5 0"));
    const std::string ply = "ply\nformat ascii 1.0\nelement vertex " + count +
                            "\nproperty double x\nproperty double y\nproperty double z\n";
    expect_taken(io::parse_ply, "a.ply",
                 ply + "property float nx\nproperty float ny\nproperty float nz\n" +
                     "property uchar red\nproperty uchar green\nproperty uchar blue\n" +
                     "property float s\nproperty float t\nproperty int number\nelement face " +
                     std::to_string(kQuads) + "\nproperty list uchar int vertex_indices\n" +
                     "property int part\nend_header\n" +
                     vertices("", " 0 0 1 255 0 0 0.5 0.5 7", far) + faces(0, "4", " 9"));
    expect_taken(io::parse_ply, "faces.ply",
                 ply + "element face " + std::to_string(kQuads) +
                     "\nproperty list uchar int vertex_indices\nproperty uchar red\n" +
                     "property uchar green\nproperty uchar blue\n" +
                     "property list uchar float texcoord\nend_header\n" + vertices("", "", far) +
                     faces(0, "4", " 255 0 0 8 0 0 1 0 1 1 0 1"));
    expect_taken(io::parse_ply, "cloud.ply",
                 ply + "property int number\nend_header\n" + vertices("", " 8", far));
    std::string edges;
    for (int e = 0; e < kQuads; ++e) edges += "0 " + std::to_string(e + 1) + " 255 0 0\n";
    expect_taken(io::parse_ply, "edges.ply",
                 ply + "property int number\nelement edge " + std::to_string(kQuads) +
                     "\nproperty int vertex1\nproperty int vertex2\nproperty uchar red\n" +
                     "property uchar green\nproperty uchar blue\nend_header\n" +
                     vertices("", " 8", far) + edges);
    expect_taken(io::parse_stl, "text.stl", stl_text(far));
    std::string npy;
    for (int i = 0; i < 9 * kQuads; ++i) npy += raw(i % 3 + (far ? 5e6 : 0.0) + i);
    expect_taken(io::parse_npy, "a.npy",
                 io::npy_header_text("<f8", "(" + std::to_string(kQuads) + ", 9)") + npy);
  }
  std::string binary(80, ' ');
  binary += raw(std::uint32_t{kQuads});
  for (int t = 0; t < kQuads; ++t) {
    for (int i = 0; i < 12; ++i) binary += raw(static_cast<float>(t * i));
    binary += raw(static_cast<std::uint16_t>(0x8000 + t));
  }
  expect_taken(io::parse_stl, "binary.stl", binary);
  GltfDocument document;
  const std::string at = std::to_string(document.floats(std::vector<float>(900, 1), "VEC3"));
  expect_taken(io::parse_gltf, "a.gltf",
               document.text(R"("meshes":[{"primitives":[{"attributes":{"POSITION":)" + at +
                             R"(,"NORMAL":)" + at + R"(}}]}],"nodes":[{"mesh":0}])"));
  expect_taken(
      io::parse_gltf, "materials.gltf",
      R"({"asset":{"version":"2.0"},"materials":[)" + repeated(R"({"name":"plain"})", 100) + "]}");
}

// Nodes of three bytes each count too.
TEST(Reading, EmptyNodesAreTakenFromTheBudget) {
  const std::string text = R"({"asset":{"version":"2.0"},"nodes":[)" + repeated("{}", 5000) + "]}";
  io::Reading reading("a.gltf", text.size(), {.memory_limit = 1 << 16});
  expect_refused("", Errc::out_of_memory,
                 [&] { (void)io::parse_gltf(std::as_bytes(std::span(text)), "a.gltf", reading); });
}

}  // namespace
}  // namespace rastrum::test::reading_test
