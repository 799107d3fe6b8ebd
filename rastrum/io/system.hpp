// SPDX-License-Identifier: BSD-3-Clause
// Files, where systems differ: system_posix.cpp and system_windows.cpp. Descriptors are the C
// library's; programs that this one starts do not inherit them. −1: errno says why not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <rastrum/io/files.hpp>

namespace rastrum::io {

struct FileInfo {
  enum class Kind { regular, folder, other };
  Kind kind = Kind::other;
  std::uint64_t bytes = 0;
  bool read_only = false;  ///< for everybody
  FileId id;
};
/// Follows links. None: errno says why not.
[[nodiscard]] std::optional<FileInfo> info_of(const std::filesystem::path& file);
[[nodiscard]] std::optional<FileInfo> info_of(int descriptor);
[[nodiscard]] bool may_write(const std::filesystem::path& file_or_folder);

/// "/dev/stdin" is standard input everywhere. `wait`: until a pipe has a writer.
[[nodiscard]] int open_to_read(const std::filesystem::path& file, bool wait);
[[nodiscard]] int open_to_write(const std::filesystem::path& file);
[[nodiscard]] int open_standard_output();
[[nodiscard]] int duplicate(int descriptor);
/// A file that is not there yet.
[[nodiscard]] int create_file(const std::filesystem::path& file);
/// Gives what will replace `target` its owner and mode, where files have them.
void take_mode(int descriptor, const std::filesystem::path& target);

/// Locks the file until its last descriptor is closed. False: another process has locked or
/// removed it.
[[nodiscard]] bool lock_file(int descriptor);
/// Removes a file that no process has locked.
void remove_unlocked(const std::filesystem::path& file);
[[nodiscard]] std::string host_name();
/// `run` will run in each child that is forked. Returns whether it will.
bool after_fork(void (*run)());

/// Maps the file to be read. Null: errno says why not.
[[nodiscard]] const std::byte* map_file(int descriptor, std::size_t bytes);
void unmap_file(const std::byte* data, std::size_t bytes);
enum class MapAdvice { sequential, will_need, drop };
/// `begin` is a page's.
void advise(MapAdvice advice, const std::byte* begin, std::size_t bytes);
[[nodiscard]] std::size_t page_bytes();

}  // namespace rastrum::io
