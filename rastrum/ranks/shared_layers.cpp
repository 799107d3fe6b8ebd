#include <rastrum/ranks/shared_layers.hpp>

#include <algorithm>
#include <atomic>

#include <rastrum/transparency/blend_kernels.hpp>

namespace rastrum::ranks {
namespace {

/// Blocks that a rank takes at once: a row of a bin.
constexpr std::size_t kAtOnce = 8;
/// Of what is seen of a block at most (SeenBlock's bytes).
constexpr std::size_t kSeenNumbers =
    (kMaskBytes + kPixels * sizeof(transparency::SeenPixel) + sizeof(std::uint64_t) - 1) /
    sizeof(std::uint64_t);
/// Before the planes of a list: where the next one of the block is, and how many bytes these are.
constexpr std::size_t kListNumbers = 2;

std::uint64_t numbers_of(std::size_t bytes) {
  return (bytes + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);
}

}  // namespace

void SharedLayers::clear(std::size_t rank) const {
  memory_[rank] = 0;
  if (rank == 0) next() = 0;
  const std::size_t first = blocks_ * rank / ranks_, last = blocks_ * (rank + 1) / ranks_;
  std::ranges::fill(memory_.subspan(ranks_ + 1 + first, last - first), 0);
}

void SharedLayers::tell(std::size_t rank, const FragmentBytes& held) const {
  std::uint64_t numbers = 0;
  held.each_size(
      [&](std::uint32_t, std::size_t bytes) { numbers += kListNumbers + numbers_of(bytes); });
  memory_[rank] = numbers;
}

std::size_t SharedLayers::first_list() const {
  return table_size(blocks_, static_cast<int>(ranks_)) + blocks_ * kSeenNumbers;
}

std::uint64_t SharedLayers::size() const {
  std::uint64_t numbers = first_list();
  for (std::size_t r = 0; r < ranks_; ++r) numbers += memory_[r];
  return numbers;
}

class SharedLayers::Lists final : public PackedTo {
 public:
  Lists(const SharedLayers& layers, std::size_t at) : layers_(layers), at_(at) {}
  std::byte* begin(std::uint32_t block, std::size_t) override {
    block_ = block;
    return reinterpret_cast<std::byte*>(&layers_.memory_[at_ + kListNumbers]);
  }
  void end(std::size_t size) override {
    if (size == 0) return;
    layers_.memory_[at_ + 1] = size;
    const std::atomic_ref<std::uint64_t> head(layers_.head(block_));
    layers_.memory_[at_] = head.exchange(at_, std::memory_order_relaxed);
    at_ += kListNumbers + numbers_of(size);
  }

 private:
  const SharedLayers& layers_;
  std::size_t at_;
  std::uint32_t block_ = 0;
};

std::uint64_t SharedLayers::lay(std::size_t rank, const FragmentBytes& held,
                                const Hides& hides) const {
  std::size_t at = first_list();
  for (std::size_t r = 0; r < rank; ++r) at += memory_[r];
  Lists lists(*this, at);
  return held.pack(lists, hides);
}

SharedLayers::Run SharedLayers::take() const {
  const std::atomic_ref<std::uint64_t> next_one(next());
  const std::size_t first =
      std::min<std::size_t>(next_one.fetch_add(kAtOnce, std::memory_order_relaxed), blocks_);
  return {first, std::min(first + kAtOnce, blocks_)};
}

std::span<std::byte> SharedLayers::seen(std::size_t block) const {
  return std::as_writable_bytes(memory_.subspan(
      table_size(blocks_, static_cast<int>(ranks_)) + block * kSeenNumbers, kSeenNumbers));
}

}  // namespace rastrum::ranks
