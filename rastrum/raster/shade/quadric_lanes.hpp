// SPDX-License-Identifier: BSD-3-Clause
// Spheres and tubes under the shaders, several samples of a row at once (quadric_lanes_simd.cpp),
// with QuadricShader's bits.
#pragma once

#include <cstdint>

#include <rastrum/frame.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/rules/quadric_surface.hpp>
#include <rastrum/raster/shade/lit_kernels.hpp>

namespace rastrum::raster {

struct QuadricBlock {
  LitBlock lit;
  alignas(64) float alpha[64];  ///< own alpha
};

struct QuadricLanes {
  /// The samples of a block whose keys end in `low`.
  std::uint64_t (*samples_of)(const std::uint64_t* keys, std::uint64_t low) noexcept;
  /// Sets the surface of a sphere or a hull at the samples `mask`, which see it, at pixel centres.
  /// `to_world`: for normals. `colors`: at the ends of its axis.
  void (*fill)(const QuadricSurface& surface, const float (&to_world)[3][3],
               const Vec4 (&colors)[2], const VisibleBlock& block, std::uint64_t mask,
               QuadricBlock& out) noexcept;
};

/// Null: the instruction set has none.
[[nodiscard]] const QuadricLanes* quadric_lanes(Isa isa) noexcept;

}  // namespace rastrum::raster
