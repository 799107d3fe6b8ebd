// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/parallel/device.hpp>

// Asks for the compiled SIMD targets just as the SIMD sources do.
#include <rastrum/core/number_text.hpp>
#include <rastrum/parallel/simd_targets.hpp>

#include <hwy/detect_targets.h>
#if HWY_ARCH_X86
#include <cpuid.h>
#endif

#include <algorithm>

#include <rastrum/core/enum.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/cuda/status.hpp>

namespace rastrum {

namespace {

/// The name of an enum's value; empty for a value out of range.
template <class E>
std::string_view name_in(std::initializer_list<std::string_view> names, E value) {
  const auto i = static_cast<std::size_t>(value);
  return i < names.size() ? names.begin()[i] : std::string_view();
}

}  // namespace

std::string_view name(Device device) {
  return name_in({"serial", "threads", "cuda", "auto"}, device);
}

DeviceChoice choose_device(Device wanted) {
  check_enum(wanted, Device::automatic, "device");
  if (wanted == Device::serial || wanted == Device::threads) return {wanted, ""};
  const parallel::CudaStatus status = parallel::cuda_status();
  if (wanted == Device::automatic) {
    if (status.usable) return {Device::cuda, "there is a " + status.name};
    return {Device::threads, std::string("no CUDA: ").append(status.why_not)};
  }
  if (!status.usable)
    throw Error(Errc::no_device, text_of("--device cuda: CUDA cannot be used: ", status.why_not,
                                         "; or use --device threads"));
  return {Device::cuda, ""};
}

std::string_view name(Isa isa) {
  return name_in({"scalar", "sse4", "avx2", "avx512", "neon", "wasm"}, isa);
}

namespace {

std::vector<Isa> find_isas() {
  std::vector<Isa> isas{Isa::scalar};
#if HWY_ARCH_X86
  // The features that Highway's targets of these names use. Every processor with AVX2, BMI2 and FMA
  // also has LZCNT and F16C. Not every compiler's library knows the processor, so cpuid is asked.
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0, saved = 0;
  __get_cpuid(1, &eax, &ebx, &ecx, &edx);
  const auto has_all = [](unsigned flags, unsigned wanted) { return (flags & wanted) == wanted; };
  const bool sse4 = has_all(ecx, bit_SSE4_2 | bit_SSSE3 | bit_AES | bit_PCLMUL);
  const bool fma = has_all(ecx, bit_FMA);
  // The system must save the wide registers, too: xgetbv says which it saves.
  if (has_all(ecx, bit_OSXSAVE)) __asm__("xgetbv" : "=a"(saved), "=d"(edx) : "c"(0));
  constexpr unsigned kSse = 1U << 1, kAvx = 1U << 2, kMasks = 1U << 5, kHighHalves = 1U << 6,
                     kUpperHalf = 1U << 7;
  if (__get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) == 0) ebx = 0;
  const bool avx2 =
      sse4 && fma && has_all(saved, kSse | kAvx) && has_all(ebx, bit_AVX2 | bit_BMI | bit_BMI2);
  const bool avx512 =
      avx2 && has_all(saved, kMasks | kHighHalves | kUpperHalf) &&
      has_all(ebx, bit_AVX512F | bit_AVX512VL | bit_AVX512DQ | bit_AVX512BW | bit_AVX512CD);
  if (sse4 && (HWY_TARGETS & HWY_SSE4) != 0) isas.push_back(Isa::sse4);
  if (avx2 && (HWY_TARGETS & HWY_AVX2) != 0) isas.push_back(Isa::avx2);
  if (avx512 && (HWY_TARGETS & HWY_AVX3) != 0) isas.push_back(Isa::avx512);
#elif HWY_ARCH_ARM
  if ((HWY_TARGETS & HWY_NEON) != 0) isas.push_back(Isa::neon);
#elif HWY_ARCH_WASM
  if ((HWY_TARGETS & HWY_WASM) != 0) isas.push_back(Isa::wasm);
#endif
  return isas;
}

}  // namespace

std::vector<Isa> available_isas() {
  static const std::vector<Isa> kFound =
      find_isas();  // asking takes microseconds in a virtual machine
  return kFound;
}

Isa choose_isa(std::optional<Isa> wanted) {
  const std::vector<Isa> isas = available_isas();
  if (!wanted) return isas.back();
  check_enum(*wanted, Isa::wasm, "isa");
  if (std::ranges::find(isas, *wanted) == isas.end()) {
    std::string others;
    for (const Isa isa : isas) others.append(others.empty() ? "" : ", ").append(name(isa));
    throw Error(Errc::no_device, text_of("--isa ", name(*wanted),
                                         ": this machine, or this build, has only ", others));
  }
  return *wanted;
}

}  // namespace rastrum
