// Translucent surfaces of parts on several ranks are blended as one renderer blends them: all
// targets have the same bits, for any number of ranks and any deal, in one band or in many.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/ranks/bands.hpp>
#include <rastrum/ranks/fragments.hpp>

#include "tests/ranks/deals.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/shaded_scenes.hpp"

namespace rastrum::test::ranks_layers_test {
namespace {

constexpr RendererOptions kSerial{.device = Device::serial}, kThreads{.threads = 1};

/// Triangles, spheres and a tube; some parts are translucent, by their opacity or their colour.
Scene glass(std::uint64_t seed, bool with_materials) {
  Scene scene = PartsScene(seed, kParts, with_materials).scene;
  Random random(seed + 1000);
  Tubes tubes;
  for (int k = 0; k < 6; ++k) {
    const double x = random.real(-1, 1);
    const double y = random.real(-1, 1);
    const double z = random.real(-1, 1);
    tubes.positions.push_back(
        {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
  }
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
                              Shader::lambert, Shader::phong, Shader::wireframe}) {
    const Scene scene = glass(seed, false);
    expect_equal(scene, frame_of(shader, 40, 30), {3}, seed, kSerial);
    expect_equal(scene, frame_of(shader, 75, 50), {1, 5}, seed, kThreads);
    ++seed;
  }
  for (const RendererOptions& of_rank : {kSerial, kThreads}) {
    expect_equal(glass(seed, true), frame_of(Shader::material, 40, 30), {1, 5}, seed, of_rank);
    expect_equal(glass(seed, true), frame_of(Shader::automatic, 40, 30), {3}, seed, of_rank);
  }
}

TEST(RanksLayers, EqualOneRendererForManyRanksAndSizes) {
  expect_equal(glass(20, false), frame_of(Shader::phong, 70, 40), {16, 64}, 20, kThreads);
  expect_equal(glass(21, false), frame_of(Shader::phong, 1, 1), {2, 8}, 21, kThreads);
  expect_equal(glass(22, false), frame_of(Shader::phong, 9, 200), {5, 16}, 22, kThreads);
  expect_equal(glass(23, true), frame_of(Shader::material, 131, 67), {8}, 23, kThreads);
}

/// Translucent surfaces on some ranks alone: linear light is of all.
TEST(RanksLayers, EqualOneRendererWhereFewPartsAreTranslucent) {
  for (std::uint64_t seed = 30; seed < 36; ++seed) {
    Scene scene = PartsScene(seed, kParts, seed % 2 == 0).scene;
    scene.instances[seed % kParts].opacity = 0.3F;
    expect_equal(scene, frame_of(Shader::automatic, 50, 40), {4}, seed, kThreads);
  }
}

TEST(RanksLayers, EqualOneRendererWithOpacityOfTheFrame) {
  FrameOptions frame = frame_of(Shader::material, 70, 70);
  frame.opacity = 0.4F;
  frame.lights.emplace_back();
  frame.tone.tone = Tone::aces;
  frame.clip_planes.push_back({{0, 0, -1}, 0.1});
  expect_equal(glass(40, true), frame, {3}, 40, kThreads);
  frame.transparency.alpha_threshold = 0.7F;
  expect_equal(glass(41, true), frame, {3}, 41, kThreads);
  expect_equal(glass(41, true), frame, {3}, 41, kSerial);
}

/// Scenes with all that can have a colour, textures that blend, masks and scalars too.
TEST(RanksLayers, EqualOneRendererForGeneratedScenes) {
  int layered = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    ShadedScene s = generate_shaded(seed);
    if (seed % 4 != 0) s.frame.samples = 1;
    s.frame.transparency.method = Transparency::exact;
    const bool linear = shader_for(s.frame.shader, s.view()) == Shader::material;
    const AllTargets one(s.frame.width, s.frame.height, linear);
    const AllTargets many(s.frame.width, s.frame.height, linear);
    Renderer renderer({.threads = 1});
    const FrameStats stats = renderer.render(s.view(), s.camera, s.frame, one.targets());
    layered += stats.visibility == "layers" ? 1 : 0;
    Deal deal(3);
    for (std::uint64_t p = 0; p < s.scene.instances.size(); ++p) deal[(p + seed) % 3].push_back(p);
    LocalRanks ranks(3);
    (void)draw_dealt(ranks, deal, s.view(), s.camera, s.frame, many.targets(), {}, {},
                     seed % 2 == 0 ? kThreads : kSerial);
    ASSERT_TRUE(same_targets(one.targets(), many.targets())) << s.kind << ", seed " << seed;
  }
  EXPECT_GT(layered, 100);
}

/// Several samples: opaque scenes, translucent ones, and both with few parts of the other kind.
TEST(RanksLayers, EqualOneRendererWithSeveralSamples) {
  for (const bool with_materials : {false, true})
    for (const int samples : {4, 8}) {
      FrameOptions frame = frame_of(Shader::automatic, 50, 35);
      frame.samples = samples;
      const std::uint64_t seed = 60 + static_cast<std::uint64_t>(samples);
      Scene opaque = PartsScene(seed, kParts, with_materials).scene;
      expect_equal(opaque, frame, {1, 3}, seed, kThreads);
      opaque.instances[7].opacity = 0.3F;
      expect_equal(opaque, frame, {4}, seed, kThreads);
      expect_equal(glass(seed, with_materials), frame, {2, 5}, seed, kThreads);
      if (samples == 4) expect_equal(glass(seed, with_materials), frame, {2}, seed, kSerial);
    }
  FrameOptions frame = frame_of(Shader::id, 40, 40);
  frame.samples = 16;
  frame.transparency.alpha_threshold = 0.8F;
  RanksOptions options{.fragment_bytes = 20'000};
  expect_equal(glass(70, false), frame, {3}, 70, kThreads, options);
  frame.shader = Shader::depth;
  expect_equal(glass(70, false), frame, {3}, 70, kThreads);
}

/// Meshes that are equal everywhere, opaque and translucent, on ranks in any order: layers of equal
/// depth are blended by their parts' numbers, and an opaque one hides those behind it in that
/// order.
TEST(RanksLayers, OfEqualDepthThePartsFollowTheirNumbers) {
  for (std::uint64_t opaque = 0; opaque < 6; ++opaque) {
    Scene scene = PartsScene(3, 1, false).scene;
    scene.instances.resize(6, scene.instances.front());
    for (std::size_t i = 0; i < 6; ++i) {
      const auto shade = static_cast<float>(i) / 8;
      scene.instances[i].color = Vec4{shade, 1 - shade, 0.5F, 1};
      if (i != opaque) scene.instances[i].opacity = 0.25F;
    }
    const SceneBinding binding(scene);
    const Camera camera = fit_camera(binding.view(), 1.0472F, false);
    LocalRanks ranks(4);
    // In one pass, and in bands, which are told what hides; ids as colours count through all parts.
    for (const Shader shader : {Shader::phong, Shader::id}) {
      const FrameOptions frame = frame_of(shader, 40, 40);
      const AllTargets one(40, 40, false);
      Renderer renderer;
      (void)renderer.render(binding.view(), camera, frame, one.targets());
      for (const Deal& deal : {Deal{{3, 0}, {1, 5}, {}, {2, 4}}, Deal{{5}, {4, 3}, {2, 1}, {0}},
                               Deal{{0, 2, 3, 5}, {1, 4}, {}, {}}})
        for (const RendererOptions& of_rank : {kSerial, kThreads})
          for (const std::uint64_t bytes : {std::uint64_t{1} << 30, std::uint64_t{1}}) {
            const AllTargets many(40, 40, false);
            RanksOptions options{.fragment_bytes = bytes};
            draw_dealt(ranks, deal, binding.view(), camera, frame, many.targets(), options, {},
                       of_rank);
            ASSERT_TRUE(same_targets(one.targets(), many.targets()))
                << opaque << ", " << name(shader) << ", " << bytes;
          }
    }
  }
}

TEST(RanksLayers, GoInBandsThatAreBounded) {
  const Scene scene = glass(50, false);
  const SceneBinding binding(scene);
  const Camera camera = fit_camera(binding.view(), 1.0472F, false);
  const FrameOptions frame = frame_of(Shader::phong, 300, 200);
  const AllTargets one(300, 200, false);
  Renderer renderer;
  (void)renderer.render(binding.view(), camera, frame, one.targets());
  LocalRanks ranks(3);
  std::uint64_t fragments = 0;
  for (const std::uint64_t bytes :
       {std::uint64_t{1} << 30, std::uint64_t{100'000}, std::uint64_t{1}}) {
    const AllTargets many(300, 200, false);
    RanksOptions options{.fragment_bytes = bytes};
    const RanksStats stats = draw_dealt(ranks, round_robin(3), binding.view(), camera, frame,
                                        many.targets(), options, {}, kThreads);
    ASSERT_TRUE(same_targets(one.targets(), many.targets())) << bytes;
    if (bytes == std::uint64_t{1} << 30) {
      EXPECT_EQ(stats.bands, 1U);
      fragments = stats.fragments;
    } else {
      EXPECT_GT(stats.bands, bytes == 1 ? 6U : 1U);
    }
    EXPECT_EQ(stats.fragments, fragments);
    EXPECT_GT(fragments, 3'000U);
  }
  const AllTargets many(300, 200, false);
  draw_dealt(ranks, round_robin(3), binding.view(), camera, frame, many.targets(), {}, {},
             {.memory_limit = 4U << 20, .threads = 1});
  EXPECT_TRUE(same_targets(one.targets(), many.targets()));
}

/// No rank sends fragments behind the nearest opaque surface of any rank, at any sample.
TEST(RanksLayers, WhatIsHiddenIsNotSent) {
  Scene scene;
  for (const float z : {0.0F, -1.0F, -2.0F}) {
    Mesh quad{.positions = {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}},
              .indices = {0, 1, 2, 0, 2, 3}};
    scene.instances.push_back({.mesh = static_cast<std::uint32_t>(scene.meshes.size())});
    scene.meshes.push_back(quad);
  }
  scene.instances[0].opacity = scene.instances[2].opacity = 0.5F;
  const SceneBinding binding(scene);
  const Camera camera{.eye = {0, 0, 2}};
  Image<Rgba8> image(32, 32);
  LocalRanks ranks(3);
  for (const bool in_bands : {false, true})
    for (const int samples : {1, 4}) {
      if (in_bands && samples > 1) continue;  // there all of a rank's are sent
      FrameOptions frame = frame_of(Shader::flat, 32, 32);
      frame.samples = samples;
      RanksOptions options;
      if (in_bands) options.fragment_bytes = 1;
      std::vector<std::uint64_t> sent(3);
      ranks.run([&](Communicator& c) {
        const auto r = static_cast<std::size_t>(c.rank());
        SceneView own = binding.view();
        own.instances = own.instances.subspan(r, 1);
        const std::uint64_t part = r;
        Renderer renderer(kThreads);
        Targets targets;
        if (r == 0) targets.color8 = image;
        sent[r] =
            render_parts(c, renderer, own, std::span(&part, 1), camera, frame, targets, options)
                .fragments;
      });
      const std::uint64_t one = static_cast<std::uint64_t>(samples) * 32 * 32;
      // With several samples the opaque surface is sent so, too.
      EXPECT_EQ(sent, (std::vector<std::uint64_t>{one, samples == 1 ? 0 : one, 0})) << samples;
    }
}

/// Every bin with fragments lies in one band, and bands hold no more than they may.
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
