// Where frames are computed, and with which instructions: what the renderers' options have in
// common.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace rastrum {

enum class Device : std::uint8_t { serial, threads, cuda };

/// Instruction sets that the SIMD leaves are compiled for. `scalar` is plain C++.
enum class Isa : std::uint8_t { scalar, sse4, avx2, avx512, neon };
[[nodiscard]] std::string_view name(Isa isa);
/// Those that this machine can run, slowest first; always begins with `scalar`.
[[nodiscard]] std::vector<Isa> available_isas();

}  // namespace rastrum
