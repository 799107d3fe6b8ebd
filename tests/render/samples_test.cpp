// SPDX-License-Identifier: BSD-3-Clause
// Several samples of opaque surfaces (raster/frame/sampled_path.hpp) equal the reference, which
// blends layers, bit for bit: on every instruction set, number of threads and memory limit, with
// and without hierarchical Z.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/light.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/layer_scenes.hpp"
#include "tests/support/point_line_scenes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::samples_test {
namespace {

/// `counts` adds overdraw, so that hidden fragments may not be left out.
Frame draw(Renderer& renderer, const SceneView& scene, const Camera& camera, const FrameOptions& o,
           bool counts) {
  return test::draw(renderer, scene, camera, o,
                    kPicture | kInstances | kNormals | (counts ? kOverdraw : 0U));
}

testing::AssertionResult same(const Frame& a, const Frame& b, bool counts) {
  if (auto images = same_images(a, b); !images) return images;
  return counts ? same_counts(a.stats, b.stats) : same_triangles(a.stats, b.stats);
}

/// Renderers of every instruction set, one of them within little memory.
std::vector<Renderer> all_renderers() {
  std::vector<Renderer> all;
  for (const Isa isa : available_isas())
    all.push_back(Renderer({.threads = 1 + static_cast<int>(all.size()) % 3, .isa = isa}));
  all.push_back(Renderer({.memory_limit = std::uint64_t{6} << 20, .threads = 3}));
  return all;
}

class Samples : public testing::Test {
 protected:
  /// `which` chooses one of the renderers.
  void expect_same(const SceneView& scene, const Camera& camera, const FrameOptions& o, int which,
                   const char* visibility = "samples") {
    const bool counts = which % 2 == 0;
    const Frame want = draw(reference_, scene, camera, o, counts);
    Renderer& renderer = all_[static_cast<std::size_t>(which) % all_.size()];
    const Frame got = draw(renderer, scene, camera, o, counts);
    ASSERT_EQ(got.stats.visibility, visibility);
    ASSERT_TRUE(same(got, want, counts));
    for (const Vec4& c : want.color.pixels()) partly_ += c.w > 0.01F && c.w < 0.99F;
    clipped_ += want.stats.triangles.clipped;
  }

  Renderer reference_{{.device = Device::serial}};
  std::vector<Renderer> all_ = all_renderers();
  std::uint64_t partly_ = 0, clipped_ = 0;  ///< pixels, triangles
};

constexpr Shader kShaders[] = {Shader::flat,  Shader::normal, Shader::id,        Shader::lambert,
                               Shader::phong, Shader::depth,  Shader::wireframe, Shader::material};
constexpr int kSamples[] = {4, 8, 16};
constexpr int kSizes[][2] = {{37, 53}, {130, 70}, {8, 8}, {1, 1}, {200, 65}};

FrameOptions options_of(int i, int width = 0, int height = 0) {
  return FrameOptions{.width = width != 0 ? width : kSizes[i % 5][0],
                      .height = height != 0 ? height : kSizes[i % 5][1],
                      .shader = kShaders[i % 8],
                      .background = {0.25F, 0.5F, 0.125F, i % 4 == 0 ? 1.0F : 0.0F},
                      .samples = kSamples[i % 3]};
}

TEST_F(Samples, OfGeneratedScenesAreTheReferences) {
  const std::vector<Light> kit = light_kit();
  std::vector<Light> lights = kit;
  lights.push_back({.kind = PointLight{.position = {1, 2, 3}}});
  // Every shader with every number of samples and size is 120 scenes.
  const int scenes = share_of(360, 20);
  for (int i = 0; i < scenes; ++i) {
    FrameOptions o = options_of(i);
    const GeneratedScene g = generate(static_cast<std::uint64_t>(i), o.width, o.height);
    SCOPED_TRACE(std::to_string(i).append(", ").append(g.kind));
    o.cull = i % 7 == 0 ? Cull::back : i % 11 == 0 ? Cull::front : Cull::none;
    // Lights with a position also depend on the fragment's place, which comes from its depth.
    if (i % 3 == 0) o.lights = i % 2 == 0 ? lights : kit;
    ASSERT_NO_FATAL_FAILURE(expect_same(g.view(), g.camera, o, i));
  }
  EXPECT_GT(partly_, 16U * static_cast<unsigned>(scenes));
  EXPECT_GT(clipped_, static_cast<unsigned>(scenes));
}

TEST_F(Samples, OfPointsAndLinesAreTheReferences) {
  for (int i = 0; i < share_of(120, 20); ++i) {
    SCOPED_TRACE(i);
    FrameOptions o = options_of(i);
    const PointLineScene s =
        generate_points_and_lines(static_cast<std::uint64_t>(i), o.width, o.height);
    ASSERT_NO_FATAL_FAILURE(expect_same(s.view(), s.camera, o, i));
  }
}

// Pieces of a clipped triangle that overlap, or leave out a centre.
TEST_F(Samples, OfClippedTrianglesAreTheReferences) {
  const LayerScene layers = overlapping_pieces();
  const OneInstance scene(layers.mesh.view());
  for (int i = 0; i < 6 * static_cast<int>(all_.size()); ++i) {
    FrameOptions o = options_of(i, 64, 64);
    if (i % 2 == 1) o.lights = {{.kind = PointLight{.position = {1, 2, 3}}}};
    // Odd, so without overdraw: it counts pieces here, triangles in the reference.
    ASSERT_NO_FATAL_FAILURE(expect_same(scene.view(), layers.camera, o, 2 * i + 1));
  }
  EXPECT_GT(clipped_, 0U);
}

// Triangles smaller than the distance of samples, and triangles that hide one another.
TEST_F(Samples, OfSmallTrianglesAreTheReferences) {
  const Mesh soup = shapes::soup(20000, 0.001F, 0.05F);
  const OneInstance scene(soup.view());
  Camera camera{.eye = {0, 0, 3}};
  for (int i = 0; i < 2 * static_cast<int>(all_.size()); ++i) {
    FrameOptions o = options_of(i, 200, 130);
    o.shader = i % 2 == 0 ? Shader::phong : Shader::id;
    ASSERT_NO_FATAL_FAILURE(expect_same(scene.view(), camera, o, i));
  }
}

// Keys of four samples also hold a primitive's place if ids are small. The picture must not change
// at the last such id and beyond.
TEST_F(Samples, OfLargeIdsAreThoseOfSmallOnes) {
  const Mesh soup = shapes::soup(5000, 0.01F, 0.1F);
  const OneInstance scene(soup.view());
  Camera camera{.eye = {0, 0, 3}};
  FrameOptions o = options_of(4, 200, 130);
  o.samples = 4;
  constexpr std::uint64_t kRoom = raster::SampledKeys::kPlacedIds;
  for (Renderer& renderer : all_) {
    const Frame want = draw(renderer, scene.view(), camera, o, false);
    for (const std::uint64_t first :
         {kRoom - 5000, kRoom - 4999, kRoom, (std::uint64_t{1} << 32) + 7}) {
      SCOPED_TRACE(first);
      Frame got(o.width, o.height, kColor | kVisible);
      renderer.render(scene.view(), camera, o, got.targets(), {.first_id = first});
      EXPECT_TRUE(same_images(got, want, kColor | kDepth));
      for (std::size_t i = 0; i < got.ids.pixels().size(); ++i) {
        const std::int64_t id = want.ids.pixels()[i];
        ASSERT_EQ(got.ids.pixels()[i], id < 0 ? -1 : id + static_cast<std::int64_t>(first));
      }
    }
  }
}

// Triangles from a pixel to many times the picture, through one another, so that blocks are filled,
// cut and hidden. The picture's edge cuts the last bins.
TEST_F(Samples, OfTrianglesOfAllSizesAreTheReferences) {
  Random random(17);
  for (int i = 0; i < 2 * static_cast<int>(all_.size()); ++i) {
    SCOPED_TRACE(i);
    FrameOptions o = options_of(i, 131 + i % 2, 93);
    o.shader = i % 2 == 0 ? Shader::phong : Shader::id;
    Mesh mesh;
    for (int t = 0; t < 60; ++t) {
      const double x = random.real(-20, 150), y = random.real(-20, 110);
      const double size = std::exp(random.real(0, 8));
      for (std::uint32_t c = 0; c < 3; ++c) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(at_pixel(x + random.real(-size, size),
                                          y + random.real(-size, size), random.real(0.05, 0.95),
                                          o.width, o.height));
      }
    }
    const OneInstance scene(mesh.view());
    // Odd, so that overdraw is off and hierarchical Z is on; each renderer in turn.
    ASSERT_NO_FATAL_FAILURE(
        expect_same(scene.view(), pixel_camera(o.width, o.height), o, 2 * i + 1));
  }
}

// A near wall hides a far one, both of small triangles, so the far one is left out. For the near
// one alone the number of samples equals the reference's.
TEST_F(Samples, WhatIsHiddenIsLeftOut) {
  constexpr int kWidth = 131, kHeight = 70;
  const auto wall = [](double depth, bool away, Mesh& mesh) {
    for (int y = -8; y < kHeight + 8; y += 4)
      for (int x = -8; x < kWidth + 8; x += 4) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const int k : {0, 1, 2, 3})
          mesh.positions.push_back(
              at_pixel(x + 4 * (k % 2) + 0.3, y + 4 * (k / 2) + 0.3, depth, kWidth, kHeight));
        for (const std::uint32_t k : {0U, 1U, 2U, 3U, 2U, 1U})
          mesh.indices.push_back(first + (away && k % 3 != 0 ? 3 - k : k));
      }
  };
  Mesh near, both;
  wall(0.8, false, near);
  const std::size_t hidden = near.indices.size() / 3;
  const bool faces = [&] {  // whichever faces the viewer
    const OneInstance scene(near.view());
    FrameOptions o = options_of(0);
    o.cull = Cull::back;
    const Frame p = draw(reference_, scene.view(), pixel_camera(o.width, o.height), o, false);
    return p.stats.triangles.culled < hidden / 2;
  }();
  near = {};
  wall(0.8, !faces, near);
  wall(0.3, faces, both);
  wall(0.8, !faces, both);
  for (const int samples : kSamples)
    for (Renderer& renderer : all_) {
      FrameOptions o = options_of(0, kWidth, kHeight);
      o.samples = samples;
      const Camera camera = pixel_camera(kWidth, kHeight);
      const OneInstance one(near.view()), two(both.view());
      const Frame want = draw(reference_, one.view(), camera, o, false);
      const Frame got = draw(renderer, one.view(), camera, o, false);
      ASSERT_TRUE(same(got, want, false));
      ASSERT_EQ(got.stats.fragments, want.stats.fragments);
      ASSERT_GE(got.stats.fragments, static_cast<std::uint64_t>(kWidth * kHeight * samples));
      const Frame of_both = draw(renderer, two.view(), camera, o, false);
      ASSERT_TRUE(same_images(of_both, want, kColor));
      if (renderer.options().isa == Isa::scalar) continue;
      // Bins with few triangles skip the test for hidden ones.
      ASSERT_LE(of_both.stats.fragments, want.stats.fragments * 9 / 8);
    }
}

// Clip planes, which shading tests, and frames that this path leaves to layers.
TEST_F(Samples, WhatIsCutIsTheReferencesAndWhatIsBlendedAreLayers) {
  const Mesh sphere = shapes::sphere(20, 10);
  const OneInstance scene(sphere.view());
  Camera camera{.eye = {0, 0, 3}};
  FrameOptions o = options_of(0);
  o.clip_planes.push_back({{1, 0.2, 0}, 0});
  for (int i = 0; i < 2 * static_cast<int>(all_.size()); ++i) {
    o.samples = kSamples[i % 3];
    ASSERT_NO_FATAL_FAILURE(expect_same(scene.view(), camera, o, i));
  }
  o.clip_planes.clear();
  o.opacity = 0.5F;
  ASSERT_NO_FATAL_FAILURE(expect_same(scene.view(), camera, o, 0, "layers"));
}

}  // namespace
}  // namespace rastrum::test::samples_test
