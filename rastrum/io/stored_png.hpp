// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a PNG whose picture libdeflate has inflated: twice as fast as zlib, of which libpng
// knows no other.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <rastrum/io/parse.hpp>

namespace rastrum::io {

/// A PNG in parts, which libpng may read one after the other in place of the file: the same chunks,
/// but those of the picture are one, whose blocks are stored as they are. Where the file's chunks
/// are not whole, or in any other way not as usual (an interlaced picture, too), the parts are the
/// file, so that libpng says what it always says. Pictures of more than 256 MiB are not held twice,
/// and are left to libpng.
class StoredPng {
 public:
  explicit StoredPng(Bytes file);
  StoredPng(StoredPng&&) = delete;  // parts are its own bytes

  [[nodiscard]] std::span<const Bytes> parts() const { return parts_; }
  /// Whether the picture was inflated, and its sums were right.
  [[nodiscard]] bool is_checked() const { return parts_.size() > 1; }

 private:
  void store(Bytes file);

  std::unique_ptr<std::byte[]> rows_;  ///< as they were compressed
  std::vector<std::array<std::byte, 5>> block_heads_;
  std::array<std::byte, 10> head_;  ///< of the chunk, and of its stream
  std::array<std::byte, 8> end_;    ///< sums of the stream and of the chunk
  std::vector<Bytes> parts_;
};

}  // namespace rastrum::io
