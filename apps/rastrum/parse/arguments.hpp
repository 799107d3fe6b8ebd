// Values of options: text to numbers, and the error for a command line that cannot be meant.
#pragma once

#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <apps/command_line/choose.hpp>
#include <apps/command_line/parser.hpp>
#include <rastrum/device.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::cli {

/// For messages: "a, b, c".
template <class Names>
std::string joined(const Names& names) {
  std::string all;
  for (const auto& name : names) all.append(all.empty() ? "" : ", ").append(name);
  return all;
}
/// The texts between characters of `separators`: one more than there are of these.
[[nodiscard]] std::vector<std::string> parts_of(std::string_view text, std::string_view separators);

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

[[nodiscard]] Isa parse_isa(const std::string& text);        ///< of --isa
[[nodiscard]] Device parse_device(const std::string& text);  ///< of --device
/// The instruction sets of this machine, for help texts.
[[nodiscard]] std::string isa_names();

/// An option whose text `parse` turns into a value; what it throws names the option.
inline Option add(Parser& app, const char* names, const char* type, const std::string& help,
                  std::function<void(const std::string&)> parse) {
  return app.add(names, type, help, std::move(parse));
}

/// Options that are one value. Each `name` has static storage.
template <class T>
Option add_number(Parser& app, const char* name, const char* type, const std::string& help,
                  T& value) {
  return app.add(name, type, help,
                 [name, &value](const std::string& text) { value = parse_number(name, text); });
}
template <class T>
Option add_integer(Parser& app, const char* name, const char* type, const std::string& help,
                   T& value, int min, int max) {
  return app.add(name, type, help, [name, &value, min, max](const std::string& text) {
    value = parse_integer(name, text, min, max);
  });
}
template <class T>
Option add_vec3(Parser& app, const char* name, const char* type, const std::string& help,
                T& value) {
  return app.add(name, type, help,
                 [name, &value](const std::string& text) { value = parse_vec3(name, text); });
}

}  // namespace rastrum::cli
