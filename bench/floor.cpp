// SPDX-License-Identifier: BSD-3-Clause
// The bytes and operations behind floor.hpp: the least that the picture rules allow. Binning,
// masks, gathers and failed tests cost nothing here: this is a floor, not a model.
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
// For 3 channels alpha times the transmittance, a multiply and an add; then the new transmittance.
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
