// SPDX-License-Identifier: BSD-3-Clause
// Materials, alpha masks and drawing over a picture on a device have the bits of the host's scalar
// form. In this program the device is the CPU (CMakeLists.txt).
#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/device_frames.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::cuda_materials_test {
namespace {

constexpr int kWidth = 107, kHeight = 91;

RenderOptions options(Device device, Shader shader = Shader::material) {
  RenderOptions o = device_options(kWidth, kHeight, device);
  o.shader = shader;
  return o;
}

const Camera kNear{.eye = {0.2F, 0.1F, 1.1F}, .near_plane = 0.3F};

using CudaMaterials = CudaTest;

// Opaque, with all textures, normal maps, masks and vertex colours; in one band and in several.
TEST_F(CudaMaterials, EqualSerial) {
  const Viewed seen(everything(), kNear);
  for (const Shader shader : {Shader::material, Shader::phong, Shader::depth, Shader::wireframe}) {
    SCOPED_TRACE(name(shader));
    Painter serial(options(Device::serial, shader));
    const Frame expected = draw(serial, seen);
    ASSERT_GT(expected.stats.triangles.clipped, 0U);
    for (const std::uint64_t limit : {std::uint64_t{0}, std::uint64_t{2300000}}) {
      RenderOptions o = options(Device::cuda, shader);
      o.memory_limit = limit;
      Painter cuda(o);
      const Frame frame = draw(cuda, seen);
      expect_by_device(frame, expected);
      if (shader == Shader::material) {
        EXPECT_EQ(counter(frame.stats, "bands") > 1, limit > 0);
      }
      EXPECT_TRUE(
          holds(frame.stats.why, shader == Shader::wireframe ? "by the host" : "on the device"));
    }
  }
}

// The papers' rasterizers leave tested fragments to the same code, so the visibility that shades at
// once has no colours for them.
TEST_F(CudaMaterials, TheFamilyEqualsSerial) {
  const Viewed seen(everything(), kNear);
  Painter serial(options(Device::serial));
  const Frame expected = draw(serial, seen);
  for (const auto& [rasterizer, visibility] :
       {std::pair{"scanline", "tuple"}, {"binned", "tuple"}, {"tiled", "sorted"}}) {
    SCOPED_TRACE(rasterizer);
    RenderOptions o = options(Device::cuda);
    o.rasterizer = rasterizer;
    o.visibility = visibility;
    Painter cuda(o);
    const Frame frame = draw(cuda, seen);
    expect_by_device(frame, expected);
    EXPECT_EQ(frame.stats.visibility, visibility);
  }
}

// A mask's holes depend only on the fragment, so they show what is behind.
TEST_F(CudaMaterials, MasksShowWhatLiesBehind) {
  Scene scene = everything();
  for (Material& m : scene.materials) m.alpha_mode = AlphaMode::opaque;
  Painter cuda(options(Device::cuda, Shader::id));
  const Frame whole = draw(cuda, SceneBinding(scene).view(), kNear);
  scene.materials[1].alpha_mode = scene.materials[3].alpha_mode = AlphaMode::mask;
  const Frame frame = draw(cuda, SceneBinding(scene).view(), kNear);
  std::uint64_t holes = 0;
  for (std::size_t i = 0; i < whole.ids.pixels().size(); ++i)
    holes += frame.ids.pixels()[i] != whole.ids.pixels()[i];
  EXPECT_GT(holes, 500U);
  EXPECT_EQ(frame.stats.fragments, whole.stats.fragments);
}

// Materials that blend, in linear light or under a lit shader, with an opacity, and with masks
// among them.
TEST_F(CudaMaterials, LayersEqualTheThreads) {
  struct Way {
    Shader shader;
    Transparency method;
    float opacity;
  };
  Scene scene = everything();
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].alpha_texture = 1;
  scene.materials[2].alpha_mode = AlphaMode::blend;
  scene.materials[3].opacity = 0.7F;  // a mask
  const Viewed seen(std::move(scene), kNear);
  std::uint64_t blended = 0;
  for (const Way& way : {Way{Shader::material, Transparency::exact, 1},
                         {Shader::material, Transparency::unsorted, 0.6F},
                         {Shader::material, Transparency::none, 1},
                         {Shader::lambert, Transparency::exact, 1},
                         {Shader::flat, Transparency::exact, 0.7F}}) {
    SCOPED_TRACE(testing::Message() << name(way.shader) << ' ' << way.opacity);
    RenderOptions o = options(Device::threads, way.shader);
    o.transparency.method = way.method;
    o.opacity = way.opacity;
    Painter threads(o), cuda(by(o, Device::cuda));
    const LayerPicture frame = take(cuda, seen);
    expect_by_device(frame, take(threads, seen));
    blended += frame.counter("translucent fragments");
  }
  EXPECT_GT(blended, 10000U);
}

// Without materials, translucent vertex colours imply a material that blends.
TEST_F(CudaMaterials, TranslucentVertexColoursEqualTheThreads) {
  Scene scene = everything();
  scene.materials.clear();
  scene.meshes[0].face_materials.clear();
  const Viewed seen(std::move(scene), kNear);
  for (const Shader shader : {Shader::material, Shader::flat}) {
    Painter threads(options(Device::threads, shader)), cuda(options(Device::cuda, shader));
    const LayerPicture frame = take(cuda, seen);
    expect_by_device(frame, take(threads, seen));
    EXPECT_GT(frame.counter("translucent fragments"), 1000U);
  }
}

TEST_F(CudaMaterials, TexturesAreCopiedWhenTheyAreNew) {
  Scene scene = everything();
  Painter serial(options(Device::serial)), cuda(options(Device::cuda));
  const auto copied = [&] {
    const SceneBinding binding(scene);
    const Frame frame = draw(cuda, binding.view(), kNear);
    EXPECT_TRUE(same_picture(frame, draw(serial, binding.view(), kNear), 0));
    return counter(frame.stats, "textures copied");
  };
  // Each of the three is a colour for one material and data for another.
  EXPECT_EQ(copied(), 6U);
  EXPECT_EQ(copied(), 0U);
  scene.textures[0].wrap_u = Wrap::clamp_to_edge;  // changes no texel
  EXPECT_EQ(copied(), 0U);
  for (Rgba8& texel : scene.textures[2].image.pixels()) texel.g ^= 0xff;
  EXPECT_EQ(copied(), 2U);
}

/// A picture with `second` drawn over `first`.
Frame drawn_over(const RenderOptions& o, const SceneView& first, const SceneView& second) {
  Painter renderer(o);
  Frame frame = draw(renderer, first, kNear);
  const Targets targets{.color8 = frame.color8.view(),
                        .color = frame.color.view(),
                        .depth = frame.depth.view(),
                        .ids = frame.ids.view()};
  frame.stats = renderer.render(second, kNear, targets, {.over = true});
  return frame;
}

TEST_F(CudaMaterials, PicturesDrawnOverEqualTheThreads) {
  const Scene masks = everything();
  Scene behind = everything(), blending = everything();
  for (Vec3& p : behind.meshes[0].positions) p = {p.y, p.z, p.x};
  blending.materials[0].alpha_mode = AlphaMode::blend;
  const SceneBinding first(behind);
  struct Way {
    const Scene* scene;
    Shader shader;
    bool on_device;
  };
  for (const Way& way : {Way{&masks, Shader::material, true},
                         {&masks, Shader::flat, true},
                         {&masks, Shader::wireframe, true},
                         {&blending, Shader::phong, true},
                         {&blending, Shader::material, false}}) {
    SCOPED_TRACE(name(way.shader));
    const SceneBinding second(*way.scene);
    const Frame expected =
        drawn_over(options(Device::threads, way.shader), first.view(), second.view());
    for (const std::uint64_t limit : {std::uint64_t{0}, std::uint64_t{2500000}}) {
      RenderOptions o = options(Device::cuda, way.shader);
      o.memory_limit = limit;
      o.threads = 1;  // each thread has its own memory
      const Frame frame = drawn_over(o, first.view(), second.view());
      EXPECT_EQ(frame.stats.device == Device::cuda, way.on_device) << frame.stats.device_why;
      if (way.on_device && way.shader == Shader::material) {
        EXPECT_EQ(counter(frame.stats, "bands") > 1, limit > 0);
      }
      EXPECT_TRUE(same_images(frame, expected, kPicture));
      EXPECT_EQ(frame.stats.pixels_covered, expected.stats.pixels_covered);
    }
    EXPECT_GT(expected.stats.pixels_covered, 500U);
    EXPECT_LT(expected.stats.pixels_covered, 9000U);
  }
}

// More pieces are tested than fit into the queue of a small memory. Still each fragment is drawn
// once over the existing picture, by the device's shaders, by the host's, and in layers.
TEST_F(CudaMaterials, PicturesDrawnOverInLittleMemoryEqualTheThreads) {
  constexpr int kAcross = 128, kDown = 100;
  const Viewed first(single(shapes::soup(40, 0.3F, 0.9F))),
      second(single(shapes::soup(20000, 0.01F, 0.2F)));
  struct Way {
    Shader shader;
    float opacity;
  };
  for (const Way& way : {Way{Shader::flat, 1}, {Shader::wireframe, 1}, {Shader::phong, 0.4F}}) {
    SCOPED_TRACE(name(way.shader));
    const auto drawn = [&](Device device, std::uint64_t limit) {
      RenderOptions o = device_options(kAcross, kDown, device);
      o.shader = way.shader;
      Painter opaque(o);
      o.opacity = way.opacity;
      o.memory_limit = limit;
      Painter renderer(o);
      Frame frame(kAcross, kDown, way.opacity == 1 ? kCounted : kPicture);
      Targets targets{.color8 = frame.color8, .depth = frame.depth, .ids = frame.ids};
      (void)opaque.render(first.view(), first.camera, targets);
      if (way.opacity == 1) targets.overdraw = frame.overdraw;
      frame.stats = renderer.render(second.view(), second.camera, targets, {.over = true});
      return frame;
    };
    const Frame expected = drawn(Device::threads, 0);
    for (const std::uint64_t limit : {std::uint64_t{0}, std::uint64_t{3} << 20}) {
      const Frame frame = drawn(Device::cuda, limit);
      ASSERT_EQ(frame.stats.device, Device::cuda) << frame.stats.device_why;
      EXPECT_EQ(counter(frame.stats, "bands listed") > 0, limit > 0);
      EXPECT_TRUE(same_images(frame, expected, kColor8 | kIds | kOverdraw));
      EXPECT_EQ(frame.stats.pixels_covered, expected.stats.pixels_covered);
      EXPECT_EQ(frame.stats.fragments, drawn(Device::cuda, 0).stats.fragments);
    }
    EXPECT_GT(expected.stats.pixels_covered, 4000U);
  }
}

TEST_F(CudaMaterials, ACallersDiscardIsTheCPUs) {
  const Program program(
      [](std::uint32_t v) {
        return VertexOutput<Vec4>{{v == 1 ? 3.0F : -1.0F, v == 2 ? 3.0F : -1.0F, 0.5F, 1}, {}};
      },
      [](const Vec4&, const Fragment&) {
        return Vec4{1, 0, 0, 1};
      },
      [](const Vec4&, const Fragment& f) { return f.x % 2 == 0; });
  raster::Draw one = program.draw(3);
  Painter cuda(options(Device::cuda)), threads(options(Device::threads));
  const Frame frame = draw(cuda, {&one, 1}, program, program);
  EXPECT_EQ(frame.stats.device, Device::threads);
  EXPECT_TRUE(holds(frame.stats.device_why, "discard"));
  EXPECT_TRUE(same_surfaces(frame, draw(threads, {&one, 1}, program, program)));
}

}  // namespace
}  // namespace rastrum::test::cuda_materials_test
