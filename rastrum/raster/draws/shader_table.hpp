// SPDX-License-Identifier: BSD-3-Clause
// The table of built-in shaders, one row each, from which every list of shaders is made. A new one
// of a normal and a base colour is a value of Shader, a row here, and a line of light()
// (shade/lit_fixed.inl).
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <rastrum/frame.hpp>

namespace rastrum::raster {

struct ShaderRow {
  std::string_view name;
  /// The parts of a surface that light() reads. Neither: light() does not have the shader.
  bool normal = false, base = false;
  bool lights = false;    ///< FrameOptions::lights apply
  bool in_place = false;  ///< arrays may be device memory
};

/// In the order of the enum.
inline constexpr std::array kShaders{
    ShaderRow{.name = "auto"},
    ShaderRow{.name = "flat", .base = true, .in_place = true},
    ShaderRow{.name = "depth"},
    ShaderRow{.name = "normal", .normal = true, .in_place = true},
    ShaderRow{.name = "id", .in_place = true},
    ShaderRow{.name = "lambert", .normal = true, .base = true, .lights = true, .in_place = true},
    ShaderRow{.name = "phong", .normal = true, .base = true, .lights = true, .in_place = true},
    ShaderRow{.name = "material", .lights = true},
    ShaderRow{.name = "wireframe"},
    ShaderRow{.name = "classic", .lights = true},
};

inline constexpr auto kLastShader = static_cast<Shader>(kShaders.size() - 1);

[[nodiscard]] constexpr const ShaderRow& row_of(Shader shader) {
  return kShaders[static_cast<std::size_t>(shader)];
}
/// Whether light() makes its colours.
[[nodiscard]] constexpr bool is_light(Shader shader) {
  return row_of(shader).normal || row_of(shader).base;
}

}  // namespace rastrum::raster
