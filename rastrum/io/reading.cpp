// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/reading.hpp>

#include <algorithm>
#include <limits>
#include <system_error>

#include <rastrum/error.hpp>

namespace rastrum::io {

namespace fs = std::filesystem;

void Budget::take(std::uint64_t count, std::uint64_t size) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::size_t>::max();
  const bool fits = size == 0 || count <= kMost / size;
  take(fits ? count * size : std::numeric_limits<std::uint64_t>::max());
}

void Budget::take(std::uint64_t bytes) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  const auto sum = [](std::uint64_t a, std::uint64_t b) { return a > kMost - b ? kMost : a + b; };
  std::uint64_t before = taken_.load(), now = 0;
  do now = sum(before, bytes);
  while (!taken_.compare_exchange_weak(before, now));
  const std::uint64_t read = bytes_.load();
  if (now <= sum(read > kMost / kPerByte ? kMost : read * kPerByte, allowance_)) return;
  throw Error(Errc::out_of_memory,
              name_ + ": would take " + std::to_string(now >> 20) +
                  " MiB or more in memory: more than 64 times the " + std::to_string(read) +
                  " bytes of it and of the files that it names, and " +
                  std::to_string(allowance_ >> 20) +
                  " MiB on top; if you trust it, allow more (--memory-limit, memory_limit=, "
                  "ReadOptions::memory_limit)");
}

bool Reading::is_outside(const fs::path& file) const {
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(folder_.empty() ? fs::path(".") : folder_, error);
  const fs::path at = error ? fs::path{} : fs::weakly_canonical(file, error);
  if (error || at.empty()) return true;
  return std::mismatch(folder.begin(), folder.end(), at.begin(), at.end()).first != folder.end();
}

std::span<const std::byte> Reading::open(const fs::path& file) {
  if (!allow_outside_ && is_outside(file))
    throw Error(Errc::unsupported,
                file.string() +
                    ": lies outside of the folder of the file that names it, and is "
                    "not read (--allow-outside yes, ReadOptions::allow_outside)");
  const std::scoped_lock lock(mutex_);
  const MappedFile& mapped = files_.emplace_back(file, MappedFile::Kind::regular);
  budget.add_file(mapped.bytes().size());
  return mapped.bytes();
}

void Reading::check() const {
  for (const MappedFile& file : files_) file.check();
}

}  // namespace rastrum::io
