// SPDX-License-Identifier: BSD-3-Clause
// A grid of boxes: sharp edges, flat faces, many small occluders. Corners are shared by index (8
// per box, closed); normals and texture coordinates have their own indices.

#include <rastrum/core/float_scope.hpp>
#include <rastrum/scene/shapes/require.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::shapes {
namespace {

// Corner c of a box lies at bit 0 → x, bit 1 → y, bit 2 → z. Faces −x +x −y +y −z +z, each
// counter-clockwise from outside, from the face's lower left.
constexpr std::uint32_t kFaceCorners[6][4] = {{0, 4, 6, 2}, {5, 1, 3, 7}, {0, 1, 5, 4},
                                              {6, 7, 3, 2}, {1, 0, 2, 3}, {4, 5, 7, 6}};
constexpr Vec3 kFaceNormals[6] = {{-1, 0, 0}, {1, 0, 0},  {0, -1, 0},
                                  {0, 1, 0},  {0, 0, -1}, {0, 0, 1}};
constexpr Vec2 kFaceTexcoords[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
constexpr std::uint32_t kQuad[6] = {0, 1, 2, 0, 2, 3};

}  // namespace

Mesh boxes(int count, float fill) {
  const FloatScope floats;
  require_range("boxes", "count", count, 1, 812);  // 8 · 812³ < 2³²
  require_range("boxes", "fill", fill, 1e-3, 1);
  Mesh mesh;
  mesh.name = "boxes";
  const auto n = static_cast<std::size_t>(count);
  mesh.positions.reserve(8 * n * n * n);
  mesh.indices.reserve(36 * n * n * n);
  mesh.normals.values.assign(kFaceNormals, kFaceNormals + 6);
  mesh.normals.indices.reserve(36 * n * n * n);
  mesh.texcoords.values.assign(kFaceTexcoords, kFaceTexcoords + 4);
  mesh.texcoords.indices.reserve(36 * n * n * n);

  const double half = static_cast<double>(fill) / 2;
  const auto centre = [&](int cell) { return cell + 0.5 - count / 2.0; };
  for (int z = 0; z < count; ++z)
    for (int y = 0; y < count; ++y)
      for (int x = 0; x < count; ++x) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int c = 0; c < 8; ++c)
          mesh.positions.push_back({static_cast<float>(centre(x) + ((c & 1) != 0 ? half : -half)),
                                    static_cast<float>(centre(y) + ((c & 2) != 0 ? half : -half)),
                                    static_cast<float>(centre(z) + ((c & 4) != 0 ? half : -half))});
        for (std::uint32_t face = 0; face < 6; ++face)
          for (const std::uint32_t corner : kQuad) {
            mesh.indices.push_back(first + kFaceCorners[face][corner]);
            mesh.normals.indices.push_back(face);
            mesh.texcoords.indices.push_back(corner);
          }
      }
  return mesh;
}

}  // namespace rastrum::shapes
