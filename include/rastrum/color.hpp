// SPDX-License-Identifier: BSD-3-Clause
// Colours as people write them, and the two meanings of their numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <rastrum/image.hpp>

namespace RASTRUM_API rastrum {

/// The meaning of a colour's numbers. The plain shaders compute with display values, `material`
/// with linear light; each converts the other kind by the sRGB transfer function.
enum class ColorSpace : std::uint8_t {
  display,  ///< sRGB, as people write colours and most files hold them
  linear,   ///< proportional to light, as in glTF
};

/// The colour that `text` names, as display values with straight alpha: '#rrggbb', '#rrggbbaa',
/// '#rgb' or '#rgba' (each digit counts twice), with or without the #; a name of CSS; or
/// 'transparent'. Upper and lower case are the same. None for anything else.
[[nodiscard]] std::optional<Rgba8> color_of(std::string_view text);

/// The 148 names of CSS Color Module Level 4, section 6.1, in alphabetical order.
[[nodiscard]] std::vector<std::string_view> color_names();

}  // namespace rastrum
