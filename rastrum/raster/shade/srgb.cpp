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

std::uint8_t srgb_code(float linear) {
  // between[i]: the linear light half-way from code i to code i + 1.
  static const std::array<float, 255> between = [] {
    std::array<float, 255> t{};
    for (std::size_t i = 0; i < t.size(); ++i)
      t[i] = static_cast<float>(linear_from_srgb((static_cast<double>(i) + 0.5) / 255));
    return t;
  }();
  // The curve is good to a hundredth of a code, so its neighbours are all there is to look at.
  auto code = static_cast<std::size_t>(srgb_from_linear(linear) * 255 + 0.5F);
  if (code > 0 && linear < between[code - 1]) --code;
  if (code < 255 && linear >= between[code]) ++code;
  return static_cast<std::uint8_t>(code);
}

}  // namespace rastrum::raster
