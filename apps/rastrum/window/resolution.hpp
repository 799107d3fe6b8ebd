// SPDX-License-Identifier: BSD-3-Clause
// How many pixels to draw while the camera moves, from the times that frames took.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace rastrum::cli::window {

/// Steps of the side length of a picture. Few, so that a moving picture does not shimmer from one
/// size to the next.
inline constexpr std::array<double, 7> kScales = {1, 0.75, 0.5, 0.375, 0.25, 0.1875, 0.125};

/// A frame takes fixed + rate · pixels: triangles cost whatever the size is. Both are taken from
/// the newest times of two sizes; from one size alone all of it counts as pixels.
class Resolution {
 public:
  explicit Resolution(double target_ms) : target_ms_(target_ms) {}

  /// A frame at kScales[step] took `ms`.
  void add(std::size_t step, double ms);
  /// Something changed (options, size, scene), so that the times so far say nothing.
  void forget();
  void set_target(double ms) { target_ms_ = ms; }

  /// The step to draw the next moving frame at: the largest picture within the target, or, where
  /// the fixed part alone is beyond it, within a quarter more than the smallest would take, since
  /// fewer pixels would not help.
  [[nodiscard]] std::size_t moving_step() const;
  /// The step to draw at when the camera stands, `last` being what is shown: 0, or on the way to it
  /// where that would take seconds.
  [[nodiscard]] std::size_t still_step(std::size_t last) const;
  /// 0 where nothing is known.
  [[nodiscard]] double expected_ms(std::size_t step) const;

 private:
  double target_ms_;
  std::array<std::optional<double>, kScales.size()> ms_{};
  std::size_t newest_ = 0;
  std::optional<std::size_t> other_;  ///< the newest of another step than newest_
};

}  // namespace rastrum::cli::window
