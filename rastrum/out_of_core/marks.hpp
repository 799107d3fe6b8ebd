// A bit for each triangle of a file.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace rastrum::out_of_core {

class Marks {
 public:
  explicit Marks(std::uint64_t triangles) : words_((triangles + 63) / 64) {}

  /// Thread-safe. Most bits are set more than once, which costs a read.
  void set(std::uint64_t t) {
    std::atomic_ref<std::uint64_t> word(words_[t / 64]);
    const std::uint64_t bit = std::uint64_t{1} << t % 64;
    if ((word.load(std::memory_order_relaxed) & bit) == 0)
      word.fetch_or(bit, std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t count() const {
    std::uint64_t n = 0;
    for (const std::uint64_t w : words_) n += static_cast<std::uint64_t>(std::popcount(w));
    return n;
  }
  [[nodiscard]] std::vector<std::uint64_t> list() const {
    std::vector<std::uint64_t> triangles;
    triangles.reserve(count());
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t m = words_[w]; m != 0; m &= m - 1)
        triangles.push_back(w * 64 + static_cast<std::uint64_t>(std::countr_zero(m)));
    return triangles;
  }
  void clear() { words_.assign(words_.size(), 0); }

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace rastrum::out_of_core
