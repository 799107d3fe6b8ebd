// SPDX-License-Identifier: BSD-3-Clause
// The oracle of transparency: at every sample all fragments of all triangles, sorted by their keys
// and blended in float64. It includes nothing of the library, so that an agreement of the two is
// evidence. Plain on purpose.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "tests/support/oracle.hpp"

namespace rastrum::test {

/// Premultiplied, display values.
struct Rgba64 {
  double r = 0, g = 0, b = 0, a = 0;

  Rgba64 operator+(const Rgba64& o) const { return {r + o.r, g + o.g, b + o.b, a + o.a}; }
  Rgba64 operator*(double s) const { return {r * s, g * s, b * s, a * s}; }
};

/// Where in its pixel a sample lies: 1/16 px from the centre, y down.
struct SamplePosition {
  int x, y;
};
/// D3D11's standard patterns: `samples` is 1, 4, 8 or 16 (checked).
[[nodiscard]] std::span<const SamplePosition> standard_positions(int samples);

/// A fragment to be shaded: the pixel, and where in the picture its colour is taken, n.8.
struct ShadePoint {
  int px, py;
  std::int64_t x_fx8, y_fx8;
};

/// The triangles of one picture, in order of submission.
struct LayerInput {
  int width = 0, height = 0;
  int samples = 1;
  std::span<const SnappedTriangle> triangles;
  /// By id: hides what is behind, and its own alpha is not looked at.
  std::function<bool(std::int64_t id)> is_opaque = [](std::int64_t) { return false; };
  /// The colour of a fragment.
  std::function<Rgba64(const SnappedTriangle&, const ShadePoint&)> color;
  /// Fragments that are not there, whatever covers them; null: all are.
  std::function<bool(const SnappedTriangle&, const ShadePoint&)> is_hole;
  Rgba64 background;  ///< premultiplied
};

enum class LayerOrder {
  depth,       ///< larger keys in front: nearer, then submitted first
  submission,  ///< what was submitted later in front; what opaque surfaces hide is left out
};

/// W × H, row 0 at the top.
struct LayerImage {
  int width = 0, height = 0;
  std::vector<Rgba64> color;  ///< over the background, averaged over the samples
  /// The largest key over the samples, of any surface; −1 and 0 where nothing is.
  std::vector<std::int64_t> ids;
  std::vector<float> depth;
  /// Translucent fragments that no opaque one hides, at the sample that has most.
  std::vector<std::uint32_t> layers;
  /// Whether equal depths, of two fragments of one sample, decided what was blended in which order.
  std::vector<std::uint8_t> tied;

  [[nodiscard]] std::uint32_t most_layers() const;
};

/// Cost: O(H · triangles + fragments · log layers); rows and columns that a bounding box misses by
/// more than a pixel are left out. A triangle is shaded once a pixel: at the centre if that is
/// covered, else at its first covered sample.
[[nodiscard]] LayerImage blend_layers(const LayerInput& input, LayerOrder order);

}  // namespace rastrum::test
