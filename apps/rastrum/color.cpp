// Colours of the command line, and what was meant instead.
#include <string>
#include <string_view>

#include <rastrum/color.hpp>
#include <rastrum/core/nearest_word.hpp>
#include "arguments.hpp"

namespace rastrum::cli {

Vec4 parse_color(std::string_view option, std::string_view text) {
  const std::optional<Rgba8> color = color_of(text);
  if (!color)
    throw UsageError(option,
                     "expected a colour such as '#ffcc00', '#ffcc0080', fc0 or gold, got '" +
                         std::string(text) + "'" + did_you_mean(text, color_names()));
  const auto value = [](std::uint8_t v) { return static_cast<float>(v) / 255.0F; };
  return {value(color->r), value(color->g), value(color->b), value(color->a)};
}

}  // namespace rastrum::cli
