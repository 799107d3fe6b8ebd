// SPDX-License-Identifier: BSD-3-Clause
// Lights of a scene, as values. A frame without any is lit as it always was: by the fixed light of
// its shader (docs/light_rules.md has the formulas, decision 0057 the reasons).
#pragma once

#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include <rastrum/environment.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

// Directions are those in which light travels, of any length but 0; positions are in world units.
// Lights of the camera (Light::of_camera) use its axes: x to the right, y up, z towards the viewer,
// from the eye.

/// From everywhere, on every side of a surface alike.
struct AmbientLight {};
/// From all around, by how far a direction leans to `up`: Light::color there, `below` opposite of
/// it, and linearly between them.
struct HemisphereLight {
  Vec3 up{0, 1, 0};
  Vec3 below{};  ///< linear, as Light::color
};
/// From so far away that it is parallel.
struct DirectionalLight {
  Vec3 direction{0, 0, -1};
};
/// Intensity at distance d: 1 / d², and with a range max(min(1 − (d / range)⁴, 1), 0) of it, as
/// glTF's KHR_lights_punctual.
struct PointLight {
  Vec3d position{};
  float range = std::numeric_limits<float>::infinity();  ///< > 0
};
/// A PointLight inside a cone: full at less than `inner_rad` from the axis, nothing beyond
/// `outer_rad`, between them as KHR_lights_punctual. 0 ≤ inner < outer ≤ π / 2.
struct SpotLight {
  Vec3d position{};
  Vec3 direction{0, 0, -1};
  float range = std::numeric_limits<float>::infinity();
  float inner_rad = 0, outer_rad = std::numbers::pi_v<float> / 4;
};

/// A picture of all that is around. Matt surfaces gather it; what `material` mirrors comes from it
/// as well, the wider the rougher. It casts no shadows.
struct EnvironmentLight {
  std::optional<Environment> picture;  ///< must be there
  Vec3 up{0, 1, 0};    ///< where the picture's top row is; what was at −z moves the shortest way
  float turn_rad = 0;  ///< about `up` before, counter-clockwise seen from there
};

struct Light {
  std::variant<AmbientLight, HemisphereLight, DirectionalLight, PointLight, SpotLight,
               EnvironmentLight>
      kind = DirectionalLight{};
  Vec3 color{1, 1, 1};  ///< linear, each ≥ 0
  /// How bright it makes a white, matt surface that faces it (a unit away, where it has a
  /// position): glTF's lux or candela divided by π; an environment is multiplied by it. In
  /// [0, 1e12].
  float intensity = 1;
  bool of_camera = false;  ///< moves with the camera: what is said of places is in its axes
};

/// At most so many a frame.
inline constexpr std::size_t kMaxLights = 256;

/// Throws Error{invalid_argument} that names the light by its number and what is out of range.
void check_lights(std::span<const Light> lights);

/// One that stands in the world, moved: its place and its directions, not its range and brightness.
[[nodiscard]] Light placed(const Light& light, const Mat4d& to_world);

/// A lamp at the viewer's forehead: directional, along the camera's axis.
[[nodiscard]] Light headlight(float intensity = 1);

/// Key, fill, back and head light of the camera, placed and weighed as VTK's vtkLightKit has them:
/// key 0.75 from 50° above and 10° to the right, fill a third of it from 75° below and 10° to the
/// left, two back lights at ±110°, 1 / 3.5 of it each, head light a third of it. Their colours are
/// the kit's warmth 0.6, 0.4, 0.5 and 0.5. With an ambient light of `ambient`.
[[nodiscard]] std::vector<Light> light_kit(float ambient = 0.05F);

}  // namespace rastrum
