// SPDX-License-Identifier: BSD-3-Clause
// The container of GLB 2.0: a header, a chunk of JSON, and one of binary data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <rastrum/io/parse.hpp>

namespace rastrum::io {

inline constexpr std::size_t kGlbHeader = 12, kGlbChunk = 8;  ///< bytes before a chunk's data
inline constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

struct Glb {
  std::string_view text;
  std::optional<Bytes> bin;
  std::size_t surplus = 0;  ///< bytes after the container's end
};

[[nodiscard]] bool is_glb(Bytes bytes);
/// Looks at headers alone. Throws Error{bad_format | unsupported} naming the file.
[[nodiscard]] Glb open_glb(Bytes bytes, const std::string& name);

}  // namespace rastrum::io
