// SPDX-License-Identifier: BSD-3-Clause
// The shading and the fragment test of a draw or a frame: values, which the host calls by blocks
// and a device reads. Each may be a caller's own function (hooks.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <variant>

#include <rastrum/frame.hpp>
#include <rastrum/image.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/samples.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {  // GCC keeps what the first declaration says
class ProgramStages;             // program.hpp
}

namespace rastrum::raster {

class BlockShader;
class FragmentTest;
struct BinSurface;
struct BlockColors;
struct BlockPixels;
struct FrameGeometry;
struct SeenBin;
struct LitScene;
struct MaterialScene;
struct VisibleBlock;

/// The plain shaders (lit.hpp): all but `depth`, `material` and `classic`.
struct LitShading {
  Shader model = Shader::flat;
  const LitScene* scene = nullptr;
  bool operator==(const LitShading&) const = default;
};

/// The scene's materials (material.hpp).
struct MaterialShading {
  const MaterialScene* scene = nullptr;
  bool linear = false;  ///< FrameRequest::linear_light applies the transfer function
  bool operator==(const MaterialShading&) const = default;
};

/// The source of colours, and the alpha that multiplies them (alpha.hpp). All that it points to
/// must outlive the frame. The built-in shaders map their draws, in order, to the instances of
/// their scene, whatever other draws stand between.
class Shading {
 public:
  Shading() = default;  ///< no colour can be asked for
  Shading(const LitShading& lit) : colors_(lit) {}
  Shading(const MaterialShading& material) : colors_(material) {}
  Shading(const BlockShader& own) : colors_(&own) {}
  Shading(const ProgramStages& program);
  /// The caller's own; null: none.
  Shading(const BlockShader* own) {
    if (own != nullptr) colors_ = own;
  }
  /// The same colours times alpha. Fragments without alpha are not shaded, and there are no further
  /// outputs. `blending`: the scene whose translucent materials have the alpha, with their
  /// textures; null: there are none.
  [[nodiscard]] Shading with_alpha(const MaterialScene* blending, float opacity) const {
    Shading s = *this;
    s.blending_ = blending;
    s.opacity_ = opacity;
    return s;
  }

  [[nodiscard]] explicit operator bool() const { return colors_.index() != 0; }
  bool operator==(const Shading&) const = default;

  /// Null unless this kind makes the colours.
  [[nodiscard]] const LitShading* lit() const { return std::get_if<LitShading>(&colors_); }
  [[nodiscard]] const MaterialShading* material() const {
    return std::get_if<MaterialShading>(&colors_);
  }
  [[nodiscard]] const BlockShader* own() const {
    const auto* const own = std::get_if<const BlockShader*>(&colors_);
    return own == nullptr ? nullptr : *own;
  }
  [[nodiscard]] const MaterialScene* blending() const { return blending_; }
  [[nodiscard]] float opacity() const { return opacity_; }

  [[nodiscard]] bool has_alpha() const { return blending_ != nullptr || opacity_ != 1; }

  struct Hash {
    std::size_t operator()(const Shading& s) const noexcept {
      const void* const what = s.lit() != nullptr        ? static_cast<const void*>(s.lit()->scene)
                               : s.material() != nullptr ? s.material()->scene
                                                         : static_cast<const void*>(s.own());
      return std::hash<const void*>()(what);
    }
  };

 private:
  std::variant<std::monostate, LitShading, MaterialShading, const BlockShader*> colors_;
  const MaterialScene* blending_ = nullptr;
  float opacity_ = 1;
};

/// AlphaMode::mask (alpha.hpp): fragments below a material's cutoff are holes. The scene must have
/// the textures of the masks.
struct MaskTest {
  const MaterialScene* scene = nullptr;
  bool operator==(const MaskTest&) const = default;
};

/// Decides before the maximum which fragments of pieces with kTested exist. All that it points to
/// must outlive the frame.
class Testing {
 public:
  Testing() = default;  ///< all exist
  Testing(const MaskTest& masks) : test_(masks) {}
  Testing(const ProgramStages& program);
  /// The caller's own; null: all exist.
  Testing(const FragmentTest* own) {
    if (own != nullptr) test_ = own;
  }

  [[nodiscard]] explicit operator bool() const { return test_.index() != 0; }
  bool operator==(const Testing&) const = default;

  /// Null unless this kind tests.
  [[nodiscard]] const MaskTest* masks() const { return std::get_if<MaskTest>(&test_); }
  [[nodiscard]] const FragmentTest* own() const {
    const auto* const own = std::get_if<const FragmentTest*>(&test_);
    return own == nullptr ? nullptr : *own;
  }

 private:
  std::variant<std::monostate, MaskTest, const FragmentTest*> test_;
};

}  // namespace rastrum::raster
