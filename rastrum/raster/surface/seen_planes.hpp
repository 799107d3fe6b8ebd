// SPDX-License-Identifier: BSD-3-Clause
// Lists the triangles that a block sees with the float64 planes of their weights, and interpolates
// many pixels by them, for outputs, numbers and wireframes. Operations, order and bits are those of
// interpolate.hpp and surface_scalars.cpp.
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

/// WeightPlanes of several triangles, by number: p[c] is kP + 3 c, and so on. A bin stores two
/// consecutive numbers as a pair.
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

/// The different triangles of a block, with what interpolation needs.
struct SeenPlanes : SeenTriangles {
  /// FrameGeometry::number of these triangles' frame; 0: there are none. Neighbouring blocks mostly
  /// see the same triangles, which are then set up once.
  std::uint64_t frame = 0;
  const Draw* draw[64];
  Draw::OfCopy part[64];        ///< the triangle of the mesh, and which copy
  std::uint32_t vertex[64][3];  ///< as in Draw::vertices
  PlaneTable<64> planes;

  /// Triangle k and its vertices, numbered within its mesh; sets nothing else.
  [[nodiscard]] Fragment fragment(std::size_t k) const {
    Fragment f;
    f.id = kIdMask - low[k];
    f.triangle = part[k].primitive;
    for (std::size_t c = 0; c < 3; ++c)
      f.vertex[c] = vertex[k][c] - draw[k]->first_vertex_of(part[k].copy);
    return f;
  }
  /// The pixels of `among` whose triangles fulfil is(k).
  template <class Is>
  [[nodiscard]] std::uint64_t pixels_where(std::uint64_t among, const Is& is) const {
    std::uint64_t triangles = 0, pixels = 0;
    for (std::size_t k = 0; k < count; ++k) triangles |= std::uint64_t{is(k)} << k;
    for (int i = 0; i < 64; ++i) pixels |= (triangles >> (place[i] & 63) & 1) << i;
    return pixels & among;
  }
};

struct alignas(64) Numbers64 : std::array<double, 64> {};
using ByCorner = std::array<Numbers64, 3>;

/// Each sets numbers of the wanted pixels. Others are unchanged or undefined.
struct SeenKernels {
  /// Finds the triangles of the covered pixels, whose draws must be triangles. `out` has those of
  /// another block, or none.
  void (*see)(const FrameGeometry& frame, const VisibleBlock& block, SeenPlanes& out) noexcept;
  /// shares_at of each corner at the covered pixels.
  void (*shares)(const SeenPlanes& seen, const VisibleBlock& block, ByCorner& out) noexcept;
  /// The shares of corners 1 and 2 at all 64 pixels, as float32.
  void (*barycentrics)(const ByCorner& shares, Vec2* out) noexcept;
  /// World positions at the pixels `mask`. `corner`: object-space positions of the corners, by
  /// axis.
  void (*positions)(const SeenPlanes& seen, const ByCorner& shares, std::uint64_t mask,
                    const ByCorner (&corner)[3], const Mat4d& object_to_world, Vec3* out) noexcept;
  /// Interpolates the corners' numbers at the pixels `mask`. The result lies between them.
  void (*numbers)(const SeenPlanes& seen, const ByCorner& shares, std::uint64_t mask,
                  const ByCorner& corner, Numbers64& out) noexcept;
};
/// Null: the instruction set has none.
[[nodiscard]] const SeenKernels* seen_kernels(Isa isa) noexcept;

}  // namespace rastrum::raster
