// AlphaMode::mask as a fragment test: a fragment whose alpha (base colour × texture × alpha map ×
// vertex colour, interpolated and filtered as the material shader does) is below the material's
// cutoff is a hole, whatever the shader.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <rastrum/raster/geometry.hpp>
#include <rastrum/raster/shaders/material.hpp>

namespace rastrum::raster {

/// The flags of triangles by material: kTested for AlphaMode::mask.
[[nodiscard]] std::vector<std::uint32_t> material_flags(std::span<const Material> materials);

/// Gives `draw`, which is of `mesh`, the flags of its materials (none: of no material) and returns
/// those that some triangle has. `flags` must outlive the draw. O(1), or O(triangles) where
/// face_materials have different ones.
std::uint32_t set_material_flags(Draw& draw, const MeshView& mesh,
                                 std::span<const std::uint32_t> flags);

/// `scene` must outlive the test; its textures must hold those of the masks.
[[nodiscard]] std::unique_ptr<FragmentTest> make_alpha_test(const MaterialScene& scene, Isa isa);

}  // namespace rastrum::raster
