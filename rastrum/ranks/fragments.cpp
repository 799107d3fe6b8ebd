#include <rastrum/ranks/fragments.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/resolve/surface.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::ranks {
namespace {

/// Of what a plane says beside its mask: the sample, and this.
constexpr std::uint32_t kOpaque = 1U << 31;

}  // namespace

LayerSurvey::LayerSurvey(int width, int height)
    : FragmentSink(Takes::keys), columns_(static_cast<std::size_t>((width + kSide - 1) / kSide)) {
  masks_.resize(columns_ * static_cast<std::size_t>((height + kSide - 1) / kSide));
  counts_.resize(masks_.size());
}

void LayerSurvey::take(const raster::FragmentPlane& plane) {
  const std::size_t block =
      static_cast<std::size_t>(plane.by) * columns_ + static_cast<std::size_t>(plane.bx);
  masks_[block] |= plane.mask;
  counts_[block] += static_cast<std::uint64_t>(parallel::popcount(plane.mask));
}

FragmentBytes::FragmentBytes(int columns, raster::Rect band, PlaceOf place_of)
    : FragmentSink(Takes::colors),
      columns_(columns),
      band_(band),
      place_of_(std::move(place_of)),
      blocks_(raster::block_count(band)) {}

void FragmentBytes::take(const raster::FragmentPlane& plane) {
  const int bx = plane.bx - band_.x0 / kSide, by = plane.by - band_.y0 / kSide;
  Bytes& bytes = blocks_[static_cast<std::size_t>(by * raster::block_columns(band_) + bx)];
  const std::size_t begin = bytes.size();
  const auto kind =
      static_cast<std::uint32_t>(plane.sample) | (plane.opaque ? kOpaque : std::uint32_t{0});
  bytes.resize(begin + sizeof(plane.mask) + sizeof(kind) +
               kFragmentBytes * static_cast<std::size_t>(parallel::popcount(plane.mask)));
  std::byte* to = bytes.data() + begin;
  const auto write = [&](const auto& value) {
    std::memcpy(to, &value, sizeof(value));
    to += sizeof(value);
  };
  write(plane.mask);
  write(kind);
  for (std::uint64_t m = plane.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t key = plane.keys[i];
    write((key & ~raster::kIdMask) | (raster::kIdMask - place_of_(key)));
    write(plane.colors->at(i));
  }
}

std::uint64_t FragmentBytes::pack(Mail& mail) {
  const auto columns = static_cast<std::size_t>(raster::block_columns(band_));
  std::uint64_t fragments = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Bytes bytes = std::exchange(blocks_[b], {});
    if (bytes.empty()) continue;
    const auto block =
        static_cast<std::uint32_t>((static_cast<std::size_t>(band_.y0 / kSide) + b / columns) *
                                       static_cast<std::size_t>(columns_) +
                                   static_cast<std::size_t>(band_.x0 / kSide) + b % columns);
    Bytes& to = mail.to(layer_owner(block, mail.ranks()));
    put(to, block);
    put(to, static_cast<std::uint64_t>(bytes.size()));
    to.insert(to.end(), bytes.begin(), bytes.end());
    for (Reader planes(bytes); !planes.at_end();) {
      const auto n = static_cast<std::size_t>(parallel::popcount(planes.take<std::uint64_t>()));
      (void)planes.take<std::uint32_t>();
      fragments += n;
      (void)planes.take_bytes(n * kFragmentBytes);
    }
  }
  return fragments;
}

std::size_t layer_owner(std::uint32_t block, std::size_t ranks) {
  // The high half of a multiplication by the golden ratio's bits, taken to [0, ranks).
  const std::uint64_t mixed = (block * std::uint64_t{0x9E3779B97F4A7C15}) >> 32;
  return static_cast<std::size_t>(mixed * ranks >> 32);
}

void LayerMerge::blend(const Mail& mail, const std::function<void(const SeenBlock&)>& f) {
  struct Source {
    std::uint32_t block;
    Reader planes;
  };
  std::vector<Source> sources;
  for (std::size_t r = 0; r < mail.ranks(); ++r)
    for (Reader from = mail.from(r); !from.at_end();) {
      const auto block = from.take<std::uint32_t>();
      const auto size = from.take<std::uint64_t>();
      sources.push_back({block, Reader(from.take_bytes(size))});
    }
  std::ranges::stable_sort(sources, {}, &Source::block);
  for (std::size_t begin = 0, end = 0; begin < sources.size(); begin = end) {
    parallel::throw_if_stopped();
    for (; end < sources.size() && sources[end].block == sources[begin].block; ++end)
      add(sources[end].planes);
    SeenBlock block{{0, sources[begin].block}, {}};
    blend_block(block);
    f(block);
  }
}

void LayerMerge::add(Reader planes) {
  while (!planes.at_end()) {
    auto m = planes.take<std::uint64_t>();
    const auto kind = planes.take<std::uint32_t>();
    auto* const pixels = pixels_.data() + (kind & ~kOpaque) * kPixels;
    for (; m != 0; m &= m - 1) {
      const auto word = planes.take<std::uint64_t>();
      pixels[std::countr_zero(m)].push_back({word, planes.take<Vec4>(), (kind & kOpaque) != 0});
    }
  }
}

std::uint64_t LayerMerge::blend_sample(std::size_t sample, transparency::Seen& seen,
                                       raster::BlockColors& behind) {
  auto* const pixels = pixels_.data() + sample * kPixels;
  std::uint64_t any = 0, left = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    auto& fragments = pixels[i];
    any |= std::uint64_t{!fragments.empty()} << i;
    seen.set(static_cast<int>(i), {});
    behind.set(static_cast<int>(i), {});
    // A part is on one rank, whose list is in order, the opaque surface last; so equal words are.
    std::ranges::stable_sort(fragments, std::ranges::greater{}, &Fragment::word);
  }
  left = any;
  std::uint64_t finished = 0;
  for (std::size_t k = 0; left != 0; ++k) {
    std::uint64_t mask = 0;
    for (std::uint64_t m = left; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      const std::uint64_t bit = std::uint64_t{1} << i;
      const auto& fragments = pixels[i];
      if (k == fragments.size() || fragments[k].opaque) {
        if (k < fragments.size()) behind.set(i, fragments[k].color);
        left &= ~bit;
        continue;
      }
      plane_.set(i, fragments[k].color);
      mask |= bit;
    }
    mask &= ~finished;
    if (mask != 0) finished |= kernel_.behind(plane_, mask, opaque_at_, seen);
  }
  for (std::size_t i = 0; i < kPixels; ++i) pixels[i].clear();
  return any;
}

void LayerMerge::blend_block(SeenBlock& block) {
  raster::BlockColors behind, one, sum{};
  if (samples_ == 1) {
    block.where.mask = blend_sample(0, block.seen, behind);
    return;
  }
  for (std::size_t s = 0; s < samples_; ++s) {
    block.where.mask |= blend_sample(s, block.seen, behind);
    kernel_.finish(block.seen, behind, one);
    for (std::size_t i = 0; i < kPixels; ++i) {
      sum.r[i] += one.r[i];
      sum.g[i] += one.g[i];
      sum.b[i] += one.b[i];
      sum.a[i] += one.a[i];
    }
  }
  const float share = 1.0F / static_cast<float>(samples_);
  for (std::size_t i = 0; i < kPixels; ++i)
    block.seen.set(static_cast<int>(i),
                   {{sum.r[i] * share, sum.g[i] * share, sum.b[i] * share, sum.a[i] * share}, 0});
}

void put_seen(const BlockGrid& grid, const SeenBlock& block, Bytes& to) {
  put_mask(to, block.where);
  grid.each_pixel(block.where, [&](int i, int, int) { put(to, block.seen.at(i)); });
}

SeenBlock take_seen(const BlockGrid& grid, Reader& from) {
  SeenBlock block{from.take_mask(), {}};
  for (int i = 0; i < static_cast<int>(kPixels); ++i) block.seen.set(i, {});
  grid.each_pixel(block.where, [&](int i, int, int) {
    block.seen.set(i, from.take<transparency::SeenPixel>());
  });
  return block;
}

}  // namespace rastrum::ranks
