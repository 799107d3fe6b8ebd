// SPDX-License-Identifier: BSD-3-Clause
// The instances of a scene that are not meshes, as draws.
#pragma once

#include <deque>
#include <optional>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/raster/rules/quadrics.hpp>
#include <rastrum/raster/shade/quadric_shader.hpp>
#include <rastrum/scene/instance_runs.hpp>

namespace rastrum {

/// None if it is of another kind.
[[nodiscard]] std::optional<raster::QuadricGeometry> quadrics_of(GeometryRef geometry);

/// The draws of a frame's quadrics, which refer to this object.
class SurfaceDraws {
 public:
  SurfaceDraws(const SceneView& scene, const raster::SurfaceLook& look, const Camera& camera,
               int width, int height)
      : look_(look), shader_(look, scene.materials, camera, width, height), scene_(scene) {}

  /// If the instance is quadrics, makes its draw with these scalars and returns true.
  bool add(const InstanceView& instance, const raster::SurfaceScalars& scalars,
           const Mat4d& world_to_clip, raster::Draw& draw, parallel::Threads* threads);

  /// See QuadricShader.
  void leave_linear() { shader_.leave_linear(); }

 private:
  raster::SurfaceLook look_;
  raster::QuadricShader shader_;
  SceneView scene_;
  std::deque<raster::QuadricStage> stages_;  // draws point to them
};

}  // namespace rastrum
