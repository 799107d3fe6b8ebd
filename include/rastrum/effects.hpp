// SPDX-License-Identifier: BSD-3-Clause
// Effects over a finished picture, from its depth, normals and ids: ambient occlusion, eye-dome
// lighting, silhouettes, the edges of meshes (docs/overlay.md has the formulas, decision 0051 the
// reasons).
//
// Each makes an image of factors in [0, 1], 1 where it leaves the picture as it is and where
// nothing is drawn; darken() brings them into colours. With several samples a pixel the depth and
// the normals are those of the nearest surface, as Targets has them. The same bits for every number
// of threads and instruction set.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/device.hpp>
#include <rastrum/held.hpp>
#include <rastrum/image.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

/// How much of the light from all around reaches a point: McGuire, Mara and Luebke, Scalable
/// Ambient Obscurance (HPG 2012), with a fixed pattern of samples.
struct AmbientOcclusion {
  double radius = 0;    ///< in the world, of what takes light from a point; 1e-37 to 1e37
  double strength = 1;  ///< [0, 16]
  int samples =
      8;  ///< a pixel, 1 to 64; the blur spans 4 × 4 pixels, so that many times as many count
};

/// Shades each pixel by how far it lies behind those around (Boucheny 2009): shape for points,
/// which have no normals.
struct EyeDome {
  double strength = 1;  ///< [0, 100]
  int radius_px = 2;    ///< 1 to 64
};

struct Silhouettes {
  double depth = 0.01;        ///< a step of more than this part of the distance is an edge; 0: none
  double angle_degrees = 35;  ///< normals that differ by more are an edge; 180: none
  bool instances = true;      ///< where ids differ, too
  int width_px = 1;           ///< 1 to 16
};

/// Images of a frame (Targets). All have one size; normals and ids may be empty.
struct Surface {
  ImageView<const float> view_depth{};  ///< Targets::view_depth
  ImageView<const Vec3> normals{};      ///< Targets::camera_normals
  ImageView<const std::int64_t> ids{};  ///< Targets::instances, or any other number
};

/// Which sides of a scene's triangles Effects::edges draws. The scene's arrays must outlive it.
class SceneEdges {
 public:
  /// The edges of the faces of all meshes; lines that cut quads and polygons into triangles are
  /// none. With an angle, in [0, 180] degrees, an edge between two faces counts only if they meet
  /// at more; borders, and edges of three faces and more, always count. Equal positions are one
  /// point, so a triangle soup has neighbours, too. Cost: O(n log n) and about 100 bytes a triangle
  /// meanwhile, for an angle and for quads and polygons; a byte a triangle afterwards. Throws
  /// Error{invalid_argument} for an angle or index out of range.
  explicit SceneEdges(const SceneView& scene, double angle_degrees = 0);

  struct Place {
    std::size_t instance;
    std::uint64_t primitive;  ///< of that instance
  };
  /// The triangle of a number of Targets::ids. Throws Error{invalid_argument} for a number that the
  /// scene does not have.
  [[nodiscard]] Place find(std::int64_t id) const;
  /// Bit c: the side from corner c to the next. 0 for other geometries. Throws likewise.
  [[nodiscard]] std::uint8_t sides(const Place& place) const;
  [[nodiscard]] const SceneView& scene() const { return scene_; }

 private:
  SceneView scene_;
  std::vector<std::uint64_t> first_ids_;           ///< one more than instances
  std::vector<std::size_t> table_of_;              ///< of an instance
  std::vector<std::vector<std::uint8_t>> tables_;  ///< empty: all sides
};

/// The materials with which effects see a scene whose textures blend: masks that are cut at an
/// alpha of 0.5, because the quad around a leaf is no surface. Empty where no texture blends, since
/// then effects can take the frame's surface. Cost: O(materials).
[[nodiscard]] std::vector<Material> materials_of_surface(const SceneView& scene);

/// Keeps threads and scratch between pictures. Threads: calls take turns.
class Effects {
 public:
  /// `threads` 0: all. Throws Error{no_device} for an instruction set that is not there.
  explicit Effects(int threads = 0, std::optional<Isa> isa = {});
  ~Effects();
  Effects(Effects&&) noexcept;
  Effects& operator=(Effects&&) noexcept;

  /// Without `normals` those of the surface that neighbours in depth span: faces', and cheaper than
  /// a frame's own. Where a pixel has none (points and lines in `normals`) nothing is taken from
  /// it. Throws Error{invalid_argument} for images that differ in size, options out of range and a
  /// camera whose planes of equal depth are not across its axis. Cost: pixels · samples.
  void ambient_occlusion(const Surface& surface, const Camera& camera,
                         const AmbientOcclusion& options, ImageView<float> factor);
  /// The same and darken() with it at once, without an image between them: what `--studio` does.
  /// Looks at no colours where nothing is seen.
  void occlude(const Surface& surface, const Camera& camera, const AmbientOcclusion& options,
               ImageView<Rgba8> color8, ImageView<Vec4> color, Vec3 ink = {0, 0, 0});
  void eye_dome(const Surface& surface, const Camera& camera, const EyeDome& options,
                ImageView<float> factor);
  /// An edge lies on the nearer of two surfaces, `width_px` wide.
  void silhouettes(const Surface& surface, const Camera& camera, const Silhouettes& options,
                   ImageView<float> factor);

  /// The edges of the triangles in view, `width_px` wide, (0, 64]; `ids` are Targets::ids of a
  /// frame of the edges' scene by `camera`. Each pixel shows those of the triangle that it sees, so
  /// of an edge at which the surface ends the half that lies on it. Throws Error{invalid_argument}
  /// for an id that the scene has not. Cost: O(pixels), about 100 ns where triangles are small.
  void edges(ImageView<const std::int64_t> ids, const SceneEdges& edges, const Camera& camera,
             double width_px, ImageView<float> factor);

  /// Colours become c · factor + ink · (1 − factor); alpha stays. `color8` is straight, `color`
  /// premultiplied; either may be empty.
  void darken(ImageView<Rgba8> color8, ImageView<Vec4> color, ImageView<const float> factor,
              Vec3 ink = {0, 0, 0});

 private:
  struct RASTRUM_INSIDE Impl;
  Held<Owner<Impl>> impl_;
};

}  // namespace rastrum
