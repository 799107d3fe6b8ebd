// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/parallel/device.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/raster/rules/projection.hpp>

namespace rastrum::raster {

/// The projected scene, for setup and again for shading.
struct FrameGeometry {
  int width = 0, height = 0;
  Viewport viewport;
  std::span<const Draw> draws;
  const ProjectedVertex* projected = nullptr;  ///< null: vertices are projected where they are read
  Isa isa = Isa::scalar;
  std::uint64_t number = 0;  ///< distinct for a process's frames, for caches; 0: none

  /// Null: vertices are projected where they are read.
  [[nodiscard]] const ProjectedVertex* projected_of(const Draw& draw) const {
    return projected == nullptr || draw.first_vertex == kNotProjected
               ? nullptr
               : projected + draw.first_vertex;
  }
  [[nodiscard]] ProjectedVertex vertex(const Draw& draw, std::uint32_t index) const {
    if (const ProjectedVertex* const all = projected_of(draw)) return all[index];
    ProjectedVertex v;
    draw.source.project(index, std::size_t{index} + 1, viewport, isa, &v);
    return v;
  }

  [[nodiscard]] Vec4d clip_position(const Draw& draw, std::uint32_t index) const {
    return draw.source.clip_position(index);
  }

  /// Draw::flags_of, and kCut or kCutAway by the draw's clip planes.
  [[nodiscard]] std::uint32_t flags_of(const Draw& draw, std::uint64_t primitive) const noexcept {
    return draw.cut == nullptr ? draw.flags_of(primitive)
                               : draw.flags_of(primitive) | cut_flags(draw, primitive);
  }

  /// O(log draws).
  [[nodiscard]] const Draw& draw_of(std::uint64_t id) const { return draw_with(draws, id); }

 private:
  [[nodiscard]] static std::uint32_t cut_flags(const Draw& draw, std::uint64_t primitive) noexcept;
};

}  // namespace rastrum::raster
