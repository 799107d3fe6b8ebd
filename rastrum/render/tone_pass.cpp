// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/tone_pass.hpp>

#include <algorithm>
#include <cstddef>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/enum.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/error.hpp>
#include <rastrum/raster/rules/color.hpp>

namespace rastrum {
namespace {

/// Beyond this all curves have reached their end. Its square is finite.
constexpr float kBrightest = 1e9F;

Vec3 each(Vec3 c, float (*curve)(float)) {
  return {curve(c.x), curve(c.y), curve(c.z)};
}

float reinhard(float x) {
  return x / (1 + x);
}

float aces(float x) {
  return (x * (2.51F * x + 0.03F)) / (x * (2.43F * x + 0.59F) + 0.14F);
}

/// Step by step as the specification's sample code.
Vec3 neutral(Vec3 c) {
  constexpr float kStart = 0.8F - 0.04F, kDesaturation = 0.15F;
  const float least = std::min({c.x, c.y, c.z});
  const float offset = least < 0.08F ? least - 6.25F * least * least : 0.04F;
  c = {c.x - offset, c.y - offset, c.z - offset};
  const float peak = std::max({c.x, c.y, c.z});
  if (peak < kStart) return c;
  constexpr float kLeft = 1 - kStart;
  const float now = 1 - kLeft * kLeft / (peak + kLeft - kStart);
  const float scale = now / peak;
  const float white = 1 - 1 / (kDesaturation * (peak - now) + 1);
  const auto mixed = [&](float x) { return x * scale * (1 - white) + now * white; };
  return {mixed(c.x), mixed(c.y), mixed(c.z)};
}

Vec3 toned(Tone tone, Vec3 c) {
  switch (tone) {
    case Tone::reinhard:
      return each(c, reinhard);
    case Tone::aces:
      return each(c, aces);
    case Tone::neutral:
      return neutral(c);
    case Tone::none:
      break;
  }
  return c;
}

}  // namespace

void check_tone(const ToneMapping& mapping) {
  check_enum(mapping.tone, Tone::neutral, "the tone");
  if (!(mapping.exposure_stops >= -32 && mapping.exposure_stops <= 32))
    reject("the exposure must lie in [-32, 32] stops");
}

ToneCurve::ToneCurve(const ToneMapping& mapping)
    : tone_(mapping.tone),
      exposure_(
          static_cast<float>(elementary::pow(2, static_cast<double>(mapping.exposure_stops)))) {}

Vec3 ToneCurve::operator()(Vec3 linear) const {
  const auto exposed = [&](float x) {
    const float e = x * exposure_;
    return e > 0 ? std::min(e, kBrightest) : 0.0F;  // a NaN gives 0
  };
  const Vec3 t = toned(tone_, {exposed(linear.x), exposed(linear.y), exposed(linear.z)});
  return each(t, raster::srgb_from_linear);
}

bool TonePass::wanted(const FrameOptions& frame, const Targets& targets, Shader taken,
                      const Pass& pass) {
  if (frame.tone == ToneMapping{} || (targets.color8.empty() && targets.color.empty()))
    return false;
  if (taken != Shader::material)
    reject("tone mapping needs linear light, which the shader '", name(taken),
           "' does not have; take 'material'");
  if (pass.over || pass.load)
    throw Error(Errc::unsupported, "tone mapping needs a whole picture, not one over another");
  return true;
}

Targets TonePass::targets(const FrameOptions& frame, const Targets& asked) {
  Targets all = asked;
  all.color8 = {};
  all.color = {};
  if (all.linear.empty()) {
    own_linear_ = Image<Vec4>(frame.width, frame.height);
    all.linear = own_linear_.view();
  }
  if (all.depth.empty()) {
    own_depth_ = Image<float>(frame.width, frame.height);
    all.depth = own_depth_.view();
  }
  linear_ = all.linear;
  depth_ = all.depth;
  return all;
}

void TonePass::draw(const FrameOptions& frame, const Targets& asked,
                    parallel::Threads* threads) const {
  const ToneCurve curve(frame.tone);
  const Vec4 nothing = raster::premultiplied_from_straight(frame.background);
  const Rgba8 nothing8 = raster::to_straight_rgba8(nothing);
  const auto row = [&](std::size_t place) {
    const int y = static_cast<int>(place);
    for (int x = 0; x < frame.width; ++x) {
      Vec4 color = nothing;
      Rgba8 color8 = nothing8;
      if (depth_(x, y) > 0) {
        const Vec4 c = raster::straight_from_premultiplied(linear_(x, y));
        const Vec3 display = curve({c.x, c.y, c.z});
        color = raster::premultiplied_from_straight({display.x, display.y, display.z, c.w});
        color8 = raster::to_straight_rgba8(color);
      }
      if (!asked.color.empty()) asked.color(x, y) = color;
      if (!asked.color8.empty()) asked.color8(x, y) = color8;
    }
  };
  parallel::for_each_index(threads, static_cast<std::size_t>(frame.height), row, 8);
}

}  // namespace rastrum
