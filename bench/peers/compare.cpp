// SPDX-License-Identifier: BSD-3-Clause
#include "compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>

namespace rastrum::bench {
namespace {

constexpr std::int64_t kSubpixels = 256;

struct Point {
  std::int64_t x, y;  ///< in 1/256 px, y down
};

}  // namespace

CountDifference compare_counts(const Image<std::uint32_t>& ours,
                               const Image<std::uint32_t>& theirs) {
  CountDifference d;
  for (std::size_t i = 0; i < ours.pixels().size(); ++i) {
    const std::uint32_t a = ours.pixels()[i], b = theirs.pixels()[i];
    d.pixels += a != b ? 1U : 0U;
    d.coverage += (a == 0) != (b == 0) ? 1U : 0U;
    d.ours += a;
    d.theirs += b;
  }
  return d;
}

ColorDifference compare_colors(const Image<Rgba8>& ours, const Image<Rgba8>& theirs,
                               int tolerance) {
  ColorDifference d;
  for (std::size_t i = 0; i < ours.pixels().size(); ++i) {
    const Rgba8 a = ours.pixels()[i], b = theirs.pixels()[i];
    if (a.a == 0 && b.a == 0) continue;
    ++d.covered;
    if ((a.a == 0) != (b.a == 0)) {
      ++d.one_only;
      ++d.far;
      continue;
    }
    const int apart = std::max(
        {std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b), std::abs(a.a - b.a)});
    d.largest = std::max(d.largest, apart);
    d.far += apart > tolerance ? 1U : 0U;
  }
  return d;
}

double PictureError::psnr() const {
  return -20 * std::log10(rmse);
}

PictureError picture_error(const Image<Vec4>& ours, const Image<Vec4>& theirs, double tolerance) {
  PictureError e;
  double squares = 0;
  for (std::size_t i = 0; i < ours.pixels().size(); ++i) {
    const Vec4 a = ours.pixels()[i], b = theirs.pixels()[i];
    if (a.w == 0 && b.w == 0) continue;
    ++e.covered;
    const auto apart = [](float x, float y) {
      return std::abs(static_cast<double>(std::min(x, 1.0F)) -
                      static_cast<double>(std::min(y, 1.0F)));
    };
    const double red = apart(a.x, b.x), green = apart(a.y, b.y), blue = apart(a.z, b.z);
    squares += red * red + green * green + blue * blue;
    const double most = std::max({red, green, blue, apart(a.w, b.w)});
    e.worst = std::max(e.worst, most);
    e.far += most > tolerance ? 1U : 0U;
  }
  if (e.covered != 0) e.rmse = std::sqrt(squares / (3 * static_cast<double>(e.covered)));
  return e;
}

std::uint64_t count_different(const Image<std::int64_t>& ours, const Image<std::int32_t>& theirs) {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < ours.pixels().size(); ++i)
    n += ours.pixels()[i] != theirs.pixels()[i] ? 1U : 0U;
  return n;
}

Mesh window_triangles(int width, int height, int count, std::uint64_t seed) {
  // Plain arithmetic on the generator's bits, because <random>'s distributions differ by library.
  std::mt19937_64 bits(seed);
  const auto between = [&](std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(bits() % static_cast<std::uint64_t>(high - low + 1));
  };
  constexpr std::array<std::int64_t, 5> kReach_px{1, 3, 12, 60, 1 << 15};
  const std::int64_t right = width * kSubpixels, bottom = height * kSubpixels;
  Mesh mesh;
  for (int t = 0; t < count; ++t) {
    const std::int64_t reach =
        kReach_px[static_cast<std::size_t>(t) % kReach_px.size()] * kSubpixels;
    const std::int64_t step = (t / 5) % 2 == 0 ? 1 : kSubpixels / 2;
    const Point centre{between(0, right), between(0, bottom)};
    for (int c = 0; c < 3; ++c) {
      const auto near = [&](std::int64_t middle, std::int64_t limit) {
        const std::int64_t low = std::max<std::int64_t>(middle - reach, 0);
        return between(low, std::min(middle + reach, limit)) / step * step;
      };
      const Point p{near(centre.x, right), near(centre.y, bottom)};
      mesh.positions.push_back({static_cast<float>(p.x) / kSubpixels,
                                static_cast<float>(bottom - p.y) / kSubpixels, -0.5F});
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.indices.size()));
    }
  }
  mesh.normals.values.assign(mesh.positions.size(), Vec3{0, 0, 1});
  return mesh;
}

Camera window_camera(int width, int height) {
  const float x = static_cast<float>(width) / 2, y = static_cast<float>(height) / 2;
  Camera camera;
  camera.eye = {x, y, 0};
  camera.target = {x, y, -1};
  camera.orthographic = true;
  camera.orthographic_height = static_cast<float>(std::min(width, height));
  camera.near_plane = 0;
  camera.far_plane = 1;
  return camera;
}

}  // namespace rastrum::bench
