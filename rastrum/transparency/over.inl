// SPDX-License-Identifier: BSD-3-Clause
// Porter and Duff's `over`, premultiplied, in lanes (blend_lanes-inl.hpp) or in one float
// (over.hpp): one body, so that planes of pixels, packed fragments, the scalar kernels and devices
// have the same bits.

/// Colour so far, and how much of what lies behind is seen through it (Seen has 64 of them).
struct SeenPixel {
  V4 color{};
  F through = set(1);
};

/// Adds a layer behind what is seen.
RASTRUM_LANES void add_behind(SeenPixel& seen, const V4& layer) {
  seen.color = seen.color + layer * seen.through;
  seen.through = seen.through * (set(1) - layer.w);
}

/// `seen` over `behind`.
RASTRUM_LANES V4 over(const SeenPixel& seen, const V4& behind) {
  V4 color = seen.color + behind * seen.through;
  // A pixel that nothing is seen through is opaque, whatever the sum was rounded to.
  color.w = choose(seen.through * (set(1) - behind.w) == set(0), set(1), color.w);
  return color;
}

/// `layer` before `behind`.
RASTRUM_LANES V4 before(const V4& layer, const V4& behind) {
  return layer + behind * (set(1) - layer.w);
}
