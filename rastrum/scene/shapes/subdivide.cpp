// SPDX-License-Identifier: BSD-3-Clause
// Splits every triangle in 4 at its edges' midpoints. Sorting the edges' vertex pairs finds shared
// edges and gives the order of new vertices.
//
// Attributes with their own indices have their own edges: a seam of texture coordinates stays one,
// although positions beside it are shared.

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/words.hpp>
#include <rastrum/scene/shapes/require.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::shapes {
namespace {

using Indices = std::vector<std::uint32_t>;

/// Side 3t + c of an index list runs from corner c of triangle t to the next corner.
struct Edges {
  parallel::Buffer<std::uint64_t> ends;  ///< smaller vertex << shift | larger vertex, ascending
  Indices of_side;                       ///< the edge of each side
  int shift = 0;

  [[nodiscard]] std::size_t first(std::size_t edge) const { return ends[edge] >> shift; }
  [[nodiscard]] std::size_t second(std::size_t edge) const {
    return ends[edge] & ((std::uint64_t{1} << shift) - 1);
  }
};

Edges find_edges(parallel::Threads& exec, const Indices& indices, std::size_t vertex_count) {
  const std::size_t sides = indices.size();
  Edges edges;
  if (sides == 0) return edges;
  edges.shift = std::max(1, static_cast<int>(std::bit_width(vertex_count - 1)));
  std::vector<std::uint64_t> keys(sides);
  Indices side(sides);
  parallel::tabulate(exec, keys, [&](std::size_t i) {
    const std::uint64_t a = indices[i], b = indices[i % 3 == 2 ? i - 2 : i + 1];
    return std::min(a, b) << edges.shift | std::max(a, b);
  });
  parallel::tabulate(exec, side, [](std::size_t i) { return static_cast<std::uint32_t>(i); });
  parallel::sort_by_key(exec, keys, side, 2 * edges.shift);

  const auto is_new = [&](std::size_t i) { return i == 0 || keys[i] != keys[i - 1]; };
  Indices number(sides);
  parallel::inclusive_scan(
      exec, parallel::Computed(sides, [&](std::size_t i) { return std::uint32_t{is_new(i)}; }),
      number, std::uint32_t{0});
  edges.of_side.resize(sides);
  parallel::scatter(exec, parallel::Computed(sides, [&](std::size_t i) { return number[i] - 1; }),
                    side, edges.of_side);
  edges.ends.resize(number.back());
  parallel::scatter_if(exec, keys,
                       parallel::Computed(sides, [&](std::size_t i) { return number[i] - 1; }),
                       parallel::Computed(sides, is_new), edges.ends);
  return edges;
}

/// Appends the midpoint of each edge. Halving before adding keeps it finite.
template <class T>
void add_midpoints(parallel::Threads& exec, std::vector<T>& values, const Edges& edges) {
  const std::size_t old = values.size();
  values.resize(old + edges.ends.size());
  parallel::tabulate(exec, std::span(values).subspan(old), [&](std::size_t e) {
    return values[edges.first(e)] * 0.5F + values[edges.second(e)] * 0.5F;
  });
}

/// 4t … 4t + 2 keep a corner each, 4t + 3 is the middle one.
Indices split(parallel::Threads& exec, const Indices& indices, const Edges& edges,
              std::size_t old_vertex_count) {
  Indices out(4 * indices.size());
  const auto first_new = static_cast<std::uint32_t>(old_vertex_count);
  parallel::for_each_block(
      exec, indices.size() / 3, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
          const std::uint32_t* corner = &indices[3 * t];
          const std::uint32_t* edge = &edges.of_side[3 * t];
          const std::uint32_t ab = first_new + edge[0], bc = first_new + edge[1],
                              ca = first_new + edge[2];
          const std::uint32_t four[12] = {corner[0], ab, ca,        ab, corner[1], bc,
                                          ca,        bc, corner[2], ab, bc,        ca};
          std::copy_n(four, 12, &out[12 * t]);
        }
      });
  return out;
}

[[noreturn]] void too_large(const Mesh& mesh, int times, const std::string& what) {
  throw Error(Errc::out_of_memory, "subdivide: " + std::to_string(mesh.triangle_count()) +
                                       " triangles split " + std::to_string(times) +
                                       " times would have " + what);
}

/// The vertices after `times` splits: V' = V + E, E' = 2 E + 3 T, T' = 4 T. An upper bound, exact
/// where no two triangles share more than one edge.
void require_numberable(const Mesh& mesh, int times, std::size_t vertices, std::size_t edges) {
  std::uint64_t v = vertices, e = edges, t = mesh.triangle_count();
  for (int k = 0; k < times; ++k) {
    v += e;
    e = 2 * e + 3 * t;
    t *= 4;
  }
  if (v > std::uint64_t{1} << 32)
    too_large(mesh, times, std::to_string(v) + " vertices, more than 2^32");
}

void require_indices(const Indices& indices, std::size_t size, const char* what) {
  for (const std::uint32_t i : indices)
    if (i >= size)
      throw Error(Errc::invalid_argument, std::string("subdivide: ") + what + " index " +
                                              std::to_string(i) + " but only " +
                                              std::to_string(size) + " values");
}

template <class F>
void for_each_attribute(Mesh& mesh, F&& f) {
  if (!mesh.normals.empty()) f(mesh.normals, "normal");
  if (!mesh.texcoords.empty()) f(mesh.texcoords, "texture coordinate");
  if (!mesh.colors.empty()) f(mesh.colors, "colour");
}

/// Makes explicit what a MeshView leaves open: every corner has a position index, and attributes
/// without indices are as many as positions.
void normalize_layout(Mesh& mesh) {
  const std::size_t corners = 3 * mesh.triangle_count();
  if (mesh.indices.empty()) {
    mesh.indices.resize(corners);
    std::iota(mesh.indices.begin(), mesh.indices.end(), 0U);
  }
  mesh.indices.resize(corners);
  require_indices(mesh.indices, mesh.positions.size(), "position");
  const auto require_all = [&](std::size_t size, std::size_t least, const char* what) {
    if (size < least)
      throw Error(Errc::invalid_argument, std::string("subdivide: only ") + std::to_string(size) +
                                              " " + what + ", needs " + std::to_string(least));
  };
  for_each_attribute(mesh, [&](auto& attribute, const char* what) {
    if (attribute.indices.empty()) {
      require_indices(mesh.indices, attribute.values.size(), what);
      attribute.values.resize(mesh.positions.size());
    } else {
      require_all(attribute.indices.size(), corners, what);
      attribute.indices.resize(corners);
      require_indices(attribute.indices, attribute.values.size(), what);
    }
  });
  for (NamedScalars& s : mesh.scalars) {
    const std::size_t count = s.per == Per::vertex   ? mesh.positions.size()
                              : s.per == Per::corner ? corners
                              : s.per == Per::face   ? corners / 3
                                                     : 1;
    require_all(s.values.size(), count, "scalars");
    s.values.resize(count);
  }
  if (mesh.face_materials.empty()) return;
  require_all(mesh.face_materials.size(), corners / 3, "face materials");
  mesh.face_materials.resize(corners / 3);
}

/// Four triangles keep their face's; corners blend as vertices do.
void split_scalars(parallel::Threads& exec, NamedScalars& s, const Edges& edges) {
  if (s.per == Per::vertex) {
    add_midpoints(exec, s.values, edges);
  } else if (s.per == Per::face) {
    std::vector<double> four(4 * s.values.size());
    parallel::tabulate(exec, four, [&](std::size_t i) { return s.values[i / 4]; });
    s.values = std::move(four);
  } else if (s.per == Per::corner) {
    std::vector<double> four(4 * s.values.size());
    parallel::for_each_block(
        exec, s.values.size() / 3, [&](std::size_t, std::size_t begin, std::size_t end) {
          for (std::size_t t = begin; t < end; ++t) {
            const double* v = &s.values[3 * t];
            const double ab = v[0] * 0.5 + v[1] * 0.5, bc = v[1] * 0.5 + v[2] * 0.5,
                         ca = v[2] * 0.5 + v[0] * 0.5;
            const double all[12] = {v[0], ab, ca, ab, v[1], bc, ca, bc, v[2], ab, bc, ca};
            std::copy_n(all, 12, &four[12 * t]);
          }
        });
    s.values = std::move(four);
  }
}

void split_once(parallel::Threads& exec, Mesh& mesh, int times_left) {
  const Edges edges = find_edges(exec, mesh.indices, mesh.positions.size());
  require_numberable(mesh, times_left, mesh.positions.size(), edges.ends.size());
  for_each_attribute(mesh, [&](auto& attribute, const char*) {
    if (attribute.indices.empty()) {
      add_midpoints(exec, attribute.values, edges);
      return;
    }
    const std::size_t old_size = attribute.values.size();
    const Edges own = find_edges(exec, attribute.indices, old_size);
    require_numberable(mesh, times_left, old_size, own.ends.size());
    add_midpoints(exec, attribute.values, own);
    attribute.indices = split(exec, attribute.indices, own, old_size);
  });
  for (NamedScalars& s : mesh.scalars) split_scalars(exec, s, edges);
  const std::size_t old_size = mesh.positions.size();
  add_midpoints(exec, mesh.positions, edges);
  if (!mesh.wide_positions.empty()) add_midpoints(exec, mesh.wide_positions, edges);
  mesh.indices = split(exec, mesh.indices, edges, old_size);
  Indices materials(4 * mesh.face_materials.size());
  parallel::tabulate(exec, materials, [&](std::size_t i) { return mesh.face_materials[i / 4]; });
  mesh.face_materials = std::move(materials);
}

}  // namespace

Mesh subdivide(const Mesh& mesh, int times) {
  const FloatScope floats;
  require_range("subdivide", "times", times, 0, 16);
  if (times == 0) return mesh;
  // 32 bits number the sides of the last split. This also keeps the arithmetic below 2⁶⁴.
  const double triangles = static_cast<double>(mesh.triangle_count()) * std::ldexp(1.0, 2 * times);
  if (triangles > 4.0 * 4294967295.0 / 3.0)
    too_large(mesh, times, "more than 5.7 billion triangles");
  try {
    Mesh out = mesh;
    normalize_layout(out);
    parallel::Threads exec;
    for (int k = 0; k < times; ++k) split_once(exec, out, times - k);
    return out;
  } catch (const std::bad_alloc&) {
    too_large(mesh, times, "more vertices and triangles than fit into memory");
  }
}

}  // namespace rastrum::shapes
