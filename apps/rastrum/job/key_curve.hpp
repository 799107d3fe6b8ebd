// SPDX-License-Identifier: BSD-3-Clause
// Numbers that change with time, given at keys.
#pragma once

#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace rastrum::cli {

enum class Interpolation {
  smooth,  ///< cubic Hermite, continuous velocity
  linear,
};

/// The velocity at a key of a smooth curve.
enum class Tangent {
  /// The slope of the parabola through the key and its neighbours (Catmull-Rom at even times):
  /// round, but may leave the keys' range.
  curve,
  /// Fritsch and Butland's harmonic mean (SIAM J. Sci. Stat. Comput. 5, 1984): never leaves the
  /// range of the two keys, for bounded values such as a field of view.
  monotone,
};

/// Constant before the first time and after the last. O(log keys) per value.
class KeyCurve {
 public:
  /// Requires times increasing, as many values as times, at least one.
  KeyCurve(std::span<const double> times, std::vector<double> values, Interpolation interpolation,
           Tangent tangent);
  /// Exact at keys.
  [[nodiscard]] double at(double time) const;

 private:
  std::vector<double> times_, values_;
  std::vector<double> velocities_;  ///< per key; empty: linear
};

template <class Camera>
struct PathColumn {
  double (*get)(const Camera&);
  void (*set)(Camera&, double);
  Tangent tangent;
};

/// A camera that moves through keys, which have `time_s` and `camera`. The first key gives what the
/// columns leave out, and what is not finite.
template <class Key>
class KeyedPath {
 public:
  using Camera = decltype(Key::camera);

  /// Requires at least one key, times increasing. `columns` must outlive the path.
  KeyedPath(std::vector<Key> keys, Interpolation interpolation,
            std::span<const PathColumn<Camera>> columns)
      : keys_(std::move(keys)), columns_(columns) {
    assert(!keys_.empty());
    std::vector<double> times;
    for (const Key& key : keys_) times.push_back(key.time_s);
    for (const PathColumn<Camera>& column : columns_) {
      std::vector<double> values;
      for (const Key& key : keys_) {
        const double value = column.get(key.camera);
        values.push_back(std::isfinite(value) ? value : 0);
      }
      curves_.emplace_back(times, std::move(values), interpolation, column.tangent);
    }
  }

  [[nodiscard]] const Key& first() const { return keys_.front(); }
  [[nodiscard]] double first_s() const { return first().time_s; }
  [[nodiscard]] double last_s() const { return keys_.back().time_s; }
  /// Exact at keys; the first camera before them, the last one after.
  [[nodiscard]] Camera at(double time_s) const {
    Camera camera = first().camera;
    for (std::size_t i = 0; i < curves_.size(); ++i)
      if (std::isfinite(columns_[i].get(camera))) columns_[i].set(camera, curves_[i].at(time_s));
    return camera;
  }

 private:
  std::vector<Key> keys_;
  std::span<const PathColumn<Camera>> columns_;
  std::vector<KeyCurve> curves_;
};

}  // namespace rastrum::cli
