// Values of options: text to numbers, and the error for a command line that cannot be meant.
#pragma once

#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>

#include <apps/command_line/parser.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::cli {

/// In radians: people write degrees.
inline constexpr double kDegree = std::numbers::pi / 180;

/// Each throws UsageError that names `option` and shows what is wanted.
[[nodiscard]] double parse_number(std::string_view option, std::string_view text);  ///< finite
[[nodiscard]] int parse_integer(std::string_view option, std::string_view text, int min, int max);
[[nodiscard]] Vec3d parse_vec3(std::string_view option, std::string_view text);  ///< X,Y,Z
/// X,Y,Z,D: keeps where X x + Y y + Z z + D ≥ 0.
[[nodiscard]] ClipPlane parse_clip_plane(std::string_view option, std::string_view text);

struct Size {
  int width = 1280, height = 720;
};
[[nodiscard]] std::uint64_t parse_bytes(std::string_view option,
                                        std::string_view text);  ///< N, NK, NM or NG, from 1
[[nodiscard]] Size parse_size(std::string_view option, std::string_view text);  ///< WxH
/// '#rrggbb', '#rrggbbaa', '#rgb' or '#rgba', also without the #, or a name of CSS's, in any case:
/// display values in [0, 1], straight alpha.
[[nodiscard]] Vec4 parse_color(std::string_view option, std::string_view text);

}  // namespace rastrum::cli
