// SPDX-License-Identifier: BSD-3-Clause
// A picture of several ranks equals one renderer's, bit for bit in all targets, for any number of
// ranks, any deal, and both exchanges.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>

#include "tests/ranks/deals.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::parts_test {
namespace {

/// A cluster's vertices are projected only if a drawn frame sees the cluster.
TEST(Parts, OfPreparedMeshesEqualOneRenderers) {
  Scene scene;
  for (int i = 0; i < kParts; ++i) {
    Instance instance;
    instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
    scene.meshes.push_back(shapes::torus_knot(2 + i % 2 * 2, 3, 300, 20));
    instance.object_to_world = rotation(rotation_about({0.3, 1, 0.2}, 0.4 * i));
    if (i % 3 == 0) instance.opacity = 0.4F;
    scene.instances.push_back(instance);
  }
  const Whole whole(std::move(scene), frame_of(Shader::phong, 150, 110), {}, true);
  for (const int n : {2, 5}) {
    LocalRanks ranks(n);
    SCOPED_TRACE(n);
    whole.expect(ranks, round_robin(n), {}, {.device = Device::threads, .threads = 1});
  }
}

TEST(Parts, EqualOneRendererWithEveryShader) {
  std::uint64_t seed = 1;
  for (const Shader shader : {Shader::flat, Shader::depth, Shader::normal, Shader::id,
                              Shader::lambert, Shader::phong, Shader::wireframe, Shader::classic}) {
    expect_equal(seed++, false, frame_of(shader, 75, 50), {1, 3});
  }
  for (const Shader shader : {Shader::material, Shader::classic})
    expect_equal(seed, true, frame_of(shader, 75, 50), {2, 5});
  expect_equal(seed, true, frame_of(Shader::automatic, 75, 50), {3});
}

TEST(Parts, EqualOneRendererForManyRanksAndSizes) {
  expect_equal(20, false, frame_of(Shader::id, 96, 64), {8, 16, 64});
  expect_equal(21, false, frame_of(Shader::phong, 1, 1), {2, 8});
  expect_equal(22, false, frame_of(Shader::phong, 9, 200), {5, 16});
  expect_equal(23, true, frame_of(Shader::material, 131, 67), {8});
}

/// Some seeds need decisions about the whole scene, such as colours on some ranks only.
TEST(Parts, EqualOneRendererForManyScenes) {
  for (std::uint64_t seed = 100; seed < 112; ++seed)
    expect_equal(seed, seed % 4 == 0,
                 frame_of(seed % 2 == 0 ? Shader::automatic : Shader::lambert, 48, 40), {5});
}

/// Scenes with everything that affects colours, textures too, opaque with one sample.
TEST(Parts, EqualOneRendererForGeneratedScenes) {
  expect_equal_generated(
      300,
      [](FrameOptions& frame, std::uint64_t) {
        frame.samples = 1;
        frame.transparency.method = Transparency::none;
      },
      [](std::uint64_t) { return kSerialRank; });
}

/// Spheres, discs, tubes and cylinders that cross, also twice at one place.
TEST(Parts, EqualOneRendererOfSurfaces) {
  Scene scene;
  Random random(8);
  const auto point = [&] { return random_point(random); };
  for (int i = 0; i < kParts; ++i) {
    Instance instance;
    instance.geometry = static_cast<std::uint32_t>(scene.geometries.size());
    Spheres spheres;
    Discs discs;
    Tubes tubes;
    Cylinders cylinders;
    for (int k = 0; k < 4; ++k) {
      spheres.centers.push_back(point());
      discs.centers.push_back(point());
      discs.normals.push_back(point());
      tubes.positions.push_back(point());
      cylinders.positions.push_back(point());
    }
    spheres.radius = discs.radius = 0.3F;
    tubes.radius = cylinders.radius = 0.12F;
    if (i % 5 == 4)
      instance.geometry = *scene.instances[static_cast<std::size_t>(i - 2)].geometry;
    else if (i % 4 == 0)
      scene.geometries.emplace_back(std::move(spheres));
    else if (i % 4 == 1)
      scene.geometries.emplace_back(std::move(discs));
    else if (i % 4 == 2)
      scene.geometries.emplace_back(std::move(tubes));
    else
      scene.geometries.emplace_back(std::move(cylinders));
    scene.instances.push_back(instance);
  }
  expect_equal(scene, frame_of(Shader::phong, 60, 44), {2, 16}, 8);
  scene.instances[2].opacity = scene.instances[7].opacity = 0.4F;
  expect_equal(scene, frame_of(Shader::phong, 40, 30), {5}, 8);
}

/// 67 million pixels take minutes, so only `./dev check --full` runs this.
TEST(Parts, EqualOneRendererAt8192) {
  if (!is_full()) GTEST_SKIP() << kOnlyFull;
  constexpr int kSize = 8192;
  PartsScene parts(12, kParts, false);
  for (const float opacity : {1.0F, 0.4F}) {
    parts.scene.instances[3].opacity = parts.scene.instances[8].opacity = opacity;
    const Whole whole(parts.scene, frame_of(Shader::phong, kSize, kSize));
    Image<Vec4> one(kSize, kSize), many(kSize, kSize);
    Image<std::int64_t> one_ids(kSize, kSize), many_ids(kSize, kSize);
    Renderer renderer({.threads = 2});
    (void)renderer.render(whole.view(), whole.camera, whole.frame, {.color = one, .ids = one_ids});
    for (const int n : {3, 16}) {
      LocalRanks ranks(n);
      whole.draw(ranks, round_robin(n), {.color = many, .ids = many_ids}, {}, kThreadRank);
      const auto same = [](const auto& a, const auto& b) {
        return std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
      };
      EXPECT_TRUE(same(one, many)) << n << " ranks, opacity " << opacity;
      EXPECT_TRUE(same(one_ids, many_ids)) << n << " ranks, opacity " << opacity;
    }
  }
}

TEST(Parts, EqualOneRendererWithLightsAToneAndPlanes) {
  FrameOptions frame = frame_of(Shader::material, 70, 70);
  frame.lights.emplace_back();
  frame.tone.tone = Tone::aces;
  frame.clip_planes.push_back({{0, 0, -1}, 0.1});
  expect_equal(30, true, frame, {3});
}

/// Equal meshes: the first part wins on any rank.
TEST(Parts, OfEqualDepthTheFirstPartWins) {
  PartsScene parts(3, 1, false);
  parts.scene.instances.resize(4, parts.scene.instances.front());
  const Whole whole(std::move(parts.scene), frame_of(Shader::phong, 40, 40));
  LocalRanks ranks(4);
  for (const WordExchange exchange : {WordExchange::shared, WordExchange::sparse}) {
    Image<std::int64_t> instances(40, 40);
    whole.draw(ranks, {{3}, {1}, {0}, {2}}, {.instances = instances}, {.exchange = exchange});
    EXPECT_EQ(std::ranges::max(instances.pixels()), 0);
    EXPECT_EQ(std::ranges::min(instances.pixels()), -1);
  }
}

/// Part numbers only order the parts, so they may have gaps.
TEST(Parts, NumbersMayHaveGaps) {
  const Whole whole(PartsScene(4, 3, false).scene, frame_of(Shader::id, 40, 40));
  Image<std::int64_t> ids(40, 40);
  Image<Vec4> color(40, 40);
  LocalRanks ranks(3);
  const std::vector<std::uint64_t> numbers{7, std::uint64_t{1} << 40, (std::uint64_t{1} << 63) - 1};
  ranks.run([&](Communicator& c) {
    const auto i = static_cast<std::size_t>(2 - c.rank());
    SceneView held = whole.view();
    held.instances = held.instances.subspan(i, 1);
    Renderer of_rank(kSerialRank);
    Targets targets;
    if (c.rank() == 0) targets = {.color = color, .ids = ids};
    (void)render_parts(c, of_rank, held, std::span(numbers).subspan(i, 1), whole.camera,
                       whole.frame, targets);
  });
  EXPECT_TRUE(same_targets({.color = color, .ids = ids},
                           {.color = whole.one().color, .ids = whole.one().ids}));
}

TEST(Parts, KeepMemoryLimits) {
  const Whole whole(PartsScene(5, kParts, false).scene, frame_of(Shader::phong, 300, 200));
  LocalRanks ranks(2);
  whole.expect(ranks, round_robin(2), {}, {.memory_limit = 4U << 20, .threads = 1});
}

/// Ranks send the words that they draw. Far away there are few, but they are most of the traffic.
TEST(Parts, SendTheWordsThatTheyDraw) {
  Whole whole(PartsScene(6, kParts, false).scene, frame_of(Shader::phong, 256, 256));
  Image<std::int64_t> ids(256, 256);
  LocalRanks ranks(4, 1);
  Camera& camera = whole.camera;
  std::uint64_t near_bytes = 0;
  for (const bool far : {false, true}) {
    if (far) camera.eye = camera.target + (camera.eye - camera.target) * 6.0;
    const RanksStats stats =
        whole.draw(ranks, round_robin(4), {.ids = ids}, {.exchange = WordExchange::automatic});
    EXPECT_EQ(stats.exchange, WordExchange::sparse);
    EXPECT_GE(stats.words, stats.won);
    std::uint64_t most = 0;
    for (const auto& t : ranks.traffic()) most = std::max(most, t.bytes);
    if (far) {
      EXPECT_LT(most * 4, near_bytes);
    }
    near_bytes = most;
  }
}

TEST(Parts, RefuseWhatNeedsMoreOfOthers) {
  PartsScene parts(7, 4, false);
  const auto refused = [&](const char* text, Errc code, const FrameOptions& frame,
                           const Deal& deal) {
    const Whole whole(parts.scene, frame);
    Image<Rgba8> image(32, 32);
    LocalRanks ranks(2);
    expect_refused(text, code, [&] { whole.draw(ranks, deal, {.color8 = image}); });
  };
  const Deal deal{{0, 1}, {2, 3}};
  FrameOptions frame = frame_of(Shader::phong, 32, 32);
  frame.environment_behind = true;
  refused("environment_behind", Errc::unsupported, frame, deal);
  frame = frame_of(Shader::phong, 32, 32);
  refused("part 1 is on rank 0 and on rank 1", Errc::invalid_argument, frame, {{0, 1}, {1, 3}});
  frame.width = 31;
  refused("rank 0: the color8 target is 32x32 and must be 31x32", Errc::invalid_argument, frame,
          deal);
  frame.width = 32;
  parts.scene.instances[3].opacity = 0.5F;
  const TransparencyOptions unsorted{.method = Transparency::unsorted};
  for (const auto& [method, samples] : {std::pair{unsorted, 1},
                                        {unsorted, 4},
                                        {family::filtered(3), 1},
                                        {family::filtered(3), 4},
                                        {family::wboit(), 1}}) {
    frame.transparency = method;
    frame.samples = samples;
    refused("blended exactly", Errc::unsupported, frame, deal);
  }
  frame.samples = 1;
  // Without blending, the blending method does not matter.
  expect_equal(7, false, frame, {1, 2});
  frame.transparency = {.method = Transparency::none};
  expect_equal(7, false, frame, {2});
}

// One rank draws as it would alone, but refuses what several ranks refuse, with and without
// samples, before it draws.
TEST(Parts, OneRankRefusesAsSeveralDoBeforeItDraws) {
  PartsScene parts(7, 4, false);
  constexpr Rgba8 kBefore{1, 2, 3, 4};
  for (const float opacity : {0.5F, 1.0F}) {
    parts.scene.instances[3].opacity = opacity;
    for (const int samples : {1, 4})
      for (const Transparency method : {Transparency::unsorted, Transparency::none}) {
        FrameOptions frame = frame_of(Shader::phong, 32, 32);
        frame.samples = samples;
        frame.transparency.method = method;
        Image<Rgba8> image(32, 32);
        std::ranges::fill(image.pixels(), kBefore);
        LocalRanks ranks(1);
        const Whole whole(parts.scene, frame);
        const auto draw = [&] { whole.draw(ranks, {{0, 1, 2, 3}}, {.color8 = image}); };
        const bool refuses = opacity < 1 && method != Transparency::none;
        if (refuses)
          expect_refused("blended exactly", Errc::unsupported, draw);
        else
          draw();
        EXPECT_EQ(std::ranges::count(image.pixels(), kBefore) == 32 * 32, refuses)
            << opacity << ", " << samples;
      }
  }
}

}  // namespace
}  // namespace rastrum::test::parts_test
