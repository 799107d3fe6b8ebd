// SPDX-License-Identifier: BSD-3-Clause
// Properties of the whole scene, on any ranks: shadows, the range of numbers, boxes, lights and
// cameras; and the root's choice of targets.
#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/ranks/deals.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::whole_scene_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Parts under lights with shadows and without.
FrameOptions lit_frame(Shader shader, int samples) {
  FrameOptions frame = frame_of(shader, 70, 50);
  frame.samples = samples;
  frame.lights = {
      {.kind = AmbientLight{}, .intensity = 0.2F},
      {.kind = DirectionalLight{{0.4F, -1, -0.7F}}, .intensity = 0.6F},
      {.kind = SpotLight{.position = {0.5, 2, 2}, .direction = {-0.2F, -1, -1}}, .intensity = 3}};
  frame.shadows = true;
  return frame;
}

void expect_shadows(const Scene& scene, const FrameOptions& frame) {
  const Whole whole(scene, frame);
  FrameOptions without = frame;
  without.shadows = false;
  ASSERT_FALSE(same_targets(whole.one(), Whole(scene, without).one()))
      << "there is no shadow to be seen";
  for (const int n : {2, 3}) {
    LocalRanks ranks(n);
    SCOPED_TRACE(n);
    whole.expect(ranks, round_robin(n), {}, kThreadRank);
  }
}

TEST(WholeScene, ShadowsAreThoseOfOneRenderer) {
  expect_shadows(PartsScene(3, kParts, false).scene, lit_frame(Shader::phong, 1));
}
TEST(WholeScene, ShadowsOnLayersOfSamples) {
  Scene scene = PartsScene(4, kParts, true).scene;
  for (std::size_t i = 0; i < scene.instances.size(); i += 3) scene.instances[i].opacity = 0.4F;
  expect_shadows(scene, lit_frame(Shader::material, 4));
}

/// Makes a part show numbers from `low` to `high`.
void show(Scene& scene, std::size_t instance, double low, double high, std::uint32_t mapping) {
  Instance& i = scene.instances[instance];
  if (i.geometry) {
    i.scalar = low;
  } else {
    NamedScalars numbers{.name = "t"};
    const std::size_t n = scene.meshes[i.mesh].positions.size();
    for (std::size_t k = 0; k < n; ++k)
      numbers.values.push_back(low +
                               (high - low) * static_cast<double>(k) / static_cast<double>(n - 1));
    scene.meshes[i.mesh].scalars = {numbers};
  }
  i.scalar_mapping = mapping;
}

TEST(WholeScene, NumbersHaveTheRangeOfAll) {
  Scene scene = PartsScene(6, kParts, false).scene;
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    show(scene, i, -1 + static_cast<double>(i), 3 + 2 * static_cast<double>(i), i % 2 == 0 ? 0 : 1);
  scene.shown_scalars = "t";
  scene.scalar_mappings = {{.map = color_map("viridis")},
                           {.map = color_map("turbo"), .logarithmic = true}};
  expect_equal(scene, frame_of(Shader::phong, 60, 40), {1, 3}, 6);
  const SceneBinding binding(scene);
  LocalRanks ranks(2);
  ranks.run([&](Communicator& c) {
    SceneView own = binding.view();
    own.instances = own.instances.subspan(c.rank() == 0 ? 0 : 5, 5);
    const auto mappings = mappings_of_ranks(c, own);
    SceneView first = binding.view();
    first.instances = first.instances.first(10);
    for (std::size_t m = 0; m < 2; ++m)
      EXPECT_EQ(mappings[m].range, scalar_colors(first, m).range()) << m;
  });
}

TEST(WholeScene, NumbersThatAreRefusedAreRefusedOnAll) {
  Scene scene = PartsScene(6, 2, false).scene;
  scene.scalar_mappings = {{.map = color_map("viridis")}};
  scene.instances[0].scalar = -std::numeric_limits<double>::max();
  scene.instances[1].scalar = std::numeric_limits<double>::max();
  const Whole whole(std::move(scene), frame_of(Shader::phong, 20, 20), Camera{.eye = {0, 0, 3}});
  LocalRanks ranks(2);
  Image<Rgba8> image(20, 20);
  expect_refused("too wide", Errc::invalid_argument, [&] {
    whole.draw(ranks, {{0}, {1}}, {.color8 = image});
  });
}

TEST(WholeScene, BoxesLightsAndCamerasOfAll) {
  const PartsScene parts(8, kParts, false);
  const SceneBinding binding(parts.scene);
  const Bounds whole = bounds(binding.view());
  LocalRanks ranks(3);
  ranks.run([&](Communicator& c) {
    SceneView own = binding.view();
    own.instances = c.rank() == 1 ? std::span<const InstanceView>{}
                                  : own.instances.subspan(c.rank() == 0 ? 0 : 11,
                                                          c.rank() == 0 ? 11 : kParts - 11);
    const Bounds all = bounds_of_ranks(c, own);
    EXPECT_TRUE(all.min == whole.min && all.max == whole.max);
    EXPECT_EQ(all.vertices_in_use, whole.vertices_in_use);
    EXPECT_EQ(bounds_of_ranks(c, {}).vertices_in_use, 0U);

    std::vector<Light> lights{{.kind = SpotLight{.position = {1.0 * c.rank(), 2, 3}, .range = 7},
                               .color = {1, 0.5F, 0.25F},
                               .intensity = 4,
                               .of_camera = c.rank() == 1}};
    if (c.rank() == 2) lights = {{.kind = PointLight{{9, 8, 7}}}, {.kind = AmbientLight{}}};
    const std::vector<Light> of_all = lights_of_ranks(c, lights);
    ASSERT_EQ(of_all.size(), 4U);
    const auto& spot = std::get<SpotLight>(of_all[1].kind);
    EXPECT_TRUE(spot.position == (Vec3d{1, 2, 3}) && spot.range == 7 && of_all[1].of_camera);
    EXPECT_TRUE(of_all[1].color == (Vec3{1, 0.5F, 0.25F}) && of_all[1].intensity == 4);
    EXPECT_TRUE(std::get<PointLight>(of_all[2].kind).position == (Vec3d{9, 8, 7}));
    EXPECT_TRUE(std::holds_alternative<AmbientLight>(of_all[3].kind));

    const Camera camera{.eye = {1.0 * c.rank(), 0, 0}};
    const std::vector<Camera> cameras =
        cameras_of_ranks(c, std::span(&camera, c.rank() == 0 ? 0U : 1U));
    ASSERT_EQ(cameras.size(), 2U);
    EXPECT_EQ(cameras[1].eye.x, 2);
  });
  expect_refused("rank 1: the lights of ranks: an environment", Errc::unsupported, [&] {
    ranks.run([](Communicator& c) {
      const Light sky{.kind = EnvironmentLight{}};
      (void)lights_of_ranks(c, std::span(&sky, c.rank() == 1 ? 1U : 0U));
    });
  });
}

TEST(WholeScene, NarrowNumbersAndAnotherDistanceOfNothing) {
  FrameOptions frame = frame_of(Shader::phong, 40, 30);
  frame.no_distance = -1;
  const Whole whole(PartsScene(9, kParts, false).scene, frame);
  struct Narrow {
    Image<std::int32_t> ids{40, 30}, instances{40, 30}, primitives{40, 30};
    Image<float> depth{40, 30}, distance{40, 30};
    [[nodiscard]] Targets targets() {
      return Targets{.ids32 = ids,
                     .instances32 = instances,
                     .primitives32 = primitives,
                     .view_depth = depth,
                     .distance = distance};
    }
  } one, many;
  Renderer renderer({.threads = 1});
  (void)renderer.render(whole.view(), whole.camera, whole.frame, one.targets());
  LocalRanks ranks(3);
  whole.draw(ranks, round_robin(3), many.targets());
  EXPECT_TRUE(std::ranges::equal(one.ids.pixels(), many.ids.pixels()));
  EXPECT_TRUE(std::ranges::equal(one.instances.pixels(), many.instances.pixels()));
  EXPECT_TRUE(std::ranges::equal(one.primitives.pixels(), many.primitives.pixels()));
  EXPECT_TRUE(std::ranges::equal(one.depth.pixels(), many.depth.pixels()));
  EXPECT_TRUE(std::ranges::equal(one.distance.pixels(), many.distance.pixels()));
  EXPECT_EQ(std::ranges::count(many.depth.pixels(), kInfinity), 0);
  EXPECT_GT(std::ranges::count(many.depth.pixels(), -1), 0);
  // A part's number sets its ids, which may need more bits.
  SceneView own = whole.view();
  own.instances = own.instances.first(1);
  LocalRanks two(2);
  expect_refused("instances32: 4294967296 wants 64 bits", Errc::invalid_argument, [&] {
    two.run([&](Communicator& c) {
      const std::uint64_t part = std::uint64_t{1} << 32;
      const bool has_it = c.rank() == 0;
      Renderer its({.threads = 1});
      (void)render_parts(c, its, has_it ? own : SceneView{}, std::span(&part, has_it ? 1 : 0),
                         whole.camera, whole.frame, has_it ? many.targets() : Targets{});
    });
  });
}

}  // namespace
}  // namespace rastrum::test::whole_scene_test
