#include <rastrum/raster/shade/srgb.hpp>

#include <algorithm>

#include <rastrum/core/srgb.hpp>

namespace rastrum::raster {
float linear_from_display(float display) {
  constexpr std::size_t kSteps = 4096;
  static const std::array<double, kSteps + 2> table = [] {
    std::array<double, kSteps + 2> t{};
    for (std::size_t i = 0; i < t.size(); ++i)
      t[i] = linear_from_srgb(static_cast<double>(i) / kSteps);
    return t;
  }();
  if (!(display > 0)) return 0;
  const double at = std::min(double{display}, 1.0) * kSteps;
  const auto i = static_cast<std::size_t>(at);
  return static_cast<float>(table[i] + (table[i + 1] - table[i]) * (at - static_cast<double>(i)));
}

const DecodeTables& decode_tables() {
  static const DecodeTables tables = [] {
    DecodeTables t;
    for (std::size_t i = 0; i < 256; ++i) {
      t.unorm[i] = static_cast<float>(i) / 255;
      t.srgb[i] = static_cast<float>(linear_from_srgb(static_cast<double>(i) / 255));
    }
    return t;
  }();
  return tables;
}

SrgbCodes::SrgbCodes() {
  for (std::size_t i = 0; i < 255; ++i)
    between_[i] = static_cast<float>(linear_from_srgb((static_cast<double>(i) + 0.5) / 255));
  between_[255] = 2;
  std::uint8_t at = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto bits = static_cast<std::uint32_t>(kFirst + i) << kShift;
    while (std::bit_cast<float>(bits) >= between_[at]) ++at;
    code_[i] = at;
  }
}

const SrgbCodes& srgb_codes() {
  static const SrgbCodes codes;
  return codes;
}

}  // namespace rastrum::raster
