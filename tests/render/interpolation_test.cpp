// SPDX-License-Identifier: BSD-3-Clause
// Perspective-correct interpolation within 1e-5 relative of Σ(aᵢfᵢ/wᵢ) / Σ(aᵢ/wᵢ), in long double
// at the snapped positions (at the homogeneous ones of a clipped triangle).
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/projection.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::interpolation_test {
namespace {

constexpr int kW = 96, kH = 80;

struct Worst {
  Real error = 0;
  std::string where;
  int samples = 0, clipped = 0;
};

void compare(const Frame& f, const Mesh& mesh, const std::vector<ProjectedTriangle>& projected,
             const std::string& scene, Worst& worst) {
  for (const auto& [x, y] : pixels(kW, kH)) {
    if (f.ids(x, y) < 0) continue;
    const ProjectedTriangle& t = projected[static_cast<std::size_t>(f.ids(x, y))];
    const auto a = exact_weights(t, kW, kH, x, y);
    const Real sum = a[0] + a[1] + a[2];
    // Snapping a clipped triangle may cover a sample just outside, where the weights extrapolate.
    // Only samples inside are compared.
    if (std::ranges::any_of(a, [&](Real v) { return v / sum < 0; })) continue;
    const auto first = static_cast<std::size_t>(3 * t.id);
    Real exact[3] = {0, 0, 0};
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec4 v = mesh.colors.values[mesh.indices[first + c]];
      exact[0] += a[c] / sum * v.x;
      exact[1] += a[c] / sum * v.y;
      exact[2] += a[c] / sum * v.z;
    }
    const Vec4 got = f.color(x, y);
    ++worst.samples;
    worst.clipped += t.fate == Fate::needs_clip;
    const float channels[3] = {got.x, got.y, got.z};
    for (std::size_t c = 0; c < 3; ++c) {
      const Real error = std::abs(channels[c] - exact[c]) / exact[c];
      if (error <= worst.error) continue;
      worst.error = error;
      worst.where = scene + " id " + std::to_string(t.id) + " at " + std::to_string(x) + "," +
                    std::to_string(y) + ": " + std::to_string(channels[c]) + " for " +
                    std::to_string(static_cast<double>(exact[c]));
    }
  }
}

// Triangles of every size, |w| from 0.1 to 4, some through the near plane. Colours stay away from
// 0, so that a relative error is meaningful.
TEST(Interpolation, WithinOneInHundredThousandOfTheExactValue) {
  RenderOptions base({.width = kW, .height = kH, .shader = Shader::flat});
  for (const RenderOptions& way : EveryWay(base, {{.threads = 2}})) {
    SCOPED_TRACE(name_of(way));
    Painter renderer(way);
    Worst worst;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Random random(seed);
      Camera camera{.eye = {0, 0, 0},
                    .target = {0, 0, -1},
                    .fov_rad = random.real32(0.5, 2.0),
                    .near_plane = 0.05F};
      const Placer placer(camera, kW, kH);
      Mesh mesh;
      for (int i = 0; i < 20; ++i) {
        const double size = std::exp(random.real(0, 9));
        const double x = random.real(0, kW), y = random.real(0, kH);
        const bool crossing = random.chance(0.2);
        for (int c = 0; c < 3; ++c) {
          const auto offset = [&] { return random.real(-size, size); };
          Vec3 p = placer.at({x + offset(), y + offset(), random.real(0.1, 4)});
          if (crossing && c == 0) p.z = random.real32(0, 2);  // behind the eye
          mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
          mesh.positions.push_back(p);
          const auto channel = [&] { return random.real32(0.25, 1); };
          mesh.colors.values.push_back({channel(), channel(), channel(), 1});
        }
      }
      const Scene scene = single(std::move(mesh));
      const SceneBinding binding(scene);
      compare(draw(renderer, binding.view(), camera), scene.meshes[0],
              project(binding.view(), camera, kW, kH), "scene " + std::to_string(seed), worst);
    }
    EXPECT_LE(static_cast<double>(worst.error), 1e-5) << worst.where;
    EXPECT_GT(worst.samples, 100000);
    EXPECT_GT(worst.clipped, 1000);
  }
}

}  // namespace
}  // namespace rastrum::test::interpolation_test
