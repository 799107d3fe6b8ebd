// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/io/large_file.hpp>

namespace rastrum::out_of_core {

/// Walks through a file chunk after chunk. The next chunk is read while f(chunk) works on one.
class Chunks {
 public:
  /// A chunk lies within one part.
  struct Place {
    std::size_t number = 0, part = 0;
    std::uint64_t first = 0, count = 0;
  };
  /// Whether to read a chunk; empty: all.
  using Wanted = std::function<bool(const Place&)>;
  using Work = std::function<void(const io::FileChunk&, const Place&)>;
  /// `triangles`: the most that a chunk has.
  Chunks(const io::LargeFile& file, std::uint64_t triangles, std::size_t vertex_bytes);
  /// If f or reading throws, the walk ends with that exception.
  void walk(const Work& f, const Wanted& wanted = {}) { walk(in_file_, f, wanted); }
  /// The same in another order, given by chunk numbers.
  void walk(std::span<const std::size_t> order, const Work& f, const Wanted& wanted);
  [[nodiscard]] const std::vector<Place>& places() const { return places_; }
  /// The numbers of all chunks in the file's order.
  [[nodiscard]] const std::vector<std::size_t>& in_file() const { return in_file_; }
  [[nodiscard]] std::uint64_t read() const { return read_; }
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }
  /// The box of a chunk's positions, known from the walk that read it or from a look at the whole
  /// file (LargeFile::box). Null if there was neither, or if a vertex is not finite: such a chunk
  /// is always read, and its triangles counted.
  [[nodiscard]] std::optional<io::FileBox> box(const Place& chunk) const;

 private:
  const io::LargeFile& file_;
  std::size_t vertex_bytes_;
  std::vector<Place> places_;
  std::vector<std::size_t> in_file_;  ///< 0, 1, …
  io::FileChunk two_[2];
  std::vector<std::optional<io::FileBox>> boxes_;  ///< of chunks that were read
  std::uint64_t read_ = 0, left_out_ = 0;
};

}  // namespace rastrum::out_of_core
