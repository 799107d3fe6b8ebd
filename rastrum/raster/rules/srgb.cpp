// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/rules/srgb.hpp>

#include <algorithm>

#include <rastrum/core/srgb.hpp>

namespace rastrum::raster {

std::span<const double, kDisplaySteps + 2> display_curve() {
  static const std::array<double, kDisplaySteps + 2> curve = [] {
    std::array<double, kDisplaySteps + 2> c{};
    for (std::size_t i = 0; i < c.size(); ++i)
      c[i] = linear_from_srgb(static_cast<double>(i) / kDisplaySteps);
    return c;
  }();
  return curve;
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
