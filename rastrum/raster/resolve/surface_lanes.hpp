// Weights and places of many pixels of triangles at once, by instruction set. The scalar form
// (shares_at, SurfaceScene) computes each in the same order, so the bits are the same.
#pragma once

#include <cstdint>

#include <rastrum/device.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/raster/draws/interpolate.hpp>

namespace rastrum::raster {

/// Pixels of a block, densely, whose triangles are of one instance.
struct alignas(64) SurfaceRun {
  /// The numbers read at each pixel. All are float64, since lanes gather them.
  struct Triangle {
    double x0, y0;  ///< of WeightPlanes, as what follows
    double r[3], p[3], q[3];
    double position[3][3];  ///< [corner][axis], in object space; set where places are asked for
  };
  static constexpr int kStride = sizeof(Triangle) / sizeof(double);

  /// Lanes are written eight at once, from any pixel on.
  static constexpr int kRoom = 64 + 8;

  const Triangle* triangles = nullptr;
  double x[kRoom], y[kRoom];  ///< centres of the pixels, px
  /// Where the numbers of a pixel's triangle begin among all numbers of `triangles`. Pixels of one
  /// triangle lie one after the other.
  std::int64_t place[kRoom];
  float b1[kRoom], b2[kRoom];
  Vec3 position[kRoom];
  const Mat4d* object_to_world = nullptr;  ///< null: no places
  int n = 0;                               ///< pixels, at most 64
};

/// Fills what is asked for of a run's pixels, n > 0.
using SurfaceLanes = void (*)(SurfaceRun& run) noexcept;
/// Null where there is none.
[[nodiscard]] SurfaceLanes surface_lanes(Isa isa) noexcept;

/// Which of the block's 64 keys are of primitive `id`.
using SameId = std::uint64_t (*)(const std::uint64_t* keys, std::uint64_t id) noexcept;
/// Null where surface_lanes() is.
[[nodiscard]] SameId same_id(Isa isa) noexcept;

}  // namespace rastrum::raster
