// Triangles of an NPY file, (n, 3, 3) or (n, 9): corners with equal position bits become one
// vertex, as those of STL do.
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/io/npy_header.hpp>
#include <rastrum/io/vertex_table.hpp>

namespace rastrum::io {
namespace {

template <class T>
float number_at(const std::byte* at) {
  std::array<std::byte, sizeof(T)> raw;
  for (std::size_t b = 0; b < sizeof(T); ++b)
    raw[b] = at[std::endian::native == std::endian::little ? b : sizeof(T) - 1 - b];
  return float32_of(double{std::bit_cast<T>(raw)});
}

template <class T>
Mesh read_triangles(const std::byte* at, std::size_t count) {
  Mesh mesh;
  mesh.indices.resize(count * 3);
  // A closed mesh has half as many vertices as triangles.
  mesh.positions.reserve(count / 2 + 3);
  VertexTable vertex(mesh.positions, count / 2);
  for (std::uint32_t& i : mesh.indices) {
    i = vertex({number_at<T>(at), number_at<T>(at + sizeof(T)), number_at<T>(at + 2 * sizeof(T))});
    at += 3 * sizeof(T);
  }
  return mesh;
}

}  // namespace

Scene parse_npy(Bytes bytes, const std::filesystem::path& file) {
  const std::string name = file.string();
  const NpyTriangles triangles = parse_npy_triangles(bytes, name);
  const std::byte* const at = bytes.data() + triangles.header.data;
  Scene scene = scene_of(triangles.wide ? read_triangles<double>(at, triangles.count)
                                        : read_triangles<float>(at, triangles.count));
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
