// The instances of a scene that are no meshes, as draws.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/raster/draws/quadrics.hpp>
#include <rastrum/raster/shade/quadric_shader.hpp>
#include <rastrum/scene/instance_runs.hpp>

namespace rastrum {

/// What of instances are quadrics; none: it is another geometry.
[[nodiscard]] std::optional<raster::QuadricGeometry> quadrics_of(const GeometryView& geometry);

/// Throws Error{invalid_argument} that names the instance and its array: fewer radii, colours or
/// normals than there are to be, an index or offset out of range, offsets that do not rise, a
/// material that is none. O(indices).
void check_surfaces(const InstanceRuns& runs);

/// The draws of a frame's quadrics; they refer to it.
class SurfaceDraws {
 public:
  SurfaceDraws(const SceneView& scene, const raster::SurfaceLook& look, const Camera& camera,
               int width, int height)
      : look_(look), shader_(look, scene.materials, camera, width, height), scene_(scene) {}

  /// Whether the instance, with these scalars, is one; then makes its draw.
  bool add(const InstanceView& instance, const raster::SurfaceScalars& scalars,
           const Mat4d& world_to_clip, raster::Draw& draw, parallel::Threads* threads);

  /// As QuadricShader's.
  void leave_linear() { shader_.leave_linear(); }

 private:
  raster::SurfaceLook look_;
  raster::QuadricShader shader_;
  SceneView scene_;
  std::deque<raster::QuadricStage> stages_;  // draws point to them
};

}  // namespace rastrum
