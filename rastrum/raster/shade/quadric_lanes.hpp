// SPDX-License-Identifier: BSD-3-Clause
// Spheres and tubes under the shaders, several samples of a row at once (quadric_lanes_simd.cpp):
// the bits are those of QuadricShader's one sample.
#pragma once

#include <cstdint>

#include <rastrum/frame.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/rules/quadric_surface.hpp>
#include <rastrum/raster/shade/lit_kernels.hpp>

namespace rastrum::raster {

/// The surfaces of a block's samples as shading needs them.
struct QuadricBlock {
  LitBlock lit;
  alignas(64) float alpha[64];  ///< the surfaces' own
};

struct QuadricLanes {
  /// The samples of a block whose keys end in `low`.
  std::uint64_t (*samples_of)(const std::uint64_t* keys, std::uint64_t low) noexcept;
  /// Sets the surface of a sphere or a hull at the samples `mask`, which see it, at the centres of
  /// their pixels. `to_world`: for normals; `colors`: at the ends of its axis.
  void (*fill)(const QuadricSurface& surface, const float (&to_world)[3][3],
               const Vec4 (&colors)[2], const VisibleBlock& block, std::uint64_t mask,
               QuadricBlock& out) noexcept;
};

/// Null: that instruction set has none.
[[nodiscard]] const QuadricLanes* quadric_lanes(Isa isa) noexcept;

}  // namespace rastrum::raster
