// A file's bytes, mapped: readers work on the page cache and copy nothing but their results.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace rastrum::io {

/// Owns the mapping. What is not a regular file (a pipe) is read into memory instead.
/// Throws Error{not_found | io} naming the file.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_, size_}; }

  /// Asks the system to read [offset, offset + size) ahead; returns at once.
  void will_need(std::size_t offset, std::size_t size) const;
  /// Takes whole pages within [offset, offset + size) out of the process; who reads them again has
  /// them from the page cache, or from the disk.
  void drop(std::size_t offset, std::size_t size) const;

 private:
  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  bool mapped_ = false;
  std::vector<std::byte> copy_;
};

[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace rastrum::io
