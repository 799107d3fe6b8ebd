// SPDX-License-Identifier: BSD-3-Clause
// Cameras from which a whole scene fills the picture, as with `--fit` and `--turntable`, and views
// by name and angle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <rastrum/function.hpp>
#include <rastrum/scene.hpp>

namespace RASTRUM_API rastrum {

/// Vertices that no SceneView holds, such as those of a file that is drawn out of core
/// (out_of_core.hpp). They come in runs, which are numbered in their order.
class FitVertices {
 public:
  /// The box of a run's finite vertices, in object space; min > max where there is none.
  struct Box {
    Vec3d min, max;
  };
  virtual ~FitVertices() = default;
  /// The number of runs, the same at each call.
  [[nodiscard]] virtual std::size_t runs() const = 0;
  /// The box of a run; none if it is not known yet, and then the run is read.
  [[nodiscard]] virtual std::optional<Box> box(std::size_t run) const = 0;
  [[nodiscard]] virtual const Mat4d& object_to_world(std::size_t run) const = 0;
  /// Calls f(i, vertices) for each of `runs`, which are in rising order, with the vertices in use
  /// of runs[i], in object space and in their order. One thread makes all calls for a run, one or
  /// several; other threads may serve other runs.
  virtual void read(std::span<const std::size_t> runs,
                    FunctionRef<void(std::size_t i, std::span<const Vec3d> vertices)> f) const = 0;
};

/// Joins ranks that each have a part of one scene (ranks.hpp). A fit with this reads the vertices
/// of all, in the order of ranks, and returns to each the camera of the whole scene, with the same
/// bits. All ranks must call it with the same other arguments.
class FitRanks {
 public:
  virtual ~FitRanks() = default;
  /// Calls `work`, this rank's own. An exception on one rank is thrown on all.
  virtual void own(FunctionRef<void()> work) = 0;
  /// Returns the numbers of all ranks, in the order of ranks. All must give equally many.
  [[nodiscard]] virtual std::vector<double> gather(std::span<const double> numbers) = 0;
  /// Vertices of this rank beside the instances of its scene; null: none.
  [[nodiscard]] virtual const FitVertices* beyond() const { return nullptr; }
};

/// How a scene is to fill a picture.
struct FitOptions {
  /// The share of the picture's width or height that the scene takes, in (0, 1].
  double fill = 0.95;
  /// Whether the scene is to turn about the axis through the centre of its bounding box along the
  /// view's `up`. The space that it sweeps then fills the picture, so one camera serves every angle
  /// and the scene keeps its size. The target lies on that axis.
  bool turns = false;
  /// Ranks that have the rest of the scene; null: there is none.
  FitRanks* ranks = nullptr;
};

/// The camera that sees the whole scene as large as a W × H picture can have it. It looks the way
/// `view` looks (from its eye to its target with its `up`, or as its matrix does), with its field
/// of view, or as a parallel projection if `view.orthographic`. Eye, target, planes and
/// orthographic height are found. The scene takes `fill` of the width or the height, whichever is
/// full first. In the other direction the margins are equal.
///
/// Perspective: the eye is the nearest one that has all vertices in use between the four planes of
/// a frustum `fill` as wide as the picture's, found from the vertices that those planes touch
/// first. It stays at least r/20 before the nearest vertex, with r half the diagonal of the
/// bounding box (0 counts as 1). near is 0.99 of the distance to the nearest vertex, along the view
/// axis; far is infinite. Orthographic: the height is the least that does the same; near and far
/// are 1 % of r off the nearest and the farthest vertex. The target lies straight ahead, as far as
/// the box's centre.
///
/// A scene without vertices is a point at the origin. All is in float64 and in the order of
/// vertices, so the bits are the same on every machine. fit_camera (scene.hpp) fits a sphere
/// instead, for any shape of picture. Cost: a few passes over the vertices, O(vertices +
/// triangles).
/// Throws Error{invalid_argument} for a size below 1, a field of view outside of 0 to π, a `fill`
/// out of range, directions that world_to_camera refuses, an index out of range.
[[nodiscard]] Camera fit_picture(const SceneView& scene, const Camera& view, int width, int height,
                                 const FitOptions& options = {});

/// A sphere around all that is drawn.
struct BoundingSphere {
  Vec3d centre;
  double radius = 1;
};
/// The sphere around the centre of the box of the vertices in use, as far as the farthest (0 counts
/// as 1). O(vertices + triangles). Throws Error{invalid_argument} for an index out of range.
[[nodiscard]] BoundingSphere bounding_sphere(const SceneView& scene, FitRanks* ranks = nullptr);

/// A near plane that does not cut off the target, for an eye anywhere, even inside the scene: a
/// thousandth of the scene's radius or of the distance to its centre, whichever is more, but at
/// most a hundredth of the distance to the target (`to_target`). With a much nearer plane, large
/// triangles that cross it would lose digits of depth.
[[nodiscard]] double nearest_plane(Vec3d eye, double to_target, const BoundingSphere& scene);

/// Sets the near plane of a camera, and the far plane of an orthographic one, around the sphere.
/// With d the distance from the eye to the centre and r the radius, near = d − 1.001 r, but at
/// least nearest_plane(), and far = d + 1.001 r. Leaves a camera with a matrix unchanged.
void place_planes(Camera& camera, const BoundingSphere& scene);

/// A way to look at a scene: along `direction`, with `up` upward in the picture. Both are of unit
/// length and perpendicular to each other.
struct View {
  Vec3d direction{0, 0, -1};
  Vec3d up{0, 1, 0};
};

/// The side on which the eye stands. With +y up, front is at +z and right at +x. Another `up` turns
/// these axes by the shortest way from +y: with +z up (CAD) front is at −y, and right stays +x.
enum class ViewName : std::uint8_t { front, back, left, right, top, bottom, iso };
/// The names front, back, …, iso, in the order of the enum.
[[nodiscard]] std::vector<std::string_view> view_names();
/// The view from that side. `iso` lies between front, right and top, so that the axes of a cube are
/// equally long in the picture. In `top` the back is up in the picture, in `bottom` the front.
/// Throws Error{invalid_argument} for an `up` without a direction.
[[nodiscard]] View view_of(ViewName name, Vec3d up = {0, 1, 0});

/// Angles in degrees. First the eye goes `azimuth` around `up` (to the right), then `elevation`
/// upward, at most to where it looks straight down or up. Last the picture turns by `roll` about
/// its middle, counter-clockwise.
struct Turn {
  double azimuth_deg = 0, elevation_deg = 0, roll_deg = 0;
};
/// `view` turned so. Throws Error{invalid_argument} for angles that are not finite, an elevation
/// that leads beyond straight down or up, and an `up` without a direction.
[[nodiscard]] View turned(const View& view, const Turn& by, Vec3d up = {0, 1, 0});

/// `camera` with a picture `times` as large: a narrower field of view (or height), the eye where it
/// is. Throws Error{invalid_argument} unless `times` is > 0 and finite, for a field of view out of
/// range, and for a camera with a matrix.
[[nodiscard]] Camera zoomed(Camera camera, double times);

}  // namespace rastrum
