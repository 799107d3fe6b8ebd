// SPDX-License-Identifier: BSD-3-Clause
// Which of a frame's shadings and fragment tests a device has, and their arrays there. A caller's
// own shader or discard function is host code: the CPU shades or draws such frames.
#pragma once

#include <algorithm>
#include <optional>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/materials.cuh>
#include <rastrum/raster/cuda/resolve.cuh>
#include <rastrum/raster/cuda/upload.cuh>
#include <rastrum/raster/draws/shading.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/material.hpp>

namespace rastrum::raster {

/// Whether a device has this shading: a lit model except `wireframe`, or one scene's materials with
/// any alpha.
[[nodiscard]] inline bool is_on_device(const Shading& shading) {
  if (const LitShading* const lit = shading.lit()) return LitOnDevice::has(lit->model);
  const MaterialShading* const material = shading.material();
  return material != nullptr &&
         (shading.blending() == nullptr || shading.blending() == material->scene);
}

[[nodiscard]] inline bool has_tests(const FrameRequest& request) {
  return request.has_tests() && std::ranges::any_of(request.draws, [](const Draw& draw) {
           return (draw.any_flags() & kMayDrop) != 0;
         });
}
[[nodiscard]] inline bool wants_colors(const Targets& t) {
  return !t.color8.empty() || !t.color.empty();
}
/// Whether a device has all targets, blending and the shader of the frame. Only a caller's shader
/// has extra targets. To decode what is behind linear light takes powers from the host's library.
[[nodiscard]] inline bool can_resolve(const FrameRequest& request) {
  const Targets& t = request.targets;
  if (!t.extra.empty() || (request.pass.over && request.linear_light)) return false;
  return !wants_colors(t) || is_on_device(request.shading);
}

/// Whether colours, alpha or tests need more than a lit shader.
[[nodiscard]] inline bool uses_materials(const FrameRequest& request) {
  const Shading& shading = request.shading;
  return has_tests(request) || (is_on_device(shading) &&
                                (shading.material() != nullptr || shading.blending() != nullptr));
}

/// A frame's shader and test for kernels. Construction waits.
template <class Exec>
class DeviceShading {
 public:
  /// `uploads` must outlive it. Has colours if can_resolve(request), and tests unless they are a
  /// caller's.
  DeviceShading(Exec& exec, Uploads<Exec>& uploads, DeviceTextures<Exec>& textures,
                const FrameRequest& request)
      : is_linear_(request.linear_light), has_test_(has_tests(request)) {
    textures.begin();
    if (wants_colors(request.targets) && can_resolve(request)) {
      const Shading& shading = request.shading;
      opacity_ = shading.opacity();
      blends_ = shading.blending() != nullptr;
      if (const LitShading* const lit = shading.lit()) {
        model_ = lit->model;
        lit_.emplace(exec, uploads, *lit);
      }
      if (const MaterialShading* const material = shading.material()) {
        shades_ = true;
        materials_.emplace(exec, uploads, textures, *material->scene, MaterialUse::all);
      } else if (blends_) {
        materials_.emplace(exec, uploads, textures, *shading.blending(), MaterialUse::alpha);
      }
    }
    const MaskTest* const masks = has_test_ ? request.test.masks() : nullptr;
    if (masks != nullptr)
      masks_.emplace(exec, uploads, textures, *masks->scene, MaterialUse::alpha);
  }

  [[nodiscard]] bool has_test() const { return has_test_; }
  [[nodiscard]] TestOnDevice test(const DeviceGeometry& geometry, ImageView<const float> behind,
                                  int y0) const {
    return {geometry, masks_ ? masks_->view() : MaterialView{}, masks_.has_value(), behind, y0};
  }

  /// Calls f(shade, test) with functors of (key, x, y): a premultiplied colour, and whether the
  /// fragment exists.
  template <class F>
  void with(const DeviceGeometry& geometry, const TestOnDevice& test, F&& f) const {
    const LitOnDevice lit{model_, geometry, lit_ ? lit_->view() : LitView{}, opacity_};
    if (materials_ || has_test_)
      f(MaterialOnDevice{lit, materials_ ? materials_->view() : MaterialView{}, opacity_, shades_,
                         blends_, is_linear_},
        test);
    else
      f(lit, KeepsFragments());
  }

 private:
  Shader model_ = Shader::flat;
  std::optional<LitUpload<Exec>> lit_;
  std::optional<MaterialUpload<Exec>> materials_, masks_;
  float opacity_ = 0;
  bool shades_ = false, blends_ = false, is_linear_;
  bool has_test_;
};

}  // namespace rastrum::raster
