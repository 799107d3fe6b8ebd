// Where alpha comes from, whatever the shader. A fragment's own alpha is base colour × vertex
// colour × texture × alpha map, interpolated and filtered as the material shader does.
//
//   AlphaMode::opaque   alpha = opacity
//   AlphaMode::mask     own alpha below the cutoff: a hole (a fragment test); else alpha = opacity
//   AlphaMode::blend    alpha = opacity · own alpha, in [0, 1], NaN 0
//
// The opacity is the frame's times the material's.
// Scenes without materials have one of AlphaMode::blend, so that vertex colours say it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/shade/material.hpp>

namespace rastrum::raster {

/// The flags of triangles by material: kTested for AlphaMode::mask and, with `blends`, kTranslucent
/// for AlphaMode::blend and an opacity below 1.
[[nodiscard]] std::vector<std::uint32_t> material_flags(std::span<const Material> materials,
                                                        bool blends);

/// Gives `draw`, which is of `mesh`, the flags of its materials (none: of no material) and returns
/// those that some triangle has. `flags` must outlive the draw. O(1), or O(triangles) where
/// face_materials have different ones.
std::uint32_t set_material_flags(Draw& draw, const MeshView& mesh,
                                 std::span<const std::uint32_t> flags);

/// Whether some vertex colour is translucent. O(vertices), divided among the threads of `exec`
/// (null: one).
[[nodiscard]] bool has_vertex_alpha(const MeshView& mesh, parallel::Threads* exec);

/// AlphaMode::mask. `scene` must outlive the test; its textures must hold those of the masks.
[[nodiscard]] std::unique_ptr<FragmentTest> make_alpha_test(const MaterialScene& scene, Isa isa);

/// The colours of `inner`, multiplied by alpha; what has none is not shaded. `blending` may be null
/// where no material is translucent; else its textures must hold those of such materials.
/// Both must outlive the shader, which has no further outputs.
[[nodiscard]] std::unique_ptr<BlockShader> make_alpha_shader(const BlockShader& inner,
                                                             const MaterialScene* blending,
                                                             float opacity);

/// What make_alpha_shader was given; none for another shader.
struct AlphaForm {
  const BlockShader* inner;
  const MaterialScene* blending;
  float opacity;
};
[[nodiscard]] std::optional<AlphaForm> alpha_form(const BlockShader& shader);

/// What make_alpha_test was given; null for another test.
[[nodiscard]] const MaterialScene* alpha_test_form(const FragmentTest& test);

}  // namespace rastrum::raster
