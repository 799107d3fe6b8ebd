// SPDX-License-Identifier: BSD-3-Clause
// FutSpace (Kristensen, Rasmussen, Sørensen and Troelsen, 2020), section 5.6: the parameters of
// figures 5.6 to 5.8. The paper plots its times without numbers, so only the findings in its text
// are here.
#pragma once

#include <array>
#include <string_view>

namespace rastrum::bench::paper3 {

inline constexpr std::string_view kMachine = "Ryzen 5 3600 (C) and GTX 1080 (OpenCL)";
/// Two of distance d, columns m and rows l keep this value while the third grows.
inline constexpr int kFixed = 10;
inline constexpr std::array kSizes{10, 100, 1000, 10000, 100000, 1000000};
/// Section 6.2, figures 6.7 to 6.9: shadows of a map of q × r with d_c samples a ray.
inline constexpr int kShadowEdge = 128, kShadowSamples = 32;
inline constexpr std::array kShadowSizes{128, 512, 2048, 8192, 32768};
inline constexpr std::string_view kFindings =
    "The paper finds that time grows least with d, since slices grow with its root, and most with "
    "m; parallel time behaves alike on its GPU.";

}  // namespace rastrum::bench::paper3
