// SPDX-License-Identifier: BSD-3-Clause
// Weighted blended transparency (in_one_pass.cpp), in lanes of pixels or in one float.

struct Weighted {
  V4 sum;
  F through;

  RASTRUM_LANES void add(const V4& c, F depth) {
    const F weight = c.w * max_of(set(0.01F), set(3000) * (depth * depth * depth));
    sum = sum + c * weight;
    through = through * (set(1) - c.w);
  }
};
RASTRUM_LANES Weighted load_weighted(const WeightedBlock& block, std::size_t i) {
  return {load(block.sum, i), load(block.through + i)};
}
RASTRUM_LANES void store_weighted(const Weighted& pixel, WeightedBlock& block, std::size_t i) {
  store(pixel.sum, block.sum, i);
  store(pixel.through, block.through + i);
}

/// A pixel without a fragment has colour 0, which changes nothing.
void weighted_row(const PackedRow& row, std::size_t first, WeightedBlock& block) noexcept {
  if (row.layers == 0) return;
  for (std::size_t part = 0; part < 8; part += kLanes) {
    const std::uint64_t* const keys = row.sort_keys + part;
    Weighted pixel = load_weighted(block, first + part);
    for (std::size_t k = 0; k < row.layers; ++k)
      pixel.add(load_colors(keys + k * 8, row.colors), depths(keys + k * 8));
    store_weighted(pixel, block, first + part);
  }
}

void weighted_layer(const Layer& layer, WeightedBlock& block) noexcept {
  for (std::size_t i = 0; i < 64; i += kLanes) {
    if ((layer.mask >> i & kVector) == 0) continue;
    const auto some = lanes_of(layer.mask >> i);
    Weighted pixel = load_weighted(block, i);
    pixel.add(choose_or_zero(some, load(layer.colors, i)),
              choose_or_zero(some, depths(layer.keys + i)));
    store_weighted(pixel, block, i);
  }
}

void weighted_finish(const WeightedBlock& block, const BlockColors& behind,
                     BlockColors& out) noexcept {
  for (std::size_t i = 0; i < 64; i += kLanes) {
    const Weighted pixel = load_weighted(block, i);
    const F weight = pixel.sum.w, through = pixel.through;
    const auto some = weight > set(0);
    const F scale = choose_or_zero(some, (set(1) - through) / choose(some, weight, set(1)));
    const V4 back = load(behind, i);
    V4 mixed = pixel.sum * scale + back * through;
    mixed.w = set(1) - through * (set(1) - back.w);
    store(mixed, out, i);
  }
}

constexpr WeightedKernels kWeighted{weighted_row, weighted_layer, weighted_finish};
