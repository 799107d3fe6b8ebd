// Layers on memory that ranks of one machine share: each rank lays its fragments there, a list a
// block, whoever is free blends a block, and the root reads what is seen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/ranks/fragments.hpp>

namespace rastrum::ranks {

/// Numbers of 64 bits: the table, of which is room from the beginning of a frame on (how much each
/// rank has, the next block that nobody blends, and of each block where its list begins), and then
/// what is seen of each block and the lists, where all have told how much that is.
class SharedLayers {
 public:
  /// `memory`: of the table and, perhaps, of the rest.
  SharedLayers(std::span<std::uint64_t> memory, std::size_t blocks, int ranks)
      : memory_(memory), blocks_(blocks), ranks_(static_cast<std::size_t>(ranks)) {}
  [[nodiscard]] static std::size_t table_size(std::size_t blocks, int ranks) {
    return static_cast<std::size_t>(ranks) + 1 + blocks;
  }

  /// First each rank makes its share of the table empty, and then tells what it holds: before an
  /// agreement.
  void clear(std::size_t rank) const;
  void tell(std::size_t rank, const FragmentBytes& held) const;
  /// Behind it: the size of all, the same on all ranks.
  [[nodiscard]] std::uint64_t size() const;
  /// Lays them there, and returns how many; all ranks at the same time.
  std::uint64_t lay(std::size_t rank, const FragmentBytes& held, const Hides& hides) const;
  /// Behind another agreement: blocks [first, last) that nobody else blends, until first == last.
  struct Run {
    std::size_t first, last;
  };
  [[nodiscard]] Run take() const;
  [[nodiscard]] bool has(std::size_t block) const { return head(block) != 0; }
  /// Calls f(Reader) for the planes of each rank that has some, in any order of ranks.
  template <class F>
  void each_list(std::size_t block, const F& f) const {
    for (std::uint64_t at = head(block); at != 0; at = memory_[at])
      f(Reader({reinterpret_cast<const std::byte*>(&memory_[at + 2]), memory_[at + 1]}));
  }
  /// Where what is seen of a block lies, or comes to lie.
  [[nodiscard]] std::span<std::byte> seen(std::size_t block) const;

 private:
  class Lists;
  [[nodiscard]] std::uint64_t& next() const { return memory_[ranks_]; }
  [[nodiscard]] std::uint64_t& head(std::size_t block) const { return memory_[ranks_ + 1 + block]; }
  [[nodiscard]] std::size_t first_list() const;

  std::span<std::uint64_t> memory_{};
  std::size_t blocks_ = 0, ranks_ = 0;
};

}  // namespace rastrum::ranks
