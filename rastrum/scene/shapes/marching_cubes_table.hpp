// SPDX-License-Identifier: BSD-3-Clause
// The triangles of a cell, by which of its corners lie inside: derived, not typed.
//
// On each face of the cell a segment cuts off every run of inside corners, so those that meet only
// diagonally stay apart. The rule sees the face alone, so both its cells agree and the surface has
// no hole. Segments close to loops. A loop becomes the first fan whose diagonals leave the faces,
// so that none coincides with the neighbour's. Source: Lorensen and Cline, "Marching cubes", 1987;
// the ambiguity: Dürst, 1988.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace rastrum::shapes {

/// Corner c of a cell lies at bit 0 → x, bit 1 → y, bit 2 → z. Edge 4 a + k runs along axis a from
/// the corner whose other two coordinates, in the order of the axes, are the bits of k.
struct CellTriangles {
  std::int8_t count = 0;
  std::int8_t edge[5][3] = {};  ///< counter-clockwise as seen from outside
};

/// The corner where an edge starts, along its axis.
[[nodiscard]] constexpr int edge_start(int edge) {
  const int k = edge % 4;
  switch (edge / 4) {
    case 0:
      return k << 1;
    case 1:
      return (k & 1) | (k & 2) << 1;
    default:
      return k;
  }
}

namespace marching_cubes_detail {

/// Faces −x +x −y +y −z +z, counter-clockwise from outside the cell.
inline constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {5, 1, 3, 7}, {0, 1, 5, 4},
                                     {6, 7, 3, 2}, {1, 0, 2, 3}, {4, 5, 7, 6}};

/// The inverse of edge_start: the corners differ in one bit, and the other two are the edge's k.
constexpr int edge_between(int a, int b) {
  const int both = a & b;
  switch (a ^ b) {
    case 1:
      return both >> 1;
    case 2:
      return 4 + ((both & 1) | (both >> 1 & 2));
    default:
      return 8 + both;
  }
}

/// Bit f for each of the two faces of an edge.
constexpr std::array<unsigned, 12> faces_of_edges() {
  std::array<unsigned, 12> faces{};
  for (unsigned f = 0; f < 6; ++f)
    for (int i = 0; i < 4; ++i)
      faces[static_cast<std::size_t>(edge_between(kFaces[f][i], kFaces[f][(i + 1) % 4]))] |= 1U
                                                                                             << f;
  return faces;
}
inline constexpr std::array<unsigned, 12> kFacesOfEdges = faces_of_edges();

constexpr bool share_a_face(int edge_a, int edge_b) {
  return (kFacesOfEdges[static_cast<std::size_t>(edge_a)] &
          kFacesOfEdges[static_cast<std::size_t>(edge_b)]) != 0;
}

constexpr int fan_apex(const int* loop, int length) {
  for (int apex = 0; apex < length; ++apex) {
    bool inside = true;
    for (int k = 2; k + 1 < length; ++k)
      inside = inside && !share_a_face(loop[apex], loop[(apex + k) % length]);
    if (inside) return apex;
  }
  return -1;  // does not occur: indexing with it would not compile
}

/// `inside`: bit c for corner c.
constexpr CellTriangles triangulate(unsigned inside) {
  const auto is_inside = [&](int corner) { return (inside >> corner & 1U) != 0; };
  int next[12] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
  for (const auto& face : kFaces)
    for (int i = 0; i < 4; ++i) {
      if (is_inside(face[(i + 3) % 4]) || !is_inside(face[i])) continue;
      int last = i;
      while (is_inside(face[(last + 1) % 4])) ++last;
      next[edge_between(face[(i + 3) % 4], face[i])] =
          edge_between(face[last % 4], face[(last + 1) % 4]);
    }
  CellTriangles out;
  for (int first = 0; first < 12; ++first) {
    int loop[12] = {};
    int length = 0;
    for (int e = first; next[e] >= 0;) {
      loop[length++] = e;
      const int following = next[e];
      next[e] = -1;
      e = following;
    }
    if (length == 0) continue;
    const int apex = fan_apex(loop, length);
    for (int k = 1; k + 1 < length; ++k) {
      auto& triangle = out.edge[out.count++];
      triangle[0] = static_cast<std::int8_t>(loop[apex]);
      triangle[1] = static_cast<std::int8_t>(loop[(apex + k) % length]);
      triangle[2] = static_cast<std::int8_t>(loop[(apex + k + 1) % length]);
    }
  }
  return out;
}

constexpr std::array<CellTriangles, 256> make_table() {
  std::array<CellTriangles, 256> table{};
  for (unsigned inside = 0; inside < 256; ++inside) table[inside] = triangulate(inside);
  return table;
}

}  // namespace marching_cubes_detail

/// Indexed by the set of inside corners, bit c for corner c.
inline constexpr std::array<CellTriangles, 256> kMarchingCubes =
    marching_cubes_detail::make_table();

}  // namespace rastrum::shapes
