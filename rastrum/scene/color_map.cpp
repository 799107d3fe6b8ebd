// SPDX-License-Identifier: BSD-3-Clause
// Colour maps by name, and lists of colours (color_map.hpp).
#include <algorithm>
#include <string>

#include <rastrum/color.hpp>
#include <rastrum/color_map.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/nearest_word.hpp>
#include <rastrum/error.hpp>

namespace rastrum {
namespace {

struct PublishedMap {
  std::string_view name;
  bool discrete;
  std::string_view digits;
};

#include <rastrum/scene/color_maps/tables.inc>

/// RRGGBB or RRGGBBAA; else none.
std::optional<Vec4> parsed(std::string_view digits) {
  if (digits.size() != 6 && digits.size() != 8) return std::nullopt;
  const std::optional<Rgba8> color = color_of(std::string("#").append(digits));
  if (!color) return std::nullopt;
  const auto channel = [](std::uint8_t byte) { return static_cast<float>(byte) / 255.0F; };
  return Vec4{channel(color->r), channel(color->g), channel(color->b), channel(color->a)};
}

}  // namespace

std::vector<std::string_view> color_map_names() {
  std::vector<std::string_view> names;
  for (const PublishedMap& m : kPublishedMaps) names.push_back(m.name);
  return names;
}

ColorMap color_map(std::string_view name) {
  const FloatScope floats;
  const bool reversed = name.ends_with("_r");
  const std::string_view stem = name.substr(0, name.size() - (reversed ? 2 : 0));
  for (const PublishedMap& m : kPublishedMaps) {
    if (m.name != stem) continue;
    ColorMap map{std::string(name), {}, m.discrete};
    for (std::size_t i = 0; i < m.digits.size(); i += 6)
      map.colors.push_back(parsed(m.digits.substr(i, 6)).value());
    if (reversed) std::reverse(map.colors.begin(), map.colors.end());
    return map;
  }
  std::vector<std::string> reverses;
  for (const PublishedMap& m : kPublishedMaps) reverses.push_back(std::string(m.name) + "_r");
  std::vector<std::string_view> known = color_map_names();
  std::string names;
  for (const std::string_view n : known) names.append(" ").append(n);
  known.insert(known.end(), reverses.begin(), reverses.end());
  throw Error(Errc::not_found, "no colour map is called '" + std::string(name) + "'" +
                                   did_you_mean(name, known) +
                                   " (there are, each also with _r for its reverse:" + names + ")");
}

ColorMap color_map_or_list(std::string_view text) {
  const FloatScope floats;
  if (text.empty() || text[0] != '#') return color_map(text);
  ColorMap map{std::string(text), {}, false};
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(", ", begin), text.size());
    const std::string_view one = text.substr(begin, end - begin);
    begin = end + 1;
    if (one.empty()) continue;
    const std::optional<Vec4> color = one[0] == '#' ? parsed(one.substr(1)) : std::nullopt;
    if (!color)
      throw Error(Errc::invalid_argument,
                  "a list of colours is #RRGGBB or #RRGGBBAA, separated by "
                  "commas; '" +
                      std::string(one) + "' is none");
    map.colors.push_back(*color);
  }
  return map;
}

}  // namespace rastrum
