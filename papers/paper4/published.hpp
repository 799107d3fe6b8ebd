// SPDX-License-Identifier: BSD-3-Clause
// Paper 4: K. Jakubowski, "LucidRaster: GPU software rasterizer for exact order-independent
// transparency". These figures are from its text; its tables of each scene are pictures.
#pragma once

#include <array>
#include <string_view>

namespace rastrum::bench::paper4 {

/// Section 3, "Fragment sorting errors": percent of wrong pixels by the size of the depth filter;
/// 0: not published. The scenes are ours, or not available.
inline constexpr std::array<int, 3> kFilters{3, 8, 12};
struct WrongPixels {
  std::string_view scene;
  std::array<double, 3> percent;
};
inline constexpr WrongPixels kAverage{"average", {0.17, 0.02, 0.01}};
inline constexpr std::array<WrongPixels, 3> kWrongPixels{
    {{"hairball", {0.41, 0, 0}}, {"san-miguel", {0.50, 0, 0}}, {"white-oak", {1.02, 0.08, 0}}}};

/// Time over unsorted hardware blending: SW/HW over all scenes and GPUs.
struct OverUnsorted {
  double average, least, most;
};
inline constexpr OverUnsorted kOverUnsorted{3.3, 2.1, 5.1};

/// The same for other techniques, which the paper takes from the one on moments.
struct Other {
  std::string_view technique;
  double over_unsorted;
};
inline constexpr std::array<Other, 4> kOthers{
    {{"wboit", 1.17}, {"mboit4", 2.6}, {"mboit6", 3.1}, {"mlab4", 4.75}}};

/// The alpha at which a block is finished, if the early end is on.
inline constexpr float kAlphaThreshold = 1 - 1.0F / 128;

}  // namespace rastrum::bench::paper4
