// SPDX-License-Identifier: BSD-3-Clause
// Translucent parts on several ranks are blended as by one renderer: all targets have the same
// bits, for any number of ranks and any deal, in one band or many.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/ranks/bands.hpp>
#include <rastrum/ranks/fragments.hpp>

#include "tests/ranks/deals.hpp"

namespace rastrum::test::ranks_layers_test {
namespace {

/// Triangles, spheres and a tube. Some parts are translucent, by opacity or colour.
Scene glass(std::uint64_t seed, bool with_materials) {
  Scene scene = PartsScene(seed, kParts, with_materials).scene;
  Random random(seed + 1000);
  Tubes tubes;
  for (int k = 0; k < 6; ++k) tubes.positions.push_back(random_point(random));
  tubes.radius = 0.15F;
  scene.instances[seed % kParts] = {};
  scene.instances[seed % kParts].geometry = static_cast<std::uint32_t>(scene.geometries.size());
  scene.geometries.emplace_back(std::move(tubes));
  for (Instance& i : scene.instances) {
    if (random.chance(0.5)) i.opacity = static_cast<float>(random.real(0.1, 0.9));
    if (!with_materials && random.chance(0.3)) i.color = Vec4{0.2F, 0.4F, 0.9F, 0.6F};
  }
  return scene;
}

TEST(RanksLayers, EqualOneRendererWithEveryShader) {
  std::uint64_t seed = 1;
  for (const Shader shader : {Shader::flat, Shader::depth, Shader::normal, Shader::id,
                              Shader::lambert, Shader::phong, Shader::wireframe, Shader::classic}) {
    const Scene scene = glass(seed, false);
    expect_equal(scene, frame_of(shader, 40, 30), {3}, seed, kSerialRank);
    expect_equal(scene, frame_of(shader, 75, 50), {1, 5}, seed, kThreadRank);
    ++seed;
  }
  for (const RendererOptions& of_rank : {kSerialRank, kThreadRank}) {
    expect_equal(glass(seed, true), frame_of(Shader::material, 40, 30), {1, 5}, seed, of_rank);
    expect_equal(glass(seed, true), frame_of(Shader::automatic, 40, 30), {3}, seed, of_rank);
  }
}

TEST(RanksLayers, EqualOneRendererForManyRanksAndSizes) {
  expect_equal(glass(20, false), frame_of(Shader::phong, 70, 40), {16, 64}, 20, kThreadRank);
  expect_equal(glass(21, false), frame_of(Shader::phong, 1, 1), {2, 8}, 21, kThreadRank);
  expect_equal(glass(22, false), frame_of(Shader::phong, 9, 200), {5, 16}, 22, kThreadRank);
  expect_equal(glass(23, true), frame_of(Shader::material, 131, 67), {8}, 23, kThreadRank);
}

/// Only some ranks have translucent surfaces, but linear light applies to all.
TEST(RanksLayers, EqualOneRendererWhereFewPartsAreTranslucent) {
  for (std::uint64_t seed = 30; seed < 36; ++seed) {
    Scene scene = PartsScene(seed, kParts, seed % 2 == 0).scene;
    scene.instances[seed % kParts].opacity = 0.3F;
    expect_equal(scene, frame_of(Shader::automatic, 50, 40), {4}, seed, kThreadRank);
  }
}

TEST(RanksLayers, EqualOneRendererWithOpacityOfTheFrame) {
  FrameOptions frame = frame_of(Shader::material, 70, 70);
  frame.opacity = 0.4F;
  frame.lights.emplace_back();
  frame.tone.tone = Tone::aces;
  frame.clip_planes.push_back({{0, 0, -1}, 0.1});
  expect_equal(glass(40, true), frame, {3}, 40, kThreadRank);
  frame.transparency.alpha_threshold = 0.7F;
  expect_equal(glass(41, true), frame, {3}, 41, kThreadRank);
  expect_equal(glass(41, true), frame, {3}, 41, kSerialRank);
}

/// Scenes with everything that affects colours, also blended textures, masks and scalars.
TEST(RanksLayers, EqualOneRendererForGeneratedScenes) {
  const int layered = expect_equal_generated(
      400,
      [](FrameOptions& frame, std::uint64_t seed) {
        if (seed % 4 != 0) frame.samples = 1;
        frame.transparency.method = Transparency::exact;
      },
      [](std::uint64_t seed) { return seed % 2 == 0 ? kThreadRank : kSerialRank; });
  EXPECT_GT(layered, 100);
}

/// Several samples: opaque scenes, translucent ones, and both with a few parts of the other kind.
TEST(RanksLayers, EqualOneRendererWithSeveralSamples) {
  for (const bool with_materials : {false, true})
    for (const int samples : {4, 8}) {
      FrameOptions frame = frame_of(Shader::automatic, 50, 35);
      frame.samples = samples;
      const std::uint64_t seed = 60 + static_cast<std::uint64_t>(samples);
      Scene opaque = PartsScene(seed, kParts, with_materials).scene;
      expect_equal(opaque, frame, {1, 3}, seed, kThreadRank);
      opaque.instances[7].opacity = 0.3F;
      expect_equal(opaque, frame, {4}, seed, kThreadRank);
      expect_equal(glass(seed, with_materials), frame, {2, 5}, seed, kThreadRank);
      if (samples == 4) expect_equal(glass(seed, with_materials), frame, {2}, seed, kSerialRank);
    }
  FrameOptions frame = frame_of(Shader::id, 40, 40);
  frame.samples = 16;
  frame.transparency.alpha_threshold = 0.8F;
  RanksOptions options{.fragment_bytes = 20'000};
  expect_equal(glass(70, false), frame, {3}, 70, kThreadRank, options);
  frame.shader = Shader::depth;
  expect_equal(glass(70, false), frame, {3}, 70, kThreadRank);
}

/// Equal meshes, opaque and translucent, on ranks in any order. Layers of equal depth blend by part
/// number, and an opaque one hides those behind it in that order.
TEST(RanksLayers, OfEqualDepthThePartsFollowTheirNumbers) {
  for (std::uint64_t opaque = 0; opaque < 6; ++opaque) {
    Scene scene = PartsScene(3, 1, false).scene;
    scene.instances.resize(6, scene.instances.front());
    for (std::size_t i = 0; i < 6; ++i) {
      const auto shade = static_cast<float>(i) / 8;
      scene.instances[i].color = Vec4{shade, 1 - shade, 0.5F, 1};
      if (i != opaque) scene.instances[i].opacity = 0.25F;
    }
    LocalRanks ranks(4);
    // In one pass, and in bands, which know what hides. Ids as colours count through all parts.
    for (const Shader shader : {Shader::phong, Shader::id}) {
      const Whole whole(scene, frame_of(shader, 40, 40));
      for (const Deal& deal : {Deal{{3, 0}, {1, 5}, {}, {2, 4}}, Deal{{5}, {4, 3}, {2, 1}, {0}},
                               Deal{{0, 2, 3, 5}, {1, 4}, {}, {}}})
        for (const RendererOptions& of_rank : {kSerialRank, kThreadRank})
          for (const std::uint64_t bytes : {std::uint64_t{1} << 30, std::uint64_t{1}}) {
            SCOPED_TRACE(testing::Message() << opaque << ", " << name(shader) << ", " << bytes);
            whole.expect(ranks, deal, {.fragment_bytes = bytes}, of_rank);
          }
    }
  }
}

TEST(RanksLayers, GoInBandsThatAreBounded) {
  const Whole whole(glass(50, false), frame_of(Shader::phong, 300, 200));
  LocalRanks ranks(3);
  std::uint64_t fragments = 0;
  for (const std::uint64_t bytes :
       {std::uint64_t{1} << 30, std::uint64_t{100'000}, std::uint64_t{1}}) {
    SCOPED_TRACE(bytes);
    const RanksStats stats =
        whole.expect(ranks, round_robin(3), {.fragment_bytes = bytes}, kThreadRank);
    if (bytes == std::uint64_t{1} << 30) {
      EXPECT_EQ(stats.bands, 1U);
      fragments = stats.fragments;
    } else {
      EXPECT_GT(stats.bands, bytes == 1 ? 6U : 1U);
    }
    EXPECT_EQ(stats.fragments, fragments);
    EXPECT_GT(fragments, 3'000U);
  }
  whole.expect(ranks, round_robin(3), {}, {.memory_limit = 4U << 20, .threads = 1});
}

/// No rank sends fragments that any rank's opaque surface hides, at any sample.
TEST(RanksLayers, WhatIsHiddenIsNotSent) {
  Scene scene;
  for (const float z : {0.0F, -1.0F, -2.0F}) {
    Mesh quad{.positions = {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}},
              .indices = {0, 1, 2, 0, 2, 3}};
    scene.instances.push_back({.mesh = static_cast<std::uint32_t>(scene.meshes.size())});
    scene.meshes.push_back(quad);
  }
  scene.instances[0].opacity = scene.instances[2].opacity = 0.5F;
  Image<Rgba8> image(32, 32);
  LocalRanks ranks(3);
  for (const bool in_bands : {false, true})
    for (const int samples : {1, 4}) {
      if (in_bands && samples > 1) continue;  // a rank then sends all of its fragments
      FrameOptions frame = frame_of(Shader::flat, 32, 32);
      frame.samples = samples;
      const Whole whole(scene, frame, Camera{.eye = {0, 0, 2}});
      RanksOptions options;
      if (in_bands) options.fragment_bytes = 1;
      std::vector<std::uint64_t> sent(3);
      ranks.run([&](Communicator& c) {
        const auto r = static_cast<std::uint64_t>(c.rank());
        sent[r] = whole.draw_on(c, {&r, 1}, {.color8 = image}, options, kThreadRank).fragments;
      });
      const std::uint64_t one = static_cast<std::uint64_t>(samples) * 32 * 32;
      // With several samples the opaque surface is sent too.
      EXPECT_EQ(sent, (std::vector<std::uint64_t>{one, samples == 1 ? 0 : one, 0})) << samples;
    }
}

/// Every bin with fragments is in one band, and bands keep their limit.
TEST(RanksLayers, BandsCoverWhatHasFragments) {
  Random random(7);
  for (int round = 0; round < 300; ++round) {
    const int width = random.integer(1, 500), height = random.integer(1, 500);
    const int columns = (width + 63) / 64, rows = (height + 63) / 64;
    std::vector<ranks::BinFragments> bins(static_cast<std::size_t>(columns * rows));
    for (auto& b : bins)
      if (random.chance(0.6)) {
        b.all = static_cast<std::uint64_t>(random.integer(1, 5000));
        b.most = std::max<std::uint64_t>(1, b.all / 2);
      }
    const auto bytes = static_cast<std::uint64_t>(random.integer(1, 1'000'000));
    std::vector<int> covered(bins.size());
    for (const raster::Rect& band : ranks::bands_of(width, height, bins, 3, bytes)) {
      ASSERT_EQ(band.x0 % 64 + band.y0 % 64, 0);
      std::uint64_t held = 0;
      int used = 0;
      for (int y = band.y0 / 64; y * 64 < band.y1; ++y)
        for (int x = band.x0 / 64; x * 64 < band.x1; ++x) {
          const std::size_t bin = static_cast<std::size_t>(y * columns + x);
          ++covered[bin];
          held += (2 * bins[bin].most + (bins[bin].all + 2) / 3) * ranks::kFragmentBytes;
          used += bins[bin].all > 0 ? 1 : 0;
        }
      ASSERT_GT(used, 0);
      ASSERT_TRUE(held <= bytes || used == 1) << held << " " << bytes;
    }
    for (std::size_t b = 0; b < bins.size(); ++b)
      ASSERT_TRUE(bins[b].all > 0 ? covered[b] == 1 : covered[b] <= 1) << round;
  }
}

TEST(RanksLayers, OwnersHaveEqualWork) {
  for (const std::size_t n : {1U, 3U, 16U, 100U}) {
    std::vector<int> blocks(n);
    for (std::uint32_t b = 0; b < 32'400; ++b) {
      const std::size_t owner = ranks::layer_owner(b, n);
      ASSERT_LT(owner, n);
      ++blocks[owner];
    }
    EXPECT_LT(std::ranges::max(blocks), 1.1 * 32'400 / static_cast<double>(n));
  }
}

}  // namespace
}  // namespace rastrum::test::ranks_layers_test
