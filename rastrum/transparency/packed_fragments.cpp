// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/transparency/packed_fragments.hpp>

#include <bit>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/shade/shader.hpp>

namespace rastrum::transparency {
namespace {

using raster::BlockColors;
using raster::kBlockSize;
using raster::kIdMask;

/// 64 k fragments, which a list's length allows, were a little faster than half of them.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 22;
/// Key, pixel, colour, and bits.
constexpr std::uint64_t kFragmentBytes = 8 + 2 + sizeof(Vec4) + 1;
/// A pixel's list has a 16-bit length.
constexpr std::size_t kMostFragments = 65535;

/// Layers that are shaded before it is known how much they hide.
constexpr std::uint32_t kFirstTurn = 4;

/// The place of a piece's samples in the filter's order: larger first, above 0. 0 if unknown: a
/// sliver's plane may have any depth.
std::uint32_t arrival_of(const raster::Piece& piece, std::uint64_t mask, int bx, int by) {
  const auto depth = static_cast<std::uint32_t>(~near_first(piece, mask, bx, by) >> 32);
  constexpr std::uint32_t kMost = 0x3FFFFFFE;  // of depths below 2
  return depth < kMost ? 1 + depth : 0;
}

/// Layers of `alpha` until no more than `opaque_at` shows through, as the kernels count.
std::uint32_t layers_until(float alpha, float opaque_at) {
  std::uint32_t layers = 0;
  for (float through = 1; !(through <= opaque_at) && layers < kMostFragments; ++layers)
    through *= 1 - alpha;
  return layers;
}

}  // namespace

void PackedFragments::begin(Isa isa, std::uint64_t bytes) {
  kernel_ = &packed_kernels(isa);
  raster_kernel_ = &raster::kernels(isa);
  most_bytes_ = bytes == 0 ? kMostBytes : std::min(bytes, kMostBytes);
  filter_ = 0;
}

bool PackedFragments::collect(std::span<const Window> windows, const MicroFragments& micro,
                              const BlockGrid& grid, const raster::SurfaceView* opaque) {
  std::size_t most = micro.count;
  for (const Window& w : windows) most += static_cast<std::size_t>(parallel::popcount(w.mask));
  if (most > kMostFragments || most * fragment_bytes() > most_bytes_) return false;
  // Shaders take 64 at a time.
  keys_.reserve(most + kPackSlack + 64);
  pixels_.reserve(most + kPackSlack + 64);
  for (int y = 0; y < grid.rows; ++y)
    for (int x = 0; x < grid.columns; ++x) {
      const std::uint64_t*& keys = opaque_[y * grid.columns + x];
      keys = opaque == nullptr ? nullptr : opaque->block(grid.bx + x, grid.by + y);
      if (keys != nullptr && raster_kernel_->covered(keys) == 0) keys = nullptr;
    }
  first_.reserve(most / 64 + 1);
  count_ = kernel_->pack(windows, micro, {grid.bx * kBlockSize, grid.by * kBlockSize}, keys_.data(),
                         pixels_.data());
  if (!kernel_->find_firsts(keys_.data(), count_, first_.data())) return false;
  grid_ = grid;
  count_layers();
  if (filter_ != 0 && !find_arrivals(windows)) return false;
  if (leave_out_hidden()) count_layers();
  return deal();
}

void PackedFragments::count_layers() {
  kernel_->count(pixels_.data(), count_,
                 static_cast<std::size_t>(grid_.rows * kBlockSize) * (kPackedPitch / 8), left_,
                 most_);
}

/// Returns whether there are opaque surfaces.
bool PackedFragments::leave_out_hidden() {
  const auto blocks = static_cast<std::size_t>(grid_.columns * grid_.rows);
  if (std::all_of(opaque_, opaque_ + blocks, [](const std::uint64_t* keys) { return !keys; }))
    return false;
  std::size_t n = 0;
  for (std::size_t f = 0; f < count_; ++f) {
    const int pixel = pixels_[f];
    const int x = pixel % kPackedPitch, y = pixel / kPackedPitch;
    const std::uint64_t* const opaque = opaque_[y / kBlockSize * grid_.columns + x / kBlockSize];
    keys_[n] = keys_[f];
    pixels_[n] = pixels_[f];
    if (filter_ != 0) arrivals_[n] = arrivals_[f];
    n += opaque == nullptr || keys_[f] > opaque[y % kBlockSize * kBlockSize + x % kBlockSize];
  }
  if (n == count_) return false;
  count_ = n;
  (void)kernel_->find_firsts(keys_.data(), count_, first_.data());
  return true;
}

/// The order in which the filter takes fragments: a piece's in a block by the depth at its samples'
/// centroid, then micro triangles'. Only for pixels where it may matter.
bool PackedFragments::find_arrivals(std::span<const Window> windows) {
  arrivals_.reserve(count_);
  std::uint64_t deep[kBlocks] = {};
  bool any_deep = false;
  for (int r = 0; r < grid_.rows * kBlockSize * (kPackedPitch / 8); ++r) {
    if (most_[r] <= filter_ + 1) continue;
    std::uint64_t bits = 0;
    for (int x = 0; x < 8; ++x) bits |= std::uint64_t{left_[r * 8 + x] > filter_ + 1} << x;
    deep[r / 64 * 8 + r % 8] |= bits << r % 64 / 8 * 8;
    any_deep = true;
  }
  if (!any_deep) return true;
  std::fill_n(arrivals_.data(), count_, 0U);
  bool told = true;
  std::size_t f = 0;
  for (const Window& w : windows) {
    while ((keys_[f] & kIdMask) > w.piece->low) ++f;  // skips micro triangles
    const std::size_t end = f + static_cast<std::size_t>(parallel::popcount(w.mask));
    const std::uint32_t column = w.pixel % kPackedPitch / 8, row = w.pixel / kPackedPitch / 8;
    std::uint32_t arrival[2][2] = {};
    bool any = false;
    for_each_block_of(w.mask, w.pixel % kPackedPitch, w.pixel / kPackedPitch,
                      [&](std::uint32_t c, std::uint32_t r, std::uint64_t mask) {
                        if ((deep[r * 8 + c] & mask) == 0) return;
                        any = true;
                        std::uint32_t& of_block = arrival[r - row][c - column];
                        of_block = arrival_of(*w.piece, mask, grid_.bx + static_cast<int>(c),
                                              grid_.by + static_cast<int>(r));
                        told &= of_block != 0;
                      });
    const bool is_block = (w.pixel % kPackedPitch | w.pixel / kPackedPitch) % 8 == 0;
    if (any && is_block)
      std::fill(arrivals_.data() + f, arrivals_.data() + end, arrival[0][0]);
    else if (any)
      for (std::size_t i = f; i < end; ++i) {
        const std::uint32_t x = pixels_[i] % kPackedPitch, y = pixels_[i] / kPackedPitch;
        arrivals_[i] = arrival[y / 8 - row][x / 8 - column];
      }
    f = end;
  }
  return told;
}

std::uint64_t PackedFragments::fragment_bytes() const {
  return kFragmentBytes + (filter_ != 0 ? sizeof(std::uint32_t) : 0);
}

bool PackedFragments::deal() {
  sorted_ = false;
  std::size_t end = 0;
  deepest_ = 0;
  for (int y = 0; y < grid_.rows * kBlockSize; ++y)
    for (int x = 0; x < grid_.columns; ++x) {
      const int r = y * (kPackedPitch / 8) + x;
      const std::uint32_t layers = most_[r];
      rows_[r] = {static_cast<std::uint32_t>(end), layers};
      end += layers * 8;
      deepest_ = std::max<std::size_t>(deepest_, layers);
    }
  if (count_ * fragment_bytes() + end * sizeof(std::uint64_t) > most_bytes_) return false;
  if (filter_ != 0 && deepest_ > most_layers_) return false;
  sort_keys_.reserve(end);
  std::fill_n(sort_keys_.data(), end, 0U);
  deal_sort_keys();
  return true;
}

void PackedFragments::deal_sort_keys() {
  // From the last on, so that counts turn into places.
  for (std::size_t f = count_; f-- > 0;) {
    const std::size_t pixel = pixels_[f];
    const std::size_t k = --left_[pixel];
    const Row& r = rows_[pixel / 8];
    const bool by_arrival = filter_ != 0 && r.layers > filter_ + 1;
    const std::uint64_t key =
        by_arrival ? std::uint64_t{arrivals_[f]} << raster::kIdBits : keys_[f];
    sort_keys_[r.begin + k * 8 + pixel % 8] = packed_sort_key(key, f);
  }
}

void PackedFragments::sort() {
  sorted_ = filter_ == 0;
  for (int y = 0; y < grid_.rows * kBlockSize; ++y)
    for (int x = 0; x < grid_.columns; ++x) {
      const int n = y * (kPackedPitch / 8) + x;
      const Row& r = rows_[n];
      misplaced_[n] = 0;
      if (r.layers > 1) kernel_->sort(sort_keys_.data() + r.begin, r.layers);
      if (filter_ != 0 && r.layers > filter_ + 1) misplaced_[n] = filter(r);
    }
}

/// Sorts a row from the order of arrivals. Pixels with at most filter_ + 1 fragments come out right
/// in any order.
std::uint8_t PackedFragments::filter(const Row& r) {
  std::uint64_t* const sort_keys = sort_keys_.data() + r.begin;
  for (std::size_t k = 0; k < std::size_t{r.layers} * 8; ++k) {
    // Without a branch: an empty place looks up the first fragment.
    const std::uint64_t low = sort_keys[k] & kIdMask;
    const std::size_t number = low == 0 ? 0 : number_of_sort_key(low);
    sort_keys[k] = low == 0 ? 0 : packed_sort_key(keys_[number], number);
  }
  return kernel_->filter(sort_keys, r.layers, filter_);
}

std::uint64_t PackedFragments::misplaced(int bx, int by) const {
  std::uint64_t pixels = 0;
  for (int y = 0; y < kBlockSize; ++y)
    pixels |= std::uint64_t{misplaced_[row_number(bx, by, y)]} << 8 * y;
  return pixels;
}

void PackedFragments::shade(const raster::BinContext& context, const raster::Shading& shading,
                            float opaque_at) {
  const std::size_t blocks = (count_ + 63) / 64;
  colors_.reserve(1 + blocks * 64 + kPackSlack);
  colors_[0] = {};
  wanted_.reserve(blocks);
  std::fill_n(wanted_.data(), blocks, ~std::uint64_t{0});
  if (count_ % 64 != 0) wanted_[blocks - 1] = ~std::uint64_t{0} >> (64 - count_ % 64);
  wanted_all_ = !(opaque_at > 0);
  if (opaque_at > 0) {
    const std::optional<float> alpha = constant_alpha(shading);
    if (!alpha) return shade_by_turns(context, shading, opaque_at);
    const std::uint32_t most = layers_until(*alpha, opaque_at);
    leave_out_behind(most);
    for (Row& row : rows_) row.layers = std::min(row.layers, most);
  }
  shade_wanted(context, shading);
}

void PackedFragments::shade_wanted(const raster::BinContext& context,
                                   const raster::Shading& shading) {
  const bool all = wanted_all_;
  const raster::FragmentRuns runs{keys_.data(),
                                  pixels_.data(),
                                  count_,
                                  first_.data(),
                                  all ? nullptr : wanted_.data(),
                                  grid_.bx * kBlockSize,
                                  grid_.by * kBlockSize};
  if (shade_runs(shading, *context.frame, runs, context.request->isa, colors_.data() + 1)) return;
  // Rows of 8 fragments stay in place: mostly they are one triangle's, wanted as a whole.
  const std::size_t blocks = (count_ + 63) / 64;
  for (std::size_t b = 0; b < blocks; ++b) {
    // Prefetches the vertices of the next block.
    if (b + 1 < blocks)
      for (std::uint64_t m = wanted_[b + 1] & first_[b + 1]; m != 0; m &= m - 1) {
        const std::size_t number = (b + 1) * 64 + static_cast<std::size_t>(std::countr_zero(m));
        prefetch(shading, *context.frame, raster::id_of_key(keys_[number]));
      }
    if (wanted_[b] == 0) continue;
    kernel_->points(pixels_.data() + b * 64, points_);
    raster::VisibleBlock block{keys_.data() + b * 64, wanted_[b], grid_.bx * kBlockSize,
                               grid_.by * kBlockSize, context.shader_scratch};
    block.points = &points_;
    if (shade_block(shading, *context.frame, block, context.request->isa, plane_))
      std::fill_n(plane_.a, 64, 1.0F);
    Vec4* const colors = colors_.data() + 1 + b * 64;
    if (block.covered == ~std::uint64_t{0}) {
      kernel_->interleave(plane_, colors);
      continue;
    }
    for (std::uint64_t m = block.covered; m != 0; m &= m - 1)
      colors[std::countr_zero(m)] = plane_.at(std::countr_zero(m));
  }
}

void PackedFragments::leave_out_behind(std::uint32_t most) {
  if (deepest_ <= most) return;
  for (int y = 0; y < grid_.rows * kBlockSize; ++y)
    for (int x = 0; x < grid_.columns; ++x) {
      const Row& r = rows_[y * (kPackedPitch / 8) + x];
      for (std::size_t k = std::size_t{most} * 8; k < std::size_t{r.layers} * 8; ++k) {
        const std::uint64_t sort_key = sort_keys_[r.begin + k];
        if (sort_key == 0) continue;
        const std::size_t number = number_of_sort_key(sort_key);
        wanted_[number / 64] &= ~(std::uint64_t{1} << number % 64);
      }
    }
}

void PackedFragments::shade_by_turns(const raster::BinContext& context,
                                     const raster::Shading& shading, float opaque_at) {
  std::uint32_t begin = 0, end = kFirstTurn;
  leave_out_behind(end);
  shade_wanted(context, shading);
  std::fill_n(through_, std::size(through_), 1.0F);
  for (; end < deepest_; begin = end, end *= 2) {
    std::fill_n(wanted_.data(), (count_ + 63) / 64, 0U);
    bool any = false;
    for (int y = 0; y < grid_.rows * kBlockSize; ++y)
      for (int x = 0; x < grid_.columns * kBlockSize; ++x) {
        const Row& r = rows_[(y * kPackedPitch + x) / 8];
        if (r.layers <= end) continue;
        const std::uint64_t* const sort_keys = sort_keys_.data() + r.begin + x % 8;
        float& through = through_[y * kPackedPitch + x];
        for (std::size_t k = begin; k < end && sort_keys[k * 8] != 0 && !(through <= opaque_at);
             ++k)
          through *= 1 - colors_[color_of_sort_key(sort_keys[k * 8])].w;
        if (through <= opaque_at) continue;
        for (std::size_t k = end; k < std::min(r.layers, 2 * end) && sort_keys[k * 8] != 0; ++k) {
          const std::size_t number = number_of_sort_key(sort_keys[k * 8]);
          wanted_[number / 64] |= std::uint64_t{1} << number % 64;
          any = true;
        }
      }
    if (!any) return;
    shade_wanted(context, shading);
  }
}

bool PackedFragments::any(int bx, int by) const {
  for (int y = 0; y < kBlockSize; ++y)
    if (row(bx, by, y).layers != 0) return true;
  return false;
}

void PackedFragments::raise(int bx, int by, std::uint64_t* keys) const {
  for (int y = 0; y < kBlockSize; ++y, keys += 8) {
    const Row& r = row(bx, by, y);
    // If sorted, the first is the nearest.
    const std::size_t layers = sorted_ ? std::min(r.layers, 1U) : r.layers;
    std::uint64_t nearest[8] = {};
    for (std::size_t k = 0; k < layers; ++k)
      for (std::size_t x = 0; x < 8; ++x)
        nearest[x] = std::max(nearest[x], sort_keys_[r.begin + k * 8 + x]);
    for (std::size_t x = 0; x < 8; ++x)
      if (nearest[x] != 0) keys[x] = std::max(keys[x], keys_[number_of_sort_key(nearest[x])]);
  }
}

void PackedFragments::blend(int bx, int by, LayerBlend& blend, const BlockColors* behind,
                            BlockColors& out) {
  PackedRow rows[kBlockSize];
  for (int y = 0; y < kBlockSize; ++y) {
    const Row& r = row(bx, by, y);
    rows[y] = {sort_keys_.data() + r.begin, r.layers, colors_.data()};
  }
  blend_rows(blend, rows, behind, out, [&] { blend_planes(bx, by, blend); });
}

void PackedFragments::blend_planes(int bx, int by, LayerBlend& blend) {
  std::uint32_t layers = 0;
  for (int y = 0; y < kBlockSize; ++y) layers = std::max(layers, row(bx, by, y).layers);
  std::uint64_t finished = 0;
  for (std::uint32_t k = 0; k < layers; ++k) {
    std::uint64_t mask = 0;
    for (int y = 0; y < kBlockSize; ++y) {
      const Row& r = row(bx, by, y);
      if (k >= r.layers) continue;
      const std::uint64_t* const sort_keys = sort_keys_.data() + r.begin + std::size_t{k} * 8;
      const auto first = static_cast<std::size_t>(y) * 8;
      kernel_->gather({sort_keys, 1, colors_.data()}, first, plane_);
      for (std::size_t x = 0; x < 8; ++x) {
        if (sort_keys[x] == 0) continue;
        mask |= std::uint64_t{1} << (first + x);
        plane_keys_[first + x] = keys_[number_of_sort_key(sort_keys[x])];
      }
    }
    mask &= ~finished;
    if (mask != 0) finished |= blend.layer({plane_keys_, mask, plane_});
  }
}

}  // namespace rastrum::transparency
