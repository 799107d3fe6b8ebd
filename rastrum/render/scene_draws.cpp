// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/scene_draws.hpp>

#include <algorithm>
#include <utility>
#include <variant>

#include <rastrum/core/reject.hpp>
#include <rastrum/pick.hpp>
#include <rastrum/raster/draws/shader_table.hpp>
#include <rastrum/raster/draws/vertices_of.hpp>
#include <rastrum/raster/shade/alpha.hpp>
#include <rastrum/render/target_checks.hpp>

namespace rastrum {
namespace {

/// With `depth`, nobody sees the colours of surfaces.
Shader lit_model(Shader shader) {
  return shader == Shader::depth ? Shader::phong : shader;
}

bool blends_surfaces(const SceneDraws::Options& o) {
  return o.frame.transparency.method != Transparency::none && o.shader != Shader::depth;
}

raster::SurfaceLook look_of(const SceneDraws::Options& o,
                            const std::optional<raster::FrameLights>& lights) {
  std::optional<Shader> model;
  const bool classic = o.shader == Shader::classic;
  if (o.shader != Shader::material && !classic) model = lit_model(o.shader);
  return {model, classic, blends_surfaces(o), o.frame.opacity, lights ? &lights->set() : nullptr};
}

/// None if nothing asks for them.
std::optional<raster::FrameLights> lights_of(const SceneDraws::Options& o, const Camera& camera) {
  const bool classic = o.shader == Shader::classic;
  const Light plain = headlight();
  std::span<const Light> lights = o.frame.lights;
  if (!raster::row_of(o.shader).lights || (lights.empty() && !classic)) return {};
  if (lights.empty()) lights = {&plain, 1};
  if (classic)
    for (const Light& light : lights)
      require(!std::holds_alternative<EnvironmentLight>(light.kind),
              "the shader classic has no environments: take them out of the lights, or the shader "
              "material");
  return std::optional<raster::FrameLights>(std::in_place, lights, o.shadows, camera, o.frame.width,
                                            o.frame.height, classic);
}

}  // namespace

SceneDraws::SceneDraws(const InstanceRuns& runs, const Camera& camera, const Options& options,
                       raster::TextureSet& textures, parallel::Threads* threads)
    : runs_(runs),
      scene_(runs.firsts()),
      lights_(lights_of(options, camera)),
      meshes_(scene_),
      surfaces_(scene_, look_of(options, lights_), camera, options.frame.width,
                options.frame.height),
      points_and_lines_(look_of(options, lights_), scene_.materials, camera, options.frame.width,
                        options.frame.height) {
  const FrameOptions& o = options.frame;
  const Targets& targets = options.targets;
  set_scalars(targets);
  choose_meshes();
  const Flags flags = make_draws(options, world_to_clip(camera, o.width, o.height), threads);

  const bool masks = (flags.materials & kTested) != 0;
  const bool material_alpha = (flags.materials & kTranslucent) != 0;
  const bool shades_materials = options.shader == Shader::material;
  const bool classic = options.shader == Shader::classic;
  const bool wants_albedo = !targets.albedo.empty();
  if (shades_materials || classic || masks || material_alpha || wants_albedo)
    textures.update(
        scene_.textures,
        raster::texture_uses(scene_, shades_materials || wants_albedo, material_alpha, classic),
        threads);
  if (shades_materials || masks || material_alpha || wants_albedo) {
    materials_.emplace(meshes_, camera, o.width, o.height, textures);
    materials_->lights = lights_ ? &lights_->set() : nullptr;
    set_copies(materials_->draws);
  }
  if (raster::wants_surface(targets)) {
    surface_.emplace(scene_, &runs_, camera, o.width, o.height);
    surface_->materials = materials_ ? &*materials_ : nullptr;
    surface_->points_and_lines = &points_and_lines_;
    surface_->scalars = scalars_;
    if (!targets.view_depth.empty() || !targets.distance.empty())
      surface_->distance_by_depth = distance_by_depth(camera);
  }
  if (masks) test_ = raster::MaskTest{&*materials_};
  shade_scalar_meshes(options, camera, textures);
  if (options.shader == Shader::depth) return;

  const bool translucent = (flags.any & kTranslucent) != 0;
  linear_light_ = shades_materials && (translucent || !targets.linear.empty());
  if (linear_light_) {
    surfaces_.leave_linear();
    points_and_lines_.leave_linear();
    if (scalar_meshes_) scalar_meshes_->leave_linear();
  }
  if (shades_materials) {
    shading_ = raster::MaterialShading{&*materials_, linear_light_};
  } else if (classic) {
    classic_.emplace(meshes_, camera, o.width, o.height, textures, true);
    classic_->lights = &lights_->set();
    set_copies(classic_->draws);
    shading_ = raster::MaterialShading{&*classic_};
  } else {
    lit_.emplace(meshes_, camera, o.width, o.height);
    lit_->lights = lights_ ? &lights_->set() : nullptr;
    set_copies(lit_->draws);
    shading_ = raster::LitShading{lit_model(options.shader), &*lit_};
  }
  if (translucent)
    shading_ = shading_.with_alpha(material_alpha ? &*materials_ : nullptr, o.opacity);
}

template <class MeshDraw>
void SceneDraws::set_copies(std::vector<MeshDraw>& of_meshes) const {
  std::size_t mesh = 0;
  for (std::size_t run = 0; run < draws_.size(); ++run) {
    if (scene_.instances[run].mesh() == nullptr || shows_scalars(run)) continue;
    if (draws_[run].is_copied()) of_meshes[mesh].copies = runs_.instances(run);
    ++mesh;
  }
}

void SceneDraws::set_scalars(const Targets& targets) {
  const auto shows = [&](const InstanceView& i) { return rastrum::shows_scalars(scene_, i); };
  const bool any = !scene_.scalar_mappings.empty() && std::ranges::any_of(scene_.instances, shows);
  if (!any && targets.scalars.empty()) return;
  if (any)
    for (std::size_t m = 0; m < scene_.scalar_mappings.size(); ++m)
      scalar_colors_.push_back(scalar_colors(scene_, m));
  for (const InstanceView& i : scene_.instances)
    scalars_.emplace_back(i, any ? &scalar_colors_[i.scalar_mapping] : nullptr);
}

const raster::SurfaceScalars& SceneDraws::scalars_of(std::size_t instance) const {
  static const raster::SurfaceScalars kNone;
  return scalars_.empty() ? kNone : scalars_[instance];
}

void SceneDraws::choose_meshes() {
  bool others = false;
  for (std::size_t i = 0; i < scene_.instances.size() && !others; ++i)
    others = scene_.instances[i].mesh() == nullptr || shows_scalars(i);
  if (!others) return;
  mesh_list_.emplace();
  for (std::size_t i = 0; i < scene_.instances.size(); ++i)
    if (scene_.instances[i].mesh() != nullptr)
      (shows_scalars(i) ? scalar_mesh_list_ : *mesh_list_).push_back(scene_.instances[i]);
  meshes_.instances = *mesh_list_;
}

void SceneDraws::shade_scalar_meshes(const Options& options, const Camera& camera,
                                     const raster::TextureSet& textures) {
  if (scalar_mesh_list_.empty()) return;
  std::vector<raster::SurfaceScalars> scalars;
  for (std::size_t i = 0; i < scene_.instances.size(); ++i)
    if (scene_.instances[i].mesh() != nullptr && shows_scalars(i)) scalars.push_back(scalars_[i]);
  const SceneView shown{scalar_mesh_list_, scene_.materials, scene_.textures, {}};
  scalar_meshes_.emplace(look_of(options, lights_), shown, std::move(scalars), camera,
                         options.frame.width, options.frame.height, textures);
  for (std::size_t i = 0; i < scene_.instances.size(); ++i)
    if (scene_.instances[i].mesh() != nullptr && shows_scalars(i)) {
      draws_[i].shading = *scalar_meshes_;
      draws_[i].test = &*scalar_meshes_;
    }
}

SceneDraws::Flags SceneDraws::make_draws(const Options& options, const Mat4d& to_clip,
                                         parallel::Threads* threads) {
  const FrameOptions& o = options.frame;
  const bool blends = blends_surfaces(options);
  Flags all;
  if (blends && o.opacity < 1) all.any |= kTranslucent;
  material_flags_ = raster::material_flags(scene_.materials, blends);
  draws_.reserve(scene_.instances.size());
  for (const InstanceView& instance : scene_.instances) {
    raster::Draw& draw = draws_.emplace_back();
    draw.visible = instance.visible;
    draw.winding = winding_of(instance);
    if (!o.clip_planes.empty() || !instance.clip_planes.empty()) {
      raster::check_clip_planes(instance.clip_planes,
                                names().of(draws_.size() - 1).append(": ").c_str());
      draw.cut = &cuts_.emplace_back(instance, o.clip_planes);
    }
    const raster::SurfaceScalars& scalars = scalars_of(draws_.size() - 1);
    if (surfaces_.add(instance, scalars, to_clip, draw, threads)) {
      all.any |= draw.flags;
      continue;
    }
    if (const std::size_t run = draws_.size() - 1; runs_.length(run) > 1)
      raster::set_copies(draw, *instance.mesh(), runs_.instances(run), runs_.length(run), to_clip);
    else
      raster::set_vertices(draw, instance.geometry, to_clip * instance.object_to_world);
    std::uint32_t flags = 0;
    ArrayView<Vec4> colors;
    if (const MeshView* const mesh = instance.mesh()) {
      colors = mesh->colors.values;
      draw.cull = material_cull(instance, scene_.materials, options.shader);
      flags = raster::set_material_flags(draw, instance, material_flags_);
    } else {
      colors = points_and_lines_.add(instance, scalars);
      draw.shading = points_and_lines_;
      draw.test = &points_and_lines_;
      if (!material_flags_.empty()) draw.flags |= material_flags_[raster::material_of(instance)];
    }
    const bool color_alpha = scalars.colors() != nullptr
                                 ? scalars.colors()->is_translucent()
                                 : scene_.materials.empty() && !options.in_place &&
                                       raster::has_color_alpha(instance, colors, threads);
    if (blends && instance.visible && color_alpha) {
      draw.flags |= kTranslucent;
      flags |= kTranslucent;
    }
    if (blends && instance.visible && instance.opacity < 1) flags |= kTranslucent;
    if (blends && (o.opacity < 1 || instance.opacity < 1)) draw.flags |= kTranslucent;
    if (instance.mesh() != nullptr) all.materials |= flags;
    all.any |= flags | draw.flags;
  }
  return all;
}

}  // namespace rastrum
