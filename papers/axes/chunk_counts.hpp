// SPDX-License-Identifier: BSD-3-Clause
// Counts the fragments of each chunk of a region and finds runs of chunks whose fragments fit into
// a budget. Methods that keep fragments draw one run at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <papers/axes/region.hpp>
#include <rastrum/core/memory.hpp>

namespace rastrum::family {

class ChunkCounts {
 public:
  explicit ChunkCounts(MemoryAccount& memory) : counts_(memory) {}

  void restart(std::size_t chunks) {
    counts_.reserve(chunks);
    std::fill_n(counts_.data(), chunks, std::uint64_t{0});
    chunks_ = chunks;
    next_ = 0;
  }
  /// Threads may call this at once for different chunks.
  void add(std::size_t chunk, std::uint64_t fragments) { counts_[chunk] += fragments; }

  struct Run {
    Region::Pass chunks;
    std::uint64_t fragments = 0;
  };
  /// Returns the next chunks that have at most `most` fragments together, or one chunk that alone
  /// has more. A run without fragments is the end.
  [[nodiscard]] Run take(std::uint64_t most) {
    Run run{{next_, next_}, 0};
    while (next_ < chunks_ && (run.fragments == 0 || run.fragments + counts_[next_] <= most))
      run.fragments += counts_[next_++];
    run.chunks.last = next_;
    return run;
  }

 private:
  ScratchBuffer<std::uint64_t> counts_;
  std::size_t chunks_ = 0, next_ = 0;
};

}  // namespace rastrum::family
