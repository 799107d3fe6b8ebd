// SPDX-License-Identifier: BSD-3-Clause
// The benchmarks' device in builds without CUDA. choose_device throws before these functions are
// called.
#include <bench/cuda/device.hpp>
#include <rastrum/error.hpp>

namespace rastrum::bench {
namespace {

[[noreturn]] void refuse() {
  throw Error(Errc::no_device, "bench: this program was built without CUDA");
}

}  // namespace

DeviceMemory::DeviceMemory(std::size_t) {
  refuse();
}
DeviceMemory::~DeviceMemory() = default;
void DeviceMemory::write(const void*, std::size_t) {
  refuse();
}
void DeviceMemory::read(void*, std::size_t) const {
  refuse();
}

struct DeviceWords::Impl {};
DeviceWords::DeviceWords(const WordInput&) {
  refuse();
}
DeviceWords::~DeviceWords() = default;
void DeviceWords::run(Word) {
  refuse();
}
std::vector<std::uint64_t> DeviceWords::result() const {
  refuse();
}

}  // namespace rastrum::bench
