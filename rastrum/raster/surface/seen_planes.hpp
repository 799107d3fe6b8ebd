// The triangles that a block sees with the planes of their weights, and values that are
// interpolated by them, many pixels at once: what float64 weights are read for (outputs, numbers,
// wireframes). Operations and their order are those of interpolate.hpp and surface_scalars.cpp, so
// the bits are too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <rastrum/device.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/interpolate.hpp>

namespace rastrum::raster {

/// WeightPlanes of several triangles, number by number, in pairs that pixels look up together: p[c]
/// is kP + 3 c, and so on.
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

/// The different triangles of a block. One may be there twice.
struct SeenPlanes {
  std::size_t count = 0;
  std::uint64_t low[64];  ///< of their keys
  const Draw* draw[64];
  std::uint32_t vertex[64][3];  ///< as Draw::vertices has them
  PlaneTable<64> planes;
  /// The number of each covered pixel's triangle.
  alignas(64) std::uint8_t place[64];

  /// The number of triangle k in its draw.
  [[nodiscard]] std::uint64_t primitive(std::size_t k) const {
    return kIdMask - low[k] - draw[k]->first_id;
  }
  [[nodiscard]] std::uint64_t copy(std::size_t k) const {
    return draw[k]->of_copy(primitive(k)).copy;
  }
  /// Triangle k and its vertices as those of its mesh; nothing else is set.
  [[nodiscard]] Fragment fragment(std::size_t k) const {
    Fragment f;
    const Draw::OfCopy part = draw[k]->of_copy(primitive(k));
    f.id = kIdMask - low[k];
    f.triangle = part.primitive;
    for (std::size_t c = 0; c < 3; ++c)
      f.vertex[c] = vertex[k][c] - draw[k]->first_vertex_of(part.copy);
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

struct SeenKernels {
  /// Finds the triangles of the covered pixels, whose draws must be triangles.
  void (*see)(const FrameGeometry& frame, const VisibleBlock& block, SeenPlanes& out) noexcept;
  /// shares_at at the covered pixels, of each corner.
  void (*shares)(const SeenPlanes& seen, const VisibleBlock& block, ByCorner& out) noexcept;
  /// The shares of corners 1 and 2 of all 64 pixels, rounded to float32.
  void (*barycentrics)(const ByCorner& shares, Vec2* out) noexcept;
  /// The places in the world at the pixels `mask`: `corner` has those of the corners in object
  /// space, by axis.
  void (*positions)(const SeenPlanes& seen, const ByCorner& shares, std::uint64_t mask,
                    const ByCorner (&corner)[3], const Mat4d& object_to_world, Vec3* out) noexcept;
  /// Numbers at the pixels `mask`, no further than those of the corners (surface_scalars.cpp).
  void (*numbers)(const SeenPlanes& seen, const ByCorner& shares, std::uint64_t mask,
                  const ByCorner& corner, Numbers64& out) noexcept;
};
/// Null: that instruction set has none.
[[nodiscard]] const SeenKernels* seen_kernels(Isa isa) noexcept;

}  // namespace rastrum::raster
