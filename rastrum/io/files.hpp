// SPDX-License-Identifier: BSD-3-Clause
// Helpers of programs: files that were read and must not be replaced (mapped_file.cpp), files that
// can be written (atomic_file.cpp), messages.
#pragma once

#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace rastrum::io {

/// From now on the library remembers the files that it reads, by device and number. Thread-safe, as
/// the next three.
void remember_files_read();
void remember_read(const std::filesystem::path& file);
void remember_read(const struct stat& file);
/// Whether `file`, by any name or link, is a remembered file.
[[nodiscard]] bool was_read(const std::filesystem::path& file);

/// Why an AtomicFile of this name will fail, as far as can be known; empty: it will not. Ask before
/// an hour of work.
[[nodiscard]] std::string why_not_writable(const std::filesystem::path& file);

/// A nameless file in the first possible of TMPDIR, /tmp, /var/tmp, the working directory and
/// memory; null: errno says why not.
[[nodiscard]] std::FILE* open_scratch_file();

/// `message`; if longer than 2,000 bytes, its begin and end and the number of bytes between. UTF-8
/// characters stay whole.
[[nodiscard]] std::string shortened(std::string message);

}  // namespace rastrum::io
