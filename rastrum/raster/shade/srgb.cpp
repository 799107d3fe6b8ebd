#include <rastrum/raster/shade/srgb.hpp>

#include <algorithm>
#include <bit>

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

namespace {

/// Codes by a float's exponent and first seven bits of mantissa: such a cell has one place between
/// codes at most.
struct CodeCells {
  static constexpr int kShift = 16;
  static constexpr float kLeast = 0x1p-13F;  // below is code 0
  static constexpr std::uint32_t kFirst = std::bit_cast<std::uint32_t>(kLeast) >> kShift;
  static constexpr std::size_t kCount = (std::bit_cast<std::uint32_t>(1.0F) >> kShift) - kFirst;

  std::uint8_t code[kCount];  ///< at the cell's begin
  float between[256];         ///< [i]: the linear light half-way from code i to code i + 1

  CodeCells() {
    for (std::size_t i = 0; i < 255; ++i)
      between[i] = static_cast<float>(linear_from_srgb((static_cast<double>(i) + 0.5) / 255));
    between[255] = 2;
    std::uint8_t at = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      const auto bits = static_cast<std::uint32_t>(kFirst + i) << kShift;
      while (std::bit_cast<float>(bits) >= between[at]) ++at;
      code[i] = at;
    }
  }
};

}  // namespace

std::uint8_t srgb_code(float linear) {
  static const CodeCells cells;
  if (!(linear >= CodeCells::kLeast)) return 0;
  if (linear >= 1) return 255;
  const std::uint32_t cell =
      (std::bit_cast<std::uint32_t>(linear) >> CodeCells::kShift) - CodeCells::kFirst;
  const std::uint8_t code = cells.code[cell];
  return static_cast<std::uint8_t>(code + (linear >= cells.between[code] ? 1 : 0));
}

}  // namespace rastrum::raster
