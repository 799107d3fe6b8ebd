// SPDX-License-Identifier: BSD-3-Clause
// The half of system.cuh for CUDA: streams, memory, copies, launches and what the driver says of
// them.
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <type_traits>

#include <cuda_runtime_api.h>
#include <thrust/execution_policy.h>
#include <thrust/system/cuda/error.h>
#include <thrust/system_error.h>
#include <cub/device/device_radix_sort.cuh>

#include <rastrum/error.hpp>
#include <rastrum/parallel/arena.hpp>
#include <rastrum/parallel/cuda/device_tally.hpp>
#include <rastrum/parallel/cuda/loop_count.hpp>

namespace rastrum::parallel::cuda_system {
inline namespace on_gpu {

using Stream = cudaStream_t;
inline constexpr bool kOnHost = false;

/// Whether a kernel went wrong before the call that reports it. The driver then refuses all that
/// this process asks of the device, with the same error.
[[nodiscard]] inline bool is_fault(cudaError_t error) {
  switch (error) {
    case cudaErrorIllegalAddress:
    case cudaErrorMisalignedAddress:
    case cudaErrorInvalidAddressSpace:
    case cudaErrorInvalidPc:
    case cudaErrorIllegalInstruction:
    case cudaErrorHardwareStackError:
    case cudaErrorLaunchFailure:
    case cudaErrorLaunchTimeout:
    case cudaErrorAssert:
    case cudaErrorECCUncorrectable:
      return true;
    default:
      return false;
  }
}

/// Throws Error{out_of_memory} or Error{no_device} that says what was being done, and whether it
/// was that or a kernel before it.
[[noreturn]] inline void fail(cudaError_t error, const char* doing) {
  const Errc code = error == cudaErrorMemoryAllocation ? Errc::out_of_memory : Errc::no_device;
  std::string what("CUDA: ");
  what.append(doing).append(": ").append(cudaGetErrorString(error));
  if (is_fault(error))
    what.append(
        "; earlier work on the device failed, and this process can no longer use it (arrays of "
        "render_in_place must be memory of that device, and stay until the frame is drawn)");
  throw Error(code, what);
}
inline void check(cudaError_t error, const char* doing) {
  if (error != cudaSuccess) fail(error, doing);
}
/// The same for what Thrust throws, whose codes are the runtime's.
[[noreturn]] inline void fail(const thrust::system_error& error) {
  static_cast<void>(cudaGetLastError());  // or the next call reports it again
  if (error.code().category() == thrust::cuda_category())
    fail(static_cast<cudaError_t>(error.code().value()), error.what());
  throw Error(Errc::no_device, std::string("CUDA: ").append(error.what()));
}

/// Memory of the current device. Freeing it waits for all work on the device. A failure that is not
/// for lack of memory is an Error of its own: after a fault every allocation fails, and more memory
/// would not help.
[[nodiscard]] inline MemorySource memory_source() {
  return {[](std::size_t bytes) -> void* {
            ++device_tally().blocks;
            void* block = nullptr;
            const cudaError_t error = cudaMalloc(&block, bytes);
            if (error == cudaSuccess) return block;
            static_cast<void>(cudaGetLastError());  // or the next call reports it again
            if (error == cudaErrorMemoryAllocation) return nullptr;  // the arena says for how much
            fail(error, "allocating");
          },
          [](void* block) noexcept { static_cast<void>(cudaFree(block)); }, "CUDA memory", true};
}

/// Memory of the host that stays where it is, which a device writes at its own speed and without
/// the host: copies into other memory go through the driver's, and wait for the stream.
[[nodiscard]] inline MemorySource pinned_source() {
  return {[](std::size_t bytes) -> void* {
            void* block = nullptr;
            const cudaError_t error = cudaHostAlloc(&block, bytes, cudaHostAllocDefault);
            if (error == cudaSuccess) return block;
            static_cast<void>(cudaGetLastError());
            if (error == cudaErrorMemoryAllocation) return nullptr;
            fail(error, "allocating pinned memory");
          },
          [](void* block) noexcept { static_cast<void>(cudaFreeHost(block)); },
          "pinned memory for a device", true};
}

/// The device that this thread's calls are of.
[[nodiscard]] inline int current_device() {
  int device = 0;
  check(cudaGetDevice(&device), "asking for the current device");
  return device;
}
inline void set_device(int device) {
  check(cudaSetDevice(device), "choosing a device");
}

[[nodiscard]] inline Stream make_stream() {
  Stream stream = nullptr;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "making a stream");
  return stream;
}
/// As others know it.
[[nodiscard]] inline void* handle_of(Stream stream) {
  return stream;
}
inline void destroy_stream(Stream stream) noexcept {
  static_cast<void>(cudaStreamSynchronize(stream));
  static_cast<void>(cudaStreamDestroy(stream));
}
inline void wait(Stream stream) {
  ++device_tally().waits;
  check(cudaStreamSynchronize(stream), "waiting for a stream");
}
/// Work of `other`, a cudaStream_t of this device (null: its default stream), that was given to it
/// before this call comes before what is given to `stream` from now on.
inline void wait_for(Stream stream, void* other) {
  cudaEvent_t event = nullptr;
  check(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "making an event");
  cudaError_t error = cudaEventRecord(event, static_cast<cudaStream_t>(other));
  if (error == cudaSuccess) error = cudaStreamWaitEvent(stream, event, 0);
  static_cast<void>(cudaEventDestroy(event));  // kept by the driver until it is reached
  check(error, "waiting for the caller's stream");
}
/// Memory of the device is what it was: what reads it unset is found by initcheck.
inline void spoil(Stream, void*, std::size_t) {}
/// Zeros there.
inline void clear(Stream stream, void* data, std::size_t bytes) {
  ++device_tally().launches;
  check(cudaMemsetAsync(data, 0, bytes, stream), "clearing");
}
/// Between host and device, either way; of pageable host memory it may wait for the stream.
inline void copy(Stream stream, void* to, const void* from, std::size_t bytes) {
  count_copy(bytes);
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, stream), "copying");
}

/// The same of `rows` rows of `bytes` bytes that lie `to_pitch` and `from_pitch` bytes apart,
/// neither less than `bytes`.
inline void copy_rows(Stream stream, void* to, std::size_t to_pitch, const void* from,
                      std::size_t from_pitch, std::size_t bytes, std::size_t rows) {
  count_copy(bytes * rows);
  check(cudaMemcpy2DAsync(to, to_pitch, from, from_pitch, bytes, rows, cudaMemcpyDefault, stream),
        "copying rows");
}

template <class Allocator>
[[nodiscard]] auto policy(Allocator& allocator, Stream stream) {
  ++device_tally().algorithms;
  return thrust::cuda::par_nosync(allocator).on(stream);
}

/// Sorts pairs by the low `bits` bits; which of the two rooms has the result is returned (0 or 1).
/// `allocate(bytes)` is scratch that lives until the sort is over on the stream.
template <class K, class V, class Allocate>
[[nodiscard]] int sort_pairs(Stream stream, K* keys[2], V* values[2], std::size_t n, int bits,
                             Allocate&& allocate) {
  ++device_tally().algorithms;
  cub::DoubleBuffer<K> key_rooms(keys[0], keys[1]);
  cub::DoubleBuffer<V> value_rooms(values[0], values[1]);
  std::size_t bytes = 0;
  check(cub::DeviceRadixSort::SortPairs(nullptr, bytes, key_rooms, value_rooms, n, 0, bits, stream),
        "measuring a sort");
  auto scratch = allocate(bytes);
  check(cub::DeviceRadixSort::SortPairs(scratch.data(), bytes, key_rooms, value_rooms, n, 0, bits,
                                        stream),
        "sorting");
  return key_rooms.selector;
}

/// How many members a team of for_each_team has, for arrays of what each keeps to itself.
template <int kThreads>
inline constexpr std::size_t kTeamMembers = kThreads;

/// A block of threads.
class Team {
 public:
  [[nodiscard]] __device__ std::size_t rank() const { return threadIdx.x; }
  [[nodiscard]] __device__ std::size_t size() const { return blockDim.x; }
  __device__ void sync() const { __syncthreads(); }
};

#if defined(__CUDACC__)
inline constexpr int kIndexThreads = 128;

/// The functor stays where the launch has put it, in constant memory: CUB's agents take a copy of
/// it, which a place in it that is known only at run time forces into each thread's own memory.
template <class F>
__global__ void __launch_bounds__(kIndexThreads)
    index_kernel(std::size_t n, const __grid_constant__ F f) {
  const std::size_t i = std::size_t{blockIdx.x} * kIndexThreads + threadIdx.x;
  if (i < n) f(i);
}

/// Calls f(i) for i in [0, n), a thread each.
template <class F>
void launch_indices(Stream stream, std::size_t n, const F& f) {
  if (n == 0) return;
  const std::size_t blocks = (n - 1) / kIndexThreads + 1;
  constexpr std::size_t kMostBlocks = (std::size_t{1} << 31) - 1;
  if (blocks > kMostBlocks) throw Error(Errc::unsupported, "CUDA: a loop is too long");
  ++device_tally().launches;
  index_kernel<<<static_cast<unsigned>(blocks), kIndexThreads, 0, stream>>>(n, f);
  check(cudaGetLastError(), "starting a kernel");
}

/// How many blocks of a kernel a device holds at once: asked of the driver once a device, since it
/// takes microseconds. One for each kernel; zero-initialized. Threads that ask together find the
/// same.
class ResidentBlocks {
 public:
  template <class Kernel>
  [[nodiscard]] unsigned of(Kernel kernel, int threads) {
    int device = 0;
    check(cudaGetDevice(&device), "asking for the current device");
    const auto d = static_cast<std::size_t>(device);
    if (d >= kDevices) return asked(kernel, threads, device);
    const unsigned known = blocks_[d].load(std::memory_order_relaxed);
    if (known != 0) return known;
    const unsigned blocks = asked(kernel, threads, device);
    blocks_[d].store(blocks, std::memory_order_relaxed);
    return blocks;
  }

 private:
  static constexpr std::size_t kDevices = 64;  ///< those beyond are asked each time

  template <class Kernel>
  [[nodiscard]] static unsigned asked(Kernel kernel, int threads, int device) {
    int processors = 0, each = 0;
    check(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device),
          "asking for a device's processors");
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&each, kernel, threads, 0),
          "asking for a kernel's blocks");
    return static_cast<unsigned>(processors) * static_cast<unsigned>(each > 0 ? each : 1);
  }

  std::atomic<unsigned> blocks_[kDevices] = {};  ///< 0: not asked yet
};

/// How often a device is filled by a loop of strides whose length the host knows.
inline constexpr unsigned kRounds = 4;

template <class Local, class F>
__global__ void __launch_bounds__(kIndexThreads)
    strided_kernel(LoopCount n, const __grid_constant__ F f) {
  Local local{};
  const std::size_t end = n.get(), step = std::size_t{gridDim.x} * kIndexThreads;
  for (std::size_t i = std::size_t{blockIdx.x} * kIndexThreads + threadIdx.x; i < end; i += step)
    f(i, local);
  f.end(local);
}

/// Calls f(i, local) for i in [0, n) by threads that take strides, and f.end(local) by each at
/// last.
template <class Local, class F>
void launch_strided(Stream stream, LoopCount n, const F& f) {
  if (n.most == 0) return;
  const std::size_t wanted = (n.most - 1) / kIndexThreads + 1;
  static ResidentBlocks known;
  // More than are held at once, where the work is there: who is done early then takes another.
  const unsigned resident =
      known.of(strided_kernel<Local, F>, kIndexThreads) * (n.count == nullptr ? kRounds : 1);
  const unsigned blocks = wanted < resident ? static_cast<unsigned>(wanted) : resident;
  ++device_tally().launches;
  strided_kernel<Local, F><<<blocks, kIndexThreads, 0, stream>>>(n, f);
  check(cudaGetLastError(), "starting a kernel");
}

/// Threads of one kernel that a multiprocessor is to hold at least, by the registers of each (80).
inline constexpr int kResidentThreads = 768;

template <class Local, class T, int kThreads, class F>
__global__ void __launch_bounds__(kThreads, kResidentThreads / kThreads)
    strided_team_kernel(LoopCount n, const __grid_constant__ F f) {
  __shared__ alignas(T) unsigned char room[sizeof(T)];
  T& scratch = *reinterpret_cast<T*>(room);
  const Team team;
  Local local{};
  const std::size_t end = n.get();
  for (std::size_t i = blockIdx.x; i < end; i += gridDim.x) {
    f(i, local, scratch, team);
    team.sync();
  }
  f.end(local);
}

/// Calls f(i, local, scratch, team) for i in [0, n) by teams of kThreads that take strides, and
/// f.end(local) by each member at last.
template <class Local, class T, int kThreads, class F>
void launch_strided_teams(Stream stream, LoopCount n, const F& f) {
  if (n.most == 0) return;
  static ResidentBlocks known;
  const unsigned resident = known.of(strided_team_kernel<Local, T, kThreads, F>, kThreads);
  const unsigned blocks = n.most < resident ? static_cast<unsigned>(n.most) : resident;
  ++device_tally().launches;
  strided_team_kernel<Local, T, kThreads><<<blocks, kThreads, 0, stream>>>(n, f);
  check(cudaGetLastError(), "starting teams");
}

template <class T, int kThreads, int kResident, class F>
__global__ void __launch_bounds__(kThreads, kResident)
    team_kernel(LoopCount n, const __grid_constant__ F f) {
  __shared__ alignas(T) unsigned char room[sizeof(T)];
  T& scratch = *reinterpret_cast<T*>(room);
  const Team team;
  const std::size_t end = n.get();
  for (std::size_t i = blockIdx.x; i < end; i += gridDim.x) {
    f(i, scratch, team);
    team.sync();
  }
}

/// Calls f(i, scratch, team) for i in [0, n) by teams of kThreads.
template <class T, int kThreads, int kResident, class F>
void launch_teams(Stream stream, LoopCount n, F f) {
  if (n.most == 0) return;
  constexpr std::size_t kMostBlocks = std::size_t{1} << 20;
  auto blocks = static_cast<unsigned>(n.most < kMostBlocks ? n.most : kMostBlocks);
  // Most of what a queue has room for is not there.
  if (n.count != nullptr) {
    static ResidentBlocks known;
    const unsigned resident = known.of(team_kernel<T, kThreads, kResident, F>, kThreads);
    if (resident < blocks) blocks = resident;
  }
  ++device_tally().launches;
  team_kernel<T, kThreads, kResident><<<blocks, kThreads, 0, stream>>>(n, f);
  check(cudaGetLastError(), "starting teams");
}
#endif

}  // namespace on_gpu
}  // namespace rastrum::parallel::cuda_system
