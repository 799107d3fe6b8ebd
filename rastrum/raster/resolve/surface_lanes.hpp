// Weights, places and normals of many pixels of triangles at once, by instruction set: what the
// scalar form says of each (shares_at, SurfaceScene), in the same order, so the same bits.
#pragma once

#include <cstdint>

#include <rastrum/device.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/raster/shade/interpolate.hpp>

namespace rastrum::raster {

struct SurfaceScene;

/// Pixels of a block, densely, whose triangles are of one instance.
struct alignas(64) SurfaceRun {
  /// What is read at each pixel; numbers of float64 alone, since lanes gather them.
  struct Triangle {
    double x0, y0;  ///< of WeightPlanes, as what follows
    double r[3], p[3], q[3];
    double normal[3][3];    ///< [corner][axis], in object space; set where normals are asked for
    double position[3][3];  ///< the same of places
  };
  static constexpr int kStride = sizeof(Triangle) / sizeof(double);

  Triangle triangles[64];
  double x[64], y[64];     ///< centres of the pixels, px
  std::int64_t place[64];  ///< of its triangle among all numbers of `triangles`
  float b1[64], b2[64];
  float position[3][64], normal[3][64], camera_normal[3][64];
  const float (*normal_matrix)[3] = nullptr;  ///< null: no normals
  const Mat4d* object_to_world = nullptr;     ///< null: no places
  const SurfaceScene* scene = nullptr;        ///< required for normals
  bool in_camera = false;                     ///< camera_normal, too
  int triangle_count = 0;
  int n = 0;  ///< pixels

  [[nodiscard]] bool is_full() const { return n == 64; }
  /// Of the pixel at (px, py) and of triangle `t`.
  void add(int px, int py, int t) {
    x[n] = px + 0.5;
    y[n] = py + 0.5;
    place[n++] = std::int64_t{t} * kStride;
  }
  Triangle& add_triangle(const WeightPlanes& w) {
    Triangle& t = triangles[triangle_count++];
    t.x0 = w.x0;
    t.y0 = w.y0;
    for (int c = 0; c < 3; ++c) {
      t.r[c] = w.r[c];
      t.p[c] = w.p[c];
      t.q[c] = w.q[c];
    }
    return t;
  }
  void clear() { triangle_count = n = 0; }
};

/// Fills what is asked for of a run's pixels, n > 0.
using SurfaceLanes = void (*)(SurfaceRun& run) noexcept;
/// Null where there is none.
[[nodiscard]] SurfaceLanes surface_lanes(Isa isa) noexcept;

}  // namespace rastrum::raster
