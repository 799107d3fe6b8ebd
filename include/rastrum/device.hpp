// SPDX-License-Identifier: BSD-3-Clause
// Where frames are computed, with which instructions, and how long their parts took: what the
// renderers have in common.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/config.hpp>

namespace RASTRUM_API rastrum {

/// `automatic` takes the best that there is.
enum class Device : std::uint8_t { serial, threads, cuda, automatic };
[[nodiscard]] std::string_view name(Device device);

/// A stream of a caller's on the device that draws: CUDA's cudaStream_t, null for its default
/// stream (PyTorch: torch.cuda.current_stream().cuda_stream).
struct DeviceStream {
  void* handle = nullptr;
};

/// Instruction sets that the SIMD leaves are compiled for. `scalar` is plain C++.
enum class Isa : std::uint8_t { scalar, sse4, avx2, avx512, neon };
[[nodiscard]] std::string_view name(Isa isa);
/// The instruction sets that this machine can run and this library is compiled for, slowest first;
/// always begins with `scalar`.
[[nodiscard]] std::vector<Isa> available_isas();

/// One timed part of a frame, in ms since the frame began.
struct StageTime {
  std::string name;
  double begin_ms = 0, end_ms = 0;
};

}  // namespace rastrum
