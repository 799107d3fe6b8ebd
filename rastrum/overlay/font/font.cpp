// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/overlay/font/font.hpp>

#include <algorithm>
#include <cstdlib>
#include <iterator>

namespace rastrum::overlay {
namespace {

#include <rastrum/overlay/font/outlines.inc>

static_assert(kUnitsPerEm == 2048, "for_each_contour shifts by it");

}  // namespace

FontMetrics font_metrics() {
  return {kUnitsPerEm, kCapitalHeight, kAscent + kDescent};
}

const Glyph& glyph_of(char32_t code) {
  const auto* found = std::lower_bound(std::begin(kGlyphs), std::end(kGlyphs), code,
                                       [](const Glyph& g, char32_t c) { return g.code < c; });
  return found != std::end(kGlyphs) && found->code == code ? *found : kGlyphs[0];
}

const std::int16_t* glyph_points(const Glyph& glyph) {
  return kPoints + glyph.points;
}

std::vector<char32_t> decode_utf8(std::string_view text) {
  constexpr char32_t kNone = 0xFFFD;
  std::vector<char32_t> codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const int more = lead < 0x80                   ? 0
                     : lead >= 0xC2 && lead < 0xE0 ? 1
                     : lead >= 0xE0 && lead < 0xF0 ? 2
                     : lead >= 0xF0 && lead < 0xF5 ? 3
                                                   : -1;
    char32_t code = more == 0 ? lead : more < 0 ? kNone : lead & (0x3FU >> more);
    bool good = more >= 0 && i + static_cast<std::size_t>(more) < text.size();
    for (int k = 1; good && k <= more; ++k) {
      const auto next = static_cast<unsigned char>(text[i + static_cast<std::size_t>(k)]);
      good = (next & 0xC0) == 0x80;
      code = code << 6 | (next & 0x3FU);
    }
    constexpr char32_t kLeast[] = {0, 0x80, 0x800, 0x10000};
    good = good && code >= kLeast[more] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
    codes.push_back(good ? code : kNone);
    i += good ? static_cast<std::size_t>(more) + 1 : 1;
  }
  return codes;
}

void append_curve(Point a, Point c, Point b, std::int32_t tolerance_fx8, std::vector<Point>& to) {
  // Each of n pieces deviates from its chord by at most |a − 2 c + b| / (4 n²). That length is at
  // most √2 times its larger component; 3/2 is taken.
  const std::int64_t ax = a.x, ay = a.y, bx = b.x, by = b.y, cx = c.x, cy = c.y;
  const std::int64_t bend =
      std::max(std::abs(ax - 2 * cx + bx), std::abs(ay - 2 * cy + by)) * 3 / 2;
  std::int64_t n = 1;
  while (bend > 4 * n * n * tolerance_fx8 && n < 64) ++n;
  for (std::int64_t i = 1; i <= n; ++i) {
    const std::int64_t u = n - i, nn = n * n;
    const auto at = [&](std::int64_t from, std::int64_t by_way_of, std::int64_t until) {
      const std::int64_t sum = u * u * from + 2 * u * i * by_way_of + i * i * until;
      const std::int64_t twice = 2 * sum + nn;  // rounded: floor((2 s + n²) / 2 n²)
      const std::int64_t q = twice / (2 * nn);
      return static_cast<std::int32_t>(q - static_cast<std::int64_t>(twice % (2 * nn) < 0));
    };
    to.push_back({at(ax, cx, bx), at(ay, cy, by)});
  }
}

}  // namespace rastrum::overlay
