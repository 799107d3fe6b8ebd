#include <rastrum/parallel/device.hpp>

#include <hwy/targets.h>

namespace rastrum {

std::string_view name(Isa isa) {
  switch (isa) {
    case Isa::scalar:
      return "scalar";
    case Isa::sse4:
      return "sse4";
    case Isa::avx2:
      return "avx2";
    case Isa::avx512:
      return "avx512";
    case Isa::neon:
      return "neon";
  }
  return "";
}

std::vector<Isa> available_isas() {
  std::vector<Isa> isas{Isa::scalar};
  const std::int64_t supported = hwy::SupportedTargets();
  const auto add = [&](std::int64_t target, Isa isa) {
    if ((supported & target) != 0) isas.push_back(isa);
  };
#if HWY_ARCH_X86
  add(HWY_SSE4, Isa::sse4);
  add(HWY_AVX2, Isa::avx2);
  add(HWY_AVX3, Isa::avx512);
#elif HWY_ARCH_ARM
  add(HWY_NEON, Isa::neon);
#endif
  return isas;
}

}  // namespace rastrum
