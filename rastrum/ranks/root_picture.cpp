// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/root_picture.hpp>

#include <algorithm>
#include <bit>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/ranks/layer_merge.hpp>
#include <rastrum/transparency/blend_kernels.hpp>

namespace rastrum::ranks {

RootPicture::RootPicture(const BlockGrid& grid, const raster::FrameRequest& request,
                         parallel::Threads* threads)
    : grid_(grid),
      request_(request),
      plan_(raster::FramePlan::of(request, true, false)),
      threads_(threads),
      masks_(grid.count()),
      behind_(grid.count()),
      stored_(grid.count()) {}

void RootPicture::take_behind(Reader from) {
  while (!from.at_end()) {
    const BlockMask b = from.take_mask();
    auto& colors = behind_[b.block];
    if (!colors) colors = std::make_unique<raster::BlockColors>();
    for (std::uint64_t m = b.mask; m != 0; m &= m - 1)
      colors->set(std::countr_zero(m), from.take<Vec4>());
    masks_[b.block] |= b.mask;
  }
}

void RootPicture::take_seen(const Mail& mail) {
  std::vector<Reader> blocks;
  for (std::size_t r = 0; r < mail.ranks(); ++r)
    for (Reader from = mail.from(r); !from.at_end();) {
      blocks.push_back(from);
      (void)from.take_bytes(seen_bytes(Reader(from).take_mask().mask));
    }
  parallel::for_each_index(
      threads_, blocks.size(), [&](std::size_t i) { take_block(ranks::take_seen(blocks[i])); },
      kGrain);
}

void RootPicture::take_seen(SharedLayers layers) {
  const auto take = [&](std::size_t b) {
    if (layers.has(b)) take_block(layers.take_seen(b));
  };
  parallel::for_each_index(threads_, grid_.count(), take, kGrain);
}

void RootPicture::take_block(const SeenBlock& block) {
  const std::uint32_t b = block.where.block;
  static constexpr raster::BlockColors kNothing{};
  raster::BlockColors out;
  transparency::blend_kernels(request_.isa)
      .finish(block.seen, behind_[b] ? *behind_[b] : kNothing, out);
  stored_[b] = 1;
  if (request_.samples > 1) {
    // It is final, with nothing seen through it.
    for (std::uint64_t m = block.where.mask; m != 0; m &= m - 1)
      out.set(std::countr_zero(m), block.seen.at(std::countr_zero(m)).color);
  }
  for (std::uint64_t m = masks_[b] & ~block.where.mask; m != 0; m &= m - 1)
    out.set(std::countr_zero(m), behind_[b]->at(std::countr_zero(m)));
  store(b, block.where.mask | masks_[b], out);
}

void RootPicture::store_behind(std::size_t block) {
  static constexpr raster::BlockColors kNothing{};
  stored_[block] = 1;
  store(static_cast<std::uint32_t>(block), masks_[block],
        behind_[block] ? *behind_[block] : kNothing);
}

template <class F>
void RootPicture::store_all_behind(const F& where) {
  const auto store = [&](std::size_t b) {
    if (stored_[b] == 0 && where(b)) store_behind(b);
  };
  parallel::for_each_index(threads_, grid_.count(), store, kGrain);
}

void RootPicture::store_rest(SharedLayers layers) {
  store_all_behind([&](std::size_t b) { return !layers.has(b); });
}

void RootPicture::finish() {
  store_all_behind([](std::size_t) { return true; });
}

void RootPicture::store(std::uint32_t block, std::uint64_t mask,
                        const raster::BlockColors& colors) const {
  const int x0 = grid_.x_of(block), y0 = grid_.y_of(block);
  if (mask == 0)
    return raster::resolve_empty(
        request_, plan_,
        {x0, y0, std::min(x0 + kSide, request_.width), std::min(y0 + kSide, request_.height)});
  alignas(64) std::uint64_t keys[kPixels];
  for (std::size_t i = 0; i < kPixels; ++i) keys[i] = mask >> i & 1;
  (void)raster::resolve_block(request_, plan_, {}, keys, x0, y0, nullptr, &colors);
}

}  // namespace rastrum::ranks
