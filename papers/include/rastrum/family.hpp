// SPDX-License-Identifier: BSD-3-Clause
// The papers' rasterizers (library Rastrum::family): named ways to find what triangles cover, named
// ways to resolve the fragments of a pixel, and paper 3's way to draw a terrain. All give the
// picture of a plain Renderer, bit for bit. They exist to be compared.
#pragma once

#include <string>
#include <vector>

#include <rastrum/render.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/tuning.hpp>

namespace RASTRUM_API rastrum {
namespace family {

/// An entry on one of the two axes of the papers' table.
struct AxisInfo {
  std::string name, description;
};
/// The rasterizers: `reference`, the plain one, then those that combine with every visibility.
[[nodiscard]] const std::vector<AxisInfo>& rasterizer_axis();
/// The visibilities; the first is the default.
[[nodiscard]] const std::vector<AxisInfo>& visibility_axis();

/// A point of the table: names on its two axes. A device also has `by-size`, its default.
struct Row {
  std::string rasterizer = "auto";
  std::string visibility = "auto";
  Tuning tuning{};             ///< parameters of the rasterizer
  bool hierarchical_z = true;  ///< if the rasterizer has it; changes no pixel

  bool operator==(const Row&) const = default;
};

/// Everything but the scene that a picture depends on, in one piece for a command line or a
/// benchmark.
struct Options : RendererOptions, FrameOptions, Row {};

/// A renderer that draws by a row. Device::automatic takes a GPU for the default row alone. Throws
/// as Renderer does, and Error{invalid_argument}, which lists the valid names or tunings. Its
/// frames throw Error{invalid_argument} if the row cannot draw layers.
[[nodiscard]] Renderer make_renderer(const RendererOptions& options, const Row& row);

/// Published approximations of exact transparency, for FrameOptions::transparency of any renderer.
/// They run on the CPU.
[[nodiscard]] TransparencyOptions wboit();   ///< weighted blended (McGuire and Bavoil 2013)
[[nodiscard]] TransparencyOptions mboit4();  ///< four power moments (Münstermann et al. 2018)
[[nodiscard]] TransparencyOptions mboit6();  ///< six power moments
[[nodiscard]] TransparencyOptions mlab4();   ///< four layers (Salvi and Vaidyanathan 2014)
/// Paper 4's method: sorted blocks and a filter of 1 to 64 fragments a pixel, without repair.
/// Throws Error{invalid_argument} for any other number.
[[nodiscard]] TransparencyOptions filtered(int fragments);

/// Paper 3's way to draw the same picture of a terrain, for TerrainOptions::added: `occlude` scan,
/// scatter, `fill` scan.
[[nodiscard]] const terrain::AddedMethod& terrain_words();

}  // namespace family
}  // namespace rastrum
