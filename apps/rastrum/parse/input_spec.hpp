// SPDX-License-Identifier: BSD-3-Clause
// An INPUT of the command line: its file or shape, how it is read, where it stands and how it
// looks.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::cli {

inline constexpr std::string_view kBuiltin = "builtin:";

/// Scaled about its origin, turned about the world's x, y and z axes in this order, then moved.
struct Placement {
  double x = 0, y = 0, z = 0, scale = 1;
  double rx_deg = 0, ry_deg = 0, rz_deg = 0;

  bool operator==(const Placement&) const = default;
  [[nodiscard]] Mat4d matrix() const;
};

/// Replaces what a file says.
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
/// takes them also among its own parameters. A file of that exact name comes first. Throws
/// UsageError that names the input.
[[nodiscard]] InputSpec parse_input(const std::string& text);

enum class Normals {
  file,    ///< the file's; made with creases if it has none
  crease,  ///< always made; smooth but for edges sharper than the crease angle
  vertex,  ///< always made; area-weighted
  face,    ///< one per triangle
};

struct NormalOptions {
  Normals kind = Normals::file;
  double crease_deg = 40;  ///< 180: as Normals::vertex
};

/// In px.
struct PixelSizes {
  float point = 1, line = 1;
};

struct InputReading {
  std::string format{};  ///< of inputs without an extension: one of io::scene_formats, or empty
  io::ReadOptions options{};
};

[[nodiscard]] bool is_stdin(const std::string& source);
/// Whether only `format` tells what it is, as for a pipe.
[[nodiscard]] bool is_unnamed(const std::string& source, std::string_view format);
/// Throws UsageError for a pipe without a format, and for two uses of standard input.
void check_inputs(const std::vector<std::string>& inputs, std::string_view format);
/// So that no output replaces one (files.hpp).
void remember_inputs(const std::vector<std::string>& inputs);

}  // namespace rastrum::cli
