// Which shaders and fragment tests of a frame a device has, and their arrays there. A caller's own
// shader or discard function is code of the host's: such frames are shaded, or drawn, by the CPU.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/materials.cuh>
#include <rastrum/raster/cuda/resolve.cuh>
#include <rastrum/raster/cuda/upload.cuh>
#include <rastrum/raster/draws/over_picture.hpp>
#include <rastrum/raster/shade/alpha.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/material.hpp>

namespace rastrum::raster {

/// What a device knows of a shader.
struct ShaderForm {
  std::optional<LitForm> lit;            ///< the colours: this,
  std::optional<MaterialForm> material;  ///< or this
  const MaterialScene* blending = nullptr;
  float opacity = 1;

  /// None of a shader that it does not know.
  [[nodiscard]] static std::optional<ShaderForm> of(const BlockShader* shader) {
    if (shader == nullptr) return std::nullopt;
    const AlphaForm alpha = alpha_form(*shader).value_or(AlphaForm{shader, nullptr, 1});
    ShaderForm form{lit_form(*alpha.inner), material_form(*alpha.inner), alpha.blending,
                    alpha.opacity};
    const bool is_lit = form.lit && LitOnDevice::has(form.lit->model);
    const bool is_one_scene =
        !form.material || form.blending == nullptr || form.blending == form.material->scene;
    return (is_lit || form.material) && is_one_scene ? std::optional(form) : std::nullopt;
  }
};

/// What a device knows of a fragment test.
struct TestForm {
  const OverPicture* over = nullptr;
  const MaterialScene* masks = nullptr;

  /// None of a test that it does not know.
  [[nodiscard]] static std::optional<TestForm> of(const FragmentTest& test) {
    TestForm form;
    form.over = dynamic_cast<const OverPicture*>(&test);
    const FragmentTest* const inner = form.over != nullptr ? form.over->inner() : &test;
    if (inner == nullptr) return form;
    form.masks = alpha_test_form(*inner);
    return form.masks != nullptr ? std::optional(form) : std::nullopt;
  }
};

/// Whether some primitive is tested.
[[nodiscard]] inline bool has_tests(const FrameRequest& request) {
  return request.test != nullptr && std::ranges::any_of(request.draws, [](const Draw& draw) {
           return (draw.any_flags() & kTested) != 0;
         });
}
[[nodiscard]] inline bool wants_colors(const Targets& t) {
  return !t.color8.empty() || !t.color.empty();
}
/// Whether no target, way to blend or shader of the frame lacks a form for the device. Only a
/// caller's shader has extra targets; what is behind linear light is decoded by powers of the
/// host's library.
[[nodiscard]] inline bool can_resolve(const FrameRequest& request) {
  const Targets& t = request.targets;
  if (!t.extra.empty() || (t.over && request.linear_light)) return false;
  return !wants_colors(t) || ShaderForm::of(request.shader);
}

/// Whether colours, alpha or tests are more than those of a lit shader.
[[nodiscard]] inline bool uses_materials(const FrameRequest& request) {
  if (has_tests(request)) return true;
  const auto form = ShaderForm::of(request.shader);
  return form && (form->material || form->blending != nullptr);
}

/// A frame's shader and test, for kernels. Waits when it is made.
template <class Exec>
class DeviceShading {
 public:
  /// `uploads` must outlive it. Colours are had where can_resolve(request), tests where they have
  /// a TestForm.
  DeviceShading(Exec& exec, Uploads<Exec>& uploads, DeviceTextures<Exec>& textures,
                const FrameRequest& request)
      : is_linear_(request.linear_light) {
    textures.begin();
    std::optional<ShaderForm> shader;
    if (wants_colors(request.targets) && can_resolve(request))
      shader = ShaderForm::of(request.shader);
    std::optional<TestForm> test;
    if (has_tests(request)) test = TestForm::of(*request.test);
    has_test_ = test.has_value();
    if (shader && shader->lit) {
      model_ = shader->lit->model;
      lit_.emplace(exec, uploads, *shader->lit);
    }
    opacity_ = shader ? shader->opacity : 0;
    shades_ = shader && shader->material;
    blends_ = shader && shader->blending != nullptr;
    if (shades_)
      materials_.emplace(exec, uploads, textures, *shader->material->scene, MaterialUse::all);
    else if (blends_)
      materials_.emplace(exec, uploads, textures, *shader->blending, MaterialUse::alpha);
    if (!test || test->masks == nullptr) return;
    masks_.emplace(exec, uploads, textures, *test->masks, MaterialUse::alpha);
    std::vector<std::uint32_t> flags;
    const std::span<const Draw> draws =
        test->over != nullptr ? test->over->given() : std::span<const Draw>(request.draws);
    for (const Draw& draw : draws) flags.push_back(draw.flags);
    flags_ = parallel::to_device(exec, flags);
  }

  [[nodiscard]] bool has_test() const { return has_test_; }
  [[nodiscard]] TestOnDevice test(const DeviceGeometry& geometry, ImageView<const float> behind,
                                  int y0) const {
    return {geometry,
            masks_ ? masks_->view() : MaterialView{},
            masks_.has_value(),
            {flags_.data(), flags_.size()},
            behind,
            y0};
  }

  /// Calls f(shade, test) with functors (key, x, y): to a premultiplied colour, and to whether the
  /// fragment is there.
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
  template <class T>
  using Array = decltype(parallel::make_buffer<T>(std::declval<Exec&>(), 0));

  LitModel model_ = LitModel::flat;
  std::optional<LitUpload<Exec>> lit_;
  std::optional<MaterialUpload<Exec>> materials_, masks_;
  Array<std::uint32_t> flags_;
  float opacity_ = 0;
  bool shades_ = false, blends_ = false, has_test_ = false;
  bool is_linear_ = false;
};

}  // namespace rastrum::raster
