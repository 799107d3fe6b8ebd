// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a PNG whose picture libdeflate has inflated, twice as fast as zlib, the only one
// that libpng knows.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <rastrum/io/parse.hpp>

namespace rastrum::io {

/// A PNG in parts, which libpng reads instead of the file. The chunks are the same, but those of
/// the picture are one, of stored (uncompressed) blocks. If chunks are damaged or unusual, or the
/// picture is interlaced, the parts are the file, so that libpng gives its own messages. Pictures
/// of more than 256 MiB are left to libpng, so that they are not held twice.
class StoredPng {
 public:
  explicit StoredPng(Bytes file);
  StoredPng(StoredPng&&) = delete;  // parts point to its own bytes

  [[nodiscard]] std::span<const Bytes> parts() const { return parts_; }
  /// Whether the picture was inflated and its sums were right.
  [[nodiscard]] bool is_checked() const { return parts_.size() > 1; }

 private:
  void store(Bytes file);

  std::unique_ptr<std::byte[]> rows_;  ///< inflated, still filtered
  std::vector<std::array<std::byte, 5>> block_heads_;
  std::array<std::byte, 10> head_;  ///< of the chunk, and of its stream
  std::array<std::byte, 8> end_;    ///< sums of the stream and of the chunk
  std::vector<Bytes> parts_;
};

}  // namespace rastrum::io
