// SPDX-License-Identifier: BSD-3-Clause
// Environments of our own, drawn from a few formulas.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <rastrum/core/angle.hpp>
#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/environment.hpp>

namespace rastrum {
namespace {

constexpr int kBuiltinRows = 512;

Vec3 mixed_light(Vec3 a, Vec3 b, double t) {
  const auto s = static_cast<float>(std::clamp(t, 0.0, 1.0));
  return a * (1 - s) + b * s;
}

Vec3 sky_at(const Vec3d& d) {
  constexpr Vec3 kZenith{0.16F, 0.32F, 0.75F}, kHorizon{0.80F, 0.88F, 1.0F},
      kHaze{0.55F, 0.55F, 0.54F}, kGround{0.22F, 0.21F, 0.20F}, kSun{240, 225, 195},
      kGlow{1.6F, 1.3F, 0.9F};
  static const Vec3d to_sun = [] {
    const SinCos up = sin_cos_degrees(42), across = sin_cos_degrees(38);
    return Vec3d{up.cos * across.sin, up.sin, up.cos * across.cos};
  }();
  if (d.y < 0) return mixed_light(kHaze, kGround, std::sqrt(-d.y) * 1.6);
  const Vec3 air = mixed_light(kHorizon, kZenith, std::sqrt(d.y));
  const double cosine = d.x * to_sun.x + d.y * to_sun.y + d.z * to_sun.z;
  // A disc of 2.5° with a soft edge of half a degree, and light that the air scatters around it.
  const double edge = (cosine - 0.99905) / (0.99965 - 0.99905);
  const double glow = std::max(cosine, 0.0);
  const double g2 = glow * glow, g4 = g2 * g2, g8 = g4 * g4, g32 = (g8 * g8) * (g8 * g8);
  return mixed_light(air + kGlow * static_cast<float>(g32), kSun, edge);
}

struct WallLamp {
  double u0, u1, v0, v1;
  Vec3 light;

  [[nodiscard]] Vec3 on(Vec3 wall, double u, double v) const {
    constexpr double kEdge = 0.08;
    const double inside = std::min({u - u0, u1 - u, v - v0, v1 - v});
    return mixed_light(wall, light, inside / kEdge);
  }
};

/// A room of 8 × 5 × 8 around the eye.
Vec3 room_at(const Vec3d& d) {
  constexpr double kAside = 4, kAbove = 3, kBelow = 2;
  constexpr WallLamp kCeiling[] = {{-3, -0.6, -2.6, 0.4, {5.4F, 5.2F, 4.8F}},
                                   {1.0, 2.6, -1.5, 2.4, {4.2F, 4.5F, 4.8F}}};
  constexpr WallLamp kRight{-1.6, 1.6, -0.6, 1.8, {2.6F, 2.2F, 1.7F}};
  constexpr WallLamp kLeft{-2.4, -0.2, -0.4, 1.2, {1.0F, 1.4F, 2.0F}};
  constexpr WallLamp kBehind{-2.6, 2.6, 0.4, 1.4, {1.8F, 1.8F, 1.8F}};
  const double tx = kAside / std::max(std::abs(d.x), 1e-9);
  const double tz = kAside / std::max(std::abs(d.z), 1e-9);
  const double ty = (d.y > 0 ? kAbove : kBelow) / std::max(std::abs(d.y), 1e-9);
  const double t = std::min({tx, ty, tz});
  const Vec3d p = d * t;
  if (t == ty && d.y > 0) {
    Vec3 ceiling{0.42F, 0.41F, 0.40F};
    for (const WallLamp& lamp : kCeiling) ceiling = lamp.on(ceiling, p.x, p.z);
    return ceiling;
  }
  if (t == ty) return {0.16F, 0.148F, 0.136F};
  const auto height = static_cast<float>((p.y + kBelow) / (kAbove + kBelow));
  const Vec3 wall = Vec3{0.24F, 0.25F, 0.27F} * (0.55F + 0.6F * height);
  if (t == tx) return (d.x > 0 ? kRight : kLeft).on(wall, p.z, p.y);
  return d.z > 0 ? kBehind.on(wall, p.x, p.y) : wall;
}

}  // namespace

Image<Vec3> builtin_environment(BuiltinEnvironment which) {
  const FloatScope floats;
  Image<Vec3> picture(2 * kBuiltinRows, kBuiltinRows);
  const double step = std::numbers::pi / kBuiltinRows;
  for (int y = 0; y < kBuiltinRows; ++y) {
    const auto [sin, cos] = elementary::sin_cos((y + 0.5) * step);
    for (int x = 0; x < 2 * kBuiltinRows; ++x) {
      const auto across = elementary::sin_cos((x + 0.5) * step - std::numbers::pi);
      const Vec3d d{sin * across.sin, cos, -sin * across.cos};
      picture(x, y) = which == BuiltinEnvironment::room ? room_at(d) : sky_at(d);
    }
  }
  return picture;
}

}  // namespace rastrum
