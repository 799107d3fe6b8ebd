// SPDX-License-Identifier: BSD-3-Clause
// Where alpha comes from, for every shader. A fragment's own alpha is base colour × vertex colour ×
// texture × alpha map, interpolated and filtered as the material shader does.
//
//   AlphaMode::opaque   alpha = opacity
//   AlphaMode::mask     own alpha below the cutoff: a hole (a fragment test); else alpha = opacity
//   AlphaMode::blend    alpha = opacity · own alpha, in [0, 1], NaN 0
//
// The opacity is the product of the frame's, the material's and the instance's. A scene without
// materials acts as one of AlphaMode::blend, so vertex colours decide.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// Flags of triangles by material: kTested for AlphaMode::mask and, if `blends`, kTranslucent for
/// AlphaMode::blend and for an opacity below 1.
[[nodiscard]] std::vector<std::uint32_t> material_flags(std::span<const Material> materials,
                                                        bool blends);

/// Gives `draw`, of `instance`, the flags of its materials (empty: no materials). Returns all flags
/// that occur. `flags` must outlive the draw. O(1), or O(faces) where face_materials differ.
std::uint32_t set_material_flags(Draw& draw, const InstanceView& instance,
                                 std::span<const std::uint32_t> flags);

/// Whether a colour is translucent: the instance's or, without one, any of its geometry's.
/// O(colours), shared among the threads of `exec` (null: one).
[[nodiscard]] bool has_color_alpha(const InstanceView& instance, const ArrayView<Vec4>& colors,
                                   parallel::Threads* exec);

}  // namespace rastrum::raster
