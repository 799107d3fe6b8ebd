// SPDX-License-Identifier: BSD-3-Clause
// CUDA's half of system.cuh: streams, memory, copies, launches and driver errors.
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

/// Whether an earlier kernel failed. The driver then gives the same error for every later call of
/// this process on the device.
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

/// Throws Error{out_of_memory} or Error{no_device}, and says whether an earlier kernel failed.
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
/// The same for Thrust's exceptions, whose codes are the runtime's.
[[noreturn]] inline void fail(const thrust::system_error& error) {
  static_cast<void>(cudaGetLastError());  // clears the error for the next call
  if (error.code().category() == thrust::cuda_category())
    fail(static_cast<cudaError_t>(error.code().value()), error.what());
  throw Error(Errc::no_device, std::string("CUDA: ").append(error.what()));
}

/// Memory of the current device. Freeing waits for all work on it. Failures other than lack of
/// memory throw: after a fault every allocation fails, and freeing memory does not help.
[[nodiscard]] inline MemorySource memory_source() {
  return {[](std::size_t bytes) -> void* {
            ++device_tally().blocks;
            void* block = nullptr;
            const cudaError_t error = cudaMalloc(&block, bytes);
            if (error == cudaSuccess) return block;
            static_cast<void>(cudaGetLastError());  // clears the error for the next call
            if (error == cudaErrorMemoryAllocation) return nullptr;  // the arena reports it
            fail(error, "allocating");
          },
          [](void* block) noexcept { static_cast<void>(cudaFree(block)); }, "CUDA memory", true};
}

/// Pinned host memory, to which the device copies at full speed without the host. Copies to other
/// host memory go through the driver's buffers and wait for the stream.
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
/// For code without CUDA's headers.
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
/// Orders later work of `stream` behind all work given to `other` until now, a cudaStream_t of this
/// device (null: its default stream).
inline void wait_for(Stream stream, void* other) {
  cudaEvent_t event = nullptr;
  check(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "making an event");
  cudaError_t error = cudaEventRecord(event, static_cast<cudaStream_t>(other));
  if (error == cudaSuccess) error = cudaStreamWaitEvent(stream, event, 0);
  static_cast<void>(cudaEventDestroy(event));  // the driver keeps it until it is reached
  check(error, "waiting for the caller's stream");
}
/// Nothing to do: initcheck finds reads of unset device memory.
inline void spoil(Stream, void*, std::size_t) {}
inline void clear(Stream stream, void* data, std::size_t bytes) {
  ++device_tally().launches;
  check(cudaMemsetAsync(data, 0, bytes, stream), "clearing");
}
/// Between host and device, either way; waits for the stream if the host memory is pageable.
inline void copy(Stream stream, void* to, const void* from, std::size_t bytes) {
  count_copy(bytes);
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, stream), "copying");
}

/// The same for `rows` rows of `bytes` bytes, `to_pitch` and `from_pitch` ≥ `bytes` apart.
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

/// Sorts pairs by the low `bits` bits; returns the room with the result (0 or 1). `allocate(bytes)`
/// is scratch that must live until the stream has sorted.
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

/// Members of a team of for_each_team, for arrays with an element per member.
template <int kThreads>
inline constexpr std::size_t kTeamMembers = kThreads;

class Team {
 public:
  [[nodiscard]] __device__ std::size_t rank() const { return threadIdx.x; }
  [[nodiscard]] __device__ std::size_t size() const { return blockDim.x; }
  __device__ void sync() const { __syncthreads(); }
};

#if defined(__CUDACC__)
inline constexpr int kIndexThreads = 128;

/// The functor stays in constant memory, where the launch puts it. CUB's agents otherwise copy it,
/// into local memory if an index is known only at run time.
template <class F>
__global__ void __launch_bounds__(kIndexThreads)
    index_kernel(std::size_t n, const __grid_constant__ F f) {
  const std::size_t i = std::size_t{blockIdx.x} * kIndexThreads + threadIdx.x;
  if (i < n) f(i);
}

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

/// How many blocks of a kernel a device holds at once. Cached, because the driver takes
/// microseconds to answer. One object per kernel, zero-initialized; a race stores the same value.
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
  static constexpr std::size_t kDevices = 64;  ///< later devices are not cached

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

/// How many times over a strided loop fills the device if the host knows its length.
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

/// Calls f(i, local) for i in [0, n) on threads that take strides, and f.end(local) on each last.
template <class Local, class F>
void launch_strided(Stream stream, LoopCount n, const F& f) {
  if (n.most == 0) return;
  const std::size_t wanted = (n.most - 1) / kIndexThreads + 1;
  static ResidentBlocks known;
  // More blocks than fit at once, if there is work for them: they replace those that end early.
  const unsigned resident =
      known.of(strided_kernel<Local, F>, kIndexThreads) * (n.count == nullptr ? kRounds : 1);
  const unsigned blocks = wanted < resident ? static_cast<unsigned>(wanted) : resident;
  ++device_tally().launches;
  strided_kernel<Local, F><<<blocks, kIndexThreads, 0, stream>>>(n, f);
  check(cudaGetLastError(), "starting a kernel");
}

/// The least number of threads per multiprocessor: leaves 80 registers for each.
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

/// Calls f(i, local, scratch, team) for i in [0, n) on teams of kThreads that take strides, and
/// f.end(local) on each member last.
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

template <class T, int kThreads, int kResident, class F>
void launch_teams(Stream stream, LoopCount n, F f) {
  if (n.most == 0) return;
  constexpr std::size_t kMostBlocks = std::size_t{1} << 20;
  auto blocks = static_cast<unsigned>(n.most < kMostBlocks ? n.most : kMostBlocks);
  // Device queues are mostly far emptier than their room.
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
