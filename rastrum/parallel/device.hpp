// Where frames are computed, and with which instructions: what the renderers' options have in
// common.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rastrum {

/// `automatic` takes the best that there is (choose_device).
enum class Device : std::uint8_t { serial, threads, cuda, automatic };
[[nodiscard]] std::string_view name(Device device);

struct DeviceChoice {
  Device device;    ///< not `automatic`
  std::string why;  ///< what `automatic` went by; empty where a device was asked for
};
/// What there is of what is wanted. Throws Error{no_device} with what to do where `cuda` is asked
/// for and cannot be had, Error{invalid_argument} for a value that is no device.
[[nodiscard]] DeviceChoice choose_device(Device wanted);

/// Instruction sets that the SIMD leaves are compiled for. `scalar` is plain C++.
enum class Isa : std::uint8_t { scalar, sse4, avx2, avx512, neon };
[[nodiscard]] std::string_view name(Isa isa);
/// Those that this machine can run and this library is compiled for, slowest first; always begins
/// with `scalar`.
[[nodiscard]] std::vector<Isa> available_isas();
/// `wanted`, or the best of available_isas(). Whoever is given an instruction set asks here, so
/// that one that is not there is never plain C++ in silence: throws Error{no_device} that names
/// those that are, Error{invalid_argument} for a value that is none.
[[nodiscard]] Isa choose_isa(std::optional<Isa> wanted);

}  // namespace rastrum
