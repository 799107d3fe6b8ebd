// SPDX-License-Identifier: BSD-3-Clause
// Ambient occlusion, plain: the reference that occlusion_simd.cpp follows operation by operation.
// McGuire, Mara and Luebke, Scalable Ambient Obscurance (HPG 2012), section 2.3: around a point P
// with normal n, samples Q of the picture within a radius take
//   max(1 − v², 0)³ · max(v · n − bias, 0) / (v² + ε),  v = (Q − P) / radius,
// of its light. Samples lie on a spiral of golden angles, turned from pixel to pixel in a pattern
// of 4 × 4 that the blur averages. The paper's hierarchy of depths is left out: it saves a GPU's
// memory traffic.
#include <rastrum/overlay/effects/occlusion.hpp>

#include <algorithm>
#include <cmath>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>
#include <rastrum/overlay/effects/lens.hpp>

namespace rastrum::overlay {
namespace {

Vec3 position(const OcclusionFrame& f, int x, int y, float depth) {
  const float px = static_cast<float>(x) + 0.5F, py = static_cast<float>(y) + 0.5F;
  const float u = (f.ux * px + f.uy * py) + f.u0, v = f.vy * py + f.v0;
  const float e = depth * f.per_radius, s = f.perspective ? e : 1.0F;
  return {u * s, v * s, -e};
}

// Positions in units of the radius are float32. Radii from kSmallRadius on are too small only for
// depths beyond 10¹², where radii are as large, and are not checked.
constexpr double kSmallRadius = 1e-18, kMostRadii = 1e30;

double farthest(ImageView<const float> depth) {
  float most = 0;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x)
      if (const float d = depth(x, y); d < kFarthest) most = std::max(most, d);
  return double{most};
}

}  // namespace

bool occlusion_plain(const OcclusionFrame& f, int y, int begin, int end, float* out) {
  const int right = f.depth.width - 1, bottom = f.depth.height - 1;
  bool some = false;
  for (int x = begin; x < end; ++x) {
    const float depth = f.depth(x, y);
    if (!(depth < kFarthest)) {
      out[x] = 1;
      continue;
    }
    some = true;
    const Vec3 p = position(f, x, y, depth);
    const Vec3 n = f.normals.empty() ? normal_from_depth(f, x, y) : f.normals(x, y);
    const float reach = std::min(f.perspective ? f.reach_px / depth : f.reach_px, f.most_px);
    const float bias = kOcclusionBias - p.z * kBiasPerDistance;
    float sum = 0;
    for (int k = 0; k < f.samples; ++k) {
      const auto lane = x % kPatternLanes;
      const int qx = x + static_cast<int>(std::nearbyint(f.offsets(y, k, 0)[lane] * reach));
      const int qy = y + static_cast<int>(std::nearbyint(f.offsets(y, k, 1)[lane] * reach));
      if (qx < 0 || qx > right || qy < 0 || qy > bottom) continue;
      const float there = f.depth(qx, qy);
      if (!(there < kFarthest)) continue;
      const Vec3 q = position(f, qx, qy, there);
      const float vx = q.x - p.x, vy = q.y - p.y, vz = q.z - p.z;
      const float vv = (vx * vx + vy * vy) + vz * vz, vn = (vx * n.x + vy * n.y) + vz * n.z;
      const float near = std::max(1.0F - vv, 0.0F);
      sum = sum + ((near * near) * near) * std::max(vn - bias, 0.0F) / (vv + kOcclusionEpsilon);
    }
    out[x] = std::max(1.0F - f.weight * sum, 0.0F);
  }
  return some;
}

void blur_plain(const OcclusionFrame& f, const float* in, int y, BlurTaps taps, int begin, int end,
                float* out) {
  const int dx = taps.down ? 0 : 1, dy = 1 - dx;
  for (int x = begin; x < end; ++x) {
    const float depth = f.depth(x, y);
    if (!(depth < kFarthest)) {
      out[x] = 1;
      continue;
    }
    float sum = 0, weights = 0;
    for (int i = -2; i <= 2; ++i) {
      const int qx = x + i * dx, qy = y + i * dy;
      if (qx < 0 || qx >= f.depth.width || qy < 0 || qy >= f.depth.height) continue;
      const float apart = std::fabs(f.depth(qx, qy) - depth) * f.per_radius;
      const float share = i == -2 || i == 2 ? 0.5F : 1.0F;
      const float weight = share * std::max(1.0F - apart * kBlurSharpness, 0.0F);
      sum = sum + weight * in[x + i * taps.step];
      weights = weights + weight;
    }
    out[x] = sum / weights;
  }
}

void load_each(const float* from, const std::int32_t* places, int count, float* out) noexcept {
  int i = 0;
  // Compilers make one store of these four.
  for (; i + 4 <= count; i += 4) {
    const float a = from[places[i]], b = from[places[i + 1]], c = from[places[i + 2]],
                d = from[places[i + 3]];
    out[i] = a;
    out[i + 1] = b;
    out[i + 2] = c;
    out[i + 3] = d;
  }
  for (; i < count; ++i) out[i] = from[places[i]];
}

Vec3 normal_from_depth(const OcclusionFrame& f, int x, int y) {
  const float depth = f.depth(x, y);
  if (!(depth < kFarthest)) return {};
  const Vec3 p = position(f, x, y, depth);
  bool found = true;
  // Towards growing x or y, to the neighbour that is nearer in depth.
  const auto difference = [&](int dx, int dy) {
    Vec3 best{};
    float least = kFarthest;
    for (const int side : {1, -1}) {
      const int qx = x + side * dx, qy = y + side * dy;
      if (qx < 0 || qx >= f.depth.width || qy < 0 || qy >= f.depth.height) continue;
      const float there = f.depth(qx, qy), apart = std::fabs(there - depth);
      if (!(apart < least)) continue;
      least = apart;
      const Vec3 q = position(f, qx, qy, there);
      best = side > 0 ? q - p : p - q;
    }
    found = found && least < kFarthest;
    return best;
  };
  const Vec3 a = difference(1, 0), b = difference(0, 1);
  if (!found) return {};
  // x goes right and y down, so b × a faces the viewer.
  const Vec3 n{b.y * a.z - b.z * a.y, b.z * a.x - b.x * a.z, b.x * a.y - b.y * a.x};
  const float square = (n.x * n.x + n.y * n.y) + n.z * n.z;
  if (!(square > 0)) return {};
  const float length = std::sqrt(square);
  return {n.x / length, n.y / length, n.z / length};
}

OcclusionFrame occlusion_frame(const Surface& surface, const Camera& camera,
                               const AmbientOcclusion& options) {
  const auto refuse = [](const char* what, double got) {
    throw Error(Errc::invalid_argument, text_of("AmbientOcclusion::", what, ", got ", got));
  };
  // Beyond, 1 / radius may leave the range of float32.
  if (!(options.radius >= 1e-37 && options.radius <= 1e37))
    refuse("radius must lie in [1e-37, 1e37]", options.radius);
  if (options.radius < kSmallRadius && farthest(surface.view_depth) > options.radius * kMostRadii)
    refuse("radius must be at least 1e-30 of the picture's depths", options.radius);
  if (!(options.strength >= 0 && options.strength <= 16))
    refuse("strength must lie in [0, 16]", options.strength);
  if (options.samples < 1 || options.samples > kMostSamples)
    refuse("samples must lie in 1 to 64", options.samples);
  const int width = surface.view_depth.width, height = surface.view_depth.height;
  const Lens lens = lens_of(camera, width, height);
  const double scale = lens.perspective ? 1 : 1 / options.radius;
  OcclusionFrame f;
  f.depth = surface.view_depth;
  f.stride = static_cast<int>(surface.view_depth.stride);
  f.normals = surface.normals;
  f.perspective = lens.perspective;
  f.ux = static_cast<float>(lens.ux * scale);
  f.uy = static_cast<float>(lens.uy * scale);
  f.u0 = static_cast<float>(lens.u0 * scale);
  f.vy = static_cast<float>(lens.vy * scale);
  f.v0 = static_cast<float>(lens.v0 * scale);
  f.per_radius = static_cast<float>(1 / options.radius);
  f.reach_px = static_cast<float>(options.radius / std::fabs(lens.ux));
  // Samples farther apart say little about what lies between, and miss every cache.
  f.most_px = static_cast<float>(std::max(width, height)) / 8;
  f.samples = options.samples;
  f.weight =
      static_cast<float>(options.strength * static_cast<double>(kOcclusionScale) / options.samples);
  const auto count = static_cast<std::size_t>(kPatternSide * options.samples * 2 * kPatternLanes);
  f.pattern.resize(count);
  // Turns are sixteenths in the order of a Bayer matrix, so that neighbours differ most.
  constexpr int kTurn[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
  constexpr double kTau = 6.283185307179586, kGolden = 2.399963229728653;
  std::size_t i = 0;
  for (const auto& row : kTurn)
    for (int k = 0; k < options.samples; ++k)
      for (const int axis : {0, 1})
        for (int lane = 0; lane < kPatternLanes; ++lane) {
          const int number = row[lane % kPatternSide];
          // A lattice: each pixel of the pattern has its own sixteenth of both.
          const double turn = number / 16.0, ring = ((11 * number & 15) + 0.5) / 16;
          const double out = (k + ring) / options.samples;
          const auto angle = elementary::sin_cos(kGolden * k + kTau * turn);
          f.pattern[i++] = static_cast<float>(out * (axis == 0 ? angle.cos : angle.sin));
        }
  return f;
}

}  // namespace rastrum::overlay
