// SPDX-License-Identifier: BSD-3-Clause
// Where alpha comes from, whatever the shader. A fragment's own alpha is base colour × vertex
// colour × texture × alpha map, interpolated and filtered as the material shader does.
//
//   AlphaMode::opaque   alpha = opacity
//   AlphaMode::mask     own alpha below the cutoff: a hole (a fragment test); else alpha = opacity
//   AlphaMode::blend    alpha = opacity · own alpha, in [0, 1], NaN 0
//
// The opacity is the frame's times the material's times the instance's.
// Scenes without materials have one of AlphaMode::blend, so that vertex colours say it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// The flags of triangles by material: kTested for AlphaMode::mask and, with `blends`, kTranslucent
/// for AlphaMode::blend and an opacity below 1.
[[nodiscard]] std::vector<std::uint32_t> material_flags(std::span<const Material> materials,
                                                        bool blends);

/// Gives `draw`, which is of `instance`, the flags of its materials (none: of no material) and
/// returns those that some triangle has. `flags` must outlive the draw. O(1), or O(faces) where
/// face_materials have different ones.
std::uint32_t set_material_flags(Draw& draw, const InstanceView& instance,
                                 std::span<const std::uint32_t> flags);

/// Whether some colour is translucent: the instance's, or where it has none one of its geometry's.
/// O(colours), divided among the threads of `exec` (null: one).
[[nodiscard]] bool has_color_alpha(const InstanceView& instance, const ArrayView<Vec4>& colors,
                                   parallel::Threads* exec);

}  // namespace rastrum::raster
