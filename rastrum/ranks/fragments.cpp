// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/fragments.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::ranks {
namespace {

/// A plane's header is its mask and a number with the sample and this bit.
constexpr std::uint32_t kOpaque = 1U << 31;
constexpr std::size_t kPlaneBytes = sizeof(std::uint64_t) + sizeof(std::uint32_t);
/// A block's header in mail: its number and the size of its planes in bytes.
constexpr std::size_t kBlockBytes = sizeof(std::uint32_t) + sizeof(std::uint64_t);

std::size_t count_of(std::uint64_t mask) {
  return static_cast<std::size_t>(parallel::popcount(mask));
}

/// Writes a plane's header; returns where its words begin.
std::byte* put_plane(std::byte* at, std::uint64_t mask, int sample, bool opaque) {
  const std::uint32_t kind = static_cast<std::uint32_t>(sample) | (opaque ? kOpaque : 0);
  std::memcpy(at, &mask, sizeof(mask));
  std::memcpy(at + sizeof(mask), &kind, sizeof(kind));
  return at + kPlaneBytes;
}

/// Writes a plane's fragments that are not behind `hides` to `to`, which is at or before the plane.
/// Returns their number.
std::size_t put_seen_of(const PackedPlane& plane, const std::uint64_t* hides, std::byte* to) {
  std::uint64_t mask = 0, kept = 0;  // of the block's pixels, and of the plane's fragments
  std::size_t k = 0;
  // Equal words belong to the same part; the rank that drew it has already dropped what it hides.
  for (std::uint64_t m = plane.mask; m != 0; m &= m - 1, ++k) {
    const int i = std::countr_zero(m);
    const std::uint64_t seen{plane.word(k) >= hides[i]};
    mask |= seen << i;
    kept |= seen << k;
  }
  if (mask == 0) return 0;
  to = put_plane(to, mask, plane.sample, plane.opaque);
  // First all words, then all colours: the words may overwrite the old place of colours.
  const auto put_all = [&](const std::byte* from, std::size_t size) {
    for (std::uint64_t m = kept; m != 0; m &= m - 1, to += size)
      std::memmove(to, from + static_cast<std::size_t>(std::countr_zero(m)) * size, size);
  };
  put_all(plane.words, sizeof(std::uint64_t));
  put_all(plane.colors, sizeof(Vec4));
  return count_of(mask);
}

}  // namespace

void LayerSurvey::take(const raster::FragmentPlane& plane) {
  const std::size_t block = grid_.at(plane.bx, plane.by);
  masks_[block] |= plane.mask;
  counts_[block] += count_of(plane.mask);
}

FragmentBytes::FragmentBytes(const BlockGrid& grid, raster::Rect band, PlacesOfKeys places,
                             SparseBlocks* keys, std::uint64_t most_bytes, FragmentRoom room)
    : KeySink(raster::Translucent::colors_to_sink, grid, keys),
      band_(band),
      places_(places),
      most_bytes_(most_bytes),
      room_(std::move(room)),
      blocks_(raster::block_count(band)) {}

void FragmentBytes::take(const raster::FragmentPlane& plane) {
  const std::size_t n = count_of(plane.mask);
  const std::size_t bytes = kPlaneBytes + n * kFragmentBytes;
  if (bytes_.fetch_add(bytes, std::memory_order_relaxed) > most_bytes_) return;
  const int bx = plane.bx - band_.x0 / kSide, by = plane.by - band_.y0 / kSide;
  Block& block = blocks_[static_cast<std::size_t>(by * raster::block_columns(band_) + bx)];
  std::byte* word = put_plane(room_in(block, bytes), plane.mask, plane.sample, plane.opaque);
  std::byte* color = word + n * sizeof(std::uint64_t);
  block.fragments += n;
  // Caches the part, because neighbouring pixels mostly show the same one.
  std::uint64_t first = 0, last = 0, place = 0;
  for (std::uint64_t m = plane.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t key = plane.keys[i], id = raster::id_of_key(key) + places_.from_pass;
    if (id < first || id >= last) {
      const std::size_t instance = places_.own.instance_of(id);
      first = places_.own.first_ids[instance];
      last = places_.own.first_ids[instance + 1];
      place = raster::kIdMask - places_.places[instance];
    }
    const std::uint64_t number = (key & ~raster::kIdMask) | place;
    std::memcpy(word, &number, sizeof(number));
    word += sizeof(number);
    const Vec4 c = plane.colors->at(i);
    std::memcpy(color, &c, sizeof(c));
    color += sizeof(c);
  }
}

/// Chunks begin small, for ranks with few fragments, and double a few times.
void FragmentBytes::begin_chunk(Memory& own, std::size_t size) {
  constexpr std::size_t kLeast = std::size_t{1} << 12, kDoublings = 5;
  size = std::max(kLeast << std::min(own.taken, kDoublings), size);
  ++own.taken;
  own.at = room_ ? room_(size) : nullptr;
  if (own.at == nullptr) {
    own.at = own.chunks.emplace_back(std::make_unique_for_overwrite<std::byte[]>(size)).get();
    own_memory_ = true;
  }
  own.end = own.at + size;
}

/// Appends to the block's last run if possible; planes of a block mostly arrive in sequence.
std::byte* FragmentBytes::room_in(Block& block, std::size_t size) {
  Memory& own = memory_.local();
  if (FragmentRun* const last = block.last; last != nullptr &&
                                            last->planes() + last->bytes == own.at &&
                                            size <= static_cast<std::size_t>(own.end - own.at)) {
    last->bytes += size;
    return std::exchange(own.at, own.at + size);
  }
  const auto left = static_cast<std::size_t>(own.end - own.at);
  const std::size_t apart = reinterpret_cast<std::uintptr_t>(own.at) % alignof(FragmentRun);
  own.at += apart == 0 ? 0 : std::min(alignof(FragmentRun) - apart, left);
  const std::size_t whole = sizeof(FragmentRun) + size;
  if (whole > static_cast<std::size_t>(own.end - own.at)) begin_chunk(own, whole);
  auto* const run = ::new (static_cast<void*>(own.at)) FragmentRun{0, size};
  if (block.last == nullptr)
    block.first = run;
  else
    block.last->next = run->place();
  block.last = run;
  own.at += whole;
  return run->planes();
}

template <class F>
void FragmentBytes::each_run(const Block& block, const F& f) {
  for (FragmentRun* run = block.first; run != nullptr; run = FragmentRun::at(run->next)) f(*run);
}

template <class F>
void FragmentBytes::each_plane(const Block& block, const F& f) {
  each_run(block, [&](FragmentRun& run) {
    for (Reader planes({run.planes(), static_cast<std::size_t>(run.bytes)}); !planes.at_end();)
      f(take_plane(planes));
  });
}

void FragmentBytes::has_moved(std::uint64_t from, std::uint64_t bytes, std::uint64_t to) {
  const auto now = [&](std::uint64_t place) {
    return place >= from && place - from < bytes ? place - from + to : place;
  };
  for (Block& block : blocks_) {
    if (block.first == nullptr) continue;
    block.first = FragmentRun::at(now(block.first->place()));
    block.last = FragmentRun::at(now(block.last->place()));
    each_run(block, [&](FragmentRun& run) { run.next = now(run.next); });
  }
}

std::uint32_t FragmentBytes::number_of(std::size_t own) const {
  const int columns = raster::block_columns(band_), block = static_cast<int>(own);
  return static_cast<std::uint32_t>(
      grid_.at(band_.x0 / kSide + block % columns, band_.y0 / kSide + block / columns));
}

void FragmentBytes::each_block(const std::function<void(BlockMask)>& f) const {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (blocks_[b].first == nullptr) continue;
    BlockMask where{0, number_of(b)};
    each_plane(blocks_[b], [&](const PackedPlane& plane) { where.mask |= plane.mask; });
    f(where);
  }
}

SparseBlocks FragmentBytes::hiding(const BlockGrid& grid, int samples) const {
  SparseBlocks words(grid.count());
  std::array<std::uint64_t, kPixels> least{};
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    std::uint64_t mask = ~std::uint64_t{0};
    int found = 0;
    least.fill(~std::uint64_t{0});
    each_plane(blocks_[b], [&](const PackedPlane& plane) {
      if (!plane.opaque) return;
      ++found;
      mask &= plane.mask;
      std::size_t k = 0;
      for (std::uint64_t m = plane.mask; m != 0; m &= m - 1, ++k) {
        std::uint64_t& word = least[static_cast<std::size_t>(std::countr_zero(m))];
        word = std::min(word, plane.word(k));
      }
    });
    if (found == samples && mask != 0) words.set(number_of(b), least.data(), mask);
  }
  return words;
}

std::uint64_t FragmentBytes::leave_out(const Hides& hides) {
  std::uint64_t fragments = 0;
  std::array<std::uint64_t, kPixels> words{};
  std::size_t next = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Block& block = blocks_[b];
    if (block.first == nullptr) continue;
    const std::uint32_t number = number_of(b);
    while (next < hides.where.size() && hides.where[next].block < number) ++next;
    if (next == hides.where.size() || hides.where[next].block != number) {
      fragments += block.fragments;
      continue;
    }
    block.fragments = 0;
    words.fill(0);
    std::size_t from = hides.at[next];
    for (std::uint64_t m = hides.where[next].mask; m != 0; m &= m - 1)
      words[static_cast<std::size_t>(std::countr_zero(m))] = hides.words[from++];
    each_run(block, [&](FragmentRun& run) {
      std::byte* to = run.planes();
      for (Reader planes({to, static_cast<std::size_t>(run.bytes)}); !planes.at_end();) {
        const std::size_t n = put_seen_of(take_plane(planes), words.data(), to);
        if (n != 0) to += kPlaneBytes + n * kFragmentBytes;
        block.fragments += n;
      }
      run.bytes = static_cast<std::uint64_t>(to - run.planes());
    });
    fragments += block.fragments;
  }
  return fragments;
}

void FragmentBytes::pack(Mail& mail) const {
  const auto bytes_of = [](const Block& block) {
    std::uint64_t bytes = 0;
    each_run(block, [&](const FragmentRun& run) { bytes += run.bytes; });
    return bytes;
  };
  // One allocation per owner.
  std::vector<std::size_t> sizes(mail.ranks());
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (const std::uint64_t bytes = bytes_of(blocks_[b]); bytes != 0)
      sizes[layer_owner(number_of(b), mail.ranks())] += kBlockBytes + bytes;
  for (std::size_t r = 0; r < sizes.size(); ++r) mail.to(r).reserve(mail.to(r).size() + sizes[r]);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::uint64_t bytes = bytes_of(blocks_[b]);
    if (bytes == 0) continue;
    Bytes& to = mail.to(layer_owner(number_of(b), mail.ranks()));
    put(to, number_of(b));
    put(to, bytes);
    each_run(blocks_[b], [&](FragmentRun& run) {
      to.insert(to.end(), run.planes(), run.planes() + run.bytes);
    });
  }
}

PackedPlane take_plane(Reader& planes) {
  PackedPlane plane{};
  plane.mask = planes.take<std::uint64_t>();
  const auto kind = planes.take<std::uint32_t>();
  plane.sample = static_cast<int>(kind & ~kOpaque);
  plane.opaque = (kind & kOpaque) != 0;
  const std::size_t n = count_of(plane.mask);
  plane.words = planes.take_bytes(n * sizeof(std::uint64_t)).data();
  plane.colors = planes.take_bytes(n * sizeof(Vec4)).data();
  return plane;
}

std::size_t layer_owner(std::uint32_t block, std::size_t ranks) {
  // The high half of a product with the golden ratio's bits, mapped to [0, ranks).
  const std::uint64_t mixed = (block * std::uint64_t{0x9E3779B97F4A7C15}) >> 32;
  return static_cast<std::size_t>(mixed * ranks >> 32);
}

}  // namespace rastrum::ranks
