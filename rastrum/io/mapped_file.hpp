// SPDX-License-Identifier: BSD-3-Clause
// A file's bytes, mapped: readers work on the page cache and copy nothing but their results.
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

/// Owns the mapping. A file that is not regular (a pipe) is read into memory instead, or refused; a
/// file that cannot be watched (LostPages) is copied into memory. Throws Error{not_found | io}
/// naming the file.
class MappedFile {
 public:
  enum class Kind { any, regular };
  explicit MappedFile(const std::filesystem::path& file, Kind kind = Kind::any);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_, size_}; }

  /// Throws Error{io} where the file has become shorter than when it was mapped, or could not be
  /// read: bytes that were read since the last call may be zeros.
  void check() const;

  /// Asks the system to read [offset, offset + size) ahead; returns at once.
  void will_need(std::size_t offset, std::size_t size) const;
  /// Takes whole pages within [offset, offset + size) out of the process; who reads them again has
  /// them from the page cache, or from the disk.
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

/// A number at any address. `swap`: whether its byte order is not this machine's.
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
