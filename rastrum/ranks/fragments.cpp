#include <rastrum/ranks/fragments.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/resolve/surface.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::ranks {

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
  bytes.resize(begin + sizeof(plane.mask) +
               kFragmentBytes * static_cast<std::size_t>(parallel::popcount(plane.mask)));
  std::byte* to = bytes.data() + begin;
  const auto write = [&](const auto& value) {
    std::memcpy(to, &value, sizeof(value));
    to += sizeof(value);
  };
  write(plane.mask);
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
  while (!planes.at_end())
    for (auto m = planes.take<std::uint64_t>(); m != 0; m &= m - 1) {
      const auto word = planes.take<std::uint64_t>();
      pixels_[std::countr_zero(m)].push_back({word, planes.take<Vec4>()});
    }
}

void LayerMerge::blend_block(SeenBlock& block) {
  std::size_t depth = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    auto& fragments = pixels_[i];
    block.where.mask |= std::uint64_t{!fragments.empty()} << i;
    block.seen.set(static_cast<int>(i), {});
    depth = std::max(depth, fragments.size());
    // A part is on one rank, whose list is in order; so equal words are, too.
    std::ranges::stable_sort(fragments, std::ranges::greater{}, &Fragment::word);
  }
  std::uint64_t finished = 0;
  for (std::size_t k = 0; k < depth; ++k) {
    std::uint64_t mask = 0;
    for (std::size_t i = 0; i < kPixels; ++i) {
      if (k >= pixels_[i].size()) continue;
      mask |= std::uint64_t{1} << i;
      plane_.set(static_cast<int>(i), pixels_[i][k].color);
    }
    mask &= ~finished;
    if (mask == 0) continue;
    finished |= kernel_.behind(plane_, mask, opaque_at_, block.seen);
  }
  for (auto& fragments : pixels_) fragments.clear();
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
