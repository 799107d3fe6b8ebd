// SPDX-License-Identifier: BSD-3-Clause
// The translucent fragments of an 8 × 8 block in order, a list per pixel: the second stage of the
// sort of paper 4 ("LucidRaster", sections "Sample blending" and "Phase 3"). The first sorts a
// block's pieces, so fragments arrive nearly in order and are inserted from the back of a list. An
// insertion that looks back over at most K fragments is the paper's depth filter. The paper leaves
// a pixel wrong if that is too few; here the pixel is noted, and its list can be sorted.
//
// Plane k has the k-th key of every pixel, and is shaded like a visible surface and blended in
// vectors of pixels. The paper keeps no lists but blends what leaves the filter.
//
// A full list keeps the first fragments of its order; the rest needs another walk over the block's
// pieces (a `window`). So memory is bounded.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::transparency {

/// A key and an owner per pixel, and the mask.
inline constexpr std::uint64_t kPlaneBytes = 64 * 12 + 8;

enum class LayerOrder : std::uint8_t {
  depth,      ///< falling keys: nearest first; of equal depths the first submitted
  submission  ///< rising ids
};

/// `Owner`: stored beside each key.
struct NoOwner {};
template <class Owner = NoOwner>
class LayerLists {
 public:
  explicit LayerLists(MemoryAccount& memory)
      : planes_(memory), masks_(memory), owners_(memory), column_(memory) {}

  /// `filter`: fragments that an insertion looks back over. `capacity`: most planes, at least 2.
  void restart(LayerOrder order, std::size_t filter, std::size_t capacity) {
    order_mask_ = order == LayerOrder::depth ? ~std::uint64_t{0} : raster::kIdMask;
    filter_ = filter;
    capacity_ = capacity;
    room_ = std::min(allocated_, capacity);
    left_ = misplaced_ = 0;
    std::fill_n(before_, 64, ~std::uint64_t{0});
    std::fill_n(earlier_, 64, 0U);
    clear();
  }
  /// If fragments were left out, begins their lists, which follow those in the planes, and returns
  /// true.
  [[nodiscard]] bool next_window() {
    if (left_ == 0) return false;
    for (int i = 0; i < 64; ++i) before_[i] = (left_ >> i & 1) != 0 ? cutoff_[i] : 0;
    for (int i = 0; i < 64; ++i) earlier_[i] += counts_[i];
    left_ = 0;
    clear();
    return true;
  }

  /// Adds a fragment of pixel i. O(filter), O(log capacity) amortized if its list is full.
  void insert(int i, std::uint64_t key, Owner owner = {}) {
    const std::uint64_t bit = std::uint64_t{1} << i;
    const std::uint64_t own = sort_key(key);
    if (own >= before_[i]) return;
    if (own < cutoff_[i]) {
      left_ |= bit;
      return;
    }
    if (counts_[i] == room_ && !grow()) {
      halve(i);
      insert(i, key, owner);
      return;
    }
    const std::size_t n = counts_[i]++;
    masks_[n] |= bit;
    std::uint64_t* const column = planes_.data() + i;
    [[maybe_unused]] Owner* const owners = kOwned ? owners_.data() + i : nullptr;
    const std::size_t first = n > filter_ ? n - filter_ : 0;
    std::size_t k = n;
    for (; k > first && sort_key(column[(k - 1) * 64]) < own; --k) {
      column[k * 64] = column[(k - 1) * 64];
      if constexpr (kOwned) owners[k * 64] = owners[(k - 1) * 64];
    }
    column[k * 64] = key;
    if constexpr (kOwned) owners[k * 64] = owner;
    if (k == first && first > 0 && sort_key(column[(k - 1) * 64]) < own) misplaced_ |= bit;
  }

  void sort() {
    for (std::uint64_t m = misplaced_; m != 0; m &= m - 1) sort_column(std::countr_zero(m));
  }

  [[nodiscard]] std::size_t depth() const { return *std::max_element(counts_, counts_ + 64); }
  /// The most fragments of a pixel, in all windows so far.
  [[nodiscard]] std::size_t deepest() const {
    std::uint32_t most = 0;
    for (int i = 0; i < 64; ++i) most = std::max(most, earlier_[i] + counts_[i]);
    return most;
  }
  /// 64 keys, valid within `mask`. 64-byte aligned.
  [[nodiscard]] const std::uint64_t* plane(std::size_t k) const { return planes_.data() + k * 64; }
  /// 64 owners, likewise.
  [[nodiscard]] const Owner* owners(std::size_t k) const { return owners_.data() + k * 64; }
  [[nodiscard]] std::uint64_t mask(std::size_t k) const { return masks_[k]; }
  /// Pixels where a fragment had to go beyond the filter, in any window so far.
  [[nodiscard]] std::uint64_t misplaced() const { return misplaced_; }

 private:
  [[nodiscard]] std::uint64_t sort_key(std::uint64_t key) const { return key & order_mask_; }

  void clear() {
    std::fill_n(counts_, 64, 0U);
    std::fill_n(cutoff_, 64, 0U);
    std::fill_n(masks_.data(), allocated_, 0U);
  }
  bool grow() {
    if (room_ == capacity_) return false;
    const std::size_t planes = std::min(capacity_, std::max<std::size_t>(16, allocated_ * 2));
    planes_.reserve(planes * 64, allocated_ * 64);
    masks_.reserve(planes, allocated_);
    if constexpr (kOwned) owners_.reserve(planes * 64, allocated_ * 64);
    std::fill_n(masks_.data() + allocated_, planes - allocated_, 0U);
    allocated_ = room_ = planes;
    return true;
  }
  /// Leaves the second half of a full list to the next window.
  void halve(int i) {
    const std::uint64_t bit = std::uint64_t{1} << i;
    sort_column(i);
    const std::size_t kept = counts_[i] / 2;
    cutoff_[i] = sort_key(plane(kept - 1)[i]);
    for (std::size_t k = kept; k < counts_[i]; ++k) masks_[k] &= ~bit;
    counts_[i] = static_cast<std::uint32_t>(kept);
    left_ |= bit;
  }
  void sort_column(int i) {
    const std::size_t n = counts_[i];
    const auto place = [i](std::size_t k) { return k * 64 + static_cast<std::size_t>(i); };
    column_.reserve(n);
    for (std::size_t k = 0; k < n; ++k) {
      column_[k].key = planes_[place(k)];
      if constexpr (kOwned) column_[k].owner = owners_[place(k)];
    }
    std::stable_sort(column_.data(), column_.data() + n, [this](const Entry& a, const Entry& b) {
      return sort_key(a.key) > sort_key(b.key);
    });
    for (std::size_t k = 0; k < n; ++k) {
      planes_[place(k)] = column_[k].key;
      if constexpr (kOwned) owners_[place(k)] = column_[k].owner;
    }
  }

  static constexpr bool kOwned = !std::is_same_v<Owner, NoOwner>;
  struct Entry {
    std::uint64_t key;
    [[no_unique_address]] Owner owner;
  };

  ScratchBuffer<std::uint64_t> planes_, masks_;
  ScratchBuffer<Owner> owners_;
  ScratchBuffer<Entry> column_;
  std::size_t allocated_ = 0, capacity_ = 0, room_ = 0, filter_ = 0;
  std::uint64_t order_mask_ = 0;
  std::uint32_t counts_[64] = {};
  std::uint32_t earlier_[64] = {};  ///< counts of earlier windows
  std::uint64_t before_[64] = {};   ///< sort_keys from here on are in earlier windows; 0: all are
  std::uint64_t cutoff_[64] = {};   ///< sort_keys below are left to the next window
  std::uint64_t left_ = 0, misplaced_ = 0;
};

}  // namespace rastrum::transparency
