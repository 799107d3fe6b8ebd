// SPDX-License-Identifier: BSD-3-Clause
// Limits on reading a document: its memory, and the files it names.
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

#include <rastrum/image.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/mapped_file.hpp>

namespace rastrum::io {

/// The memory that a document may take: 64 bytes for each byte of it and its files, more than
/// ordinary ones need, plus ReadOptions::memory_limit. Thread-safe.
class Budget {
 public:
  static constexpr std::uint64_t kPerByte = 64;
  /// `name`: the document's, for errors.
  Budget(std::string name, std::uint64_t bytes, const ReadOptions& options)
      : name_(std::move(name)), allowance_(options.memory_limit), bytes_(bytes) {}

  /// Call it before allocating. Throws Error{out_of_memory} if the limit is exceeded.
  void take(std::uint64_t bytes);
  void take(std::uint64_t count, std::uint64_t size);
  /// Takes and makes room for `count` values in all. Like push_back it makes more than asked for,
  /// so that adding one by one seldom reallocates.
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
  /// `bytes`: of a pixel, and what is made beside it.
  template <class Pixel>
  [[nodiscard]] Image<Pixel> image(int width, int height, std::size_t bytes = sizeof(Pixel)) {
    take(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height), bytes);
    return Image<Pixel>(width, height);
  }
  /// One more file belongs to the document.
  void add_file(std::uint64_t bytes) { bytes_ += bytes; }

 private:
  std::string name_;
  std::uint64_t allowance_;
  std::atomic<std::uint64_t> bytes_, taken_{0};
};

/// Thread-safe.
class Reading {
 public:
  /// `file`: the document's name; its folder has the files that it names.
  Reading(const std::filesystem::path& file, std::uint64_t bytes, const ReadOptions& options)
      : budget(file.string(), bytes, options),
        folder_(file.parent_path()),
        allow_outside_(options.allow_outside) {}

  [[nodiscard]] std::filesystem::path beside(const std::filesystem::path& name) const {
    return folder_ / name;
  }
  /// Whether a file, after links, lies outside the document's folder. Messages must not quote such
  /// a file.
  [[nodiscard]] bool is_outside(const std::filesystem::path& file) const;
  /// The bytes of a file that the document or its files name; valid as long as this. Throws
  /// Error{not_found | io}, also if it is no regular file, and Error{unsupported} if it lies
  /// outside without permission.
  [[nodiscard]] std::span<const std::byte> open(const std::filesystem::path& file);
  /// Throws Error{io} if a file that was opened has become shorter.
  void check() const;

  Budget budget;

 private:
  std::filesystem::path folder_;
  bool allow_outside_;
  mutable std::mutex mutex_;
  std::list<MappedFile> files_;
};

/// Returns read(), which reads from `files`, a MappedFile or a Reading. Throws Error{io} if one has
/// become shorter or could not be read.
template <class Files, class Read>
auto read_whole(const Files& files, const Read& read) {
  try {
    auto made = read();
    files.check();
    return made;
  } catch (const Error&) {
    files.check();  // lost pages read as zeros, which are wrong, too
    throw;
  }
}
/// Likewise for read(bytes) of a file.
template <class Read>
auto read_mapped(const std::filesystem::path& file, const Read& read) {
  const MappedFile mapped(file);
  return read_whole(mapped, [&] { return read(mapped.bytes()); });
}

}  // namespace rastrum::io
