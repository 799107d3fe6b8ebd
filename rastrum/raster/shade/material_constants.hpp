// SPDX-License-Identifier: BSD-3-Clause
// Constants of the material shader (material.hpp).
#pragma once

#include <rastrum/vec.hpp>

namespace rastrum::raster {

inline constexpr Vec3 kKeyLight{0.32444284F, 0.48666426F, 0.81110710F};  // (0.4, 0.6, 1) / √1.52
inline constexpr float kKeyRadiance = 0.65F;
inline constexpr Vec3 kFillLight{-0.79603036F, 0.099503795F,
                                 0.59702277F};  // (−0.8, 0.1, 0.6)/√1.01
inline constexpr float kFillRadiance = 0.2F;
inline constexpr float kSky = 0.3F, kGround = 0.12F;
inline constexpr float kSkyMean = (kSky + kGround) / 2, kSkySlope = (kSky - kGround) / 2;
inline constexpr float kDielectricF0 = 0.04F;  ///< index of refraction 1.5
inline constexpr float kMinRoughness = 0.045F;
inline constexpr float kMostLight = 65504;  ///< of a blended colour: no infinities

}  // namespace rastrum::raster
