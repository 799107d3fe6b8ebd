// Spheres under the shaders, several samples of a row at once (sphere_lanes_simd.cpp): the bits are
// those of QuadricShader's one sample.
#pragma once

#include <cstdint>

#include <rastrum/frame.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/setup/quadric_surface.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>

namespace rastrum::raster {

struct SphereLanes {
  /// The samples of a block whose keys end in `low`.
  std::uint64_t (*samples_of)(const std::uint64_t* keys, std::uint64_t low) noexcept;
  /// Sets normals and base colours of the samples `mask`, which a sphere has whose quadric is
  /// plain, at the centres of their pixels. `to_world`: of normals.
  void (*fill)(const QuadricSurface& sphere, const float (&to_world)[3][3], Vec3 base,
               const VisibleBlock& block, std::uint64_t mask, LitBlock& out) noexcept;
};

/// Null: that instruction set has none.
[[nodiscard]] const SphereLanes* sphere_lanes(Isa isa) noexcept;

}  // namespace rastrum::raster
