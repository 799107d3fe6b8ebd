// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/bin/bin_parts.hpp>

#include <algorithm>

namespace rastrum::raster {
namespace {

// Costs of drawing in units of some 10 cycles; a micro triangle's fragment is 1.
constexpr std::uint64_t kPiece = 16, kPixels = 12'000, kNothing = 300;
/// Bins of smaller load are not cut, because each part walks the bin's whole lists.
constexpr std::uint64_t kLeastCut = 16'000;
constexpr int kLeastSide = 16;

}  // namespace

void BinParts::make(const FrameContext& frame, const BinTable& lists, const TriangleGroups& groups,
                    bool cuts) {
  const std::size_t count = lists.bins.count();
  const int threads = frame.concurrency();
  const auto load_of = [&](std::size_t bin) {
    const BinLoad load = groups.load(bin);
    const std::uint64_t all = load.pieces * kPiece + load.fragments;
    return all == 0 ? kNothing : all + kPixels;
  };
  std::uint64_t total = 0;
  for (std::size_t bin = 0; bin < count; ++bin) total += load_of(bin);
  const std::uint64_t most =
      std::max(kLeastCut, total / static_cast<std::uint64_t>(std::max(threads, 1)));
  parts_.clear();
  loads_.clear();
  for (std::size_t bin = 0; bin < count; ++bin) {
    std::uint64_t load = load_of(bin);
    const bool is_empty = load == kNothing;
    int side = kBinSize;
    if (cuts && threads > kFewThreads)
      for (; load > most && side > kLeastSide; side /= 2) load /= 4;
    const Rect r = lists.bins.rect(bin);
    for (int y = r.y0; y < r.y1; y += side)
      for (int x = r.x0; x < r.x1; x += side) {
        parts_.push_back(
            {bin, {x, y, std::min(x + side, r.x1), std::min(y + side, r.y1)}, side, is_empty});
        loads_.push_back(load);
      }
  }
  if (threads > kFewThreads) order_.arrange(loads_, threads);
}

}  // namespace rastrum::raster
