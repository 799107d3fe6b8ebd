// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/shared_layers.hpp>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <thread>

#include <rastrum/ranks/layer_merge.hpp>

namespace rastrum::ranks {
namespace {

/// Blocks that a rank takes at once: a row of a bin.
constexpr std::size_t kAtOnce = 8;
constexpr std::size_t kSeenNumbers = sizeof(SeenBlock) / sizeof(std::uint64_t);

std::uint64_t numbers_of(std::uint64_t bytes) {
  return (bytes + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);
}

/// Calls f(run) for the list from `first` on; f may change the links.
template <class F>
void each_run_from(FragmentRun* first, const F& f) {
  for (FragmentRun *run = first, *next = nullptr; run != nullptr; run = next) {
    next = FragmentRun::at(run->next);
    f(*run);
  }
}

/// A bit beside the number of visitors: the root has gone.
constexpr std::uint64_t kClosed = std::uint64_t{1} << 63;

}  // namespace

std::byte* SharedLayers::room(std::size_t bytes) const {
  const std::uint64_t first = first_run(), numbers = numbers_of(bytes);
  const std::atomic_ref<std::uint64_t> end(taken());
  std::uint64_t at = end.load(std::memory_order_relaxed);
  do {
    if (first + at + numbers > memory_.size()) return nullptr;
  } while (!end.compare_exchange_weak(at, at + numbers, std::memory_order_relaxed));
  return reinterpret_cast<std::byte*>(&memory_[first + at]);
}

void SharedLayers::clear(std::size_t rank) const {
  memory_[rank] = 0;
  if (rank == 0) next() = picture() = visitors() = 0;
  const std::size_t first = blocks_ * rank / ranks_, last = blocks_ * (rank + 1) / ranks_;
  std::ranges::fill(memory_.subspan(ranks_ + kNumbers + first, last - first), 0);
}

void SharedLayers::tell(std::size_t rank, const FragmentBytes& held) const {
  std::uint64_t numbers = 0;
  if (held.has_memory_of_its_own())
    held.each_list([&](std::uint32_t, FragmentRun* first) {
      each_run_from(first, [&](const FragmentRun& run) {
        if (!has(run)) numbers += numbers_of(sizeof(run) + run.bytes);
      });
    });
  memory_[rank] = numbers;
}

std::size_t SharedLayers::first_run() const {
  return table_size(blocks_, static_cast<int>(ranks_)) + blocks_ * kSeenNumbers;
}

std::uint64_t SharedLayers::size() const {
  std::uint64_t numbers = first_run() + taken();
  for (std::size_t r = 0; r < ranks_; ++r) numbers += memory_[r];
  return numbers;
}

void SharedLayers::lay(std::size_t rank, const FragmentBytes& held) const {
  std::size_t room = first_run() + taken();
  for (std::size_t r = 0; r < rank; ++r) room += memory_[r];
  held.each_list([&](std::uint32_t block, FragmentRun* runs) {
    std::uint64_t first = 0;
    std::uint64_t* end = &first;
    each_run_from(runs, [&](FragmentRun& run) {
      if (run.bytes == 0) return;  // all fragments are hidden
      std::uint64_t at = room;
      if (has(run)) {
        at = static_cast<std::uint64_t>(reinterpret_cast<const std::uint64_t*>(&run) -
                                        memory_.data());
      } else {
        std::memcpy(&memory_[at], &run, sizeof(run) + run.bytes);
        room += numbers_of(sizeof(run) + run.bytes);
      }
      *end = at;
      end = &memory_[at];
    });
    if (first == 0) return;
    const std::atomic_ref<std::uint64_t> list(head(block));
    *end = list.exchange(first, std::memory_order_relaxed);
  });
}

SharedLayers::Run SharedLayers::take() const {
  const std::atomic_ref<std::uint64_t> next_one(next());
  const std::size_t first =
      std::min<std::size_t>(next_one.fetch_add(kAtOnce, std::memory_order_relaxed), blocks_);
  return {first, std::min(first + kAtOnce, blocks_)};
}

SharedLayers::OpenPicture::OpenPicture(SharedLayers layers, RootPicture& picture)
    : visitors_(&layers.visitors()) {
  layers.picture() = reinterpret_cast<std::uintptr_t>(&picture);
  std::atomic_ref<std::uint64_t>(*visitors_).store(0);
}

// After a whole frame all visitors have gone; after a failure some rank may still be drawing.
SharedLayers::OpenPicture::~OpenPicture() {
  const std::atomic_ref<std::uint64_t> visitors(*visitors_);
  visitors.fetch_or(kClosed);
  while (visitors.load() != kClosed) std::this_thread::yield();
}

SharedLayers::Visit::Visit(SharedLayers layers) : visitors_(&layers.visitors()) {
  const bool is_open = (std::atomic_ref<std::uint64_t>(*visitors_).fetch_add(1) & kClosed) == 0;
  // NOLINTNEXTLINE(performance-no-int-to-ptr): one process, where the root has put it
  picture_ = is_open ? reinterpret_cast<RootPicture*>(layers.picture()) : nullptr;
}

SharedLayers::Visit::~Visit() {
  std::atomic_ref<std::uint64_t>(*visitors_).fetch_sub(1);
}

std::uint64_t* SharedLayers::seen(std::size_t block) const {
  return &memory_[table_size(blocks_, static_cast<int>(ranks_)) + block * kSeenNumbers];
}

void SharedLayers::put(const SeenBlock& block) const {
  std::memcpy(seen(block.where.block), &block, sizeof(block));
}

SeenBlock SharedLayers::take_seen(std::size_t block) const {
  SeenBlock own;
  std::memcpy(static_cast<void*>(&own), seen(block), sizeof(own));
  return own;
}

}  // namespace rastrum::ranks
