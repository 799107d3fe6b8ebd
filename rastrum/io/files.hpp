// SPDX-License-Identifier: BSD-3-Clause
// Helpers of programs: which file a name means (system.hpp), files that were read and must not be
// replaced (mapped_file.cpp), files that can be written (atomic_file.cpp), messages.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace rastrum::io {

/// A file's device and number there, by any name or link.
using FileId = std::pair<std::uint64_t, std::uint64_t>;
/// None: there is no such file.
[[nodiscard]] std::optional<FileId> id_of(const std::filesystem::path& file);

/// From now on the library remembers the files that it reads, by device and number. Thread-safe, as
/// the next two.
void remember_files_read();
void remember_read(const std::filesystem::path& file);
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
