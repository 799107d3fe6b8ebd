#include <rastrum/raster/bin/bin_parts.hpp>

#include <array>
#include <bit>

namespace rastrum::raster {
namespace {

/// What a piece takes and what a bin's pixels take, in fragments of micro triangles.
constexpr std::uint64_t kPiece = 16, kPixels = 12'000;
/// Less is not cut: each part walks the whole lists of its bin.
constexpr std::uint64_t kLeastCut = 16'000;
constexpr int kLeastSide = 16;

/// Bins of loads within an eighth of each other go by their place.
constexpr std::size_t kBuckets = 64 * 8;
std::size_t bucket_of(std::uint64_t load) {
  const auto width = static_cast<unsigned>(std::bit_width(load | 8U));
  const std::size_t bucket = width * std::size_t{8} + (load >> (width - 4) & 7);
  return kBuckets - 1 - std::min(bucket, kBuckets - 1);
}

void cut(const BinPart& whole, std::uint64_t most, std::vector<BinPart>& parts) {
  int side = kBinSize;
  std::uint64_t load = whole.load;
  for (; load > most && load > kLeastCut && side > kLeastSide; side /= 2) load /= 4;
  const Rect r = whole.rect;
  for (int y = r.y0; y < r.y1; y += side)
    for (int x = r.x0; x < r.x1; x += side)
      parts.push_back(
          {whole.bin, {x, y, std::min(x + side, r.x1), std::min(y + side, r.y1)}, side, load});
}

}  // namespace

std::span<const BinPart> BinParts::of(const Frame& frame, const BinTable& lists,
                                      const TriangleGroups& groups, bool cuts) {
  const std::size_t count = lists.bins.count();
  const auto threads = static_cast<std::uint64_t>(frame.concurrency());
  parts_.clear();
  std::uint64_t total = 0;
  for (std::size_t bin = 0; bin < count; ++bin) {
    const BinLoad load = groups.load(bin);
    const std::uint64_t all = load.pieces * kPiece + load.fragments;
    parts_.push_back({bin, lists.bins.rect(bin), kBinSize, all == 0 ? 0 : all + kPixels});
    total += parts_.back().load;
  }
  if (threads == 1) return parts_;
  if (cuts) {
    sorted_.clear();
    for (const BinPart& part : parts_) cut(part, total / threads, sorted_);
    parts_.swap(sorted_);
  }
  std::array<std::uint32_t, kBuckets + 1> next{};
  for (const BinPart& part : parts_) ++next[bucket_of(part.load) + 1];
  for (std::size_t b = 0; b < kBuckets; ++b) next[b + 1] += next[b];
  sorted_.resize(parts_.size());
  for (const BinPart& part : parts_) sorted_[next[bucket_of(part.load)]++] = part;
  return sorted_;
}

}  // namespace rastrum::raster
