// SPDX-License-Identifier: BSD-3-Clause
// The oracle of transparency: sorts all fragments of all triangles at every sample by key and
// blends them in float64. It includes nothing of the library, so agreement is evidence.
// Deliberately plain.
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

/// A sample's place in its pixel: 1/16 px from the centre, y down.
struct SamplePosition {
  int x, y;
};
/// D3D11's standard patterns: `samples` is 1, 4, 8 or 16 (checked).
[[nodiscard]] std::span<const SamplePosition> standard_positions(int samples);

/// Where a fragment is shaded: its pixel, and the point in the picture, n.8.
struct ShadePoint {
  int px, py;
  std::int64_t x_fx8, y_fx8;
};

/// The triangles of one picture, in order of submission.
struct LayerInput {
  int width = 0, height = 0;
  int samples = 1;
  std::span<const SnappedTriangle> triangles;
  /// By id: an opaque triangle hides what is behind it, and its alpha is ignored.
  std::function<bool(std::int64_t id)> is_opaque = [](std::int64_t) { return false; };
  /// The colour of a fragment.
  std::function<Rgba64(const SnappedTriangle&, const ShadePoint&)> color;
  /// Fragments that are left out; null: none.
  std::function<bool(const SnappedTriangle&, const ShadePoint&)> is_hole;
  Rgba64 background;  ///< premultiplied
};

enum class LayerOrder {
  depth,       ///< larger keys in front: nearer, then submitted first
  submission,  ///< later submissions in front; fragments behind opaque surfaces are left out
};

/// W × H, row 0 at the top.
struct LayerImage {
  int width = 0, height = 0;
  std::vector<Rgba64> color;  ///< over the background, averaged over the samples
  /// The largest key over the samples, of any surface; −1 and 0 where there is none.
  std::vector<std::int64_t> ids;
  std::vector<float> depth;
  /// Visible translucent fragments of the sample with the most.
  std::vector<std::uint32_t> layers;
  /// Whether the order of blending depended on equal depths of two fragments in a sample.
  std::vector<std::uint8_t> tied;

  [[nodiscard]] std::uint32_t most_layers() const;
};

/// Cost: O(H · triangles + fragments · log layers), without rows and columns more than a pixel
/// outside of a bounding box. A triangle is shaded once per pixel: at the centre if it is covered,
/// else at the first covered sample.
[[nodiscard]] LayerImage blend_layers(const LayerInput& input, LayerOrder order);

}  // namespace rastrum::test
