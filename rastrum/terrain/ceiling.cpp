// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain/ceiling.hpp>

#include <utility>

namespace rastrum::terrain {
namespace {

Image<float> maxima(ImageView<const float> fine, int edge) {
  const HighestCell highest{fine, edge};
  Image<float> coarse((fine.width + edge - 1) / edge, (fine.height + edge - 1) / edge);
  for (int y = 0; y < coarse.height(); ++y)
    for (int x = 0; x < coarse.width(); ++x) coarse(x, y) = highest(x, y);
  return coarse;
}

}  // namespace

Ceiling::Ceiling(Shared<const Image<float>> heights) : heights_(std::move(heights)) {
  levels_.push_back(maxima(heights_->view(), 1 << CeilingView::kFirstLevel));
  while (levels_.back().width() > 1 || levels_.back().height() > 1)
    levels_.push_back(maxima(std::as_const(levels_.back()).view(), 2));
  for (const Image<float>& level : levels_) views_.push_back(level.view());
}

std::uint64_t Ceiling::bytes() const {
  std::uint64_t bytes = 0;
  for (const Image<float>& level : levels_) bytes += level.pixels().size_bytes();
  return bytes;
}

}  // namespace rastrum::terrain
