// Generated scenes: small, nasty and reproducible from a seed. Each kind aims at one rule of the
// picture; the kinds take turns with the seed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <rastrum/camera.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::test {

struct GeneratedScene {
  std::string kind;
  Scene scene;
  Camera camera;

  /// While the scene stays as it is.
  [[nodiscard]] SceneView view() const {
    if (!binding) binding.emplace(scene);
    return binding->view();
  }
  mutable std::optional<SceneBinding> binding{};
};

/// How many kinds there are; `generate` draws kind seed % kSceneKinds.
extern const int kSceneKinds;

/// At most 200 triangles, to be seen in a `width` × `height` image.
[[nodiscard]] GeneratedScene generate(std::uint64_t seed, int width, int height);

/// A place on the screen and the distance from the eye along the view direction. Braces order the
/// evaluation of their members, which calls do not: so a seed means one scene with every compiler.
struct ScreenPoint {
  double x_px = 0, y_px = 0, w = 1;
};

/// Places world points where they are wanted on the screen. The points of a `Placer` go through
/// float64 and are rounded once, so they are exact only for the cameras that say so.
class Placer {
 public:
  Placer(const Camera& camera, int width, int height);
  /// The world point that is seen there.
  [[nodiscard]] Vec3 at(ScreenPoint p) const;

 private:
  Camera camera_;
  double width_, height_, scale_;  // scale: world units of a pixel (at w = 1 for perspective)
  Mat4d world_to_camera_;
};

/// An orthographic camera for which world x = x_px − W/2, y = H/2 − y_px and z = depth, exactly
/// where W and H are equal powers of two.
[[nodiscard]] Camera pixel_camera(int width, int height);
[[nodiscard]] Vec3 at_pixel(double x_px, double y_px, double depth, int width, int height);

/// One mesh, one instance, identity.
[[nodiscard]] Scene single(Mesh mesh);

/// Sees the unit square from (0, 0) to (1, 1) as the whole picture.
inline Camera square_camera() {
  return Camera{.eye = {0.5, 0.5, 1},
                .target = {0.5, 0.5, 0},
                .orthographic = true,
                .orthographic_height = 1,
                .near_plane = 0.1F,
                .far_plane = 2};
}

}  // namespace rastrum::test
