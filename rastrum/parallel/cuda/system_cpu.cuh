// SPDX-License-Identifier: BSD-3-Clause
// The CPU's half of system.cuh. Device memory is the heap and begins as garbage; a team is
// coroutines; a stream is a list (host_stream.hpp). Under the address sanitizer neither side can
// read the other's memory (host_walls.hpp).
#pragma once

#include <cstddef>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>

#include <thrust/execution_policy.h>
#include <thrust/sort.h>
#include <thrust/system_error.h>

#include <rastrum/error.hpp>
#include <rastrum/parallel/arena.hpp>
#include <rastrum/parallel/cuda/device_tally.hpp>
#include <rastrum/parallel/cuda/host_stream.hpp>
#include <rastrum/parallel/cuda/loop_count.hpp>
#include <rastrum/parallel/cuda/team_on_host.hpp>

namespace rastrum::parallel::cuda_system {
inline namespace on_cpu {

struct Stream {
  HostStream* work = nullptr;  ///< null: work is done at once
  friend bool operator==(Stream, Stream) = default;
};
inline constexpr bool kOnHost = true;

/// Fails as a driver that refuses a call.
[[noreturn]] inline void refuse(const char* doing) {
  throw Error(Errc::no_device,
              std::string("device: ").append(doing).append(": a fault was asked for"));
}
[[noreturn]] inline void fail(const thrust::system_error& error) {
  throw Error(Errc::no_device, std::string("device: ").append(error.what()));
}

[[nodiscard]] inline MemorySource memory_source() {
  return {[](std::size_t bytes) -> void* {
            ++device_tally().blocks;
            if (DeviceFaults::strikes()) return nullptr;
            void* const block = host_memory().allocate(bytes);
            Walls::add(block, bytes);
            return block;
          },
          [](void* block) noexcept {
            HostStream::run_all();
            Walls::remove(block);
            host_memory().release(block);
          },
          "device memory", true};
}
[[nodiscard]] inline MemorySource pinned_source() {
  return {[](std::size_t bytes) -> void* {
            return DeviceFaults::strikes() ? nullptr : host_memory().allocate(bytes);
          },
          [](void* block) noexcept {
            HostStream::run_all();
            host_memory().release(block);
          },
          "pinned memory for a device", true};
}
/// Only a number, so that tests see which device a call goes to.
[[nodiscard]] inline int& device_of_thread() {
  thread_local int device = 0;
  return device;
}
[[nodiscard]] inline int current_device() {
  return device_of_thread();
}
inline void set_device(int device) {
  device_of_thread() = device;
}

[[nodiscard]] inline Stream make_stream() {
  if (DeviceFaults::strikes()) refuse("making a stream");
  return {new HostStream};
}
[[nodiscard]] inline void* handle_of(Stream stream) {
  return stream.work;
}
inline void destroy_stream(Stream stream) noexcept {
  stream.work->run();
  delete stream.work;
}
template <class F>
void give(Stream stream, F work) {
  if (stream.work == nullptr) return work();
  stream.work->add(std::move(work));
}
/// Launches a kernel. Its copied parameters are not host memory.
template <class F>
void give_kernel(Stream stream, F kernel) {
  ++device_tally().launches;
  if (DeviceFaults::strikes()) refuse("starting a kernel");
  give(stream, [kernel = std::move(kernel)] {
    const F own = kernel;
    const Walls::Kernel walls;
    own();
  });
}
/// Copies bytes between host and device.
template <class F>
void give_copy(Stream stream, F copy) {
  give(stream, [copy] {
    const Walls::Device open;
    copy();
  });
}
inline void wait(Stream stream) {
  ++device_tally().waits;
  if (stream.work == nullptr) return;
  if (DeviceFaults::strikes()) {
    stream.work->drop();
    refuse("waiting for a stream");
  }
  stream.work->run();
}
inline void wait_for(Stream, void* other) {
  if (DeviceFaults::strikes()) refuse("waiting for the caller's stream");
  if (other != nullptr) static_cast<HostStream*>(other)->run();
}
/// Fills a new buffer with garbage, so that reads of unset memory show even where it is reused.
inline void spoil(Stream stream, void* data, std::size_t bytes) {
  if (bytes > 0) give_copy(stream, [=] { std::memset(data, 0xA5, bytes); });
}
inline void clear(Stream stream, void* data, std::size_t bytes) {
  ++device_tally().launches;
  if (DeviceFaults::strikes()) refuse("clearing");
  if (bytes > 0) give_copy(stream, [=] { std::memset(data, 0, bytes); });
}
inline void copy(Stream stream, void* to, const void* from, std::size_t bytes) {
  count_copy(bytes);
  if (DeviceFaults::strikes()) refuse("copying");
  if (bytes > 0) give_copy(stream, [=] { std::memcpy(to, from, bytes); });
}
inline void copy_rows(Stream stream, void* to, std::size_t to_pitch, const void* from,
                      std::size_t from_pitch, std::size_t bytes, std::size_t rows) {
  count_copy(bytes * rows);
  if (DeviceFaults::strikes()) refuse("copying rows");
  give_copy(stream, [=] {
    for (std::size_t y = 0; y < rows; ++y)
      std::memcpy(static_cast<char*>(to) + y * to_pitch,
                  static_cast<const char*>(from) + y * from_pitch, bytes);
  });
}
/// Thrust's algorithms run at once, after all earlier work of the stream.
inline void begin_algorithm(Stream stream) {
  ++device_tally().algorithms;
  if (DeviceFaults::strikes())
    throw thrust::system_error(thrust::errc::io_error, thrust::generic_category(),
                               "an algorithm: a fault was asked for");
  if (stream.work != nullptr) stream.work->run();
}
template <class Allocator>
[[nodiscard]] auto policy(Allocator& allocator, Stream stream) {
  begin_algorithm(stream);
  using Policy = std::remove_cvref_t<decltype(thrust::cpp::par(allocator))>;
  struct Open : Policy {
    Walls::Device open;
    explicit Open(const Policy& policy) : Policy(policy) {}
  };
  return Open(thrust::cpp::par(allocator));
}

template <class K>
struct LessInLowBits {
  K mask;
  bool operator()(K a, K b) const { return (a & mask) < (b & mask); }
};

/// As CUB's sort, but always with the result in the second room, so that copying it back is tested.
template <class K, class V, class Allocate>
[[nodiscard]] int sort_pairs(Stream stream, K* keys[2], V* values[2], std::size_t n, int bits,
                             Allocate&& allocate) {
  auto order = allocate(n * sizeof(std::size_t));
  begin_algorithm(stream);
  const Walls::Device open;
  auto* const index = static_cast<std::size_t*>(static_cast<void*>(order.data()));
  std::iota(index, index + n, std::size_t{0});
  const auto all = std::numeric_limits<K>::digits;
  const LessInLowBits<K> less{static_cast<K>(std::numeric_limits<K>::max() >> (all - bits))};
  thrust::stable_sort(thrust::cpp::par, index, index + n,
                      [&](std::size_t a, std::size_t b) { return less(keys[0][a], keys[0][b]); });
  for (std::size_t i = 0; i < n; ++i) {
    keys[1][i] = keys[0][index[i]];
    values[1][i] = values[0][index[i]];
  }
  return 1;
}

/// A small odd number, so that wrong shares of work show. Larger under the thread sanitizer, which
/// sees a race only between elements of different members.
inline constexpr int kMostMembers = kRacesAreSeen ? 7 : 3;
template <int kThreads>
inline constexpr std::size_t kTeamMembers = kThreads < kMostMembers ? kThreads : kMostMembers;

template <class Host>
class Team {
 public:
  Team(std::size_t rank, std::size_t size, Host& host) : rank_(rank), size_(size), host_(&host) {}
  [[nodiscard]] std::size_t rank() const { return rank_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  void sync() const { host_->sync(rank_); }

 private:
  std::size_t rank_, size_;
  Host* host_;
};

/// Calls share(first, stride) for `kShares` threads in turn. Under the thread sanitizer these are
/// members of a team that never meet, so that it sees what two elements of a loop share.
template <std::size_t kShares, class F>
void run_shares(const F& share) {
  if constexpr (kRacesAreSeen) {
    constexpr std::size_t kMembers = kMostMembers;
    const auto body = [&](std::size_t rank, auto&) { share(rank, kMembers); };
    TeamOnHost<kMembers, decltype(body)>::run(body);
  } else {
    for (std::size_t first = 0; first < kShares; ++first) share(first, kShares);
  }
}

template <class F>
void launch_indices(Stream stream, std::size_t n, const F& f) {
  if (n == 0) return;
  give_kernel(stream, [n, f] {
    run_shares<1>([&](std::size_t first, std::size_t stride) {
      for (std::size_t i = first; i < n; i += stride) f(i);
    });
  });
}

/// Uses several threads, to test strides and repeated ends.
template <class Local, class F>
void launch_strided(Stream stream, LoopCount n, const F& f) {
  if (n.most == 0) return;
  give_kernel(stream, [n, f] {
    const std::size_t end = n.get();
    run_shares<3>([&](std::size_t first, std::size_t stride) {
      Local local{};
      for (std::size_t i = first; i < end; i += stride) f(i, local);
      f.end(local);
    });
  });
}

/// Calls member(n, scratch, team) for each member of one team.
template <class T, int kThreads, class F>
void give_team(Stream stream, LoopCount n, F member) {
  if (n.most == 0) return;
  give_kernel(stream, [n, member] {
    constexpr std::size_t kMembers = kTeamMembers<kThreads>;
    const std::size_t end = n.get();
    T scratch;
    std::memset(static_cast<void*>(&scratch), 0xA5, sizeof scratch);
    const auto body = [&](std::size_t rank, auto& host) {
      member(end, scratch, Team<std::remove_reference_t<decltype(host)>>(rank, kMembers, host));
    };
    TeamOnHost<kMembers, decltype(body)>::run(body);
  });
}

/// One team suffices: its members already test strides and repeated ends.
template <class Local, class T, int kThreads, class F>
void launch_strided_teams(Stream stream, LoopCount n, const F& f) {
  give_team<T, kThreads>(stream, n, [f](std::size_t end, T& scratch, const auto& team) {
    Local local{};
    for (std::size_t i = 0; i < end; ++i) {
      f(i, local, scratch, team);
      team.sync();
    }
    f.end(local);
  });
}

template <class T, int kThreads, int kResident, class F>
void launch_teams(Stream stream, LoopCount n, const F& f) {
  give_team<T, kThreads>(stream, n, [f](std::size_t end, T& scratch, const auto& team) {
    for (std::size_t i = 0; i < end; ++i) {
      f(i, scratch, team);
      team.sync();
    }
  });
}

}  // namespace on_cpu
}  // namespace rastrum::parallel::cuda_system
