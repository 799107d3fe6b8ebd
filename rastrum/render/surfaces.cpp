// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/surfaces.hpp>

#include <rastrum/raster/shade/alpha.hpp>

namespace rastrum {
namespace {

bool is_translucent(const raster::QuadricGeometry& geometry, const InstanceView& instance,
                    const Material* material, parallel::Threads* threads) {
  if (material != nullptr) return material->alpha_mode == AlphaMode::blend || material->opacity < 1;
  return raster::has_color_alpha(
      instance, std::visit([](const auto& g) { return g.colors; }, geometry), threads);
}

bool is_translucent(const raster::SurfaceScalars& scalars, const Material* material) {
  return scalars.colors()->is_translucent() || (material != nullptr && material->opacity < 1);
}

}  // namespace

std::optional<raster::QuadricGeometry> quadrics_of(GeometryRef geometry) {
  if (const auto* const s = geometry.get_if<SpheresView>()) return *s;
  if (const auto* const c = geometry.get_if<CylindersView>()) return *c;
  if (const auto* const t = geometry.get_if<TubesView>()) return *t;
  if (const auto* const d = geometry.get_if<DiscsView>()) return *d;
  return std::nullopt;
}

bool SurfaceDraws::add(const InstanceView& instance, const raster::SurfaceScalars& scalars,
                       const Mat4d& world_to_clip, raster::Draw& draw, parallel::Threads* threads) {
  const auto geometry = quadrics_of(instance.geometry);
  if (!geometry) return false;
  const raster::QuadricStage& stage =
      stages_.emplace_back(*geometry, world_to_clip * instance.object_to_world);
  shader_.add(stage, instance, scalars);
  draw.quadrics = &stage;
  draw.primitive_count = std::visit([](const auto& g) { return g.size(); }, *geometry);
  draw.shading = shader_;
  const Material* const material =
      scene_.materials.empty() ? nullptr : &scene_.materials[raster::material_of(instance)];
  if (look_.blends &&
      (look_.opacity < 1 || instance.opacity < 1 ||
       (scalars.colors() != nullptr ? is_translucent(scalars, material)
                                    : is_translucent(*geometry, instance, material, threads))))
    draw.flags |= kTranslucent;
  if (material != nullptr && material->alpha_mode == AlphaMode::mask) {
    draw.flags |= kTested;
    draw.test = &shader_;
  }
  return true;
}

}  // namespace rastrum
