// SPDX-License-Identifier: BSD-3-Clause
// The papers' rasterizers (library Rastrum::family): named ways to find what triangles cover, and
// named ways to resolve the fragments of a pixel; and paper 3's way to draw a terrain. All give the
// picture that a plain Renderer gives, bit for bit: they are there to be compared.
#pragma once

#include <string>
#include <vector>

#include <rastrum/render.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/tuning.hpp>

namespace RASTRUM_API rastrum {
namespace family {

/// A row of one of the table's two axes.
struct AxisInfo {
  std::string name, description;
};
/// `reference`, the plain one, then those that combine with every visibility.
[[nodiscard]] const std::vector<AxisInfo>& rasterizer_axis();
/// The first is the default.
[[nodiscard]] const std::vector<AxisInfo>& visibility_axis();

/// A point of the table. On a device there is `by-size`, too, its default.
struct Row {
  std::string rasterizer = "auto";
  std::string visibility = "auto";
  Tuning tuning{};             ///< of the rasterizer
  bool hierarchical_z = true;  ///< where the rasterizer has it; changes no pixel

  bool operator==(const Row&) const = default;
};

/// Everything that a picture depends on but the scene, for callers that keep it in one piece: a
/// command line, a benchmark.
struct Options : RendererOptions, FrameOptions, Row {};

/// A renderer that draws by a row. Device::automatic takes a GPU for the default row alone. Throws
/// as Renderer, and Error{invalid_argument} that lists the names, or says which tunings
/// there are; its frames throw Error{invalid_argument} where the row cannot draw layers.
[[nodiscard]] Renderer make_renderer(const RendererOptions& options, const Row& row);

/// Published approximations of exact transparency, for FrameOptions::transparency of any renderer.
/// A device leaves them to the CPU.
[[nodiscard]] TransparencyOptions wboit();   ///< weighted blended (McGuire and Bavoil 2013)
[[nodiscard]] TransparencyOptions mboit4();  ///< four power moments (Münstermann et al. 2018)
[[nodiscard]] TransparencyOptions mboit6();  ///< six power moments
[[nodiscard]] TransparencyOptions mlab4();   ///< four layers (Salvi and Vaidyanathan 2014)
/// Paper 4's: sorted blocks and a filter of 1 to 64 fragments a pixel, without repair. Throws
/// Error{invalid_argument}.
[[nodiscard]] TransparencyOptions filtered(int fragments);

/// Paper 3's way to draw a terrain, for TerrainOptions::added: the `occlude` scan, the scatter and
/// the `fill` scan. The same picture.
[[nodiscard]] const terrain::AddedMethod& terrain_words();

}  // namespace family
}  // namespace rastrum
