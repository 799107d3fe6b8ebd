// SPDX-License-Identifier: BSD-3-Clause
// Effects over a finished picture, from its depth, normals and ids: ambient occlusion, eye-dome
// lighting, silhouettes, the edges of meshes (docs/overlay.md has the formulas, decision 0051 the
// reasons).
//
// Each effect makes an image of factors in [0, 1], 1 where the picture stays as it is and where
// nothing is drawn; darken() applies them to colours. With several samples a pixel, depth and
// normals are those of the nearest surface, as in Targets. The bits are the same for every number
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
  /// Surfaces nearer than this, in world units, take light from a point. 1e-37 to 1e37, and at
  /// least 1e-30 of the picture's depths.
  double radius = 0;
  double strength = 1;  ///< [0, 16]
  int samples = 8;      ///< at each pixel, 1 to 64; a blur averages those of 4 × 4 pixels
};

/// Shades each pixel by how far it lies behind its neighbours (Boucheny 2009). So points, which
/// have no normals, show their shape.
struct EyeDome {
  double strength = 1;  ///< [0, 100]
  int radius_px = 2;    ///< how far away the neighbours are, 1 to 64
};

/// Lines where surfaces end, bend or meet another instance. The first three say what is a line.
struct Silhouettes {
  double depth = 0.01;        ///< depth steps above this share of the distance; 0: none
  double angle_degrees = 35;  ///< normals that differ by more, [0, 180]; 180: none
  bool instances = true;      ///< also where Surface::ids differ
  int width_px = 1;           ///< 1 to 16
};

/// The images of a frame that effects read. All have one size; normals and ids may be empty.
struct Surface {
  ImageView<const float> view_depth{};  ///< Targets::view_depth
  ImageView<const Vec3> normals{};      ///< Targets::camera_normals
  ImageView<const std::int64_t> ids{};  ///< Targets::instances, or other numbers
};

/// The sides of a scene's triangles that Effects::edges draws. The scene's arrays must outlive it.
class SceneEdges {
 public:
  /// Finds the edges of the faces of all meshes; lines that cut quads and polygons into triangles
  /// are none. With an angle, in [0, 180] degrees, an edge between two faces counts only if they
  /// meet at more; borders, and edges of three or more faces, always count. Equal positions are one
  /// point, so a triangle soup has neighbours, too. Cost, for an angle and for quads and polygons:
  /// O(n log n) and meanwhile about 100 bytes per triangle, of which one stays. Throws
  /// Error{invalid_argument} for an angle or index out of range.
  explicit SceneEdges(const SceneView& scene, double angle_degrees = 0);

  struct Place {
    std::size_t instance;
    std::uint64_t primitive;  ///< its number within that instance
  };
  /// The primitive whose number in Targets::ids is `id`. Throws Error{invalid_argument} for a
  /// number that the scene does not have.
  [[nodiscard]] Place find(std::int64_t id) const;
  /// Bit c: the side from corner c to the next is drawn. 0 for other geometries. Throws as find().
  [[nodiscard]] std::uint8_t sides(const Place& place) const;
  [[nodiscard]] const SceneView& scene() const { return scene_; }

 private:
  SceneView scene_;
  std::vector<std::uint64_t> first_ids_;           ///< for each instance, then the number of all
  std::vector<std::size_t> table_of_;              ///< for each instance
  std::vector<std::vector<std::uint8_t>> tables_;  ///< empty: all sides
};

/// The materials with which a scene whose textures blend is drawn once more for its effects: masks
/// that are cut at an alpha of 0.5, because the quad around a leaf is no surface. Empty if no
/// texture blends; then the effects take the frame's surface. Cost: O(materials).
[[nodiscard]] std::vector<Material> materials_of_surface(const SceneView& scene);

/// Keeps threads and scratch between pictures. Several threads may call it, and take turns.
class Effects {
 public:
  /// `threads` 0: all of the machine. Throws Error{no_device} for an instruction set that it lacks.
  explicit Effects(int threads = 0, std::optional<Isa> isa = {});
  ~Effects();
  Effects(Effects&&) noexcept;
  Effects& operator=(Effects&&) noexcept;

  /// Without Surface::normals it finds the faces' normals from the depths of neighbours, which is
  /// cheaper than a frame's own. A pixel without a normal (points and lines in `normals`) keeps its
  /// light. Throws Error{invalid_argument} for images that differ in size, options out of range and
  /// a camera whose planes of equal depth are not across its axis. Cost: pixels · samples.
  void ambient_occlusion(const Surface& surface, const Camera& camera,
                         const AmbientOcclusion& options, ImageView<float> factor);
  /// Does ambient_occlusion() and darken() at once, without an image between them, as `--studio`
  /// does. It touches no colours where nothing is seen.
  void occlude(const Surface& surface, const Camera& camera, const AmbientOcclusion& options,
               ImageView<Rgba8> color8, ImageView<Vec4> color, Vec3 ink = {0, 0, 0});
  void eye_dome(const Surface& surface, const Camera& camera, const EyeDome& options,
                ImageView<float> factor);
  /// Lines lie on the nearer of two surfaces. This and eye_dome() throw as ambient_occlusion().
  void silhouettes(const Surface& surface, const Camera& camera, const Silhouettes& options,
                   ImageView<float> factor);

  /// Finds the edges of the triangles in view, `width_px` wide, (0, 64]. `ids` are Targets::ids of
  /// a frame of edges.scene() by `camera`. Each pixel shows the edges of the triangle that it sees,
  /// so an edge at which the surface ends has half the width. Throws Error{invalid_argument} for an
  /// id that the scene does not have. Cost: O(pixels), about 100 ns each where triangles are small.
  void edges(ImageView<const std::int64_t> ids, const SceneEdges& edges, const Camera& camera,
             double width_px, ImageView<float> factor);

  /// Replaces each colour c by c · factor + ink · (1 − factor); alpha stays. `color8` is straight,
  /// `color` premultiplied; either may be empty.
  void darken(ImageView<Rgba8> color8, ImageView<Vec4> color, ImageView<const float> factor,
              Vec3 ink = {0, 0, 0});

 private:
  struct RASTRUM_INSIDE Impl;
  Held<Owner<Impl>> impl_;
};

}  // namespace rastrum
