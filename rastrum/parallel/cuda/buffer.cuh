// SPDX-License-Identifier: BSD-3-Clause
// Memory of a device for words, and the copies to and from it.
#pragma once

#include <cassert>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include <rastrum/parallel/cuda/exec.cuh>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// n uninitialized elements on the device, in the memory of a Cuda context, which they may outlive.
/// The host cannot read them: to_host copies them.
template <class T>
class DeviceBuffer {
  static_assert(std::is_trivially_copy_constructible_v<T> && std::is_trivially_destructible_v<T>);

 public:
  using value_type = T;
  DeviceBuffer() noexcept = default;
  DeviceBuffer(std::shared_ptr<Arena> arena, std::size_t n) : arena_(std::move(arena)), size_(n) {
    if (n > SIZE_MAX / sizeof(T))
      throw Error(Errc::out_of_memory, std::to_string(n).append(" elements fit no memory"));
    if (n > 0) data_ = static_cast<T*>(arena_->allocate(n * sizeof(T)));
  }
  DeviceBuffer(DeviceBuffer&& other) noexcept
      : arena_(std::move(other.arena_)),
        data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)) {}
  DeviceBuffer& operator=(DeviceBuffer&& other) noexcept {
    std::swap(arena_, other.arena_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~DeviceBuffer() {
    if (data_ != nullptr) arena_->release(data_, size_ * sizeof(T));
  }

  [[nodiscard]] RASTRUM_HD T* data() noexcept { return data_; }
  [[nodiscard]] RASTRUM_HD const T* data() const noexcept { return data_; }
  [[nodiscard]] RASTRUM_HD std::size_t size() const noexcept { return size_; }
  /// On the device only; kernels take view_of(buffer).
  [[nodiscard]] RASTRUM_HD T& operator[](std::size_t i) noexcept { return data_[i]; }
  [[nodiscard]] RASTRUM_HD const T& operator[](std::size_t i) const noexcept { return data_[i]; }

 private:
  std::shared_ptr<Arena> arena_;
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

template <class T>
[[nodiscard]] DeviceBuffer<T> make_buffer(const Cuda& exec, std::size_t n = 0) {
  DeviceBuffer<T> buffer(exec.memory(), n);
  cuda_system::spoil(exec.stream(), buffer.data(), n * sizeof(T));
  return buffer;
}

/// `n` uninitialized bytes of host memory to which the device copies without waiting. Keep them
/// until the stream was waited for.
[[nodiscard]] inline Buffer<std::byte> pinned_buffer(const Cuda& exec, std::size_t n) {
  return Buffer<std::byte>(n, ArenaAllocator<std::byte>(exec.pinned()));
}

/// Copies `source`, contiguous host memory, without waiting. The context keeps a copy meanwhile:
/// for small arrays.
template <class R>
[[nodiscard]] auto upload(Cuda& exec, const R& source) {
  using T = std::remove_cvref_t<decltype(*std::data(source))>;
  const auto staged = std::make_shared<const std::vector<T>>(std::data(source),
                                                             std::data(source) + std::size(source));
  exec.keep(staged);
  auto out = make_buffer<T>(exec, staged->size());
  cuda_system::copy(exec.stream(), out.data(), staged->data(), out.size() * sizeof(T));
  return out;
}
/// Copies `source`, contiguous host memory. Waits.
template <class R>
[[nodiscard]] auto to_device(Cuda& exec, const R& source) {
  auto out =
      make_buffer<std::remove_cvref_t<decltype(*std::data(source))>>(exec, std::size(source));
  cuda_system::copy(exec.stream(), out.data(), std::data(source),
                    out.size() * sizeof(*std::data(source)));
  exec.wait();
  return out;
}
/// Copies contiguous device memory. Waits.
template <class R>
[[nodiscard]] auto to_host(Cuda& exec, const R& source) {
  std::vector<std::remove_cvref_t<decltype(*std::data(source))>> out(std::size(source));
  cuda_system::copy(exec.stream(), out.data(), std::data(source),
                    out.size() * sizeof(*std::data(source)));
  exec.wait();
  return out;
}

/// Copies rows of `width` pixels either way, without waiting. They are dense on the device and
/// `stride` pixels apart on the host (negative: from the bottom up).
template <class T>
void copy_image(Cuda& exec, T* on_device, std::size_t width, T* on_host, std::ptrdiff_t stride,
                std::size_t rows, bool to_device) {
  const std::size_t bytes = width * sizeof(T);
  if (stride == static_cast<std::ptrdiff_t>(width)) {  // contiguous on the host too
    T* const to = to_device ? on_device : on_host;
    const T* const from = to_device ? on_host : on_device;
    return cuda_system::copy(exec.stream(), to, from, rows * bytes);
  }
  const auto once = [&](T* there, T* here, std::size_t pitch, std::size_t count) {
    if (to_device)
      cuda_system::copy_rows(exec.stream(), there, bytes, here, pitch, bytes, count);
    else
      cuda_system::copy_rows(exec.stream(), here, pitch, there, bytes, bytes, count);
  };
  if (stride > 0)
    return once(on_device, on_host, static_cast<std::size_t>(stride) * sizeof(T), rows);
  for (std::size_t y = 0; y < rows; ++y)
    once(on_device + y * width, on_host + static_cast<std::ptrdiff_t>(y) * stride, bytes, 1);
}

/// A number that the device is computing. get() waits.
template <class T>
class Pending {
 public:
  Pending(Cuda& exec, DeviceBuffer<T> cell) : exec_(&exec), cell_(std::move(cell)) {}
  [[nodiscard]] T get() const { return to_host(*exec_, cell_)[0]; }
  operator T() const { return get(); }
  /// Its address on the device.
  [[nodiscard]] const T* device() const { return cell_.data(); }
  friend bool operator==(const Pending& a, const T& b) { return a.get() == b; }

 private:
  Cuda* exec_;
  DeviceBuffer<T> cell_;
};

/// A range in the form that kernels take. Refuses containers of host memory, except on the CPU.
template <class R>
[[nodiscard]] auto device_view(R&& range) {
  using View = view_t<R>;
  constexpr bool owns_host_memory = requires(std::remove_cvref_t<R> r) {
    r.push_back(*std::data(r));
  };
  static_assert(cuda_system::kOnHost || !owns_host_memory,
                "this range is the host's; copy it with to_device");
  return View(view_of(range));
}

}  // namespace rastrum::parallel
