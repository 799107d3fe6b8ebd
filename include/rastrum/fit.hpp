// SPDX-License-Identifier: BSD-3-Clause
// Cameras from which a whole scene fills the picture: what `--fit` and `--turntable` take; and ways
// to look at it by name and angle.
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

/// Vertices that no SceneView holds: those of a file that is drawn out of core (out_of_core.hpp).
/// They come in runs, which are numbered in their order.
class FitVertices {
 public:
  /// The box of a run's finite vertices, in object space; min > max where there is none.
  struct Box {
    Vec3d min, max;
  };
  virtual ~FitVertices() = default;
  /// How many there are, the same each time.
  [[nodiscard]] virtual std::size_t runs() const = 0;
  /// None where the box is not known yet: then the run is read.
  [[nodiscard]] virtual std::optional<Box> box(std::size_t run) const = 0;
  [[nodiscard]] virtual const Mat4d& object_to_world(std::size_t run) const = 0;
  /// Calls f(i, vertices) for each of `runs`, which are in rising order, with the vertices in use
  /// of runs[i], in object space and in their order. One thread makes all calls for a run, one or
  /// several; other threads may serve other runs.
  virtual void read(std::span<const std::size_t> runs,
                    FunctionRef<void(std::size_t i, std::span<const Vec3d> vertices)> f) const = 0;
};

/// Ranks that each have a part of one scene (ranks.hpp). A fit with this reads the vertices of all,
/// in the order of ranks, and returns to each rank the camera of the whole scene, with the same
/// bits. All ranks call it with the same other arguments.
class FitRanks {
 public:
  virtual ~FitRanks() = default;
  /// Does this rank's own work. An exception on one rank is thrown on all.
  virtual void own(FunctionRef<void()> work) = 0;
  /// These numbers of all ranks, one rank's after the other's. All give equally many.
  [[nodiscard]] virtual std::vector<double> gather(std::span<const double> numbers) = 0;
  /// Vertices of this rank beside the instances of its scene; null: none.
  [[nodiscard]] virtual const FitVertices* beyond() const { return nullptr; }
};

/// How a scene is to fill a picture.
struct FitOptions {
  /// The share of the picture's width or height that it takes, in (0, 1].
  double fill = 0.95;
  /// For a scene that turns about the axis through the centre of its bounding box along the view's
  /// `up`: what it sweeps over fills the picture, so one camera serves every angle, and the scene
  /// keeps its size. The target lies on that axis.
  bool turns = false;
  /// Ranks that have the rest of the scene; null: there is none.
  FitRanks* ranks = nullptr;
};

/// The camera that sees the whole scene as large as a W × H picture can have it: it looks the way
/// `view` looks (from its eye to its target with its `up`, or as its matrix does), by its field of
/// view, or as a parallel projection where `view.orthographic`; its eye, target, planes and height
/// are found. The scene takes `fill` of the width or the height, whichever is full first. In the
/// other direction the margins are equal.
///
/// Perspective: the nearest eye for which all vertices in use lie between the four planes of a
/// frustum `fill` as wide as the picture's, found from the vertices that those planes touch first,
/// and at least r/20 before the nearest vertex, with r half the diagonal of the bounding box
/// (0 counts as 1). near = 0.99 of the distance to the nearest vertex, along the view axis; far
/// infinite. Orthographic: the least height that does the same; near and far are 1 % of r off the
/// nearest and the farthest vertex. The target lies straight ahead, as far as the box's centre.
///
/// A scene without vertices is a point at the origin. In float64 and in the order of vertices: the
/// same bits on every machine. fit_camera is the one around a sphere, for any shape of picture.
/// Cost: a few passes over the vertices, O(vertices + triangles).
/// Throws Error{invalid_argument} for a size below 1, a field of view outside of 0 to π, a `fill`
/// out of range, directions that world_to_camera refuses, an index out of range.
[[nodiscard]] Camera fit_picture(const SceneView& scene, const Camera& view, int width, int height,
                                 const FitOptions& options = {});

/// A ball around all that is drawn.
struct BoundingSphere {
  Vec3d centre;
  double radius = 1;
};
/// Around the centre of the box of the vertices in use, as far as the farthest of them (0 counts as
/// 1). O(vertices + triangles). Throws Error{invalid_argument} for an index out of range.
[[nodiscard]] BoundingSphere bounding_sphere(const SceneView& scene, FitRanks* ranks = nullptr);

/// A distance for the near plane that does not hide the target, for an eye anywhere, even inside
/// the scene: a thousandth of the scene's radius or of the distance to its centre, whichever is
/// more, but at most a hundredth of the distance to the target (`to_target`). With a much nearer
/// plane, large triangles that pass it would lose digits of depth.
[[nodiscard]] double nearest_plane(Vec3d eye, double to_target, const BoundingSphere& scene);

/// Sets the near plane of a camera, and the far plane of an orthographic one, by its place: with d
/// from the eye to the centre and r the radius, near = d − 1.001 r, but at least nearest_plane, and
/// far = d + 1.001 r. Leaves a camera with a matrix unchanged.
void place_planes(Camera& camera, const BoundingSphere& scene);

/// A way to look at something: along `direction`, with `up` upward in the picture, at right angles
/// and of unit length.
struct View {
  Vec3d direction{0, 0, -1};
  Vec3d up{0, 1, 0};
};

/// Where the eye stands. With +y up: front at +z, right at +x; another `up` turns these axes by the
/// shortest way from +y, so that with +z up (CAD) the front is at −y and right stays +x.
enum class ViewName : std::uint8_t { front, back, left, right, top, bottom, iso };
/// front, back, …, iso, in the order of the enum.
[[nodiscard]] std::vector<std::string_view> view_names();
/// `iso`: between front, right and top, so that the axes of a cube are equally long in the picture.
/// From above, back is up in the picture, from below front is. Throws Error{invalid_argument} for
/// an `up` without a direction.
[[nodiscard]] View view_of(ViewName name, Vec3d up = {0, 1, 0});

/// Degrees. First the eye goes `azimuth` around `up` (to the right), then `elevation` upward, at
/// most to where it looks straight down or up; at last the picture turns by `roll` about its
/// middle, counter-clockwise.
struct Turn {
  double azimuth_deg = 0, elevation_deg = 0, roll_deg = 0;
};
/// Throws Error{invalid_argument} for numbers that are not finite, and an elevation that leads
/// beyond straight down or up.
[[nodiscard]] View turned(const View& view, const Turn& by, Vec3d up = {0, 1, 0});

/// `camera` with a picture `times` as large: a narrower field of view, the eye where it is. Throws
/// Error{invalid_argument} unless `times` is > 0 and finite, and for a camera with a matrix.
[[nodiscard]] Camera zoomed(Camera camera, double times);

}  // namespace rastrum
