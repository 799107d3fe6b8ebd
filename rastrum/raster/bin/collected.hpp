// SPDX-License-Identifier: BSD-3-Clause
// Entries in the order in which they were made, and sorted by bin.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/core/memory.hpp>

namespace rastrum::raster {

/// Consecutive entries in one bin. Neighbours mostly share one, so runs are found once, then
/// counted and copied whole.
struct BinRun {
  std::uint32_t bin, count;
};

/// Entries in their order, and how many each bin gets. For one thread, which fills it for every
/// group, so that it stays in cache. `Entry` has a member `bin`.
template <class Entry>
class Collected {
 public:
  explicit Collected(MemoryAccount& memory) : entries_(memory), runs_(memory), next_(memory) {}

  void restart(std::size_t bins) {
    count_ = 0;
    run_count_ = 0;
    next_.reserve(bins + 1);
    std::fill_n(next_.data(), bins + 1, 0U);
  }
  /// Room for `n` more entries; call `added` with the number written.
  [[nodiscard]] Entry* room(std::size_t n) {
    entries_.grow(count_ + n, count_);
    return entries_.data() + count_;
  }
  void added(std::size_t n) {
    runs_.grow(run_count_ + n, run_count_);
    const Entry* const entries = entries_.data() + count_;
    for (std::size_t i = 0; i < n;) {
      const std::uint32_t bin = entries[i].bin;
      const auto other = [&](std::size_t e) { return entries[e].bin ^ bin; };
      std::size_t end = i + 1;
      // Four at a time: one by one took half again as long where the loop lay in two cache lines.
      while (end + 4 <= n && (other(end) | other(end + 1) | other(end + 2) | other(end + 3)) == 0)
        end += 4;
      while (end < n && other(end) == 0) ++end;
      const auto count = static_cast<std::uint32_t>(end - i);
      runs_[run_count_++] = {bin, count};
      next_[bin + 1] += count;
      i = end;
    }
    count_ += n;
  }
  [[nodiscard]] std::span<const Entry> entries() const { return {entries_.data(), count_}; }
  [[nodiscard]] std::span<const BinRun> runs() const { return {runs_.data(), run_count_}; }
  /// bins + 1 numbers; element b + 1 counts bin b.
  [[nodiscard]] std::span<const std::uint32_t> counts(std::size_t bins) const {
    return {next_.data(), bins + 1};
  }

 private:
  ScratchBuffer<Entry> entries_;
  ScratchBuffer<BinRun> runs_;
  ScratchBuffer<std::uint32_t> next_;
  std::size_t count_ = 0, run_count_ = 0;
};

template <class Entry>
class BinLists {
 public:
  explicit BinLists(MemoryAccount& memory) : sorted_(memory), begin_(memory) {}

  /// Stable counting sort.
  void sort(const Collected<Entry>& collected, std::size_t bins) {
    const std::span<const Entry> entries = collected.entries();
    const std::span<const std::uint32_t> counts = collected.counts(bins);
    sorted_.reserve(entries.size());
    begin_.reserve(bins + 1);
    // Shifted by one, so that the scatter moves each element on to its bin's begin.
    std::uint32_t sum = 0;
    begin_[0] = 0;
    for (std::size_t b = 0; b < bins; ++b) {
      begin_[b + 1] = sum;
      sum += counts[b + 1];
    }
    const Entry* from = entries.data();
    for (const BinRun& run : collected.runs()) {
      Entry* const to = sorted_.data() + begin_[run.bin + 1];
      begin_[run.bin + 1] += run.count;
      // Most runs are shorter than a memmove call is worth.
      for (std::uint32_t i = 0; i < run.count; ++i) to[i] = from[i];
      from += run.count;
    }
  }
  [[nodiscard]] std::span<const Entry> bin(std::size_t b) const {
    return {sorted_.data() + begin_[b], begin_[b + 1] - begin_[b]};
  }

 private:
  ScratchBuffer<Entry> sorted_;
  ScratchBuffer<std::uint32_t> begin_;
};

}  // namespace rastrum::raster
