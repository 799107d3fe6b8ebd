// SPDX-License-Identifier: BSD-3-Clause
// Every member of the family draws the same bits as the serial device, which draws what the
// brute-force oracle says: generated scenes at several image sizes.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/pieces.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::family_test {
namespace {

struct Variant {
  int width, height;
  Shader shader;
  Cull cull;
};

// Sizes around the block (8), the bin (64) and the single pixel.
constexpr Variant kVariants[] = {
    {64, 64, Shader::phong, Cull::none},    {37, 53, Shader::flat, Cull::none},
    {128, 96, Shader::normal, Cull::back},  {1, 1, Shader::id, Cull::none},
    {8, 8, Shader::depth, Cull::front},     {100, 20, Shader::wireframe, Cull::none},
    {17, 128, Shader::lambert, Cull::none}, {65, 33, Shader::phong, Cull::back},
};

class Family : public testing::TestWithParam<Variant> {};

TEST_P(Family, EqualsSerialAndTheOracle) {
  const Variant setup = GetParam();
  RenderOptions base({.width = setup.width,
                      .height = setup.height,
                      .shader = setup.shader,
                      .cull = setup.cull,
                      .background = {0.2F, 0.3F, 0.4F, 0.5F}});
  EveryWay ways(base);
  const int scenes = share_of(10000 / static_cast<int>(std::size(kVariants)), kSceneKinds);
  std::map<std::string, std::uint64_t> fragments_of_kind;
  for (int i = 0; i < scenes && !HasFailure(); ++i) {
    // Each setup has other scenes.
    const auto seed = static_cast<std::uint64_t>(i + setup.width * 1000000);
    const GeneratedScene g = generate(seed, setup.width, setup.height);
    SCOPED_TRACE("scene " + std::to_string(seed) + " (" + g.kind + ")");
    const Frame serial =
        ways.same([&](Painter& painter) { return draw(painter, g.view(), g.camera); }, kCountsToo);
    const PieceList pieces = pieces_of(g.view(), g.camera, setup.width, setup.height, setup.cull);
    const OracleImage oracle = brute_force(setup.width, setup.height, pieces.triangles);
    EXPECT_TRUE(same_surfaces(serial, oracle));
    EXPECT_TRUE(counts_add_up(serial));
    EXPECT_EQ(serial.stats.triangles.input, pieces.input);
    EXPECT_EQ(serial.stats.triangles.dropped, pieces.dropped);
    fragments_of_kind[g.kind] += oracle.fragments();
  }
  // Each kind of scene must stay visible on the whole; single scenes may be empty.
  for (const auto& [kind, fragments] : fragments_of_kind) {
    if (setup.width > 8 && scenes >= 60 * kSceneKinds) {
      EXPECT_GT(fragments, 0U) << kind;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Family, testing::ValuesIn(kVariants),
                         [](const testing::TestParamInfo<Variant>& p) {
                           return std::to_string(p.param.width) + "x" +
                                  std::to_string(p.param.height) + "_" +
                                  std::string(name(p.param.shader));
                         });

}  // namespace
}  // namespace rastrum::test::family_test
