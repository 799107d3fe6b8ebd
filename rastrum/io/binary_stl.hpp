// SPDX-License-Identifier: BSD-3-Clause
// Binary STL: a header of 80 bytes, the number of facets, the facets. A facet's attribute has its
// colour in one of two ways. VisCAM and SolidView: bit 15 marks a colour, with red in the highest
// five of the other bits. Magics: the header has COLOR= and the RGBA of the whole. Bit 15 marks
// facets of that colour; others have red in the lowest five bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <rastrum/io/colors.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>

namespace rastrum::io {
namespace stl {

inline constexpr std::size_t kHeader = 84, kFacet = 50;
inline constexpr std::size_t kCorners = 12;  ///< in a facet, after its normal: nine float32

/// The header's number of facets; 0: it is cut off.
[[nodiscard]] inline std::size_t said_count(Bytes bytes) {
  return bytes.size() < kHeader ? 0 : load_little_endian<std::uint32_t>(bytes.data() + 80);
}
/// Whether the size fits the header: then the file is binary, whatever it begins with.
[[nodiscard]] inline bool is_exact(Bytes bytes) {
  return bytes.size() >= kHeader && bytes.size() == kHeader + said_count(bytes) * kFacet;
}
/// The number of facets. Calls fail(why), which throws, if the bytes are no binary STL.
template <class Fail>
[[nodiscard]] std::size_t facet_count(Bytes bytes, const Fail& fail) {
  if (bytes.size() < kHeader)
    fail("is not STL: " + std::to_string(bytes.size()) + " bytes that do not begin with 'solid'");
  const std::size_t count = said_count(bytes), capacity = (bytes.size() - kHeader) / kFacet;
  if (count > capacity || (count == 0 && bytes.size() > kHeader))
    fail("the header says " + std::to_string(count) + " triangles, but there are bytes for " +
         std::to_string(capacity));
  return count;
}

}  // namespace stl

class StlColors {
 public:
  /// Begins the header of a large file's selection whose attributes are colours, because its own
  /// facets might not show it.
  static constexpr std::string_view kMark = "facets have colours ";

  explicit StlColors(Bytes header) {
    const std::string_view text = as_text(header).substr(0, 80);
    marked_ = text.starts_with(kMark);
    for (const std::string_view key : {"COLOR=", "MATERIAL="}) {
      const std::size_t at = text.find(key);
      if (at == std::string_view::npos || at + key.size() + 4 > text.size()) continue;
      is_magics_ = true;
      const auto channel = [&](std::size_t c) {
        return static_cast<float>(static_cast<unsigned char>(text[at + key.size() + c])) *
               (1 / 255.0F);
      };
      whole_ = {channel(0), channel(1), channel(2), channel(3)};
      break;
    }
    has_material_ = text.find("MATERIAL=") != std::string_view::npos;
  }

  [[nodiscard]] bool is_magics() const { return is_magics_; }
  [[nodiscard]] bool has_material() const { return has_material_; }

  [[nodiscard]] static std::uint16_t attribute(const std::byte* facet) {
    return load_little_endian<std::uint16_t>(facet + 48);
  }
  /// Whether an attribute shows that attributes are colours. In Magics any but 0 does: a file of
  /// zeros has no facet colours.
  [[nodiscard]] bool says_so(std::uint16_t attribute) const {
    return is_magics_ ? attribute != 0 : (attribute & kBit15) != 0;
  }
  /// O(facets).
  [[nodiscard]] bool are_used(const std::byte* facet, std::size_t count) const {
    if (marked_) return true;
    for (std::size_t t = 0; t < count; ++t, facet += stl::kFacet)
      if (says_so(attribute(facet))) return true;
    return false;
  }

  [[nodiscard]] Attribute<Vec4> read(const std::byte* facet, std::size_t count,
                                     Budget& budget) const {
    FaceColors colors(budget);
    if (!are_used(facet, count)) {
      if (is_magics_) colors.add(whole_, count);
      return colors.take();
    }
    for (std::size_t t = 0; t < count; ++t, facet += stl::kFacet) {
      const std::uint16_t a = attribute(facet);
      const bool flag = (a & kBit15) != 0;
      const auto channel = [&](int bit) { return static_cast<float>(a >> bit & 31) * (1 / 31.0F); };
      if (is_magics_)
        colors.add(flag ? whole_ : Vec4{channel(0), channel(5), channel(10), 1}, t + 1);
      else if (flag)
        colors.add({channel(10), channel(5), channel(0), 1}, t + 1);
      else
        colors.add_none(t + 1);
    }
    return colors.take(true);
  }

 private:
  static constexpr std::uint16_t kBit15 = 0x8000;
  Vec4 whole_{};
  bool marked_ = false, is_magics_ = false, has_material_ = false;
};

}  // namespace rastrum::io
