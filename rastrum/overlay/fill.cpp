// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/error.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/overlay/canvas.hpp>
#include <rastrum/overlay/coverage.hpp>

namespace rastrum::overlay {
namespace {

/// Straight alpha. The source's is color.a · coverage / 255; sums are in 1/255², to round once.
void blend(Rgba8& to, Rgba8 color, std::uint32_t coverage) {
  const std::uint32_t source = (color.a * coverage + 127) / 255;
  if (source == 0) return;
  const std::uint32_t behind = to.a * (255 - source);  // in 1/255²
  const std::uint32_t front = source * 255, sum = front + behind;
  const auto channel = [&](std::uint32_t over, std::uint32_t under) {
    return static_cast<std::uint8_t>((over * front + under * behind + sum / 2) / sum);
  };
  to = {channel(color.r, to.r), channel(color.g, to.g), channel(color.b, to.b),
        static_cast<std::uint8_t>((sum + 127) / 255)};
}

void blend(Vec4& to, Rgba8 color, std::uint32_t coverage) {
  const float alpha = static_cast<float>(color.a * coverage) / (255.0F * 255.0F), left = 1 - alpha;
  const auto channel = [&](std::uint8_t over, float under) {
    return static_cast<float>(over) / 255.0F * alpha + under * left;
  };
  to = {channel(color.r, to.x), channel(color.g, to.y), channel(color.b, to.z),
        alpha + to.w * left};
}

}  // namespace

void check(const Canvas& canvas) {
  check_size(canvas.color8, canvas.width(), canvas.height(), "overlay: Canvas::color8");
  check_size(canvas.color, canvas.width(), canvas.height(), "overlay: Canvas::color");
}

void fill(const Canvas& canvas, const Path& path, Rgba8 color, PixelTest test) {
  const FloatScope floats;
  check(canvas);
  if (canvas.width() <= 0 || canvas.height() <= 0) return;
  for_each_covered_row(path, canvas.width(), canvas.height(),
                       [&](int y, int begin, int end, const std::uint8_t* coverage) {
                         for (int x = begin; x < end; ++x) {
                           if (coverage[x] == 0 || (test && !test(x, y))) continue;
                           if (!canvas.color8.empty())
                             blend(canvas.color8(x, y), color, coverage[x]);
                           if (!canvas.color.empty()) blend(canvas.color(x, y), color, coverage[x]);
                         }
                       });
}

void fill(ImageView<std::uint8_t> coverage, const Path& path) {
  const FloatScope floats;
  check_stride(coverage, "overlay: the coverage");
  if (coverage.width <= 0 || coverage.height <= 0) return;
  for (int y = 0; y < coverage.height; ++y)
    std::memset(coverage.row(y), 0, static_cast<std::size_t>(coverage.width));
  for_each_covered_row(path, coverage.width, coverage.height,
                       [&](int y, int begin, int end, const std::uint8_t* row) {
                         std::memcpy(coverage.row(y) + begin, row + begin,
                                     static_cast<std::size_t>(end - begin));
                       });
}

}  // namespace rastrum::overlay
