// SPDX-License-Identifier: BSD-3-Clause
// A caller's arrays on the device. They stay there while each frame reads them.
//
// An array is known by its place, its size and a mark of all its bytes. The host's threads read it
// for the mark; a copy would be slower, since the driver copies by one thread and over the bus. An
// array changed in place is copied again, over the old copy. A change of one eight-byte word is
// never missed, others only if 64 bits in each of the words' lanes agree by chance.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/parallel/exec.hpp>

namespace rastrum::raster {

class ContentMark {
 public:
  bool operator==(const ContentMark&) const = default;

  /// The mark of so many bytes, before any is taken.
  explicit ContentMark(std::size_t bytes = 0) : lanes_{bytes, ~std::uint64_t{bytes}, 1, 2} {}
  /// Takes four words. Each step is a bijection of the word and of the lane's state.
  void take(const std::uint64_t (&words)[4]) {
    constexpr std::uint64_t kOdd[4] = {0x9E3779B97F4A7C15U, 0xBF58476D1CE4E5B9U,
                                       0x94D049BB133111EBU, 0xD6E8FEB86659FD93U};
    for (std::size_t l = 0; l < 4; ++l) {
      lanes_[l] = (lanes_[l] ^ words[l]) * kOdd[l];
      lanes_[l] ^= lanes_[l] >> 29;
    }
  }
  void take(const ContentMark& other) { take(other.lanes_); }

  /// Uses all threads. Work O(bytes), at the memory's speed.
  [[nodiscard]] static ContentMark of(std::span<const std::byte> bytes,
                                      parallel::Threads& threads) {
    constexpr std::size_t kPart = std::size_t{1} << 18;
    std::vector<ContentMark> parts((bytes.size() + kPart - 1) / kPart);
    parallel::for_each_index(threads, parts.size(), [&](std::size_t p) {
      const std::size_t begin = p * kPart;
      parts[p] = of_part(bytes.subspan(begin, std::min(kPart, bytes.size() - begin)));
    });
    ContentMark all(bytes.size());
    for (const ContentMark& part : parts) all.take(part);
    return all;
  }

 private:
  [[nodiscard]] static ContentMark of_part(std::span<const std::byte> bytes) {
    ContentMark mark(bytes.size());
    std::uint64_t words[4];
    std::size_t at = 0;
    for (; at + sizeof words <= bytes.size(); at += sizeof words) {
      std::memcpy(words, bytes.data() + at, sizeof words);
      mark.take(words);
    }
    if (at == bytes.size()) return mark;
    for (std::uint64_t& w : words) w = 0;
    std::memcpy(words, bytes.data() + at, bytes.size() - at);
    mark.take(words);
    return mark;
  }

  std::uint64_t lanes_[4];
};

template <class Exec>
class KeptArrays {
 public:
  KeptArrays(Exec& exec, parallel::Threads& threads) : exec_(exec), threads_(threads) {}

  /// Begins a frame: drops what the last one did not read.
  void begin() {
    std::erase_if(kept_, [](const auto& kept) { return !kept.second.is_read; });
    for (auto& kept : kept_) kept.second.is_read = false;
  }
  /// The copy, valid until the next begin(). The array must stay until the stream was waited for.
  /// Does not wait.
  [[nodiscard]] const void* operator()(std::span<const std::byte> host) {
    const auto [at, is_new] = kept_.try_emplace({host.data(), host.size()});
    Kept& kept = at->second;
    if (kept.is_read) return kept.bytes.data();
    const ContentMark mark = ContentMark::of(host, threads_);
    if (is_new) kept.bytes = parallel::make_buffer<std::byte>(exec_, host.size());
    if (is_new || mark != kept.mark) {
      parallel::cuda_system::copy(exec_.stream(), kept.bytes.data(), host.data(), host.size());
      ++copies_;
    }
    kept.mark = mark;
    kept.is_read = true;
    return kept.bytes.data();
  }
  /// After a frame that failed: its copies may be incomplete.
  void forget() { kept_.clear(); }
  [[nodiscard]] std::uint64_t copies() const { return copies_; }

 private:
  using Bytes = decltype(parallel::make_buffer<std::byte>(std::declval<Exec&>(), 0));
  struct Kept {
    Bytes bytes;
    ContentMark mark;
    bool is_read = false;
  };

  Exec& exec_;
  parallel::Threads& threads_;
  std::map<std::pair<const void*, std::size_t>, Kept> kept_;
  std::uint64_t copies_ = 0;
};

}  // namespace rastrum::raster
