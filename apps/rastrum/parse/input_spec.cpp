// SPDX-License-Identifier: BSD-3-Clause
#include "input_spec.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include <rastrum/core/angle.hpp>
#include <rastrum/io/files.hpp>

#include "arguments.hpp"

namespace rastrum::cli {
namespace {

constexpr const char* kPlacementKeys = "x, y, z, scale, rx, ry, rz, color and opacity";

bool exists(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

bool says_its_format(const std::string& input) {
  const std::string extension = lower(std::filesystem::path(input).extension().string());
  return std::ranges::any_of(io::scene_formats(), [&](std::string_view format) {
    return extension == std::string(".").append(format);
  });
}

/// A rotation about `axis`, counter-clockwise as seen from its end.
Mat4d rotation(int axis, double degrees) {
  const SinCos a = sin_cos_degrees(degrees);
  Mat4d m = Mat4d::identity();
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  m.m[i][i] = m.m[j][j] = a.cos;
  m.m[i][j] = -a.sin;
  m.m[j][i] = a.sin;
  return m;
}

/// Sets the value of a key. Returns whether `name` is one.
bool set(InputSpec& spec, const std::string& input, std::string_view name, std::string_view value) {
  const std::string option = std::string(input).append(": ").append(name);
  Placement& p = spec.placement;
  for (const auto& [key, field] : {std::pair{"x", &p.x},
                                   {"y", &p.y},
                                   {"z", &p.z},
                                   {"scale", &p.scale},
                                   {"rx", &p.rx_deg},
                                   {"ry", &p.ry_deg},
                                   {"rz", &p.rz_deg},
                                   {"opacity", &spec.look.opacity}}) {
    if (name != key) continue;
    *field = parse_number(option, value);
    if (p.scale == 0) throw UsageError(input, "scale must not be 0");
    if (!(spec.look.opacity >= 0 && spec.look.opacity <= 1))
      throw UsageError(input, "opacity must lie in 0 to 1");
    return true;
  }
  if (name != "color") return false;
  spec.look.color = parse_color(option, value);
  return true;
}

/// Takes the keys out of the list `items`; calls other(item) for the rest.
template <class F>
void take_keys(InputSpec& spec, const std::string& input, std::string_view items,
               const char* separators, const F& other) {
  for (const std::string& item : parts_of(items, separators)) {
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos ||
        !set(spec, input, item.substr(0, equals), item.substr(equals + 1)))
      other(item);
  }
}

/// SHAPE[?name=value,…] without the keys, which the shape does not know.
void take_keys_of_builtin(InputSpec& spec, const std::string& input) {
  const std::size_t question = spec.source.find('?');
  if (question == std::string::npos) return;
  const std::string items = spec.source.substr(question + 1);
  spec.source.resize(question);
  char separator = '?';
  take_keys(spec, input, items, "&,", [&](std::string_view item) {
    spec.source += std::exchange(separator, '&');
    spec.source += item;
  });
}

}  // namespace

Mat4d Placement::matrix() const {
  Mat4d m = rotation(2, rz_deg) * rotation(1, ry_deg) * rotation(0, rx_deg);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m.m[i][j] *= scale;
  m.m[0][3] = x;
  m.m[1][3] = y;
  m.m[2][3] = z;
  return m;
}

InputSpec parse_input(const std::string& text) {
  InputSpec spec{text, {}, {}};
  const bool builtin = text.starts_with(kBuiltin);
  if (!builtin && exists(text)) return spec;
  const std::size_t at = text.rfind('@');
  if (at != std::string::npos) {
    const std::string before = text.substr(0, at);
    const std::string items = text.substr(at + 1);
    // A file with an @ in its name that does not exist is reported by that name.
    if (builtin || exists(before) || items.find('=') != std::string::npos) {
      spec.source = before;
      take_keys(spec, text, items, ",", [&](std::string_view item) {
        throw UsageError(text, std::string("expected ") + kPlacementKeys +
                                   " as name=value after @, got '" + std::string(item) + "'");
      });
    }
  }
  if (builtin) take_keys_of_builtin(spec, text);
  return spec;
}

bool is_stdin(const std::string& input) {
  return input == "-" || input == "/dev/stdin";
}

bool is_unnamed(const std::string& input, std::string_view format) {
  std::error_code ignored;
  if (input.starts_with(kBuiltin) || says_its_format(input) ||
      std::filesystem::is_directory(input, ignored))
    return false;
  return is_stdin(input) || !format.empty() || std::filesystem::is_fifo(input, ignored);
}

void check_inputs(const std::vector<std::string>& inputs, std::string_view format) {
  std::size_t from_stdin = 0;
  for (const std::string& input : inputs) {
    const std::string source = parse_input(input).source;
    if (is_stdin(source)) ++from_stdin;
    if (format.empty() && is_unnamed(source, format))
      throw UsageError(is_stdin(source) ? "standard input" : source,
                       "the name of a pipe does not tell the format: give it, as in --format ply");
  }
  if (from_stdin > 1)
    throw UsageError("INPUT",
                     "standard input can be read only once, but two inputs are standard input");
}

void remember_inputs(const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) io::remember_read(parse_input(input).source);
}

}  // namespace rastrum::cli
