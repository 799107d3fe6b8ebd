// SPDX-License-Identifier: BSD-3-Clause
#include "buffers.hpp"

#include <cstdint>
#include <limits>
#include <new>
#include <utility>

#include <rastrum/error.hpp>

namespace rastrum::python {
namespace {

constexpr std::size_t kKept = std::size_t{128} << 20;
constexpr std::align_val_t kAlign{64};

struct FreeBuffer {
  void* data;
  std::size_t bytes;
};

/// Buffers that nobody uses, the newest last. The GIL guards them, so that a fork finds the list
/// whole; where Python has none, the lock does.
class Free {
 public:
  void* take(std::size_t bytes) {
    const nb::ft_lock_guard lock(mutex_);
    for (std::size_t i = all_.size(); i-- > 0;)
      if (all_[i].bytes == bytes) {
        void* const data = all_[i].data;
        all_.erase(all_.begin() + static_cast<std::ptrdiff_t>(i));
        kept_ -= bytes;
        return data;
      }
    return nullptr;
  }
  void give(FreeBuffer buffer) {
    if (buffer.bytes > kKept) return ::operator delete(buffer.data, kAlign);
    const nb::ft_lock_guard lock(mutex_);
    all_.push_back(buffer);
    kept_ += buffer.bytes;
    while (kept_ > kKept) {
      kept_ -= all_.front().bytes;
      ::operator delete(all_.front().data, kAlign);
      all_.erase(all_.begin());
    }
  }

 private:
  nb::ft_mutex mutex_{};
  std::vector<FreeBuffer> all_{};
  std::size_t kept_ = 0;
};

/// Never destroyed: arrays may die after everything else.
Free& free_buffers() {
  static Free& all = *new Free;
  return all;
}

nb::dlpack::dtype type_named(const std::string& name) {
  if (name == "uint8") return nb::dtype<std::uint8_t>();
  if (name == "int32") return nb::dtype<std::int32_t>();
  if (name == "int64") return nb::dtype<std::int64_t>();
  if (name == "float32") return nb::dtype<float>();
  throw Error(Errc::invalid_argument, "type: there is no " + name);
}

}  // namespace

nb::ndarray<nb::numpy> empty(const std::vector<std::size_t>& shape, const std::string& type) {
  const nb::dlpack::dtype of = type_named(type);
  std::size_t bytes = of.bits / 8;
  for (const std::size_t n : shape) {
    if (n != 0 && bytes > static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / n)
      throw Error(Errc::out_of_memory, "the pictures have more bytes than there are addresses");
    bytes *= n;
  }
  FreeBuffer buffer{free_buffers().take(bytes), bytes};
  if (buffer.data == nullptr) buffer.data = ::operator new(bytes, kAlign, std::nothrow);
  if (buffer.data == nullptr)
    throw Error(Errc::out_of_memory,
                "there is no memory for pictures of " + std::to_string(bytes) + " bytes");
  const nb::capsule owner(new FreeBuffer(buffer), [](void* p) noexcept {
    const FreeBuffer dead = *static_cast<FreeBuffer*>(p);
    delete static_cast<FreeBuffer*>(p);
    free_buffers().give(dead);
  });
  return {buffer.data, shape.size(), shape.data(), owner, nullptr, of};
}

}  // namespace rastrum::python
