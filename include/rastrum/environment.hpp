// SPDX-License-Identifier: BSD-3-Clause
// The surroundings of a scene: a picture of all directions, which is made into a light once and
// used by any number of frames (docs/light.md, "Environments"; decision 0061).
#pragma once

#include <rastrum/held.hpp>
#include <rastrum/image.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

namespace environment_detail {
struct RASTRUM_INSIDE Data;
}

/// Immutable; copies share what they hold, and a move is a copy.
class Environment {
 public:
  Environment(const Environment&) = default;
  Environment& operator=(const Environment&) = default;
  /// `picture`: linear radiance over all directions, equirectangular, twice as wide as high. Its
  /// top row is straight up (+y), its middle lies at −z, and +x is right of that. So a camera that
  /// looks along −z sees the middle ahead, not mirrored. `threads` 0: all of the machine. Throws
  /// Error{invalid_argument} for another shape, and for the first pixel with a value outside [0,
  /// 1e12]. Cost: O(pixels), and about 0.3 s of one core for the reflections of rough surfaces; 16
  /// B · min(height, 2048)² of memory.
  explicit Environment(ImageView<const Vec3> picture, int threads = 0);

  /// The mean of `picture` over all directions.
  [[nodiscard]] Vec3 mean() const;
  [[nodiscard]] const environment_detail::Data& data() const { return *data_; }

 private:
  Shared<const environment_detail::Data> data_;
};

/// Built-in pictures of 1024 × 512 pixels, for those who have none at hand.
enum class BuiltinEnvironment {
  sky,   ///< a clear sky over grey ground, with a sun from the upper right
  room,  ///< a grey room whose ceiling and walls have lamps: soft light with shape
};
[[nodiscard]] Image<Vec3> builtin_environment(BuiltinEnvironment which);

}  // namespace rastrum
