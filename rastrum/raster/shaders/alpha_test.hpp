// AlphaMode::mask as a fragment test: a fragment whose alpha (base colour × texture × alpha map ×
// vertex colour, interpolated and filtered as the material shader does) is below the material's
// cutoff is a hole, whatever the shader.
#pragma once

#include <memory>

#include <rastrum/raster/geometry.hpp>
#include <rastrum/raster/shaders/material.hpp>

namespace rastrum::raster {

/// Whether a triangle of `mesh` has a material with AlphaMode::mask: its draw needs kTested.
/// O(1), or O(triangles) with face_materials.
[[nodiscard]] bool has_mask(const MeshView& mesh, std::span<const Material> materials);

/// `scene` must outlive the test; its textures must hold those of the masks.
[[nodiscard]] std::unique_ptr<FragmentTest> make_alpha_test(const MaterialScene& scene, Isa isa);

}  // namespace rastrum::raster
