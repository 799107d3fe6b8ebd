// SPDX-License-Identifier: BSD-3-Clause
// The CUDA device for the benchmarks, without CUDA's headers: implemented in device.cu, and in
// no_device.cpp for builds without a CUDA compiler. All functions throw Error{no_device} for errors
// that the driver reports.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace rastrum::bench {

/// A block of the device's memory, uninitialized. Throws Error{out_of_memory}.
class DeviceMemory {
 public:
  DeviceMemory() = default;
  explicit DeviceMemory(std::size_t bytes);
  ~DeviceMemory();
  DeviceMemory(DeviceMemory&& other) noexcept : data_(std::exchange(other.data_, nullptr)) {}
  DeviceMemory& operator=(DeviceMemory&& other) noexcept {
    std::swap(data_, other.data_);
    return *this;
  }

  [[nodiscard]] void* data() const { return data_; }
  /// Both wait for the end.
  void write(const void* from, std::size_t bytes);
  void read(void* to, std::size_t bytes) const;

 private:
  void* data_ = nullptr;
};

/// A copy of a host array.
template <class T>
class DeviceArray {
 public:
  explicit DeviceArray(std::span<const T> from) : memory_(from.size_bytes()), size_(from.size()) {
    memory_.write(from.data(), from.size_bytes());
  }
  [[nodiscard]] std::span<const T> view() const {
    return {static_cast<const T*>(memory_.data()), size_};
  }
  [[nodiscard]] const DeviceMemory& memory() const { return memory_; }

 private:
  DeviceMemory memory_;
  std::size_t size_;
};

/// A stream beside the renderer's, like that of a program that draws its own arrays. Only the
/// destructor waits for it.
class StreamOfACaller {
 public:
  StreamOfACaller();
  ~StreamOfACaller();
  StreamOfACaller(const StreamOfACaller&) = delete;
  StreamOfACaller& operator=(const StreamOfACaller&) = delete;

  [[nodiscard]] void* handle() const;
  /// `from` must live until the stream is done.
  template <class T>
  void write(const DeviceArray<T>& to, std::span<const T> from) {
    write(to.memory(), from.data(), from.size_bytes());
  }

 private:
  void write(const DeviceMemory& to, const void* from, std::size_t bytes);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The words that are timed, and a copy, which measures the memory's bandwidth.
enum class Word : std::uint8_t { copy, exclusive_scan, sort_by_key, reduce_by_index, expand };

/// The input of the words. All arrays have the same length, except `counts`.
struct WordInput {
  std::vector<std::uint32_t> keys, values;
  std::vector<std::uint32_t> index;   ///< of bins, below `bins`
  std::vector<std::uint64_t> words;   ///< copied, and folded into bins by their maximum
  std::vector<std::uint32_t> counts;  ///< scanned; also how many results of expand each owner has
  std::size_t bins = 0;
};

/// Runs the words on the device, on a copy of the input.
class DeviceWords {
 public:
  explicit DeviceWords(const WordInput& input);
  ~DeviceWords();
  DeviceWords(const DeviceWords&) = delete;
  DeviceWords& operator=(const DeviceWords&) = delete;

  /// Waits for the end. sort_by_key copies its pairs first, reduce_by_index empties its bins.
  void run(Word word);
  /// The output of the last run. For sort_by_key, key and value share an element.
  [[nodiscard]] std::vector<std::uint64_t> result() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
