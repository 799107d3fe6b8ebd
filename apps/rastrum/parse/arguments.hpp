// SPDX-License-Identifier: BSD-3-Clause
// Values of options: text to numbers, and errors.
#pragma once

#include <cstdint>
#include <functional>
#include <numbers>
#include <ranges>
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
/// The texts between characters of `separators`, one more than there are of these.
[[nodiscard]] std::vector<std::string> parts_of(std::string_view text, std::string_view separators);

[[nodiscard]] std::string lower(std::string text);

/// In radians.
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
/// '#rrggbb', '#rrggbbaa', '#rgb' or '#rgba', also without the #, or a CSS name, in any case:
/// display values in [0, 1], straight alpha.
[[nodiscard]] Vec4 parse_color(std::string_view option, std::string_view text);

/// `parse` turns the text into a value; its errors name the option.
inline Option add(Parser& app, const char* names, const char* type, const std::string& help,
                  std::function<void(const std::string&)> parse) {
  return app.add(names, type, help, std::move(parse));
}

/// `wanted` describes `is_right`, as in "must be above 0".
[[nodiscard]] double parse_number_that(std::string_view option, std::string_view text,
                                       bool (*is_right)(double), const char* wanted);
[[nodiscard]] constexpr bool is_above_zero(double value) {
  return value > 0;
}

/// Options that are one value. Each `name` has static storage.
template <class T>
Option add_number(Parser& app, const char* name, const char* type, const std::string& help,
                  T& value) {
  return app.add(name, type, help,
                 [name, &value](const std::string& text) { value = parse_number(name, text); });
}
template <class T>
Option add_number_that(Parser& app, const char* name, const char* type, const std::string& help,
                       T& value, bool (*is_right)(double), const char* wanted) {
  return app.add(name, type, help, [name, &value, is_right, wanted](const std::string& text) {
    value = static_cast<T>(parse_number_that(name, text, is_right, wanted));
  });
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

/// --size: members `width` and `height`.
template <class Frame>
void add_size(Parser& app, Frame& frame) {
  add(app, "--size", "WxH", "size of the picture in pixels, up to 32768x32768 (default: 1280x720)",
      [&frame](const std::string& s) {
        const Size size = parse_size("--size", s);
        frame.width = size.width;
        frame.height = size.height;
      });
}
/// --device, --threads and --isa: members of these names.
template <class Options>
void add_device_options(Parser& app, Options& o) {
  add_choice(app, "--device", "NAME", "what draws: serial, threads, cuda, auto (default: threads)",
             o.device,
             {{"serial", Device::serial},
              {"threads", Device::threads},
              {"cuda", Device::cuda},
              {"auto", Device::automatic}});
  add_integer(app, "--threads", "N", "how many threads draw (default: all)", o.threads, 1, 4096);
  add(app, "--isa", "NAME",
      "instruction set; this machine has " +
          joined(std::views::transform(available_isas(), [](Isa isa) { return name(isa); })) +
          " (default: the last)",
      [&o](const std::string& s) {
        o.isa = choose<Isa>("--isa", s,
                            {{"scalar", Isa::scalar},
                             {"sse4", Isa::sse4},
                             {"avx2", Isa::avx2},
                             {"avx512", Isa::avx512},
                             {"neon", Isa::neon},
                             {"wasm", Isa::wasm}});
      });
}

}  // namespace rastrum::cli
