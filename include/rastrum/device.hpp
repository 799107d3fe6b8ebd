// SPDX-License-Identifier: BSD-3-Clause
// Types that the renderers share: where frames are computed, with which instructions, and how long
// their parts took.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/config.hpp>

namespace RASTRUM_API rastrum {

/// The processor that computes frames: one thread of the host, all its threads, or a CUDA device.
/// `automatic` takes the best that there is.
enum class Device : std::uint8_t { serial, threads, cuda, automatic };
[[nodiscard]] std::string_view name(Device device);

/// A caller's stream on the device that draws: a cudaStream_t; null is CUDA's default stream
/// (PyTorch: torch.cuda.current_stream().cuda_stream).
struct DeviceStream {
  void* handle = nullptr;
};

/// The instruction sets that SIMD code is compiled for. `scalar` is plain C++.
enum class Isa : std::uint8_t { scalar, sse4, avx2, avx512, neon, wasm };
[[nodiscard]] std::string_view name(Isa isa);
/// The instruction sets that this machine can run and this library is compiled for, slowest first.
/// The first is always `scalar`.
[[nodiscard]] std::vector<Isa> available_isas();

/// One timed part of a frame, in ms since the frame began.
struct StageTime {
  std::string name;
  double begin_ms = 0, end_ms = 0;
};

}  // namespace rastrum
