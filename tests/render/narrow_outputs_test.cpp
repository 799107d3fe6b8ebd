// SPDX-License-Identifier: BSD-3-Clause
// 32-bit numbers, and distances with another empty value (Targets), equal the wide ones, in every
// way in which a block is resolved.
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::narrow_outputs_test {
namespace {

constexpr int kW = 75, kH = 61;  // the edge cuts blocks

/// Two meshes and spheres, so that ids, instances and primitives differ.
Scene subject() {
  Scene scene = shapes::scene_from_spec("torus_knot?segments=60");
  scene.append(shapes::scene_from_spec("spheres?count=20"));
  scene.append(shapes::scene_from_spec("boxes?count=2"));
  return scene;
}

void expect_same(const Fitted& scene, const FrameOptions& frame, const RendererOptions& options) {
  Renderer renderer(options);
  const Frame wide = draw(renderer, scene.view, scene.camera, frame,
                          kColor8 | kIds | kInstances | kPrimitives | kViewDepth | kDistance);
  // One by one, because none may depend on another.
  const auto narrow = [&](ImageView<std::int32_t> Targets::*target) {
    Image<std::int32_t> image(kW, kH);
    Targets targets;
    targets.*target = image;
    renderer.render(scene.view, scene.camera, frame, targets);
    return image;
  };
  const auto ids = narrow(&Targets::ids32), instances = narrow(&Targets::instances32),
             primitives = narrow(&Targets::primitives32);
  Image<float> view_depth(kW, kH), distance(kW, kH);
  FrameOptions another = frame;
  another.no_distance = -7;
  renderer.render(scene.view, scene.camera, another,
                  {.view_depth = view_depth, .distance = distance});
  bool is_seen = false, is_empty = false;
  for (const auto& [x, y] : pixels(kW, kH)) {
    ASSERT_EQ(ids(x, y), wide.ids(x, y));
    ASSERT_EQ(instances(x, y), wide.instances(x, y));
    ASSERT_EQ(primitives(x, y), wide.primitives(x, y));
    const bool nothing = std::isinf(wide.view_depth(x, y));
    ASSERT_EQ(view_depth(x, y), nothing ? -7 : wide.view_depth(x, y));
    ASSERT_EQ(distance(x, y), nothing ? -7 : wide.distance(x, y));
    (wide.ids(x, y) < 0 ? is_empty : is_seen) = true;
  }
  EXPECT_TRUE(is_seen && is_empty);
}

TEST(NarrowOutputs, HoldWhatTheWideOnesDo) {
  const Fitted scene(subject(), 1);
  const FrameOptions plain{.width = kW, .height = kH};
  for (const Isa isa : available_isas()) expect_same(scene, plain, {.threads = 2, .isa = isa});
  expect_same(scene, plain, {.device = Device::serial});
  expect_same(scene, {.width = kW, .height = kH, .opacity = 0.5F}, {});
  expect_same(scene, {.width = kW, .height = kH, .samples = 4}, {});
}

TEST(NarrowOutputs, CountFromPassToPass) {
  const Fitted scene(shapes::scene_from_spec("boxes?count=2"), 1);
  const FrameOptions frame{.width = kW, .height = kH};
  Renderer renderer;
  Image<std::uint64_t> keys(kW, kH);
  Image<std::int32_t> ids(kW, kH);
  const Frame wide = draw(renderer, scene.view, scene.camera, frame, kIds);
  renderer.render(SceneView{}, scene.camera, frame, {.keys = keys});
  renderer.render(scene.view, scene.camera, frame, {.ids32 = ids, .keys = keys},
                  {.load = true, .first_id = 100});
  for (std::size_t i = 0; i < ids.pixels().size(); ++i)
    if (wide.ids.pixels()[i] >= 0) {
      ASSERT_EQ(ids.pixels()[i], wide.ids.pixels()[i] + 100);
    }
}

TEST(NarrowOutputs, RefuseNumbersThatDoNotFit) {
  const Fitted scene(shapes::scene_from_spec("boxes?count=1"), 1);
  std::vector<InstanceView> instances(scene.view.instances.begin(), scene.view.instances.end());
  SceneView view = scene.view;
  view.instances = instances;
  const FrameOptions frame{.width = kW, .height = kH};
  Renderer renderer;
  Image<std::int32_t> numbers(kW, kH), small(kW, kH - 1);
  Image<std::uint64_t> keys(kW, kH);
  const auto message = [&](const Targets& targets, const Pass& pass = {}) {
    return error_message_of([&] { renderer.render(view, scene.camera, frame, targets, pass); });
  };
  EXPECT_EQ(message({.instances32 = numbers}), "");
  instances[0].id = std::int64_t{1} << 31;
  EXPECT_TRUE(holds(message({.instances32 = numbers}), "instances32"));
  instances[0].id = -(std::int64_t{1} << 31);
  EXPECT_EQ(message({.instances32 = numbers}), "");
  renderer.render(SceneView{}, scene.camera, frame, {.keys = keys});
  EXPECT_TRUE(
      holds(message({.ids32 = numbers, .keys = keys}, {.load = true, .first_id = 0x7fffffff}),
            "ids32 target has 32 bits"));
  EXPECT_TRUE(holds(message({.primitives32 = small}), "primitives32"));
}

}  // namespace
}  // namespace rastrum::test::narrow_outputs_test
