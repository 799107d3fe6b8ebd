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

Vec4 straight(const Rgba64& c) {
  const double scale = c.a > 0 ? 1 / c.a : 1;
  const auto level = [](double v) {
    return static_cast<float>(std::nearbyint(std::clamp(v, 0.0, 1.0) * 255));
  };
  return {level(c.r * scale), level(c.g * scale), level(c.b * scale), level(c.a)};
}

std::array<std::uint32_t, 4> bits(Vec4 c) {
  return {std::bit_cast<std::uint32_t>(c.x), std::bit_cast<std::uint32_t>(c.y),
          std::bit_cast<std::uint32_t>(c.z), std::bit_cast<std::uint32_t>(c.w)};
}

AssertionResult failed_at(const char* what, std::size_t pixel, int width) {
  const auto w = static_cast<std::size_t>(width);
  return AssertionFailure() << what << " differs at (" << pixel % w << ", " << pixel / w << "): ";
}

void show(AssertionResult& out, Vec4 c) {
  out << "(" << c.x << " " << c.y << " " << c.z << " " << c.w << ")";
}
void show(AssertionResult& out, Rgba8 c) {
  out << "(" << int{c.r} << " " << int{c.g} << " " << int{c.b} << " " << int{c.a} << ")";
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
    if (picture.ids.pixels()[i] != oracle.ids[i])
      return failed_at("id", i, oracle.width)
             << picture.ids.pixels()[i] << " and " << oracle.ids[i];
    const float depth = picture.depth.pixels()[i];
    if (std::bit_cast<std::uint32_t>(depth) != std::bit_cast<std::uint32_t>(oracle.depth[i]))
      return failed_at("depth", i, oracle.width) << depth << " and " << oracle.depth[i];
    const Rgba64& exact = oracle.color[i];
    const Vec4 c = picture.color.pixels()[i];
    const double error = std::max({std::abs(c.x - exact.r), std::abs(c.y - exact.g),
                                   std::abs(c.z - exact.b), std::abs(c.w - exact.a)});
    if (check == Check::all && !(error <= blend_bound(oracle.layers[i]))) {
      AssertionResult failure = failed_at("colour", i, oracle.width);
      show(failure, c);
      return failure << " and (" << exact.r << " " << exact.g << " " << exact.b << " " << exact.a
                     << "), off by " << error << " where " << blend_bound(oracle.layers[i])
                     << " is the bound of " << oracle.layers[i] << " layers";
    }
    const Vec4 levels = straight(exact);
    const Rgba8 c8 = picture.color8.pixels()[i];
    const float off = std::max({std::abs(static_cast<float>(c8.r) - levels.x),
                                std::abs(static_cast<float>(c8.g) - levels.y),
                                std::abs(static_cast<float>(c8.b) - levels.z),
                                std::abs(static_cast<float>(c8.a) - levels.w)});
    if (off > 1) {
      AssertionResult failure = failed_at("8-bit colour", i, oracle.width);
      show(failure, c8);
      failure << " and ";
      show(failure, levels);
      return failure << ", " << oracle.layers[i] << " layers";
    }
  }
  return AssertionSuccess();
}

bool same_color_bits(const LayerPicture& a, const LayerPicture& b, std::size_t pixel) {
  return bits(a.color.pixels()[pixel]) == bits(b.color.pixels()[pixel]) &&
         a.color8.pixels()[pixel] == b.color8.pixels()[pixel];
}

AssertionResult same_bits(const LayerPicture& a, const LayerPicture& b) {
  return same_images(a, b, kPicture);
}

}  // namespace rastrum::test
