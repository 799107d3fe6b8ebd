// Numbers of many fragments at once, and their colours, by instruction set: what the scalar form
// says of each (interpolate.hpp, surface_scalars.cpp, scalar_colors.cpp), in the same order, so the
// same bits.
#pragma once

#include <vector>

#include <rastrum/color_map.hpp>
#include <rastrum/device.hpp>
#include <rastrum/raster/draws/interpolate.hpp>

namespace rastrum::raster {

/// Fragments, densely, with what their triangles say of numbers.
struct alignas(64) ScalarRun {
  double dx[64], dy[64];  ///< from the origin of the planes, px
  double r[3][64], p[3][64], q[3][64], corner[3][64];
  double value[64];
  int n = 0;  ///< last, since lanes are loaded from aligned places

  /// A fragment at (x, y), px.
  void add(double x, double y, const WeightPlanes& w, const double (&corners)[3]) {
    dx[n] = x - w.x0;
    dy[n] = y - w.y0;
    for (int c = 0; c < 3; ++c) {
      r[c][n] = w.r[c];
      p[c][n] = w.p[c];
      q[c][n] = w.q[c];
      corner[c][n] = corners[c];
    }
    ++n;
  }
  /// Repeats the last up to a multiple of the lanes.
  void pad();
};

struct alignas(64) RunColors {
  float r[64], g[64], b[64], a[64];
};

/// A mapping whose colours are blended by a range, and nothing else.
class ScalarRamp {
 public:
  /// Whether `colors` is one.
  [[nodiscard]] static bool is_one(const ScalarColors& colors);
  explicit ScalarRamp(const ScalarColors& colors);

  double low, high, span;
  Vec4 below, above, nan;
  double last;                 ///< place of the last colour
  std::vector<double> colors;  ///< RGBA
};

struct ScalarLanes {
  void (*interpolate)(ScalarRun& run) noexcept = nullptr;
  void (*map)(const ScalarRamp& ramp, const ScalarRun& run, RunColors& colors) noexcept = nullptr;
};
/// Null where there are none.
[[nodiscard]] const ScalarLanes* scalar_lanes(Isa isa) noexcept;

}  // namespace rastrum::raster
