// What a program asks beside reading and writing files: which it has read, so that it does not
// write over them (mapped_file.cpp), which it could write (atomic_file.cpp), and what to say of
// them.
#pragma once

#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace rastrum::io {

/// From now on what is opened to be read is remembered, by device and number: until then, and in
/// programs that never ask, nothing is. Thread-safe, as the next three.
void remember_files_read();
/// A file that will be read.
void remember_read(const std::filesystem::path& file);
void remember_read(const struct stat& file);
/// Whether `file`, maybe by another name or a link, is one of them.
[[nodiscard]] bool was_read(const std::filesystem::path& file);

/// Why an AtomicFile of this name cannot be begun, in words, as far as it is known before; empty:
/// it can. To be asked before an hour of work.
[[nodiscard]] std::string why_not_writable(const std::filesystem::path& file);

/// A nameless file to write and read for a while, in TMPDIR, /tmp, /var/tmp or the working
/// directory, the first where one can be, else in memory; null: errno says why there is none.
[[nodiscard]] std::FILE* open_scratch_file();

/// `message`, or where it is longer than 2,000 bytes its begin and end, and between them how many
/// bytes are left out: what quotes a file need not hold all of it. Characters of UTF-8 stay whole.
[[nodiscard]] std::string shortened(std::string message);

}  // namespace rastrum::io
