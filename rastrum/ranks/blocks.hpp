// SPDX-License-Identifier: BSD-3-Clause
// The picture is cut into blocks of 8 × 8 pixels, numbered row by row. Each rank owns a run of
// them; runs are about equally long. A set of pixels is a list of blocks with a mask each.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

#include <rastrum/ranks.hpp>

namespace rastrum::ranks {

inline constexpr int kSide = 8;
inline constexpr std::size_t kPixels = 64;

struct BlockMask {
  std::uint64_t mask = 0;  ///< bit 8 y + x
  std::uint32_t block = 0;
};
/// Size of a BlockMask in a message: no padding.
inline constexpr std::size_t kMaskBytes = 12;

class BlockGrid {
 public:
  BlockGrid(int width, int height, int ranks) : BlockGrid(width, 0, height, ranks) {}
  /// Covers the rows [top, bottom) of a picture; `top` is a multiple of kSide. Blocks count from
  /// `top`, pixels from the picture's corner.
  BlockGrid(int width, int top, int bottom, int ranks);
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Rank r owns blocks [firsts()[r], firsts()[r + 1]).
  [[nodiscard]] std::span<const std::uint64_t> firsts() const { return firsts_; }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int top() const { return top_; }
  /// The block in column `bx` and row `by` of the picture.
  [[nodiscard]] std::size_t at(int bx, int by) const {
    return static_cast<std::size_t>(by - top_ / kSide) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(bx);
  }
  /// The picture's coordinates of a block's upper left pixel.
  [[nodiscard]] int x_of(std::uint32_t block) const {
    return static_cast<int>(block) % columns_ * kSide;
  }
  [[nodiscard]] int y_of(std::uint32_t block) const {
    return top_ + static_cast<int>(block) / columns_ * kSide;
  }
  [[nodiscard]] std::size_t owner(std::uint32_t block) const;
  /// The pixels of a block that lie in the picture.
  [[nodiscard]] std::uint64_t inside(std::uint32_t block) const {
    const int across = width_ - x_of(block), down = bottom_ - y_of(block);
    std::uint64_t row = across >= kSide ? 0xFF : (std::uint64_t{1} << across) - 1, mask = 0;
    for (int y = 0; y < std::min(down, kSide); ++y) mask |= row << (kSide * y);
    return mask;
  }
  /// Calls f(i, x, y) for the pixels in both mask and picture, in rising order of i.
  template <class F>
  void each_pixel(BlockMask b, const F& f) const {
    const int x0 = x_of(b.block), y0 = y_of(b.block);
    for (std::uint64_t m = b.mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      const int x = x0 + i % kSide, y = y0 + i / kSide;
      if (x < width_ && y < bottom_) f(i, x, y);
    }
  }

 private:
  int width_, top_, bottom_, columns_;
  std::size_t count_;
  std::vector<std::uint64_t> firsts_;
};

/// Leaves new elements of a vector uninitialized, because all are overwritten.
template <class T>
struct Unset : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = Unset<U>;
  };
  template <class U, class... Args>
  void construct(U* at, Args&&... args) {
    if constexpr (sizeof...(Args) == 0)
      ::new (static_cast<void*>(at)) U;
    else
      ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
  }
};
using Bytes = std::vector<std::byte, Unset<std::byte>>;

template <class T>
void put(Bytes& to, const T& value) {
  const std::size_t at = to.size();
  to.resize(at + sizeof(T));
  std::memcpy(to.data() + at, &value, sizeof(T));
}
inline void put_mask(Bytes& to, BlockMask b) {
  put(to, b.mask);
  put(to, b.block);
}

/// Writes a mask and the words of its pixels, taken from the block's 64.
inline void put_words(Bytes& to, BlockMask b, const std::uint64_t* words) {
  put_mask(to, b);
  const std::size_t at = to.size();
  to.resize(at + sizeof(*words) * static_cast<std::size_t>(std::popcount(b.mask)));
  std::byte* out = to.data() + at;
  for (std::uint64_t m = b.mask; m != 0; m &= m - 1, out += sizeof(*words))
    std::memcpy(out, words + std::countr_zero(m), sizeof(*words));
}

/// Reads in the order in which put wrote.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : left_(bytes) {}
  [[nodiscard]] bool at_end() const { return left_.empty(); }
  template <class T>
  T take() {
    T value;
    std::memcpy(&value, left_.data(), sizeof(T));
    left_ = left_.subspan(sizeof(T));
    return value;
  }
  std::span<const std::byte> take_bytes(std::size_t count) {
    const auto bytes = left_.first(count);
    left_ = left_.subspan(count);
    return bytes;
  }
  std::span<const std::byte> take_all() { return take_bytes(left_.size()); }
  BlockMask take_mask() {
    BlockMask b;
    b.mask = take<std::uint64_t>();
    b.block = take<std::uint32_t>();
    return b;
  }

 private:
  std::span<const std::byte> left_;
};

/// The data to and from each rank in one exchange.
class Mail {
 public:
  explicit Mail(int ranks);
  [[nodiscard]] Bytes& to(std::size_t rank) { return to_[rank]; }
  [[nodiscard]] std::size_t ranks() const { return to_.size(); }
  /// A collective call; allocates nothing.
  void exchange_sizes(Communicator& ranks);
  void make_room();
  /// A collective call; allocates nothing.
  void exchange(Communicator& ranks);
  /// For exchanges in which all ranks know who sends to whom: the next exchange() sends sizes among
  /// these ranks. Allocates nothing.
  void begin_sizes(std::span<const std::size_t> to, std::span<const std::size_t> from);
  /// After that exchange(): makes room for the data from these ranks.
  void take_sizes(std::span<const std::size_t> from);
  [[nodiscard]] Reader from(std::size_t rank) const { return Reader(from_[rank]); }
  void clear_from() {
    for (Bytes& bytes : from_) bytes.clear();
  }
  void set_from(std::size_t rank, std::span<const std::byte> bytes) {
    from_[rank].assign(bytes.begin(), bytes.end());
  }

 private:
  std::vector<Bytes> to_, from_;
  std::vector<std::uint64_t> to_sizes_, from_sizes_;
  std::vector<std::span<const std::byte>> to_views_;
  std::vector<std::span<std::byte>> from_views_;
};

}  // namespace rastrum::ranks
