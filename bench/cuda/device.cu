// SPDX-License-Identifier: BSD-3-Clause
// The device side of the benchmarks. Tests compile this file as C++ for the CPU.
#include <bench/cuda/device.hpp>

#include <rastrum/error.hpp>
#include <rastrum/parallel/cuda/words.cuh>

namespace rastrum::bench {
namespace {

using namespace parallel;  // NOLINT: its words are the subject here

struct Same {
  RASTRUM_HD std::uint64_t operator()(std::uint64_t x) const { return x; }
};
struct Count {
  std::span<const std::uint32_t> counts;
  RASTRUM_HD std::size_t operator()(std::size_t i) const { return counts[i]; }
};
struct Owner {
  RASTRUM_HD std::uint32_t operator()(std::size_t i, std::size_t) const {
    return static_cast<std::uint32_t>(i);
  }
};

void copy(const void* from, void* to, std::size_t bytes) {
  if (bytes == 0) return;
  const Cuda exec;
  cuda_system::copy(exec.stream(), to, from, bytes);
  exec.wait();
}

}  // namespace

DeviceMemory::DeviceMemory(std::size_t bytes) {
  if (bytes == 0) return;
  data_ = cuda_system::memory_source().allocate(bytes);
  if (data_ == nullptr)
    throw Error(Errc::out_of_memory,
                std::to_string(bytes).append(" bytes of the device's memory are not there"));
}
DeviceMemory::~DeviceMemory() {
  if (data_ != nullptr) cuda_system::memory_source().release(data_);
}
void DeviceMemory::write(const void* from, std::size_t bytes) {
  copy(from, data_, bytes);
}
void DeviceMemory::read(void* to, std::size_t bytes) const {
  copy(data_, to, bytes);
}

struct StreamOfACaller::Impl {
  Cuda exec;
};
StreamOfACaller::StreamOfACaller() : impl_(std::make_unique<Impl>()) {}
StreamOfACaller::~StreamOfACaller() = default;
void* StreamOfACaller::handle() const {
  return cuda_system::handle_of(impl_->exec.stream());
}
void StreamOfACaller::write(const DeviceMemory& to, const void* from, std::size_t bytes) {
  cuda_system::copy(impl_->exec.stream(), to.data(), from, bytes);
}

struct DeviceWords::Impl {
  Cuda exec;
  DeviceBuffer<std::uint32_t> keys, values, index, counts, sorted_keys, sorted_values, sums, owners;
  DeviceBuffer<std::uint64_t> words, copies, dest;
  Word last = Word::copy;

  explicit Impl(const WordInput& in)
      : keys(to_device(exec, in.keys)),
        values(to_device(exec, in.values)),
        index(to_device(exec, in.index)),
        counts(to_device(exec, in.counts)),
        sorted_keys(make_buffer<std::uint32_t>(exec, in.keys.size())),
        sorted_values(make_buffer<std::uint32_t>(exec, in.values.size())),
        sums(make_buffer<std::uint32_t>(exec, in.counts.size())),
        words(to_device(exec, in.words)),
        copies(make_buffer<std::uint64_t>(exec, in.words.size())),
        dest(make_buffer<std::uint64_t>(exec, in.bins)) {}

  template <class T>
  [[nodiscard]] std::vector<std::uint64_t> widened(const DeviceBuffer<T>& buffer) {
    const auto host = to_host(exec, buffer);
    return {host.begin(), host.end()};
  }
};

DeviceWords::DeviceWords(const WordInput& input) : impl_(std::make_unique<Impl>(input)) {}
DeviceWords::~DeviceWords() = default;

void DeviceWords::run(Word word) {
  Impl& d = *impl_;
  d.last = word;
  switch (word) {
    case Word::copy:
      transform(d.exec, d.words, d.copies, Same{});
      break;
    case Word::exclusive_scan:
      static_cast<void>(exclusive_scan(d.exec, d.counts, d.sums, std::uint32_t{0}));
      break;
    case Word::sort_by_key:
      cuda_system::copy(d.exec.stream(), d.sorted_keys.data(), d.keys.data(),
                        d.keys.size() * sizeof(std::uint32_t));
      cuda_system::copy(d.exec.stream(), d.sorted_values.data(), d.values.data(),
                        d.values.size() * sizeof(std::uint32_t));
      sort_by_key(d.exec, d.sorted_keys, d.sorted_values);
      break;
    case Word::reduce_by_index:
      tabulate(d.exec, d.dest, range_detail::SameValue<std::uint64_t>{0});
      reduce_by_index(d.exec, d.dest, d.index, d.words, Maximum{});
      break;
    case Word::expand:
      d.owners = expand(d.exec, counting(d.counts.size()), Count{view_of(d.counts)}, Owner{});
      break;
  }
  d.exec.wait();
}

std::vector<std::uint64_t> DeviceWords::result() const {
  Impl& d = *impl_;
  switch (d.last) {
    case Word::copy:
      return d.widened(d.copies);
    case Word::exclusive_scan:
      return d.widened(d.sums);
    case Word::sort_by_key: {
      std::vector<std::uint64_t> pairs = d.widened(d.sorted_keys);
      const std::vector<std::uint64_t> low = d.widened(d.sorted_values);
      for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = pairs[i] << 32 | low[i];
      return pairs;
    }
    case Word::reduce_by_index:
      return d.widened(d.dest);
    case Word::expand:
      return d.widened(d.owners);
  }
  return {};
}

}  // namespace rastrum::bench
