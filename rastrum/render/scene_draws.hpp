// SPDX-License-Identifier: BSD-3-Clause
// A scene as the pipeline draws it: a draw for each run of alike instances, their shading and
// tests.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/context/request.hpp>
#include <rastrum/raster/draws/cut.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/raster/draws/shading.hpp>
#include <rastrum/raster/resolve/surface_point.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/shade/point_line_shader.hpp>
#include <rastrum/raster/shade/scalar_mesh_shader.hpp>
#include <rastrum/raster/shade/surface_scalars.hpp>
#include <rastrum/raster/shade/texture.hpp>
#include <rastrum/render.hpp>
#include <rastrum/render/surfaces.hpp>
#include <rastrum/scene/instance_runs.hpp>

namespace rastrum {

/// The draws of one frame. Its results point into it and into the scene.
class SceneDraws {
 public:
  struct Options {
    const FrameOptions& frame;
    const Targets& targets;
    Shader shader;  ///< the frame's shader, resolved for this scene (shader_for)
    bool in_place;  ///< arrays are a device's: no value is read here
    std::span<const raster::LightShadow> shadows{};  ///< one per light of the frame; empty: none
  };
  /// Requires check_scene. Brings the frame's textures up to date. Throws Error if planes, outputs
  /// and draws do not go together. O(runs + colours that may be translucent).
  SceneDraws(const InstanceRuns& runs, const Camera& camera, const Options& options,
             raster::TextureSet& textures, parallel::Threads* threads);
  SceneDraws(const SceneDraws&) = delete;
  SceneDraws& operator=(const SceneDraws&) = delete;

  [[nodiscard]] std::span<raster::Draw> draws() { return draws_; }
  /// The shading of draws without their own; none for Shader::depth, whose greys need the whole
  /// picture.
  [[nodiscard]] const raster::Shading& shading() const { return shading_; }
  [[nodiscard]] const raster::Testing& test() const { return test_; }
  [[nodiscard]] bool linear_light() const { return linear_light_; }
  [[nodiscard]] raster::DrawNames names() const { return {"instance", &runs_}; }
  /// Null if no target shows the surface at a pixel.
  [[nodiscard]] const raster::SurfaceScene* surface() const {
    return surface_ ? &*surface_ : nullptr;
  }

 private:
  /// Flags that some primitive has: `materials` from materials, colours and looks of meshes, which
  /// MaterialScene reads; `any` from anything.
  struct Flags {
    std::uint32_t materials = 0, any = 0;
  };
  void set_scalars(const Targets& targets);
  [[nodiscard]] const raster::SurfaceScalars& scalars_of(std::size_t instance) const;
  [[nodiscard]] bool shows_scalars(std::size_t instance) const {
    return scalars_of(instance).colors() != nullptr;
  }
  void choose_meshes();
  void shade_scalar_meshes(const Options& options, const Camera& camera,
                           const raster::TextureSet& textures);
  Flags make_draws(const Options& options, const Mat4d& to_clip, parallel::Threads* threads);
  /// Sets which instances the draws of `of_meshes` copy. These are in the order of draws.
  template <class MeshDraw>
  void set_copies(std::vector<MeshDraw>& of_meshes) const;

  const InstanceRuns& runs_;
  SceneView scene_;                            ///< the first of each run
  std::optional<raster::FrameLights> lights_;  ///< none: the fixed light
  /// Empty unless an instance has scalars that the frame asks for.
  std::vector<ScalarColors> scalar_colors_;             ///< by mapping
  std::vector<raster::SurfaceScalars> scalars_;         ///< by instance
  std::optional<std::vector<InstanceView>> mesh_list_;  ///< if other geometry exists, too
  SceneView meshes_;  ///< the instances that are meshes and show no scalars
  std::vector<InstanceView> scalar_mesh_list_;  ///< meshes that do
  std::optional<raster::ScalarMeshShader> scalar_meshes_;
  std::vector<std::uint32_t> material_flags_;  // draws point to them
  std::vector<raster::Draw> draws_;
  std::deque<raster::DrawCut> cuts_;  // draws point to them
  SurfaceDraws surfaces_;
  raster::PointLineShader points_and_lines_;
  std::optional<raster::MaterialScene> materials_;  ///< in linear light, for alpha and albedo, too
  std::optional<raster::MaterialScene> classic_;
  std::optional<raster::LitScene> lit_;
  std::optional<raster::SurfaceScene> surface_;
  raster::Shading shading_;
  raster::Testing test_;
  bool linear_light_ = false;
};

}  // namespace rastrum
