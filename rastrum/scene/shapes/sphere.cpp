// SPDX-License-Identifier: BSD-3-Clause
// Latitude-longitude sphere. Positions are shared across the seam and at the poles, so the mesh is
// closed by index. Texture coordinates jump there and have their own indices.

#include <numbers>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/scene/shapes/require.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::shapes {

Mesh sphere(int rings, int segments) {
  const FloatScope floats;
  require_range("sphere", "rings", rings, 2, 32768);
  require_range("sphere", "segments", segments, 3, 65536);
  require_size("sphere", "rings and segments", (rings + 1.0) * (segments + 1.0));
  const auto r = static_cast<std::uint32_t>(rings);
  const auto s = static_cast<std::uint32_t>(segments);

  std::vector<elementary::SinCos> azimuths(s);
  for (std::uint32_t j = 0; j < s; ++j)
    azimuths[j] = elementary::sin_cos(2 * std::numbers::pi * j / s);

  Mesh mesh;
  mesh.name = "sphere";
  mesh.positions.reserve(std::size_t{r - 1} * s + 2);
  mesh.positions.push_back({0, 1, 0});
  for (std::uint32_t i = 1; i < r; ++i) {
    const elementary::SinCos polar = elementary::sin_cos(std::numbers::pi * i / r);
    for (std::uint32_t j = 0; j < s; ++j)
      mesh.positions.push_back({static_cast<float>(polar.sin * azimuths[j].sin),
                                static_cast<float>(polar.cos),
                                static_cast<float>(polar.sin * azimuths[j].cos)});
  }
  mesh.positions.push_back({0, -1, 0});
  mesh.normals.values = mesh.positions;

  mesh.texcoords.values.reserve(std::size_t{r + 1} * (s + 1));
  for (std::uint32_t i = 0; i <= r; ++i)
    for (std::uint32_t j = 0; j <= s; ++j)
      mesh.texcoords.values.push_back(
          {static_cast<float>(double{1} * j / s), static_cast<float>(double{1} * i / r)});

  const auto position = [&](std::uint32_t i, std::uint32_t j) {
    if (i == 0) return std::uint32_t{0};
    if (i == r) return (r - 1) * s + 1;
    return (i - 1) * s + j % s + 1;
  };
  const std::size_t triangles = 2 * std::size_t{r - 1} * s;
  mesh.indices.reserve(3 * triangles);
  mesh.texcoords.indices.reserve(3 * triangles);
  const auto corner = [&](std::uint32_t i, std::uint32_t j) {
    mesh.indices.push_back(position(i, j));
    mesh.texcoords.indices.push_back(i * (s + 1) + j);
  };
  for (std::uint32_t i = 0; i < r; ++i)
    for (std::uint32_t j = 0; j < s; ++j) {
      if (i + 1 < r) {
        corner(i, j);
        corner(i + 1, j);
        corner(i + 1, j + 1);
      }
      if (i > 0) {
        corner(i, j);
        corner(i + 1, j + 1);
        corner(i, j + 1);
      }
    }
  return mesh;
}

}  // namespace rastrum::shapes
