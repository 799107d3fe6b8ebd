// SPDX-License-Identifier: BSD-3-Clause
// Generated scenes: small, difficult and reproducible from a seed. Each kind aims at one rule of
// the picture; seeds cycle through the kinds.
#pragma once

#include <cstdint>
#include <deque>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::test {

struct GeneratedScene {
  std::string kind;
  Scene scene;
  Camera camera;

  /// Valid while the scene does not change.
  [[nodiscard]] SceneView view() const {
    if (!binding) binding.emplace(scene);
    return binding->view();
  }
  mutable std::optional<SceneBinding> binding{};
};

/// The number of kinds; `generate` draws kind seed % kSceneKinds.
extern const int kSceneKinds;

/// At most 200 triangles, for a `width` × `height` image.
[[nodiscard]] GeneratedScene generate(std::uint64_t seed, int width, int height);

/// A place on the screen and the distance along the view direction. Braces fix the order of
/// evaluation of members, unlike calls, so a seed gives the same scene with every compiler.
struct ScreenPoint {
  double x_px = 0, y_px = 0, w = 1;
};

/// Finds world points for places on the screen, in float64 and rounded once. So they are exact only
/// for the cameras that say so.
class Placer {
 public:
  Placer(const Camera& camera, int width, int height);
  /// The world point at that place.
  [[nodiscard]] Vec3 at(ScreenPoint p) const;

 private:
  Camera camera_;
  double width_, height_, scale_;  // scale: world units of a pixel (at w = 1 for perspective)
  Mat4d world_to_camera_;
};

/// An orthographic camera with world x = x_px − W/2, y = H/2 − y_px and z = depth, exact if W and H
/// are equal powers of two.
[[nodiscard]] Camera pixel_camera(int width, int height);
[[nodiscard]] Vec3 at_pixel(double x_px, double y_px, double depth, int width, int height);

inline void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

/// Calls f(a, b, c, d) with the vertex numbers of the corners of each cell of a columns × rows
/// grid, two of a row and two of the next. The first vertex has the number `first`.
template <class F>
void for_each_cell(int columns, int rows, std::uint32_t first, const F& f) {
  const auto pitch = static_cast<std::uint32_t>(columns) + 1;
  for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(rows); ++y)
    for (std::uint32_t x = 0; x + 1 < pitch; ++x) {
      const std::uint32_t a = first + y * pitch + x;
      f(a, a + 1, a + pitch, a + pitch + 1);
    }
}

/// The mesh with an index for each corner.
[[nodiscard]] Mesh indexed(Mesh mesh);

/// One mesh, one instance, identity.
[[nodiscard]] Scene single(Mesh mesh);

/// A scene with its view and a camera that sees all of it.
struct Fitted {
  const Scene scene;
  const SceneBinding binding{scene};
  const SceneView view = binding.view();
  const Camera camera;

  explicit Fitted(Scene s, float fov_rad = 1.0472F, bool orthographic = false)
      : scene(std::move(s)), camera(fit_camera(view, fov_rad, orthographic)) {}
  explicit Fitted(Mesh mesh, float fov_rad = 1.0472F) : Fitted(single(std::move(mesh)), fov_rad) {}
  Fitted(const Fitted&) = delete;  // the view refers to this object
  Fitted& operator=(const Fitted&) = delete;
};

/// A scene of one instance, which owns its geometry and whose look may change.
struct OneInstance : InstanceView {
  explicit OneInstance(GeometryView kept, const Mat4d& to_world = Mat4d::identity())
      : InstanceView{.object_to_world = to_world}, shape(std::move(kept)) {
    geometry = shape;
  }
  OneInstance(const OneInstance&) = delete;
  OneInstance& operator=(const OneInstance&) = delete;
  [[nodiscard]] SceneView view() const {
    return {.instances = {static_cast<const InstanceView*>(this), 1}};
  }
  void show(GeometryView other) {
    shape = std::move(other);
    geometry = shape;
  }
  GeometryView shape;
};

/// Instances together with their geometries.
struct KeptInstances : std::vector<InstanceView> {
  KeptInstances() = default;
  KeptInstances(std::initializer_list<GeometryView> all) {
    for (const GeometryView& shape : all) add(shape);
  }
  KeptInstances(KeptInstances&&) = default;
  KeptInstances& operator=(KeptInstances&&) = default;
  InstanceView& add(GeometryView shape, const Mat4d& to_world = Mat4d::identity()) {
    return emplace_back(InstanceView{shapes.emplace_back(std::move(shape)), to_world});
  }
  std::deque<GeometryView> shapes;
};

/// The unit square as two triangles.
inline const std::vector<Vec3> kSquare{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
inline const std::vector<std::uint32_t> kTwoTriangles{0, 1, 2, 0, 2, 3};

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
