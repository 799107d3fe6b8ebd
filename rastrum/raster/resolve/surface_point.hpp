// SPDX-License-Identifier: BSD-3-Clause
// The surface at a pixel, found again from its key, for the images beside colour and depth
// (Targets) and for the surface under a pointer (pick.hpp).
//
// The result depends only on what the key names and on the pixel, in float64 and a fixed order, so
// the bits are the same however the key was found. It is rounded to float32 where it is stored.
// Only meshes' normals are the lit shaders' float32 ones (decision 0034). Scalar code;
// surface/seen_planes.hpp and lit_simd.cpp do the same for triangles of many pixels at once.
#pragma once

#include <cstdint>
#include <span>

#include <rastrum/camera.hpp>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/rules/quadric_surface.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/shade/point_line_shader.hpp>
#include <rastrum/raster/shade/surface_scalars.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/scene/instance_runs.hpp>
#include <rastrum/scene/view_distance.hpp>

namespace rastrum::raster {

/// A visible fragment. A quadric's has no vertices, and its weights are those of its axis's two
/// ends.
struct SeenFragment : Fragment {
  std::uint64_t copy = 0;               ///< of its draw
  bool cut = false;                     ///< it may not cover its pixel's centre
  const QuadricHit* quadric = nullptr;  ///< a quadric's, else null
};

/// Finds the surfaces of pixels by their keys.
class SurfaceLocator {
 public:
  /// `samples`: a pixel, of the picture that has the keys. `changes`: also find how weights change
  /// across pixels, for textures and isolines.
  SurfaceLocator(const FrameGeometry& frame, int samples, bool changes = true)
      : frame_(frame), samples_(samples), changes_(changes), locator_(frame) {}

  /// The fragment at pixel `i` of the block at (x0, y0). Valid until the next call.
  [[nodiscard]] const SeenFragment& locate(std::uint64_t key, int x0, int y0, int i);

 private:
  void locate_quadric(const Draw& draw, int x, int y);

  const FrameGeometry& frame_;
  int samples_;
  bool changes_;
  FragmentLocator locator_;
  const Draw* draw_ = nullptr;  ///< the last one
  SeenFragment seen_;
  QuadricHit hit_;
  QuadricSurface surface_;  ///< of primitive quadric_id_
  std::uint64_t quadric_id_ = kMaxId + 1;
};

/// The world position of a fragment of a mesh, point or line, from its corners and weights.
[[nodiscard]] Vec3d position_on(const InstanceView& instance, const Fragment& f);
/// From a position in object space.
[[nodiscard]] Vec3d in_world(const InstanceView& instance, Vec3d p);

/// A scene to read surfaces from. Its runs of instances are the frame's draws, in order.
struct SurfaceScene {
  const SceneView& scene;    ///< the first of each run
  const InstanceRuns* runs;  ///< null: each has one instance
  const Camera& camera;
  LitScene lit;
  Mat4d to_camera;
  float camera_rows[3][3];  ///< its rotation
  bool only_meshes = true;
  DistanceByDepth distance_by_depth;                  ///< set if view_depth or distance is wanted
  const MaterialScene* materials = nullptr;           ///< with the textures of alpha and colour
  const PointLineShader* points_and_lines = nullptr;  ///< for their draws
  std::span<const SurfaceScalars> scalars{};          ///< of each instance; empty: none

  SurfaceScene(const SceneView& s, const InstanceRuns* r, const Camera& c, int width, int height);

  [[nodiscard]] const InstanceView& instance(std::size_t draw, std::uint64_t copy) const {
    return runs == nullptr ? scene.instances[draw] : runs->instances(draw)[copy];
  }
  /// InstanceView::id.
  [[nodiscard]] std::int64_t instance_id(std::size_t draw, std::uint64_t copy) const {
    const std::uint64_t number = runs == nullptr ? draw : runs->number(draw) + copy;
    return instance(draw, copy).id.value_or(static_cast<std::int64_t>(number));
  }
  [[nodiscard]] Vec3d position(const SeenFragment& f) const {
    return f.quadric != nullptr ? in_world(instance(f.draw, f.copy), f.quadric->position)
                                : position_on(instance(f.draw, f.copy), f);
  }
  /// World space, unit length, facing the viewer; 0: none. `kept` has the last triangle, which
  /// neighbouring pixels share.
  [[nodiscard]] Vec3 normal(const FrameGeometry& frame, const SeenFragment& f,
                            LitTriangle& kept) const;
  [[nodiscard]] Vec3 in_camera(Vec3 direction) const;
  /// The geometry's scalar there; NaN: none.
  [[nodiscard]] double scalar(const FrameGeometry& frame, const SeenFragment& f) const;
  [[nodiscard]] Vec3d in_camera(Vec3d direction) const;
  /// The length of the pixel's ray for each unit along the axis; 1 for an orthographic camera.
  [[nodiscard]] double ray_length(int x, int y) const;
  /// Linear light, straight alpha. Requires `materials`, or `points_and_lines`.
  [[nodiscard]] Vec4 albedo(const FrameGeometry& frame, const SeenFragment& f) const;

 private:
  void scalars_at_ends(const FrameGeometry& frame, const SeenFragment& f, double (&ends)[2]) const;
  /// For a surface that is no mesh: in object space, not normalized.
  [[nodiscard]] Vec3d object_normal(const SeenFragment& f) const;
  /// Towards the viewer, not normalized.
  [[nodiscard]] Vec3d to_viewer(int x, int y) const;
};

}  // namespace rastrum::raster
