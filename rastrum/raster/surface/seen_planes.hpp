// SPDX-License-Identifier: BSD-3-Clause
// Lists the triangles that a block sees with the float64 planes of their weights, and interpolates
// many pixels by them. Outputs, numbers and wireframes use it. Operations and their order are those
// of interpolate.hpp and surface_scalars.cpp, so the bits are too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <rastrum/device.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/surface/seen_triangles.hpp>

namespace rastrum::raster {

/// WeightPlanes of several triangles, number by number: p[c] is kP + 3 c, and so on. A bin keeps
/// them in pairs, two numbers that follow each other.
template <std::size_t kCount>
struct PlaneTable {
  enum Number : std::size_t { kX0, kY0, kP, kQ, kR, kNumbers = kP + 9 };
  alignas(64) double number[kNumbers + 1][kCount];

  void set(std::size_t triangle, const WeightPlanes& w) {
    number[kX0][triangle] = w.x0;
    number[kY0][triangle] = w.y0;
    for (std::size_t c = 0; c < 3; ++c) {
      number[kP + 3 * c][triangle] = w.p[c];
      number[kQ + 3 * c][triangle] = w.q[c];
      number[kR + 3 * c][triangle] = w.r[c];
    }
  }
  [[nodiscard]] WeightPlanes at(std::size_t triangle) const {
    WeightPlanes w;
    w.x0 = number[kX0][triangle];
    w.y0 = number[kY0][triangle];
    for (std::size_t c = 0; c < 3; ++c) {
      w.p[c] = number[kP + 3 * c][triangle];
      w.q[c] = number[kQ + 3 * c][triangle];
      w.r[c] = number[kR + 3 * c][triangle];
    }
    return w;
  }
};

/// The different triangles of a block, with what interpolation by their corners begins from.
struct SeenPlanes : SeenTriangles {
  /// FrameGeometry::number of the frame whose triangles these are; 0: there are none yet. Blocks
  /// side by side mostly see the same ones, which are then set up once.
  std::uint64_t frame = 0;
  const Draw* draw[64];
  Draw::OfCopy part[64];        ///< the triangle of the draw's mesh, and which copy of the mesh
  std::uint32_t vertex[64][3];  ///< as Draw::vertices has them
  PlaneTable<64> planes;

  /// Triangle k and its vertices as those of its mesh; nothing else is set.
  [[nodiscard]] Fragment fragment(std::size_t k) const {
    Fragment f;
    f.id = kIdMask - low[k];
    f.triangle = part[k].primitive;
    for (std::size_t c = 0; c < 3; ++c)
      f.vertex[c] = vertex[k][c] - draw[k]->first_vertex_of(part[k].copy);
    return f;
  }
  /// The pixels of `among` that see triangles for which is(k) holds.
  template <class Is>
  [[nodiscard]] std::uint64_t pixels_where(std::uint64_t among, const Is& is) const {
    std::uint64_t triangles = 0, pixels = 0;
    for (std::size_t k = 0; k < count; ++k) triangles |= std::uint64_t{is(k)} << k;
    for (int i = 0; i < 64; ++i) pixels |= (triangles >> (place[i] & 63) & 1) << i;
    return pixels & among;
  }
};

/// A number for each pixel of a block, or for each triangle of SeenPlanes.
struct alignas(64) Numbers64 : std::array<double, 64> {};
using ByCorner = std::array<Numbers64, 3>;

/// Each sets the numbers of the pixels that it is asked for; others keep theirs or become anything.
struct SeenKernels {
  /// Finds the triangles of the covered pixels, whose draws must be triangles. `out` has those of
  /// another block, or none.
  void (*see)(const FrameGeometry& frame, const VisibleBlock& block, SeenPlanes& out) noexcept;
  /// shares_at at the covered pixels, of each corner.
  void (*shares)(const SeenPlanes& seen, const VisibleBlock& block, ByCorner& out) noexcept;
  /// The shares of corners 1 and 2 of all 64 pixels, rounded to float32.
  void (*barycentrics)(const ByCorner& shares, Vec2* out) noexcept;
  /// The places in the world at the pixels `mask`: `corner` has those of the corners in object
  /// space, by axis.
  void (*positions)(const SeenPlanes& seen, const ByCorner& shares, std::uint64_t mask,
                    const ByCorner (&corner)[3], const Mat4d& object_to_world, Vec3* out) noexcept;
  /// Interpolates the corners' numbers at the pixels `mask`; the result lies between them.
  void (*numbers)(const SeenPlanes& seen, const ByCorner& shares, std::uint64_t mask,
                  const ByCorner& corner, Numbers64& out) noexcept;
};
/// Null: that instruction set has none.
[[nodiscard]] const SeenKernels* seen_kernels(Isa isa) noexcept;

}  // namespace rastrum::raster
