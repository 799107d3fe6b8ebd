// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/parallel/arena.hpp>

#include <algorithm>
#include <bit>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <rastrum/core/aligned_memory.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>

namespace rastrum::parallel {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::size_t kLargePage = std::size_t{1} << 21;
/// Smaller blocks are left to malloc, which is good at them.
constexpr std::size_t kSmallestKept = std::size_t{1} << 16;

// Nothing is kept under the address sanitizer, so that it sees use after release.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kKeeps = false;
#elif defined(__has_feature)
constexpr bool kKeeps = !__has_feature(address_sanitizer);
#else
constexpr bool kKeeps = true;
#endif

void* system_allocate(std::size_t bytes) noexcept {
  const bool large = bytes >= 2 * kLargePage;
  const std::size_t alignment = large ? kLargePage : kAlignment;
  void* const data = aligned_allocate(alignment, (bytes + alignment - 1) / alignment * alignment);
#if defined(__linux__)
  // Only advice: if it fails, the pages are slower.
  if (large && data != nullptr) static_cast<void>(madvise(data, bytes, MADV_HUGEPAGE));
#endif
  return data;
}

void system_release(void* block) noexcept {
  aligned_free(block);
}

}  // namespace

MemorySource host_memory() {
  return {system_allocate, system_release, "scratch"};
}

/// The size of the block that serves `bytes`: 4, 5, 6 or 7 times a power of two.
std::size_t Arena::block_bytes(std::size_t bytes) const {
  const std::size_t least = source_.keeps_all ? 4 * kAlignment : kAlignment;
  const bool exact = bytes < kSmallestKept && !source_.keeps_all;
  const std::size_t wanted = std::max(bytes, least);
  const std::size_t step = exact ? kAlignment : std::bit_floor(wanted) / 4;
  return (wanted + step - 1) / step * step;
}

void* Arena::allocate(std::size_t bytes) {
  const std::size_t size = bytes > SIZE_MAX / 2 ? bytes : block_bytes(bytes);
  const std::lock_guard lock(mutex_);
  if (const std::size_t at = fitting(size); at < kept_.size()) {
    const Block block = kept_[at];
    lend(block);
    kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(at));
    kept_bytes_ -= block.bytes;
    return block.data;
  }
  while (!source_.keeps_all && !kept_.empty() &&
         in_use_ + size + kept_bytes_ > std::max(peak_, in_use_ + size))
    drop_oldest();
  void* data = size > SIZE_MAX / 2 ? nullptr : source_.allocate(size);
  if (data == nullptr && !kept_.empty() && size <= SIZE_MAX / 2) {
    while (!kept_.empty()) drop_oldest();
    data = source_.allocate(size);
  }
  if (data == nullptr)
    throw Error(Errc::out_of_memory,
                text_of("out of memory: ", bytes, " bytes of ", source_.name, " were asked for"));
  try {
    lend({data, size});
  } catch (...) {
    source_.release(data);
    throw;
  }
  if (account_ != nullptr) account_->add(size);
  return data;
}

/// The newest kept block of this size; if the source keeps all, the smallest one up to twice as
/// large, since sizes change from frame to frame. Returns kept_.size() if none fits.
std::size_t Arena::fitting(std::size_t size) const {
  std::size_t best = kept_.size();
  for (std::size_t i = kept_.size(); i-- > 0;) {
    const std::size_t bytes = kept_[i].bytes;
    if (bytes == size) return i;
    if (!source_.keeps_all || bytes < size || bytes / 2 > size) continue;
    if (best == kept_.size() || bytes < kept_[best].bytes) best = i;
  }
  return best;
}

void Arena::lend(Block block) {
  if (source_.keeps_all) lent_.emplace(block.data, block.bytes);
  in_use_ += block.bytes;
  peak_ = std::max(peak_, in_use_);
}

void Arena::release(void* block, std::size_t bytes) noexcept {
  const std::lock_guard lock(mutex_);
  std::size_t size = block_bytes(bytes);
  if (const auto lent = lent_.find(block); lent != lent_.end()) {
    size = lent->second;
    lent_.erase(lent);
  }
  in_use_ -= size;
  if (source_.keeps_all || (kKeeps && size >= kSmallestKept)) {
    try {
      kept_.push_back({block, size});
      kept_bytes_ += size;
      return;
    } catch (const std::bad_alloc&) {
      // No memory to remember the block: release it.
    }
  }
  source_.release(block);
  if (account_ != nullptr) account_->remove(size);
}

void Arena::drop_oldest() noexcept {
  const Block block = kept_.front();
  kept_.erase(kept_.begin());
  kept_bytes_ -= block.bytes;
  source_.release(block.data);
  if (account_ != nullptr) account_->remove(block.bytes);
}

void Arena::trim() noexcept {
  const std::lock_guard lock(mutex_);
  while (!kept_.empty()) drop_oldest();
}

std::uint64_t Arena::in_use() const {
  const std::lock_guard lock(mutex_);
  return in_use_;
}
std::uint64_t Arena::held() const {
  const std::lock_guard lock(mutex_);
  return in_use_ + kept_bytes_;
}
std::uint64_t Arena::peak() const {
  const std::lock_guard lock(mutex_);
  return peak_;
}

}  // namespace rastrum::parallel
