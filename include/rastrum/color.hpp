// SPDX-License-Identifier: BSD-3-Clause
// Colours as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <rastrum/image.hpp>

namespace RASTRUM_API rastrum {

/// The meaning of a colour's numbers. The plain shaders compute with display values, `material`
/// with light; each converts the other kind by the sRGB transfer.
enum class ColorSpace : std::uint8_t {
  display,  ///< sRGB, as people write colours and most files hold them
  linear,   ///< proportional to light, as in glTF
};

/// Display values, straight alpha, of '#rrggbb', '#rrggbbaa', '#rgb' or '#rgba' (one digit stands
/// for two of it), also without the #; of a name of CSS's; of 'transparent': in any case. None for
/// anything else.
[[nodiscard]] std::optional<Rgba8> color_of(std::string_view text);

/// The 148 names of CSS Color Module Level 4, section 6.1, in the order of the alphabet.
[[nodiscard]] std::vector<std::string_view> color_names();

}  // namespace rastrum
