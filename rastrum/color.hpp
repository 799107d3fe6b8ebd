// Colours as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <rastrum/image.hpp>

namespace rastrum {

/// What the numbers of colours are. The plain shaders write display values, `material` computes
/// with light: each converts what the other has, by the sRGB transfer.
enum class ColorSpace : std::uint8_t {
  display,  ///< sRGB: what people write, and most files have
  linear,   ///< proportional to light, as glTF's
};

/// Display values, straight alpha, of '#rrggbb', '#rrggbbaa', '#rgb' or '#rgba' (one digit stands
/// for two of it), also without the #; of a name of CSS's; of 'transparent': in any case. None for
/// anything else.
[[nodiscard]] std::optional<Rgba8> color_of(std::string_view text);

/// The 148 names of CSS Color Module Level 4, section 6.1, in the order of the alphabet.
[[nodiscard]] std::vector<std::string_view> color_names();

}  // namespace rastrum
