// SPDX-License-Identifier: BSD-3-Clause
// Counts of bytes and operations; see the header. They are the least that the picture rules allow,
// with nothing for binning, masks, gathers or tests that fail: a floor and not a model.
#include "floor.hpp"

namespace rastrum::bench {
namespace {

constexpr double kBytesPerVertex = 12 + 12;  // position, normal
constexpr double kBytesPerTriangle = 3 * 4;
constexpr double kBytesPerPixel = 4;

// 4 rows of 3 multiplies and 3 adds; a division, 3 multiplies, 2 × (multiply, add), 2 × (scale,
// round).
constexpr double kPerVertex = 24 + 4 + 4 + 4;
// 3 edges: 2 subtractions, then 2 multiplies and 2 additions for the value at a corner; area 3;
// depth plane: 4 differences, 6 products, 2 divisions, 4 additions.
constexpr double kPerTriangle = 3 * 6 + 3 + 16;
// 3 edge additions and comparisons, depth: 2 multiplies, 2 additions; the maximum.
constexpr double kPerFragment = 6 + 4 + 1;
// Barycentrics 9 and a division; n and v: 6 values of 5 operations; two normalizations of 10;
// n·v and turn 6 + 3; n·l 5 and its term 3; h 3 + 10; n·h 5; power and scale 6; 3 channels of
// multiply, add; and of scale, round where the colour is stored.
constexpr double kPerShade = 10 + 30 + 20 + 9 + 8 + 13 + 5 + 6 + 6;
constexpr double kPerPixel = kPerShade + 6;
// Alpha times the light that still shines through, a multiply and an add for 3 channels, and the
// light that shines through afterwards.
constexpr double kPerBlend = 1 + 6 + 1;

}  // namespace

Floor floor_of(const Workload& work, const MachineLimits& machine) {
  const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
  const double read =
      kBytesPerVertex * count(work.vertices) + kBytesPerTriangle * count(work.triangles);
  const double written = kBytesPerPixel * count(work.pixels);
  Floor floor;
  floor.bytes = read + written;
  floor.operations = kPerVertex * count(work.vertices) + kPerTriangle * count(work.triangles) +
                     kPerFragment * count(work.fragments) + kPerPixel * count(work.pixels_covered) +
                     (kPerShade + kPerBlend) * count(work.blended);
  floor.bytes_ms = (read / machine.read_gbs + written / machine.stream_gbs) / 1e6;
  floor.operations_ms = floor.operations / machine.gflops / 1e6;
  return floor;
}

}  // namespace rastrum::bench
