#include <rastrum/ranks/fragments.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/resolve/surface.hpp>

namespace rastrum::ranks {
namespace {

/// Of what a plane says beside its mask: the sample, and this.
constexpr std::uint32_t kOpaque = 1U << 31;
constexpr std::size_t kPlaneBytes = sizeof(std::uint64_t) + sizeof(std::uint32_t);

std::size_t count_of(std::uint64_t mask) {
  return static_cast<std::size_t>(parallel::popcount(mask));
}

/// Appends a plane with room for n fragments; returns where its words begin.
std::byte* put_plane(Bytes& to, std::uint64_t mask, std::uint32_t kind) {
  const std::size_t begin = to.size();
  to.resize(begin + kPlaneBytes + kFragmentBytes * count_of(mask));
  std::byte* const at = to.data() + begin;
  std::memcpy(at, &mask, sizeof(mask));
  std::memcpy(at + sizeof(mask), &kind, sizeof(kind));
  return at + kPlaneBytes;
}

std::uint64_t word_at(const std::byte* words, std::size_t k) {
  std::uint64_t word = 0;
  std::memcpy(&word, words + k * sizeof(word), sizeof(word));
  return word;
}

/// Appends the fragments of a plane that are not behind `hides`. Returns how many.
std::size_t put_seen_of(const PackedPlane& plane, const std::uint64_t* hides, Bytes& to) {
  std::uint64_t mask = 0;
  std::size_t k = 0;
  // Equal words are of one part: it has seen to it itself.
  for (std::uint64_t m = plane.mask; m != 0; m &= m - 1, ++k) {
    const int i = std::countr_zero(m);
    mask |= std::uint64_t{word_at(plane.words, k) >= hides[i]} << i;
  }
  if (mask == 0) return 0;
  const std::size_t n = count_of(mask);
  std::byte* const words =
      put_plane(to, mask, static_cast<std::uint32_t>(plane.sample) | (plane.opaque ? kOpaque : 0));
  std::byte* const colors = words + n * sizeof(std::uint64_t);
  std::size_t kept = 0;
  k = 0;
  for (std::uint64_t m = plane.mask; m != 0; m &= m - 1, ++k) {
    if ((mask >> std::countr_zero(m) & 1) == 0) continue;
    std::memcpy(words + kept * sizeof(std::uint64_t), plane.words + k * sizeof(std::uint64_t),
                sizeof(std::uint64_t));
    std::memcpy(colors + kept * sizeof(Vec4), plane.colors + k * sizeof(Vec4), sizeof(Vec4));
    ++kept;
  }
  return n;
}

}  // namespace

void LayerSurvey::take(const raster::FragmentPlane& plane) {
  const std::size_t block = grid_.at(plane.bx, plane.by);
  masks_[block] |= plane.mask;
  counts_[block] += count_of(plane.mask);
}

FragmentBytes::FragmentBytes(const BlockGrid& grid, raster::Rect band, PlacesOfKeys places,
                             SparseBlocks* keys, std::uint64_t most_bytes)
    : KeySink(Takes::colors, grid, keys),
      band_(band),
      places_(places),
      most_bytes_(most_bytes),
      blocks_(raster::block_count(band)) {}

void FragmentBytes::take(const raster::FragmentPlane& plane) {
  const std::size_t n = count_of(plane.mask);
  if (bytes_.fetch_add(n * kFragmentBytes, std::memory_order_relaxed) > most_bytes_) return;
  const int bx = plane.bx - band_.x0 / kSide, by = plane.by - band_.y0 / kSide;
  Bytes& bytes = blocks_[static_cast<std::size_t>(by * raster::block_columns(band_) + bx)];
  std::byte* word = put_plane(
      bytes, plane.mask,
      static_cast<std::uint32_t>(plane.sample) | (plane.opaque ? kOpaque : std::uint32_t{0}));
  std::byte* color = word + n * sizeof(std::uint64_t);
  // Neighbours mostly are of one part.
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

std::uint32_t FragmentBytes::number_of(std::size_t own) const {
  const int columns = raster::block_columns(band_), block = static_cast<int>(own);
  return static_cast<std::uint32_t>(
      grid_.at(band_.x0 / kSide + block % columns, band_.y0 / kSide + block / columns));
}

void FragmentBytes::each_block(const std::function<void(BlockMask)>& f) const {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (blocks_[b].empty()) continue;
    BlockMask where{0, number_of(b)};
    for (Reader planes(blocks_[b]); !planes.at_end();) where.mask |= take_plane(planes).mask;
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
    for (Reader planes(blocks_[b]); !planes.at_end();) {
      const PackedPlane plane = take_plane(planes);
      if (!plane.opaque) continue;
      ++found;
      mask &= plane.mask;
      std::size_t k = 0;
      for (std::uint64_t m = plane.mask; m != 0; m &= m - 1, ++k) {
        std::uint64_t& word = least[static_cast<std::size_t>(std::countr_zero(m))];
        word = std::min(word, word_at(plane.words, k));
      }
    }
    if (found == samples && mask != 0) words.set(number_of(b), least.data(), mask);
  }
  return words;
}

std::uint64_t FragmentBytes::pack(Mail& mail, const Hides& hides) {
  // One allocation for each owner.
  std::vector<std::size_t> sizes(mail.ranks());
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (!blocks_[b].empty())
      sizes[layer_owner(number_of(b), mail.ranks())] +=
          blocks_[b].size() + sizeof(std::uint32_t) + sizeof(std::uint64_t);
  for (std::size_t r = 0; r < sizes.size(); ++r) mail.to(r).reserve(mail.to(r).size() + sizes[r]);
  std::uint64_t fragments = 0;
  std::array<std::uint64_t, kPixels> words{};
  std::size_t next = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Bytes bytes = std::exchange(blocks_[b], {});
    if (bytes.empty()) continue;
    const std::uint32_t block = number_of(b);
    while (next < hides.where.size() && hides.where[next].block < block) ++next;
    const bool may_hide = next < hides.where.size() && hides.where[next].block == block;
    Bytes& to = mail.to(layer_owner(block, mail.ranks()));
    const std::size_t begin = to.size();
    put(to, block);
    put(to, static_cast<std::uint64_t>(bytes.size()));
    if (may_hide) {
      words.fill(0);
      std::size_t at = hides.at[next];
      for (std::uint64_t m = hides.where[next].mask; m != 0; m &= m - 1)
        words[static_cast<std::size_t>(std::countr_zero(m))] = hides.words[at++];
    } else {
      to.insert(to.end(), bytes.begin(), bytes.end());
    }
    const std::size_t planes_at = begin + sizeof(block) + sizeof(std::uint64_t);
    for (Reader planes(bytes); !planes.at_end();) {
      const PackedPlane plane = take_plane(planes);
      fragments += may_hide ? put_seen_of(plane, words.data(), to) : count_of(plane.mask);
    }
    if (to.size() == planes_at) {
      to.resize(begin);
    } else {
      const std::uint64_t size = to.size() - planes_at;
      std::memcpy(to.data() + begin + sizeof(block), &size, sizeof(size));
    }
  }
  bytes_ = 0;
  return fragments;
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
  // The high half of a multiplication by the golden ratio's bits, taken to [0, ranks).
  const std::uint64_t mixed = (block * std::uint64_t{0x9E3779B97F4A7C15}) >> 32;
  return static_cast<std::size_t>(mixed * ranks >> 32);
}

}  // namespace rastrum::ranks
