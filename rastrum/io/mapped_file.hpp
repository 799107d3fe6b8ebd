// SPDX-License-Identifier: BSD-3-Clause
// A file's bytes, mapped, so that readers copy only their results.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <rastrum/io/lost_pages.hpp>

namespace rastrum::io {

/// Owns the mapping. A file that is not regular (a pipe) is read into memory or refused; an
/// unwatched one (LostPages) is copied. Throws Error{not_found | io} naming the file.
class MappedFile {
 public:
  enum class Kind { any, regular };
  explicit MappedFile(const std::filesystem::path& file, Kind kind = Kind::any);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_, size_}; }

  /// Throws Error{io} if the file has become shorter or could not be read. Bytes read since the
  /// last call may then be zeros.
  void check() const;

  /// Asks the system to read [offset, offset + size) ahead; returns at once.
  void will_need(std::size_t offset, std::size_t size) const;
  /// Releases whole pages within [offset, offset + size); the page cache or disk has them.
  void drop(std::size_t offset, std::size_t size) const;

 private:
  void copy(int fd);

  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::optional<LostPages> mapped_;  ///< none: the bytes are in copy_
  std::vector<std::byte> copy_;
  std::filesystem::path file_;
};

[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline constexpr bool kLittleEndian = std::endian::native == std::endian::little;

/// A number at any address. `swap`: its byte order is not this machine's.
template <class T>
[[nodiscard]] T load(const std::byte* p, bool swap = false) {
  std::array<std::byte, sizeof(T)> b;
  std::memcpy(b.data(), p, sizeof(T));
  if (swap) std::reverse(b.begin(), b.end());
  return std::bit_cast<T>(b);
}
template <class T>
[[nodiscard]] T load_little_endian(const std::byte* p) {
  return load<T>(p, !kLittleEndian);
}

}  // namespace rastrum::io
