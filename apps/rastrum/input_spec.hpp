// An INPUT of the command line: which file or shape, where it stands and how it looks.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <rastrum/scene.hpp>

namespace rastrum::cli {

inline constexpr std::string_view kBuiltin = "builtin:";

/// Scaled about its origin, then turned about the world's x, y and z axes in this order, then
/// moved.
struct Placement {
  double x = 0, y = 0, z = 0, scale = 1;
  double rx_deg = 0, ry_deg = 0, rz_deg = 0;

  bool operator==(const Placement&) const = default;
  [[nodiscard]] Mat4d matrix() const;
};

/// Instead of what a file says.
struct Look {
  std::optional<Vec4> color;  ///< display values, straight alpha
  double opacity = 1;

  [[nodiscard]] bool given() const { return color || opacity != 1; }
};

struct InputSpec {
  std::string source;  ///< a file, or builtin:SHAPE with the shape's own parameters
  Placement placement;
  Look look;
};

/// `SOURCE[@name=value,…]` with x, y, z, scale, rx, ry, rz (degrees), color and opacity; a builtin
/// takes them among its own parameters, too. A file of that very name is meant before anything
/// else, whatever its name looks like. Throws UsageError that names the input.
[[nodiscard]] InputSpec parse_input(const std::string& text);

}  // namespace rastrum::cli
