// The surface at a pixel, from its key: the one place where what is seen is found again, for the
// images beside colour and depth (Targets) and for what is under a pointer (pick.hpp).
//
// In float64 and in one written order of operations, from what the key names and the pixel alone,
// so the same bits however the key was found; rounded to float32 once, where it is stored. Scalar
// code: a pixel costs about as much as a material without textures.
#pragma once

#include <cstdint>

#include <rastrum/camera.hpp>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/shade/interpolate.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/shade/point_line_shader.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// Where a fragment of an instance lies in the world, by its corners and weights.
[[nodiscard]] Vec3d position_on(const InstanceView& instance, const Fragment& f);

/// What is read of a scene whose instances are the frame's draws, in order.
struct SurfaceScene {
  const SceneView& scene;
  const Camera& camera;
  LitScene lit;
  Mat4d to_camera;
  const MaterialScene* materials = nullptr;  ///< with textures of what alpha and colour come from
  const PointLineShader* points_and_lines = nullptr;  ///< that of their draws

  SurfaceScene(const SceneView& s, const Camera& c, int width, int height)
      : scene(s), camera(c), lit(s, c, width, height), to_camera(world_to_camera(c)) {}

  /// InstanceView::id of a draw.
  [[nodiscard]] std::int64_t instance_id(std::size_t draw) const {
    return scene.instances[draw].id.value_or(static_cast<std::int64_t>(draw));
  }
  /// In the world.
  [[nodiscard]] Vec3d position(const Fragment& f) const {
    return position_on(scene.instances[f.draw], f);
  }
  /// Unit length, in the world, turned to the viewer; 0 where there is none.
  [[nodiscard]] Vec3d normal(const Fragment& f) const;
  [[nodiscard]] Vec3d in_camera(Vec3d direction) const;
  /// How far the pixel's ray goes for each unit along the axis; 1 for an orthographic camera.
  [[nodiscard]] double ray_length(int x, int y) const;
  /// Linear light, straight alpha. Requires `materials`, or `points_and_lines`.
  [[nodiscard]] Vec4 albedo(const FrameGeometry& frame, const Fragment& f) const;

 private:
  /// Towards the viewer, not normalized.
  [[nodiscard]] Vec3d to_viewer(int x, int y) const;
};

}  // namespace rastrum::raster
