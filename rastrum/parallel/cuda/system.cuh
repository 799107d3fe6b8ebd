// What CUDA and the CPU do differently under the words of this folder, and nothing else. nvcc takes
// the first half. A plain C++ compiler that is told THRUST_DEVICE_SYSTEM_CPP takes the second,
// where the device's memory is the heap, a team is coroutines, and all else is the same
// code: so the tests of the words run it where there is no GPU.
#pragma once

#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

#include <thrust/execution_policy.h>
#include <thrust/system_error.h>

#include <rastrum/error.hpp>
#include <rastrum/parallel/arena.hpp>
#include <rastrum/parallel/exec.hpp>

// Names say which half they are of: a test on the CPU may be linked with the library's code for
// GPUs.
#if THRUST_DEVICE_SYSTEM == THRUST_DEVICE_SYSTEM_CUDA
#define RASTRUM_DEVICE_SYSTEM on_gpu
#include <cuda_runtime_api.h>
#include <thrust/system/cuda/error.h>
#include <cub/device/device_radix_sort.cuh>
#elif THRUST_DEVICE_SYSTEM == THRUST_DEVICE_SYSTEM_CPP
#define RASTRUM_DEVICE_SYSTEM on_cpu
#include <cstring>
#include <limits>
#include <numeric>

#include <thrust/sort.h>

#include <rastrum/parallel/cuda/team_on_host.hpp>
#else
#error "the words of rastrum/parallel/cuda know THRUST_DEVICE_SYSTEM_CUDA and _CPP"
#endif

namespace rastrum::parallel::cuda_system {
inline namespace RASTRUM_DEVICE_SYSTEM {

#if THRUST_DEVICE_SYSTEM == THRUST_DEVICE_SYSTEM_CUDA

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

/// Memory of the current device. Freeing it waits for all work on the device. What is not for lack
/// of memory is an Error of its own: after a fault every allocation fails, and more memory would
/// not help.
[[nodiscard]] inline MemorySource memory_source() {
  return {[](std::size_t bytes) -> void* {
            void* block = nullptr;
            const cudaError_t error = cudaMalloc(&block, bytes);
            if (error == cudaSuccess) return block;
            static_cast<void>(cudaGetLastError());  // or the next call reports it again
            if (error == cudaErrorMemoryAllocation) return nullptr;  // the arena says for how much
            fail(error, "allocating");
          },
          [](void* block) noexcept { static_cast<void>(cudaFree(block)); }, "CUDA memory", true};
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
inline void destroy_stream(Stream stream) noexcept {
  static_cast<void>(cudaStreamSynchronize(stream));
  static_cast<void>(cudaStreamDestroy(stream));
}
inline void wait(Stream stream) {
  check(cudaStreamSynchronize(stream), "waiting for a stream");
}
/// Between host and device, either way; of pageable host memory it may wait for the stream.
inline void copy(Stream stream, void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, stream), "copying");
}

/// The same of `rows` rows of `bytes` bytes that lie `to_pitch` and `from_pitch` bytes apart,
/// neither less than `bytes`.
inline void copy_rows(Stream stream, void* to, std::size_t to_pitch, const void* from,
                      std::size_t from_pitch, std::size_t bytes, std::size_t rows) {
  check(cudaMemcpy2DAsync(to, to_pitch, from, from_pitch, bytes, rows, cudaMemcpyDefault, stream),
        "copying rows");
}

template <class Allocator>
[[nodiscard]] auto policy(Allocator& allocator, Stream stream) {
  return thrust::cuda::par_nosync(allocator).on(stream);
}

/// Sorts pairs by the low `bits` bits; which of the two rooms has the result is returned (0 or 1).
/// `allocate(bytes)` is scratch that lives until the sort is over on the stream.
template <class K, class V, class Allocate>
[[nodiscard]] int sort_pairs(Stream stream, K* keys[2], V* values[2], std::size_t n, int bits,
                             Allocate&& allocate) {
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
  index_kernel<<<static_cast<unsigned>(blocks), kIndexThreads, 0, stream>>>(n, f);
  check(cudaGetLastError(), "starting a kernel");
}

template <class T, int kThreads, class F>
__global__ void __launch_bounds__(kThreads)
    team_kernel(std::size_t n, const __grid_constant__ F f) {
  __shared__ alignas(T) unsigned char room[sizeof(T)];
  T& scratch = *reinterpret_cast<T*>(room);
  const Team team;
  for (std::size_t i = blockIdx.x; i < n; i += gridDim.x) {
    f(i, scratch, team);
    team.sync();
  }
}

/// Calls f(i, scratch, team) for i in [0, n) by teams of kThreads.
template <class T, int kThreads, class F>
void launch_teams(Stream stream, std::size_t n, F f) {
  if (n == 0) return;
  constexpr std::size_t kMostBlocks = std::size_t{1} << 20;
  const auto blocks = static_cast<unsigned>(n < kMostBlocks ? n : kMostBlocks);
  team_kernel<T, kThreads><<<blocks, kThreads, 0, stream>>>(n, f);
  check(cudaGetLastError(), "starting teams");
}
#endif

#else

struct Stream {
  friend bool operator==(Stream, Stream) = default;
};
inline constexpr bool kOnHost = true;

[[noreturn]] inline void fail(const thrust::system_error& error) {
  throw Error(Errc::no_device, std::string("device: ").append(error.what()));
}

[[nodiscard]] inline MemorySource memory_source() {
  MemorySource source = host_memory();
  source.name = "device memory";
  source.keeps_all = true;
  return source;
}
/// Devices by number alone, so that tests see which one a call is of.
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
  return {};
}
inline void destroy_stream(Stream) noexcept {}
inline void wait(Stream) {}
inline void copy(Stream, void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) std::memcpy(to, from, bytes);
}
inline void copy_rows(Stream stream, void* to, std::size_t to_pitch, const void* from,
                      std::size_t from_pitch, std::size_t bytes, std::size_t rows) {
  for (std::size_t y = 0; y < rows; ++y)
    copy(stream, static_cast<char*>(to) + y * to_pitch,
         static_cast<const char*>(from) + y * from_pitch, bytes);
}
template <class Allocator>
[[nodiscard]] auto policy(Allocator& allocator, Stream) {
  return thrust::cpp::par(allocator);
}

template <class K>
struct LessInLowBits {
  K mask;
  bool operator()(K a, K b) const { return (a & mask) < (b & mask); }
};

/// As CUB's: the result is in the second room, so that the way back is tested as well.
template <class K, class V, class Allocate>
[[nodiscard]] int sort_pairs(Stream, K* keys[2], V* values[2], std::size_t n, int bits,
                             Allocate&& allocate) {
  auto order = allocate(n * sizeof(std::size_t));
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

/// Few and odd: shares that are not a whole number show.
template <int kThreads>
inline constexpr std::size_t kTeamMembers = kThreads < 3 ? kThreads : 3;

/// A member of a team of coroutines.
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

template <class F>
void launch_indices(Stream, std::size_t n, const F& f) {
  for (std::size_t i = 0; i < n; ++i) f(i);
}

template <class T, int kThreads, class F>
void launch_teams(Stream, std::size_t n, F f) {
  constexpr std::size_t kMembers = kTeamMembers<kThreads>;
  if (n == 0) return;
  T scratch;
  const auto body = [&](std::size_t rank, auto& host) {
    const Team<std::remove_reference_t<decltype(host)>> team(rank, kMembers, host);
    for (std::size_t i = 0; i < n; ++i) {
      f(i, scratch, team);
      team.sync();
    }
  };
  TeamOnHost<kMembers, decltype(body)>::run(body);
}

#endif

/// While it lives, this thread's calls are of `device`.
class DeviceScope {
 public:
  explicit DeviceScope(int device) : before_(current_device()), device_(device) {
    if (device_ != before_) set_device(device_);
  }
  ~DeviceScope() {
    if (device_ == before_) return;
    try {
      set_device(before_);
    } catch (const Error&) {
      // It was current before: a device that is lost says so to the next call.
    }
  }
  DeviceScope(const DeviceScope&) = delete;
  DeviceScope& operator=(const DeviceScope&) = delete;

 private:
  int before_, device_;
};

/// f(), of which all that fails is an Error: Thrust's algorithms throw an exception of their own.
/// Around what others call of the device's code, since no one else knows that type.
template <class F>
decltype(auto) with_errors(F&& f) {
  try {
    return std::forward<F>(f)();
  } catch (const thrust::system_error& error) {
    fail(error);
  }
}

}  // namespace RASTRUM_DEVICE_SYSTEM
}  // namespace rastrum::parallel::cuda_system
