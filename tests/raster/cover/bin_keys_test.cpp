// SPDX-License-Identifier: BSD-3-Clause
// Hierarchical Z changes no pixel, and rejects what is hidden.
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::bin_keys_test {
namespace {

// Without an overdraw target, which would turn the rejection off.
Frame surfaces(const RenderOptions& o, const Scene& scene, const Camera& camera) {
  Painter painter(o);
  return draw(painter, SceneBinding(scene).view(), camera, kVisible);
}

RenderOptions options(int width, int height, Device device, std::optional<Isa> isa = {}) {
  return RenderOptions({.width = width, .height = height}, {.device = device, .isa = isa});
}

TEST(BinKeys, ChangesNoPixelOfGeneratedScenes) {
  constexpr int kW = 150, kH = 97;
  EveryWay ways(options(kW, kH, Device::threads), {{}});
  for (std::uint64_t seed = 0; seed < 300 && !testing::Test::HasFailure(); ++seed) {
    const GeneratedScene g = generate(seed, kW, kH);
    SCOPED_TRACE(std::to_string(seed) + " " + g.kind);
    ways.same([&](Painter& painter) { return draw(painter, g.view(), g.camera, kVisible); });
  }
}

// Layers of a grid of triangles in random order, some at equal depths, some tilted.
Scene stack(int layers, int cells, int size, std::uint64_t seed) {
  Random r(seed);
  Mesh mesh;
  for (int layer = 0; layer < layers; ++layer) {
    const double depth = r.integer(1, layers) / (layers + 1.0);
    const double tilt = r.integer(0, 2) == 0 ? 0.2 / layers : 0.0;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int y = 0; y <= cells; ++y)
      for (int x = 0; x <= cells; ++x)
        mesh.positions.push_back(at_pixel(double(x) * size / cells, double(y) * size / cells,
                                          depth + tilt * (x + y) / cells, size, size));
    const auto at = [&](int x, int y) {
      return first + static_cast<std::uint32_t>(y * (cells + 1) + x);
    };
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x)
        mesh.indices.insert(mesh.indices.end(), {at(x, y), at(x, y + 1), at(x + 1, y), at(x + 1, y),
                                                 at(x, y + 1), at(x + 1, y + 1)});
  }
  return single(std::move(mesh));
}

TEST(BinKeys, RejectsWhatIsHiddenAndNothingElse) {
  constexpr int kSize = 256;
  for (const int cells : {1, 3, 16, 40}) {
    const Scene scene = stack(64, cells, kSize, static_cast<std::uint64_t>(cells));
    const Camera camera = pixel_camera(kSize, kSize);
    const Frame expected = surfaces(options(kSize, kSize, Device::serial), scene, camera);
    for (const Isa isa : available_isas()) {
      SCOPED_TRACE(std::to_string(cells) + " cells, " + std::string(name(isa)));
      RenderOptions o = options(kSize, kSize, Device::threads, isa);
      const Frame with = surfaces(o, scene, camera);
      EXPECT_TRUE(same_images(with, expected));
      EXPECT_GT(counter(with.stats, "hidden pieces") + counter(with.stats, "hidden blocks"), 500U);
      EXPECT_LT(with.stats.fragments, expected.stats.fragments / 2);
      o.hierarchical_z = false;
      const Frame without = surfaces(o, scene, camera);
      EXPECT_TRUE(same_images(without, expected));
      EXPECT_EQ(without.stats.fragments, expected.stats.fragments);
    }
  }
}

// The share of its fragments that a threaded frame tested. Its picture must equal the serial one.
double share_drawn(Mesh mesh, Isa isa) {
  constexpr int kSize = 256;
  const Scene scene = single(std::move(mesh));
  const Camera camera = fit_camera(SceneBinding(scene).view(), 1.0F, false);
  const Frame expected = surfaces(options(kSize, kSize, Device::serial), scene, camera);
  const Frame drawn = surfaces(options(kSize, kSize, Device::threads, isa), scene, camera);
  EXPECT_TRUE(same_images(drawn, expected));
  return static_cast<double>(drawn.stats.fragments) / static_cast<double>(expected.stats.fragments);
}

// Half of a closed surface faces away. It is drawn last, so nearly all of it is rejected, in any
// order of the triangles. Turned inside out nothing is rejected, and the picture stays right.
TEST(BinKeys, WhatFacesAwayIsDrawnLast) {
  const Mesh ball = shapes::sphere(24, 48);
  Mesh inside_out = ball;
  for (std::size_t i = 0; i < inside_out.indices.size(); i += 3)
    std::swap(inside_out.indices[i], inside_out.indices[i + 1]);
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(std::string(name(isa)));
    EXPECT_LT(share_drawn(ball, isa), 0.65);
    EXPECT_GT(share_drawn(inside_out, isa), 0.95);
  }
}

}  // namespace
}  // namespace rastrum::test::bin_keys_test
