// SPDX-License-Identifier: BSD-3-Clause
// Meshes that stand in for the papers' models, which are not ours to ship: the same number of
// triangles, the same size in the picture. And the scenes the papers describe in words.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/camera.hpp>
#include <rastrum/mesh.hpp>

namespace rastrum::bench {

/// A closed, wavy ball about the origin with exactly `triangles` (≥ 8) triangles; an odd number
/// leaves a hole of one. `stretch` widens it along x. More than one of `shells` are nested, the
/// largest first, which multiplies the depth complexity (2 a shell).
[[nodiscard]] Mesh ball(std::size_t triangles, float stretch = 1, int shells = 1);

/// `mesh` with exactly `triangles` (≥ 8): subdivided until there are enough, then decimated by
/// clustering vertices in a grid, then filled up by splitting single triangles at their centroids.
/// Order is kept. Throws Error{invalid_argument} for a mesh that collapses.
[[nodiscard]] Mesh with_triangles(Mesh mesh, std::size_t triangles);

/// The first `share` of the triangles, all vertices kept.
[[nodiscard]] MeshView first_part(const Mesh& mesh, double share);

/// The default camera of one mesh.
[[nodiscard]] Camera whole_view(const Mesh& mesh);

/// Part `k` of `n` of `mesh` subdivided `times` times, in order: the parts' triangles one after the
/// other are those of shapes::subdivide, bit for bit, so that a mesh that does not fit into memory
/// can be drawn in passes. Vertices that parts share are in both.
[[nodiscard]] Mesh subdivided_part(const Mesh& mesh, int times, std::size_t k, std::size_t n);

/// A camera on the default one's axis from which `mesh` has about `fragments` covered samples at
/// width × height, found by bisection over the distance; what it has in the end is in `found`.
struct FragmentMatch {
  Camera camera;
  std::uint64_t found = 0;
};
[[nodiscard]] FragmentMatch match_fragments(const Mesh& mesh, int width, int height,
                                            std::uint64_t fragments, int threads);

/// `count` random triangles of a width × height picture, each of `least` to `most` px of area, in
/// random depths; seen by `window_camera`. `most` is cut to what fits the picture.
[[nodiscard]] Mesh sized_triangles(int width, int height, int count, double least, double most,
                                   std::uint64_t seed);

enum class Order { front_to_back, random, back_to_front };
[[nodiscard]] const char* name(Order order);

/// `layers` wavy sheets of cells² quads each, one behind the other, that fill a width × height
/// picture: the depth complexity is `layers` everywhere. Seen by `window_camera`. In `random`
/// order all triangles are shuffled.
[[nodiscard]] Mesh sheets(int width, int height, int layers, int cells, Order order);

}  // namespace rastrum::bench
