// SPDX-License-Identifier: BSD-3-Clause
// Porter and Duff's `over`, premultiplied, in lanes (blend_lanes-inl.hpp) or in one float
// (over.hpp), so that all ways to blend have the same bits.

/// Colour so far, and the share of what lies behind that shows through.
struct SeenPixel {
  V4 color{};
  F through = set(1);
};

RASTRUM_LANES void add_behind(SeenPixel& seen, const V4& layer) {
  seen.color = seen.color + layer * seen.through;
  seen.through = seen.through * (set(1) - layer.w);
}

RASTRUM_LANES V4 over(const SeenPixel& seen, const V4& behind) {
  V4 color = seen.color + behind * seen.through;
  // Rounding must not make a pixel translucent that nothing shows through.
  color.w = choose(seen.through * (set(1) - behind.w) == set(0), set(1), color.w);
  return color;
}

RASTRUM_LANES V4 before(const V4& layer, const V4& behind) {
  return layer + behind * (set(1) - layer.w);
}
