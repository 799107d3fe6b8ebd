// What reading a document may take: memory, and the files that it names.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/io/mapped_file.hpp>

namespace rastrum::io {

/// How much memory a document may become: 64 bytes for each of its own and of the files that it
/// names, which no honest one needs, and ReadOptions::memory_limit. Thread-safe.
class Budget {
 public:
  static constexpr std::uint64_t kPerByte = 64;
  /// `name` is the document's, for errors.
  Budget(std::string name, std::uint64_t bytes, const ReadOptions& options)
      : name_(std::move(name)), allowance_(options.memory_limit), bytes_(bytes) {}

  /// Before so many bytes are taken. Throws Error{out_of_memory} where they are too many.
  void take(std::uint64_t bytes);
  /// `count` of `size` bytes each.
  void take(std::uint64_t count, std::uint64_t size);
  /// Room for `count` values in all, taken before it is made. As push_back does, it makes more than
  /// is asked for, so that one more at a time is seldom one more room.
  template <class T>
  void reserve(std::vector<T>& values, std::size_t count) {
    const std::size_t had = values.capacity();
    if (count <= had) return;
    count = std::max(count, 2 * had);
    take(count - had, sizeof(T));
    values.reserve(count);
  }
  template <class T>
  void resize(std::vector<T>& values, std::size_t count, const T& value = {}) {
    reserve(values, count);
    values.resize(count, value);
  }
  template <class T>
  void add(std::vector<T>& values, std::type_identity_t<T> value) {
    reserve(values, values.size() + 1);
    values.push_back(value);
  }
  /// One more file belongs to the document.
  void add_file(std::uint64_t bytes) { bytes_ += bytes; }

 private:
  std::string name_;
  std::uint64_t allowance_;
  std::atomic<std::uint64_t> bytes_, taken_{0};
};

/// A document while it is read. Thread-safe.
class Reading {
 public:
  /// `file` names the document, and what it names is looked for beside it.
  Reading(const std::filesystem::path& file, std::uint64_t bytes, const ReadOptions& options)
      : budget(file.string(), bytes, options),
        folder_(file.parent_path()),
        allow_outside_(options.allow_outside) {}

  /// Where a file lies that the document names so.
  [[nodiscard]] std::filesystem::path beside(const std::filesystem::path& name) const {
    return folder_ / name;
  }
  /// Whether it lies outside of the document's folder; links count as what they lead to. Then its
  /// words are not for messages.
  [[nodiscard]] bool is_outside(const std::filesystem::path& file) const;
  /// The bytes of a file that the document names, by beside() or by one of its files; they live as
  /// long as this. Throws Error{not_found | io}, for what is no regular file, too, and
  /// Error{unsupported} where it lies outside and that is not allowed.
  [[nodiscard]] std::span<const std::byte> open(const std::filesystem::path& file);
  /// Throws Error{io} where a file that was opened has become shorter.
  void check() const;

  Budget budget;

 private:
  std::filesystem::path folder_;
  bool allow_outside_;
  mutable std::mutex mutex_;
  std::list<MappedFile> files_;
};

/// What read() returns of `files`, a MappedFile or a Reading, which stay what they were meanwhile:
/// else Error{io}.
template <class Files, class Read>
auto read_whole(const Files& files, const Read& read) {
  try {
    auto made = read();
    files.check();
    return made;
  } catch (const Error&) {
    files.check();  // zeros in the place of what was there are wrong, too
    throw;
  }
}
/// The same of read(bytes) of a file.
template <class Read>
auto read_mapped(const std::filesystem::path& file, const Read& read) {
  const MappedFile mapped(file);
  return read_whole(mapped, [&] { return read(mapped.bytes()); });
}

}  // namespace rastrum::io
