// SPDX-License-Identifier: BSD-3-Clause
// The number of pixels while the camera moves, from the times of frames.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace rastrum::cli::window {

/// Side lengths of a picture. Few, so that a moving picture does not shimmer between sizes.
inline constexpr std::array<double, 7> kScales = {1, 0.75, 0.5, 0.375, 0.25, 0.1875, 0.125};

/// A frame takes fixed + rate · pixels, because triangles cost the same at any size. Both come from
/// the newest times of two sizes; with one size all counts as pixels.
class Resolution {
 public:
  explicit Resolution(double target_ms) : target_ms_(target_ms) {}

  void add(std::size_t step, double ms);
  /// After a change of options, size or scene.
  void forget();
  void set_target(double ms) { target_ms_ = ms; }

  /// The step of the next moving frame: the largest picture within the target or, if the fixed part
  /// exceeds it, within a quarter more than the smallest takes, because fewer pixels would not
  /// help.
  [[nodiscard]] std::size_t moving_step() const;
  /// The step when the camera stands and `last` is shown: 0, or a coarser one first if that would
  /// take seconds.
  [[nodiscard]] std::size_t still_step(std::size_t last) const;
  /// 0 if unknown.
  [[nodiscard]] double expected_ms(std::size_t step) const;

 private:
  double target_ms_;
  std::array<std::optional<double>, kScales.size()> ms_{};
  std::size_t newest_ = 0;
  std::optional<std::size_t> other_;  ///< the newest time of another step than newest_
};

}  // namespace rastrum::cli::window
