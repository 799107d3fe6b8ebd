// SPDX-License-Identifier: BSD-3-Clause
// Triangles of an NPY file, (n, 3, 3) or (n, 9). As in STL, corners with equal position bits become
// one vertex.
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/npy_header.hpp>
#include <rastrum/io/vertex_table.hpp>
#include <rastrum/io/wide_positions.hpp>

namespace rastrum::io {
namespace {

template <class T, class P>
Mesh read_triangles(const std::byte* at, std::size_t count, Budget& budget) {
  Mesh mesh;
  budget.resize(mesh.indices, count * 3);
  std::vector<P> positions;
  // A closed mesh has half as many vertices as triangles.
  VertexTable vertex(positions, count / 2 + 3, budget);
  for (std::uint32_t& i : mesh.indices) {
    const auto number = [&](std::size_t c) { return load_little_endian<T>(at + c * sizeof(T)); };
    if constexpr (std::is_same_v<P, Vec3d>)
      i = vertex({number(0), number(1), number(2)});
    else
      i = vertex({float32_of(number(0)), float32_of(number(1)), float32_of(number(2))});
    at += 3 * sizeof(T);
  }
  set_positions(mesh, std::move(positions), budget);
  return mesh;
}

Mesh read_triangles(const NpyTriangles& triangles, const std::byte* at, Budget& budget) {
  if (!triangles.wide) return read_triangles<float, Vec3>(at, triangles.count, budget);
  Mesh mesh = read_triangles<double, Vec3>(at, triangles.count, budget);
  if (triangles.header.keeps_float64 || lie_far(mesh.positions))
    mesh = read_triangles<double, Vec3d>(at, triangles.count, budget);
  return mesh;
}

}  // namespace

Scene parse_npy(Bytes bytes, const std::filesystem::path& file, Reading& reading) {
  const std::string name = file.string();
  const NpyTriangles triangles = parse_npy_triangles(bytes, name);
  const std::byte* const at = bytes.data() + triangles.header.data;
  Scene scene = scene_of(read_triangles(triangles, at, reading.budget));
  scene.meshes[0].name = file.stem().string();
  if (triangles.count == 0) scene.warnings.push_back(name + ": holds no triangles");
  const std::size_t rest =
      bytes.size() - triangles.header.data - triangles.count * triangles.bytes_each();
  if (rest != 0)
    scene.warnings.push_back(name + ": " + std::to_string(rest) +
                             " bytes behind the last triangle are left out");
  return scene;
}

}  // namespace rastrum::io
