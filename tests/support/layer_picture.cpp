// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/layer_picture.hpp"
#include "tests/support/painter.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace rastrum::test {
namespace {

using testing::AssertionFailure;
using testing::AssertionResult;
using testing::AssertionSuccess;

template <class Render>
LayerPicture take_with(Painter& renderer, bool with_overdraw, const Render& render) {
  LayerPicture p{Frame(renderer.options().width, renderer.options().height,
                       (with_overdraw ? kCounted : kPicture) | kErrors)};
  p.stats = render(p.targets());
  return p;
}

using Channels = std::array<double, 4>;

/// Straight (not premultiplied), in levels of 8 bits.
Channels levels(const Rgba64& c) {
  const double scale = c.a > 0 ? 1 / c.a : 1;
  const auto level = [](double v) { return std::nearbyint(std::clamp(v, 0.0, 1.0) * 255); };
  return {level(c.r * scale), level(c.g * scale), level(c.b * scale), level(c.a)};
}

double most_apart(const Channels& a, const Channels& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::isnan(a[i]) ? a[i] : std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

std::uint64_t LayerPicture::counter(std::string_view name) const {
  for (const auto& [key, value] : stats.counters)
    if (key == name) return value;
  return 0;
}

std::uint64_t LayerPicture::error_pixels() const {
  return static_cast<std::uint64_t>(std::ranges::count(errors.pixels(), 255));
}

LayerPicture take(Painter& renderer, LayerProgram& program, bool with_overdraw) {
  return take_with(renderer, with_overdraw, [&](const Targets& targets) {
    return renderer.draw(program.draws(), program.shader(), program.test(), targets);
  });
}

LayerPicture take(Painter& renderer, LayerProgram& program, const raster::BlockShader& shader) {
  return take_with(renderer, false, [&](const Targets& targets) {
    return renderer.draw(program.draws(), shader, program.test(), targets);
  });
}

LayerPicture take(Painter& renderer, const SceneView& scene, const Camera& camera,
                  bool with_overdraw) {
  return take_with(renderer, with_overdraw,
                   [&](const Targets& targets) { return renderer.render(scene, camera, targets); });
}

double blend_bound(std::uint32_t layers) {
  return (4.0 * layers + 16) * 0x1p-24;
}

AssertionResult equals_oracle(const LayerPicture& picture, const LayerImage& oracle, Check check) {
  for (std::size_t i = 0; i < oracle.color.size(); ++i) {
    const auto failed = [&](const char* what) {
      const auto width = static_cast<std::size_t>(oracle.width);
      return AssertionFailure() << what << " differs at (" << i % width << ", " << i / width
                                << ") of " << oracle.layers[i] << " layers: ";
    };
    if (picture.ids.pixels()[i] != oracle.ids[i])
      return failed("id") << picture.ids.pixels()[i] << " and " << oracle.ids[i];
    const float depth = picture.depth.pixels()[i];
    if (std::bit_cast<std::uint32_t>(depth) != std::bit_cast<std::uint32_t>(oracle.depth[i]))
      return failed("depth") << depth << " and " << oracle.depth[i];
    const auto check_color = [&](const char* what, const Channels& got, const Channels& want,
                                 double bound) -> AssertionResult {
      if (most_apart(got, want) <= bound) return AssertionSuccess();
      return failed(what) << testing::PrintToString(got) << " and " << testing::PrintToString(want)
                          << ", off by " << most_apart(got, want) << " where " << bound
                          << " is the bound";
    };
    const Rgba64& exact = oracle.color[i];
    const Vec4 c = picture.color.pixels()[i];
    if (check == Check::all)
      if (auto r = check_color("colour", {c.x, c.y, c.z, c.w}, {exact.r, exact.g, exact.b, exact.a},
                               blend_bound(oracle.layers[i]));
          !r)
        return r;
    const Rgba8 c8 = picture.color8.pixels()[i];
    const Channels got8{double(c8.r), double(c8.g), double(c8.b), double(c8.a)};
    if (auto r = check_color("8-bit colour", got8, levels(exact), 1); !r) return r;
  }
  return AssertionSuccess();
}

bool same_color_bits(const LayerPicture& a, const LayerPicture& b, std::size_t pixel) {
  return same_pixel(a.color.pixels()[pixel], b.color.pixels()[pixel]) &&
         a.color8.pixels()[pixel] == b.color8.pixels()[pixel];
}

AssertionResult same_bits(const LayerPicture& a, const LayerPicture& b) {
  return same_images(a, b, kPicture);
}

}  // namespace rastrum::test
