// SPDX-License-Identifier: BSD-3-Clause
// Maps linear light, which has no upper end, to what a display shows (docs/light.md, "Tone").
#pragma once

#include <cstdint>

#include <rastrum/config.hpp>

namespace RASTRUM_API rastrum {

/// The curve for a channel x > 0 of linear light, before the sRGB curve. The result is cut to 1.
enum class Tone : std::uint8_t {
  none,      ///< x
  reinhard,  ///< x / (1 + x): Reinhard and others, Photographic tone reproduction (2002)
  aces,      ///< Narkowicz's fit of the Academy's curve (2015)
  neutral,   ///< Khronos PBR Neutral: colours below 0.8 nearly as they are, whiter above
};

struct ToneMapping {
  Tone tone = Tone::none;
  float exposure_stops = 0;  ///< light is first multiplied by 2 to this power, in [-32, 32]

  bool operator==(const ToneMapping&) const = default;
};

}  // namespace rastrum
