// Numbers in 32 bits and distances with another number where nothing is (Targets): what the wide
// ones hold, in every way a block is resolved.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include <tests/support/isa.hpp>

namespace rastrum::narrow_outputs_test {
namespace {

constexpr int kW = 75, kH = 61;  // blocks that the edge cuts

struct Numbers {
  Image<std::int64_t> ids{kW, kH}, instances{kW, kH}, primitives{kW, kH};
  Image<std::int32_t> ids32{kW, kH}, instances32{kW, kH}, primitives32{kW, kH};
  Image<float> depth{kW, kH}, view_depth{kW, kH}, distance{kW, kH};
  Image<Rgba8> color8{kW, kH};
};

/// Two meshes and spheres, so that ids, instances and primitives differ.
Scene subject() {
  Scene scene = shapes::scene_from_spec("torus_knot?segments=60");
  scene.append(shapes::scene_from_spec("spheres?count=20"));
  scene.append(shapes::scene_from_spec("boxes?count=2"));
  return scene;
}

void expect_same(const Scene& scene, const FrameOptions& frame, const RendererOptions& options) {
  const SceneBinding binding(scene);
  const Camera camera = fit_camera(binding.view(), 1, false);
  Renderer renderer(options);
  Numbers n;
  // One by one too: none may need another.
  renderer.render(binding.view(), camera, frame,
                  {.color8 = n.color8,
                   .ids = n.ids,
                   .instances = n.instances,
                   .primitives = n.primitives,
                   .view_depth = n.view_depth,
                   .distance = n.distance});
  renderer.render(binding.view(), camera, frame, {.ids32 = n.ids32});
  renderer.render(binding.view(), camera, frame, {.instances32 = n.instances32});
  renderer.render(binding.view(), camera, frame, {.primitives32 = n.primitives32});
  Image<float> view_depth(kW, kH), distance(kW, kH);
  renderer.render(binding.view(), camera, frame,
                  {.view_depth = view_depth, .distance = distance, .no_distance = -7});
  bool is_seen = false, is_empty = false;
  for (int y = 0; y < kH; ++y)
    for (int x = 0; x < kW; ++x) {
      ASSERT_EQ(n.ids32(x, y), n.ids(x, y));
      ASSERT_EQ(n.instances32(x, y), n.instances(x, y));
      ASSERT_EQ(n.primitives32(x, y), n.primitives(x, y));
      const bool nothing = std::isinf(n.view_depth(x, y));
      ASSERT_EQ(view_depth(x, y), nothing ? -7 : n.view_depth(x, y));
      ASSERT_EQ(distance(x, y), nothing ? -7 : n.distance(x, y));
      (n.ids(x, y) < 0 ? is_empty : is_seen) = true;
    }
  EXPECT_TRUE(is_seen && is_empty);
}

TEST(NarrowOutputs, HoldWhatTheWideOnesDo) {
  const Scene scene = subject();
  const FrameOptions plain{.width = kW, .height = kH};
  for (const Isa isa : available_isas()) expect_same(scene, plain, {.threads = 2, .isa = isa});
  expect_same(scene, plain, {.device = Device::serial});
  FrameOptions translucent = plain, sampled = plain;
  translucent.opacity = 0.5F;
  sampled.samples = 4;
  expect_same(scene, translucent, {});
  expect_same(scene, sampled, {});
}

TEST(NarrowOutputs, CountFromPassToPass) {
  const Scene scene = shapes::scene_from_spec("boxes?count=2");
  const SceneBinding binding(scene);
  const Camera camera = fit_camera(binding.view(), 1, false);
  const FrameOptions frame{.width = kW, .height = kH};
  Renderer renderer;
  Image<std::uint64_t> keys(kW, kH);
  Image<std::int32_t> ids(kW, kH);
  Image<std::int64_t> wide(kW, kH);
  renderer.render(binding.view(), camera, frame, {.ids = wide});
  renderer.render(SceneView{}, camera, frame, {.keys = keys});
  renderer.render(binding.view(), camera, frame,
                  {.ids32 = ids, .keys = keys, .load = true, .first_id = 100});
  for (std::size_t i = 0; i < wide.pixels().size(); ++i)
    if (wide.pixels()[i] >= 0) {
      ASSERT_EQ(ids.pixels()[i], wide.pixels()[i] + 100);
    }
}

TEST(NarrowOutputs, RefuseNumbersThatDoNotFit) {
  const Scene scene = shapes::scene_from_spec("boxes?count=1");
  const SceneBinding binding(scene);
  std::vector<InstanceView> instances(binding.view().instances.begin(),
                                      binding.view().instances.end());
  SceneView view = binding.view();
  view.instances = instances;
  const Camera camera = fit_camera(view, 1, false);
  const FrameOptions frame{.width = kW, .height = kH};
  Renderer renderer;
  Image<std::int32_t> numbers(kW, kH);
  Image<std::uint64_t> keys(kW, kH);
  const auto refused = [&](const Targets& targets) {
    try {
      renderer.render(view, camera, frame, targets);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused({.instances32 = numbers}), "");
  instances[0].id = std::int64_t{1} << 31;
  EXPECT_NE(refused({.instances32 = numbers}).find("instances32"), std::string::npos);
  instances[0].id = -(std::int64_t{1} << 31);
  EXPECT_EQ(refused({.instances32 = numbers}), "");
  renderer.render(SceneView{}, camera, frame, {.keys = keys});
  EXPECT_NE(refused({.ids32 = numbers, .keys = keys, .load = true, .first_id = 0x7fffffff})
                .find("ids32 target has 32 bits"),
            std::string::npos);
  Image<std::int32_t> small(kW, kH - 1);
  EXPECT_NE(refused({.primitives32 = small}).find("primitives32"), std::string::npos);
}

}  // namespace
}  // namespace rastrum::narrow_outputs_test
