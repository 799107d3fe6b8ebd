// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/rules/quadric.hpp>

namespace rastrum::raster {

/// Quadrics at fixed addresses until the next restart, so that pieces can refer to them. A sphere
/// has 112 bytes, others at most 584. Keeps its memory.
class QuadricStore {
 public:
  explicit QuadricStore(MemoryAccount& memory) : memory_(&memory) {}

  void restart() { chunk_ = used_ = 0; }
  [[nodiscard]] const Quadric* add(const Quadric& quadric) {
    const std::size_t bytes = quadric.bytes();
    if (chunk_ < chunks_.size() && used_ + bytes > kChunk) {
      ++chunk_;
      used_ = 0;
    }
    if (chunk_ == chunks_.size()) chunks_.emplace_back(*memory_).reserve(kChunk);
    std::byte* const place = chunks_[chunk_].data() + used_;
    std::memcpy(place, &quadric, bytes);
    used_ += bytes;
    return reinterpret_cast<const Quadric*>(place);
  }

 private:
  static constexpr std::size_t kChunk = std::size_t{1} << 16;

  MemoryAccount* memory_;
  std::vector<ScratchBuffer<std::byte>> chunks_;
  std::size_t chunk_ = 0, used_ = 0;
};

}  // namespace rastrum::raster
