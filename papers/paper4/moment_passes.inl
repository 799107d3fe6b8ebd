// SPDX-License-Identifier: BSD-3-Clause
// The passes of moment-based transparency over a block, in lanes of pixels or in one float.
#include <papers/paper4/moments.inl>

/// Widens the range of the depths so far by the depths of `some`.
template <class Mask>
RASTRUM_LANES void widen(Mask some, F depth, std::size_t column, MomentBlock& block) {
  store(max_of(load(block.nearest + column), choose_or_zero(some, depth)), block.nearest + column);
  const F positive = choose(some, max_of(depth, set(kLeastDepth)), set(1));
  store(min_of(load(block.farthest + column), positive), block.farthest + column);
}

void row_depths(const PackedRow& row, MomentBlock& block) noexcept {
  for (std::size_t column = 0; column < 8; column += kLanes)
    for (std::size_t k = 0; k < row.layers; ++k) {
      const std::uint64_t* const keys = row.sort_keys + k * 8 + column;
      widen(any_key(keys), depths(keys), column, block);
    }
}

void layer_depths(const Layer& layer, MomentBlock& block) noexcept {
  for (std::size_t i = 0; i < 64; i += kLanes) {
    if ((layer.mask >> i & kVector) == 0) continue;
    const auto some = lanes_of(layer.mask >> i);
    widen(some, depths(layer.keys + i), i % 8, block);
  }
}

RASTRUM_LANES Warp warp_of(const MomentBlock& block) {
  return {set(block.warp.nearest), set(block.warp.farthest), set(block.warp.scale),
          set(block.warp.offset)};
}

template <int n>
RASTRUM_LANES Sums<2 * n + 1> load_sums(const MomentBlock& block, std::size_t i) {
  Sums<2 * n + 1> sums;
  for (int k = 0; k <= 2 * n; ++k) sums.sum[k] = load(block.sum[k] + i);
  return sums;
}

/// A pixel without a fragment has colour 0, which adds nothing.
template <int n>
void whole_row(const PackedRow& row, std::size_t first, MomentBlock& block) noexcept {
  if (row.layers == 0) return;
  const Warp warp = warp_of(block);
  for (std::size_t part = 0; part < 8; part += kLanes) {
    const std::uint64_t* const keys = row.sort_keys + part;
    Sums<2 * n + 1> sums = load_sums<n>(block, first + part);
    for (std::size_t k = 0; k < row.layers; ++k)
      sums.add(absorbance(load_colors(keys + k * 8, row.colors).w), warp(depths(keys + k * 8)));
    const Problem<n> problem(sums);
    V4 color = load(block.colors, first + part);
    for (std::size_t k = 0; k < row.layers; ++k)
      color = color + load_colors(keys + k * 8, row.colors) *
                          transmittance(problem, sums.sum[0], warp(depths(keys + k * 8)));
    store(sums.sum[0], block.sum[0] + first + part);
    store(color, block.colors, first + part);
  }
}

template <int n>
void sum_layer(const Layer& layer, MomentBlock& block) noexcept {
  const Warp warp = warp_of(block);
  for (std::size_t i = 0; i < 64; i += kLanes) {
    if ((layer.mask >> i & kVector) == 0) continue;
    const auto some = lanes_of(layer.mask >> i);
    Sums<2 * n + 1> sums = load_sums<n>(block, i);
    // The keys of pixels without a fragment have any value.
    sums.add(choose_or_zero(some, absorbance(load(layer.colors.a + i))),
             choose_or_zero(some, warp(depths(layer.keys + i))));
    for (int k = 0; k <= 2 * n; ++k) store(sums.sum[k], block.sum[k] + i);
  }
}

template <int n>
void weigh_layer(const Layer& layer, MomentBlock& block) noexcept {
  const Warp warp = warp_of(block);
  for (std::size_t i = 0; i < 64; i += kLanes) {
    if ((layer.mask >> i & kVector) == 0) continue;
    const auto some = lanes_of(layer.mask >> i);
    const Sums<2 * n + 1> sums = load_sums<n>(block, i);
    const F weight = transmittance(Problem<n>(sums), sums.sum[0], warp(depths(layer.keys + i)));
    const V4 old = load(block.colors, i);
    store(choose(some, old + load(layer.colors, i) * weight, old), block.colors, i);
  }
}

void finish(const MomentBlock& block, const BlockColors& behind, BlockColors& out) noexcept {
  for (std::size_t i = 0; i < 64; i += kLanes) {
    const F through = exp_of_minus(load(block.sum[0] + i));
    const V4 color = load(block.colors, i), back = load(behind, i);
    const auto some = color.w > set(0);
    const F scale = choose_or_zero(some, (set(1) - through) / choose(some, color.w, set(1)));
    V4 mixed = color * scale + back * through;
    mixed.w = set(1) - through * (set(1) - back.w);
    store(mixed, out, i);
  }
}

template <int n>
constexpr MomentKernels kMomentKernels{row_depths,   layer_depths,   whole_row<n>,
                                       sum_layer<n>, weigh_layer<n>, finish};
