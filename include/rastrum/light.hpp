// SPDX-License-Identifier: BSD-3-Clause
// Lights of a scene, as values. A frame without any is lit by the fixed light of its shader
// (docs/light_rules.md has the formulas, decision 0057 the reasons).
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

/// Light from everywhere, on every side of a surface alike.
struct AmbientLight {};
/// Light from all around: Light::color for a surface that faces `up`, `below` for one that faces
/// the opposite way, and linear between in the cosine of the angle to `up`.
struct HemisphereLight {
  Vec3 up{0, 1, 0};
  Vec3 below{};  ///< linear, as Light::color
};
/// Parallel light, from very far away.
struct DirectionalLight {
  Vec3 direction{0, 0, -1};
};
/// Light from a point, with intensity 1 / d² at distance d; a range multiplies this by max(min(1 −
/// (d / range)⁴, 1), 0), as glTF's KHR_lights_punctual.
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

/// Light from a picture of all that is around. Matt surfaces gather it; `material` mirrors it, too,
/// the more blurred the rougher a surface is. It casts no shadows.
struct EnvironmentLight {
  std::optional<Environment> picture;  ///< must be there
  Vec3 up{0, 1, 0};    ///< where the picture's top row is, by the shortest turn from +y
  float turn_rad = 0;  ///< before that a turn about +y, counter-clockwise seen from there
};

/// A light of Shader::classic, as in OpenGL's fixed pipeline. Colours are display values, each in
/// [0, 1e12]. It takes the place of Light::color and intensity, of a point's and spot's range and
/// of a spot's inner angle.
struct ClassicLight {
  Vec3 ambient{};          ///< reaches a surface from all sides
  Vec3 diffuse{1, 1, 1};   ///< reaches a surface that faces the light
  Vec3 specular{1, 1, 1};  ///< is mirrored
  /// A point or spot at distance d is divided by x + y d + z d². None is negative, one is not 0.
  Vec3 attenuation{1, 0, 0};
  float exponent = 0;  ///< of a spot, in [0, 128]: at angle a to its axis it has cosᵉ a
};

struct Light {
  std::variant<AmbientLight, HemisphereLight, DirectionalLight, PointLight, SpotLight,
               EnvironmentLight>
      kind = DirectionalLight{};
  Vec3 color{1, 1, 1};  ///< linear, each in [0, 1e12]
  /// How bright it makes a white, matt surface that faces it (a unit away, where it has a
  /// position): glTF's lux or candela divided by π; an environment is multiplied by it. In
  /// [0, 1e12].
  float intensity = 1;
  bool of_camera = false;     ///< moves with the camera: its vectors are in those axes
  bool casts_shadows = true;  ///< where FrameOptions::shadows asks for them
  /// Directional lights, points and spots may have it. None: Shader::classic takes the display
  /// value of `color`, cut at 1, times `intensity`, and no ambient light of it.
  std::optional<ClassicLight> classic{};
};

/// The most lights of a frame.
inline constexpr std::size_t kMaxLights = 256;

/// Throws Error{invalid_argument} that names the light by its number and what is out of range.
void check_lights(std::span<const Light> lights);

/// `light` moved: its position and directions, not its range and brightness. A light of the camera
/// stays as it is.
[[nodiscard]] Light placed(const Light& light, const Mat4d& to_world);

/// A directional light of the camera, along its axis.
[[nodiscard]] Light headlight(float intensity = 1);

/// Key, fill, back and head light of the camera, placed and weighed as VTK's vtkLightKit has them:
/// key 0.75 from 50° above and 10° to the right, fill a third of it from 75° below and 10° to the
/// left, two back lights of 1 / 3.5 of it at ±110°, head light a third of it. Their colours are the
/// kit's warmth 0.6, 0.4, 0.5 and 0.5. An ambient light of intensity `ambient` is the last.
[[nodiscard]] std::vector<Light> light_kit(float ambient = 0.05F);

}  // namespace rastrum
