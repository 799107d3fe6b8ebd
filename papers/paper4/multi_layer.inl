// SPDX-License-Identifier: BSD-3-Clause
// Multi-layer alpha blending (in_one_pass.cpp), in lanes of pixels or in one float. Fragments come
// in order of submission, so of two at one depth the earlier one is in front, and depths alone give
// the order.

/// Premultiplied colour and transmittance.
struct Merged {
  F r, g, b, through;

  RASTRUM_LANES void put_before(const Merged& o) {
    r = r + through * o.r;
    g = g + through * o.g;
    b = b + through * o.b;
    through = through * o.through;
  }
};

struct KeptLayers {
  F depth[kKeptLayers];  ///< nearest first; below 0: none
  Merged merged[kKeptLayers];

  RASTRUM_LANES KeptLayers(const MultiLayerBlock& block, std::size_t i) {
    for (std::size_t k = 0; k < kKeptLayers; ++k) {
      const auto& layer = block.layers[k];
      depth[k] = load(layer.depth + i);
      merged[k] = {load(layer.r + i), load(layer.g + i), load(layer.b + i),
                   load(layer.through + i)};
    }
  }
  RASTRUM_LANES void store_to(MultiLayerBlock& block, std::size_t i) const {
    for (std::size_t k = 0; k < kKeptLayers; ++k) {
      auto& layer = block.layers[k];
      store(depth[k], layer.depth + i);
      store(merged[k].r, layer.r + i);
      store(merged[k].g, layer.g + i);
      store(merged[k].b, layer.b + i);
      store(merged[k].through, layer.through + i);
    }
  }

  /// Inserts a fragment by depth. The layers behind it move on by one place, and the one that
  /// leaves the last place merges with the last.
  RASTRUM_LANES void add(const V4& color, F at) {
    Merged fragment{color.x, color.y, color.z, set(1) - color.w};
    F moved = at;
    for (std::size_t k = 0; k < kKeptLayers; ++k) {
      const auto nearer = at > depth[k];
      const F other_depth = choose(nearer, depth[k], moved);
      const Merged other{choose(nearer, merged[k].r, fragment.r),
                         choose(nearer, merged[k].g, fragment.g),
                         choose(nearer, merged[k].b, fragment.b),
                         choose(nearer, merged[k].through, fragment.through)};
      depth[k] = choose(nearer, moved, depth[k]);
      merged[k] = {choose(nearer, fragment.r, merged[k].r), choose(nearer, fragment.g, merged[k].g),
                   choose(nearer, fragment.b, merged[k].b),
                   choose(nearer, fragment.through, merged[k].through)};
      moved = other_depth;
      fragment = other;
    }
    merged[kKeptLayers - 1].put_before(fragment);
  }
};

/// A pixel without a fragment has colour 0, and its merge changes nothing.
void multi_layer_row(const PackedRow& row, std::size_t first, MultiLayerBlock& block) noexcept {
  if (row.layers == 0) return;
  for (std::size_t part = 0; part < 8; part += kLanes) {
    const std::uint64_t* const keys = row.sort_keys + part;
    KeptLayers pixel(block, first + part);
    for (std::size_t k = 0; k < row.layers; ++k)
      pixel.add(load_colors(keys + k * 8, row.colors),
                choose(any_key(keys + k * 8), depths(keys + k * 8), set(-1)));
    pixel.store_to(block, first + part);
  }
}

void multi_layer_layer(const Layer& layer, MultiLayerBlock& block) noexcept {
  for (std::size_t i = 0; i < 64; i += kLanes) {
    if ((layer.mask >> i & kVector) == 0) continue;
    const auto some = lanes_of(layer.mask >> i);
    KeptLayers pixel(block, i);
    pixel.add(choose_or_zero(some, load(layer.colors, i)),
              choose(some, depths(layer.keys + i), set(-1)));
    pixel.store_to(block, i);
  }
}

void multi_layer_finish(const MultiLayerBlock& block, const BlockColors& behind,
                        BlockColors& out) noexcept {
  for (std::size_t i = 0; i < 64; i += kLanes) {
    const KeptLayers pixel(block, i);
    Merged all{set(0), set(0), set(0), set(1)};
    for (std::size_t k = 0; k < kKeptLayers; ++k) all.put_before(pixel.merged[k]);
    const V4 back = load(behind, i);
    store(V4{all.r + all.through * back.x, all.g + all.through * back.y,
             all.b + all.through * back.z, set(1) - all.through * (set(1) - back.w)},
          out, i);
  }
}

constexpr MultiLayerKernels kMultiLayer{multi_layer_row, multi_layer_layer, multi_layer_finish};
