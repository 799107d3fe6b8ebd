// SPDX-License-Identifier: BSD-3-Clause
// Procedural shapes, which the demo, the tests and the benchmarks draw without any file.
//
// All triangles face outward counter-clockwise. The shapes are the same on every machine. A
// parameter out of range throws Error{invalid_argument} that names it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/mesh.hpp>
#include <rastrum/scene.hpp>

namespace RASTRUM_API rastrum {
namespace shapes {

/// Newell's teapot: 32 bicubic Bézier patches, each tessellated n × n (2 n² triangles a patch),
/// with analytic normals and texture coordinates. The degenerate edges of lid and bottom stay
/// degenerate.
[[nodiscard]] Mesh teapot(int n = 16);
/// Latitude-longitude sphere of radius 1, closed: `rings` bands of `segments` quads, but of
/// triangles at the two poles; 2 (rings − 1) segments triangles.
[[nodiscard]] Mesh sphere(int rings = 32, int segments = 64);
/// Closed tube of radius `tube` around the (p, q) torus knot, p turns about the y axis and q
/// through the torus of radii 1 and 0.4: 2 segments · sides triangles. p and q have no common
/// divisor.
[[nodiscard]] Mesh torus_knot(int p = 2, int q = 3, int segments = 256, int sides = 24,
                              float tube = 0.25F);
/// `count`³ axis-aligned boxes of edge `fill` in a grid of unit cells about the origin: 12 count³
/// triangles, 8 count³ vertices.
[[nodiscard]] Mesh boxes(int count = 4, float fill = 0.6F);
/// `strands` crossing curves inside the unit ball as thin ribbons of `segments` quads: 2 · strands
/// · segments triangles. 22,500 × 64 gives the classic 2.9 M.
[[nodiscard]] Mesh hairball(int strands = 22500, int segments = 64, float width = 0.002F,
                            std::uint64_t seed = 1);
/// Gyroid isosurface in the cube [−1, 1]³ on a grid of `cells`³ over `periods` periods, by marching
/// cubes; vertices shared, closed but for the faces of the cube, analytic normals.
[[nodiscard]] Mesh gyroid(int cells = 64, float periods = 2);
/// Random triangles with edge lengths drawn from [min_size, max_size] in the cube [−1, 1]³, without
/// indices or attributes.
[[nodiscard]] Mesh soup(int count = 10000, float min_size = 0.01F, float max_size = 0.2F,
                        std::uint64_t seed = 1);

// Surfaces that are no meshes (surfaces.hpp), coloured by place.

/// Random spheres in the cube [−1, 1]³ with radii from [min_radius, max_radius]; small ones are
/// more frequent, so that each size covers as much.
[[nodiscard]] Spheres spheres(int count = 1000, float min_radius = 0.02F, float max_radius = 0.2F,
                              std::uint64_t seed = 1);
/// Random closed cones of `length` in the cube [−1, 1]³, with `radius` at one end and less at the
/// other.
[[nodiscard]] Cylinders cylinders(int count = 500, float length = 0.4F, float radius = 0.04F,
                                  std::uint64_t seed = 1);
/// A closed tube of one radius around the curve of `torus_knot`, made of `segments` segments.
[[nodiscard]] Tubes tube(int p = 2, int q = 3, int segments = 256, float radius = 0.15F);
/// Random discs, with places and radii as for `spheres`.
[[nodiscard]] Discs discs(int count = 1000, float min_radius = 0.02F, float max_radius = 0.2F,
                          std::uint64_t seed = 1);

/// Splits every triangle in 4 at the edge midpoints, `times` (0 to 16) times. Shared edges share
/// the new vertices. Triangle t becomes 4t … 4t + 3 (a corner each, then the middle). Attributes,
/// also those with indices of their own, are interpolated linearly.
/// Throws Error{out_of_memory} before the result is allocated if it would exceed 2³² vertices or
/// 5.7 · 10⁹ triangles, and Error{invalid_argument} for indices out of range.
/// Cost: a radix sort of the edges per step, about 0.1 µs per triangle of the result on one core.
[[nodiscard]] Mesh subdivide(const Mesh& mesh, int times);

/// A shape by its specification, as on the command line, as one instance: `teapot`,
/// `hairball?strands=100&width=0.01`. Throws Error{invalid_argument} that names the unknown shape
/// or parameter and lists the known ones.
[[nodiscard]] Scene scene_from_spec(std::string_view spec);
/// The mesh of scene_from_spec. Throws likewise, and for a shape that is no mesh.
[[nodiscard]] Mesh from_spec(std::string_view spec);

/// Name, parameters with their defaults and a line of description of a shape, for `--help`.
struct ShapeInfo {
  std::string name, parameters, description;
};
[[nodiscard]] std::vector<ShapeInfo> catalogue();

}  // namespace shapes
}  // namespace rastrum

// Pictures that stand in a scene: trees, signs, people as one quad with alpha.

namespace RASTRUM_API rastrum {

/// A picture (straight alpha) on a quad that is 1 high and has the picture's proportions. The
/// middle of its lower edge is at the origin, and it faces +z. It is seen from both sides, unlit
/// and blended by its alpha. Throws Error{invalid_argument} for an empty picture.
[[nodiscard]] Scene sprite(Image<Rgba8> picture);

}  // namespace rastrum
