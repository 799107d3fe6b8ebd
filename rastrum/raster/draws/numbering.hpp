// SPDX-License-Identifier: BSD-3-Clause
// Checks and numbers the draws of a frame before anything is drawn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/scene/instance_runs.hpp>

namespace rastrum::raster {

/// How messages name draws.
struct DrawNames {
  std::string_view noun = "draw";      ///< a scene's draws are instances
  const InstanceRuns* runs = nullptr;  ///< of instances, numbered by their first

  [[nodiscard]] std::string of(std::size_t draw) const {
    const std::size_t number = runs == nullptr ? draw : runs->number(draw);
    return std::string(noun).append(" ").append(std::to_string(number));
  }
};

/// Numbers the primitives (from `first_id`) and vertices of all draws, and the draws of each
/// shader. Throws Error{invalid_argument} naming the draw: more primitives than ids, no source, or
/// a number of primitives, topology, line width, point size, depth bias or face material out of
/// range. O(draws), and O(primitives) with flags by material.
struct Totals {
  std::uint64_t primitives = 0;
  std::size_t vertices = 0;
};
[[nodiscard]] Totals number_draws(std::span<Draw> draws, std::uint64_t first_id = 0,
                                  const DrawNames& names = {});

/// Throws Error{invalid_argument} naming the first index that is out of range.
void check_indices(std::span<const Draw> draws, const DrawNames& names);

}  // namespace rastrum::raster
