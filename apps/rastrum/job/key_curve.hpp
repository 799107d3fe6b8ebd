// Numbers that change with time, given at keys: what camera paths interpolate.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace rastrum::cli {

enum class Interpolation {
  smooth,  ///< cubic Hermite, continuous velocity
  linear,
};

/// How the velocity at a key is chosen in the smooth form.
enum class Tangent {
  /// The slope of the parabola through the key and its neighbours (Catmull-Rom where times are
  /// even): rounds a path off, may go beyond the keys' range.
  curve,
  /// Fritsch and Butland's harmonic mean (SIAM J. Sci. Stat. Comput. 5, 1984): never leaves the
  /// range of the two keys, for what has bounds, such as a field of view.
  monotone,
};

/// One number at increasing times. Outside them it stays what it is at the first and the last.
/// O(log keys) a value.
class KeyCurve {
 public:
  /// Requires times increasing, as many values as times, at least one.
  KeyCurve(std::span<const double> times, std::vector<double> values, Interpolation interpolation,
           Tangent tangent);
  /// At a key's time exactly the key's value.
  [[nodiscard]] double at(double time) const;

 private:
  std::vector<double> times_, values_;
  std::vector<double> velocities_;  ///< a key; empty: linear
};

}  // namespace rastrum::cli
