#include "tests/support/oracle.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>
#include <stdexcept>

namespace rastrum::test {
namespace {

// 2⁻¹⁵…2¹⁶ px in n.8. Differences stay below 2²⁵ and their products below 2⁵¹.
constexpr std::int64_t kGuardMin = -(std::int64_t{1} << 23);
constexpr std::int64_t kGuardMax = std::int64_t{1} << 24;

std::int64_t sample_fx8(int pixel) {
  return std::int64_t{pixel} * 256 + 128;
}

// Whether p is on the inner side of the edge a → b of a triangle that turns clockwise on the screen
// (y down). On the edge itself only a top edge (to the right) or a left edge (upwards) owns p.
bool inside_edge(const SnappedVertex& a, const SnappedVertex& b, std::int64_t x, std::int64_t y) {
  const std::int64_t dx = b.x_fx8 - a.x_fx8;
  const std::int64_t dy = b.y_fx8 - a.y_fx8;
  const std::int64_t e = dx * (y - a.y_fx8) - dy * (x - a.x_fx8);
  if (e != 0) return e > 0;
  const bool top = dy == 0 && dx > 0;
  const bool left = dy < 0;
  return top || left;
}

void require_guard_band(const SnappedTriangle& t) {
  for (const SnappedVertex& v : t.v)
    if (v.x_fx8 < kGuardMin || v.x_fx8 > kGuardMax || v.y_fx8 < kGuardMin || v.y_fx8 > kGuardMax)
      throw std::out_of_range("oracle: a vertex outside the guard band");
}

std::uint64_t visibility_word(float depth, std::int64_t id) {
  const std::uint64_t bits = std::bit_cast<std::uint32_t>(depth);
  return bits << 33 | ((std::uint64_t{1} << 33) - 1 - static_cast<std::uint64_t>(id));
}

}  // namespace

std::uint64_t OracleImage::fragments() const {
  return std::accumulate(overdraw.begin(), overdraw.end(), std::uint64_t{0});
}

std::uint64_t OracleImage::pixels_covered() const {
  return static_cast<std::uint64_t>(
      std::count_if(overdraw.begin(), overdraw.end(), [](std::uint32_t n) { return n > 0; }));
}

std::int64_t twice_area(const SnappedTriangle& t) {
  const std::int64_t dx1 = t.v[1].x_fx8 - t.v[0].x_fx8, dy1 = t.v[1].y_fx8 - t.v[0].y_fx8;
  const std::int64_t dx2 = t.v[2].x_fx8 - t.v[0].x_fx8, dy2 = t.v[2].y_fx8 - t.v[0].y_fx8;
  return dx1 * dy2 - dx2 * dy1;
}

bool covers(const SnappedTriangle& t, int px, int py) {
  const std::int64_t area = twice_area(t);
  if (area == 0) return false;
  const SnappedVertex& a = t.v[0];
  const SnappedVertex& b = area > 0 ? t.v[1] : t.v[2];
  const SnappedVertex& c = area > 0 ? t.v[2] : t.v[1];
  const std::int64_t x = sample_fx8(px), y = sample_fx8(py);
  return inside_edge(a, b, x, y) && inside_edge(b, c, x, y) && inside_edge(c, a, x, y);
}

float depth_at(const SnappedTriangle& t, int px, int py) {
  const double dz1 = double{t.v[1].depth} - double{t.v[0].depth};
  const double dz2 = double{t.v[2].depth} - double{t.v[0].depth};
  const double dx1 = static_cast<double>(t.v[1].x_fx8 - t.v[0].x_fx8);
  const double dy1 = static_cast<double>(t.v[1].y_fx8 - t.v[0].y_fx8);
  const double dx2 = static_cast<double>(t.v[2].x_fx8 - t.v[0].x_fx8);
  const double dy2 = static_cast<double>(t.v[2].y_fx8 - t.v[0].y_fx8);
  const double det = static_cast<double>(twice_area(t));
  const float zx = static_cast<float>(256 * (dz1 * dy2 - dz2 * dy1) / det);
  const float zy = static_cast<float>(256 * (dz2 * dx1 - dz1 * dx2) / det);
  const float x0 = static_cast<float>(t.v[0].x_fx8) / 256;
  const float y0 = static_cast<float>(t.v[0].y_fx8) / 256;
  const float x = static_cast<float>(px) + 0.5F;
  const float y = static_cast<float>(py) + 0.5F;
  const float along_x = zx * (x - x0);
  const float along_y = zy * (y - y0);
  const float d = (t.v[0].depth + along_x) + along_y;
  if (!(d > 0)) return 0.0F;
  return d < 1 ? d : 1.0F;
}

OracleImage brute_force(int width, int height, std::span<const SnappedTriangle> triangles,
                        Keep keep) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<std::uint64_t> words(pixels, 0);
  OracleImage image{width, height, {}, {}, std::vector<std::uint32_t>(pixels, 0)};
  for (const SnappedTriangle& t : triangles) {
    require_guard_band(t);
    const std::int64_t area = twice_area(t);
    if (area == 0) continue;
    const bool front = area < 0;  // counter-clockwise on the screen
    if ((keep == Keep::front && !front) || (keep == Keep::back && front)) continue;
    const auto [min_x, max_x] = std::minmax({t.v[0].x_fx8, t.v[1].x_fx8, t.v[2].x_fx8});
    const auto [min_y, max_y] = std::minmax({t.v[0].y_fx8, t.v[1].y_fx8, t.v[2].y_fx8});
    const auto first = [](std::int64_t fx8) {
      return static_cast<int>(std::max<std::int64_t>(fx8 / 256 - 2, 0));
    };
    const auto last = [](std::int64_t fx8, int size) {
      return static_cast<int>(std::min<std::int64_t>(fx8 / 256 + 2, size - 1));
    };
    for (int y = first(min_y); y <= last(max_y, height); ++y) {
      for (int x = first(min_x); x <= last(max_x, width); ++x) {
        if (!covers(t, x, y)) continue;
        const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x);
        ++image.overdraw[i];
        words[i] = std::max(words[i], visibility_word(depth_at(t, x, y), t.id));
      }
    }
  }
  image.ids.resize(pixels);
  image.depth.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint64_t low = words[i] & ((std::uint64_t{1} << 33) - 1);
    image.ids[i] =
        words[i] == 0 ? -1 : static_cast<std::int64_t>((std::uint64_t{1} << 33) - 1 - low);
    image.depth[i] = std::bit_cast<float>(static_cast<std::uint32_t>(words[i] >> 33));
  }
  return image;
}

}  // namespace rastrum::test
