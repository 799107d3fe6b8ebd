// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/rules/samples.hpp>

#include <algorithm>
#include <cstdlib>

namespace rastrum::raster {
namespace {

/// In sixteenths of a pixel, like the specification.
constexpr SampleOffset at(int x, int y) {
  return {x * kSubpixels / 16, y * kSubpixels / 16};
}

constexpr SampleOffset kOne[] = {at(0, 0)};
constexpr SampleOffset kFour[] = {at(-2, -6), at(6, -2), at(-6, 2), at(2, 6)};
constexpr SampleOffset kEight[] = {at(1, -3), at(-1, 3),  at(5, 1), at(-3, -5),
                                   at(-5, 5), at(-7, -1), at(3, 7), at(7, -7)};
constexpr SampleOffset kSixteen[] = {
    at(1, 1),  at(-1, -3), at(-3, 2),  at(4, -1), at(-5, -2), at(2, 5),  at(5, 3), at(3, -5),
    at(-2, 6), at(0, -7),  at(-4, -6), at(-6, 4), at(-8, 0),  at(7, -4), at(6, 7), at(-7, -8)};

}  // namespace

std::span<const SampleOffset> sample_offsets(int samples) noexcept {
  switch (samples) {
    case 1:
      return kOne;
    case 4:
      return kFour;
    case 8:
      return kEight;
    case 16:
      return kSixteen;
    default:
      return {};
  }
}

int reach_of(std::span<const SampleOffset> samples) noexcept {
  int reach = 0;
  for (const SampleOffset at : samples) reach = std::max({reach, std::abs(at.x), std::abs(at.y)});
  return reach;
}

}  // namespace rastrum::raster
