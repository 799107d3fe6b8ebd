// SPDX-License-Identifier: BSD-3-Clause
// The CUDA device as the benchmarks use it, without a header of CUDA. It is implemented in
// device.cu, and in no_device.cpp where there is no CUDA compiler. All functions throw
// Error{no_device} for errors that the driver reports.
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
  /// Both wait.
  void write(const void* from, std::size_t bytes);
  void read(void* to, std::size_t bytes) const;

 private:
  void* data_ = nullptr;
};

/// A copy of an array of the host's.
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

/// A stream beside the renderer's, as a program that draws its own arrays has one. Not waited for
/// until it is destroyed.
class StreamOfACaller {
 public:
  StreamOfACaller();
  ~StreamOfACaller();
  StreamOfACaller(const StreamOfACaller&) = delete;
  StreamOfACaller& operator=(const StreamOfACaller&) = delete;

  [[nodiscard]] void* handle() const;
  /// `from` must stay until the stream is done.
  template <class T>
  void write(const DeviceArray<T>& to, std::span<const T> from) {
    write(to.memory(), from.data(), from.size_bytes());
  }

 private:
  void write(const DeviceMemory& to, const void* from, std::size_t bytes);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The words that are timed, and a copy, which says what the device's memory gives.
enum class Word : std::uint8_t { copy, exclusive_scan, sort_by_key, reduce_by_index, expand };

/// The input of the words. All arrays have the same length, except `counts`.
struct WordInput {
  std::vector<std::uint32_t> keys, values;
  std::vector<std::uint32_t> index;   ///< of a bin, below `bins`
  std::vector<std::uint64_t> words;   ///< copied, and folded into bins by their maximum
  std::vector<std::uint32_t> counts;  ///< scanned; and how often each owner is written by expand
  std::size_t bins = 0;
};

/// The words on the device, over a copy of the input.
class DeviceWords {
 public:
  explicit DeviceWords(const WordInput& input);
  ~DeviceWords();
  DeviceWords(const DeviceWords&) = delete;
  DeviceWords& operator=(const DeviceWords&) = delete;

  /// Waits. sort_by_key copies its pairs first, reduce_by_index empties its bins.
  void run(Word word);
  /// The output of the last run. For sort_by_key, key and value share an element.
  [[nodiscard]] std::vector<std::uint64_t> result() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
