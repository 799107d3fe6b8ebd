// SPDX-License-Identifier: BSD-3-Clause
// Helpers of programs that read and write files: which files were read, so that none is replaced
// (mapped_file.cpp), which can be written (atomic_file.cpp), and messages about them.
#pragma once

#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace rastrum::io {

/// From now on the library remembers each file that it opens to read, by device and number. It
/// remembers none before the first call. Thread-safe, as the next three.
void remember_files_read();
/// Remembers a file that will be read.
void remember_read(const std::filesystem::path& file);
void remember_read(const struct stat& file);
/// Whether `file`, also by another name or a link, is a remembered file.
[[nodiscard]] bool was_read(const std::filesystem::path& file);

/// The reason why an AtomicFile of this name will fail, as far as that can be known; empty: none.
/// Ask before an hour of work.
[[nodiscard]] std::string why_not_writable(const std::filesystem::path& file);

/// A nameless scratch file to write and read, in the first possible of TMPDIR, /tmp, /var/tmp, the
/// working directory and memory; null: errno says why there is none.
[[nodiscard]] std::FILE* open_scratch_file();

/// `message`; if it is longer than 2,000 bytes, only its begin and end, with the number of bytes
/// left out between them. Characters of UTF-8 stay whole.
[[nodiscard]] std::string shortened(std::string message);

}  // namespace rastrum::io
