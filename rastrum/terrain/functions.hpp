// Terrains that are functions of the plane, by name; expression.hpp has those of a text.
#pragma once

#include <string_view>
#include <vector>

#include <rastrum/terrain/light.hpp>

namespace rastrum::terrain {

struct FunctionInfo {
  std::string_view name, description;
  double low, high;  ///< what the heights lie between
};

/// Those of paper 3 (its figure 6.1 and its program's list) and fractal noise. Their arithmetic is
/// ours (no sine of the C library), so they are the same bits on every machine.
[[nodiscard]] const std::vector<FunctionInfo>& named_functions();

/// Throws Error{not_found} that lists the names.
[[nodiscard]] HeightFunction named_function(std::string_view name);

/// The least and the greatest finite height on a grid of 128² points over [0, 1024)², for the
/// colours of expressions; (0, 1) where there is none.
struct HeightRange {
  double low = 0, high = 1;
};
[[nodiscard]] HeightRange sampled_range(const HeightFunction& function);

}  // namespace rastrum::terrain
