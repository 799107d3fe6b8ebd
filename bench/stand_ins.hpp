// SPDX-License-Identifier: BSD-3-Clause
// Meshes with the triangle counts and picture sizes of the papers' models, which we may not
// redistribute, and the scenes that the papers describe in words.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/camera.hpp>
#include <rastrum/mesh.hpp>

namespace rastrum::bench {

/// A closed, wavy ball around the origin with exactly `triangles` (≥ 8) triangles; an odd number
/// leaves a hole of one. `stretch` widens it along x. Several `shells` are nested, the largest
/// first, and each adds 2 to the depth complexity.
[[nodiscard]] Mesh ball(std::size_t triangles, float stretch = 1, int shells = 1);

/// `mesh` with exactly `triangles` (≥ 8), order kept: subdivides until there are enough, decimates
/// by clustering vertices in a grid, then splits single triangles at their centroids. Throws
/// Error{invalid_argument} for a mesh that collapses.
[[nodiscard]] Mesh with_triangles(Mesh mesh, std::size_t triangles);

/// The first `share` of the triangles, all vertices kept.
[[nodiscard]] MeshView first_part(const Mesh& mesh, double share);

/// The default camera of one mesh.
[[nodiscard]] Camera whole_view(const Mesh& mesh);

/// Part `k` of `n` of `mesh` subdivided `times` times. The parts' triangles in order are those of
/// shapes::subdivide, bit for bit, so a mesh larger than memory can be drawn in passes. Each part
/// has its own copy of shared vertices.
[[nodiscard]] Mesh subdivided_part(const Mesh& mesh, int times, std::size_t k, std::size_t n);

/// A camera on the default one's axis from which `mesh` has about `fragments` covered samples at
/// width × height, found by bisection over the distance. `found` is the actual number.
struct FragmentMatch {
  Camera camera;
  std::uint64_t found = 0;
};
[[nodiscard]] FragmentMatch match_fragments(const Mesh& mesh, int width, int height,
                                            std::uint64_t fragments, int threads);

/// `count` random triangles in a width × height picture, each with an area of `least` to `most` px,
/// at random depths; for `window_camera`. `most` is limited to what fits the picture.
[[nodiscard]] Mesh sized_triangles(int width, int height, int count, double least, double most,
                                   std::uint64_t seed);

enum class Order { front_to_back, random, back_to_front };
[[nodiscard]] const char* name(Order order);

/// `layers` wavy sheets of cells² quads each, one behind the other. They fill a width × height
/// picture, so the depth complexity is `layers` everywhere. For `window_camera`. `random` shuffles
/// all triangles.
[[nodiscard]] Mesh sheets(int width, int height, int layers, int cells, Order order);

}  // namespace rastrum::bench
