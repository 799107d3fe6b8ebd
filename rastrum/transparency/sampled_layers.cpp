// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/transparency/sampled_layers.hpp>

#include <algorithm>

namespace rastrum::transparency {

bool SampledLayers::deal(int samples, LayerOrder order, std::size_t filter,
                         std::size_t most_layers) {
  const std::size_t rows = static_cast<std::size_t>(samples) * 8;
  kernel_->count(places_.data(), count_, rows, left_, most_);
  std::size_t end = 0;
  deepest_ = 0;
  misplaced_ = 0;
  for (std::size_t r = 0; r < rows; ++r) {
    rows_[r] = {static_cast<std::uint32_t>(end), most_[r]};
    end += std::size_t{most_[r]} * 8;
    deepest_ = std::max<std::size_t>(deepest_, most_[r]);
  }
  if (count_ * kFragmentBytes + end * sizeof(std::uint64_t) > most_bytes_) return false;
  if (filter != 0 && deepest_ > most_layers) return false;
  sort_keys_.reserve(end);
  std::fill_n(sort_keys_.data(), end, 0U);
  // From the last on, so that counts turn into places.
  for (std::size_t f = count_; f-- > 0;) {
    const std::size_t place = places_[f];
    const std::size_t k = --left_[place];
    sort_keys_[rows_[place / 8].begin + k * 8 + place % 8] = packed_sort_key(keys_[f], numbers_[f]);
  }
  if (order == LayerOrder::submission) return true;
  for (std::size_t r = 0; r < rows; ++r) {
    std::uint64_t* const sort_keys = sort_keys_.data() + rows_[r].begin;
    if (rows_[r].layers < 2) continue;
    if (filter == 0)
      kernel_->sort(sort_keys, rows_[r].layers);
    else
      misplaced_ |= std::uint64_t{kernel_->filter(sort_keys, rows_[r].layers, filter)}
                    << 8 * (r % 8);
  }
  return true;
}

}  // namespace rastrum::transparency
