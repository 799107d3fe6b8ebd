// SPDX-License-Identifier: BSD-3-Clause
// The heat map's colours can be read back: the picture holds the counts.
#include "frame/heatmap.hpp"

#include <map>
#include <string>

#include "program.hpp"

namespace rastrum::test::heatmap_test {
namespace {

double luminance(Rgba8 c) {
  return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

TEST(HeatRamp, GetsLighterFromEndToEnd) {
  const auto& ramp = cli::heat_ramp();
  for (std::size_t i = 32; i < ramp.size(); i += 32)
    EXPECT_GT(luminance(ramp[i]), luminance(ramp[i - 32])) << i;
  // The first colour is distinct from black, the last is nearly white.
  EXPECT_GT(luminance(ramp.front()), 25);
  EXPECT_GT(luminance(ramp.back()), 220);
}

TEST(HeatRamp, EndsAreOneAndTheMaximum) {
  EXPECT_EQ(cli::ramp_index(1, 1), 0);
  EXPECT_EQ(cli::ramp_index(1, 500), 0);
  EXPECT_EQ(cli::ramp_index(500, 500), cli::kRampSize - 1);
}

TEST(MakeHeatmap, CountsAndColours) {
  Image<std::uint32_t> overdraw(3, 1);
  overdraw(1, 0) = 1;
  overdraw(2, 0) = 7;
  const cli::Heatmap h = cli::make_heatmap(overdraw.view());
  EXPECT_EQ(h.max, 7U);
  EXPECT_EQ(h.sum, 8U);
  EXPECT_EQ(h.image(0, 0), (Rgba8{0, 0, 0, 255}));
  EXPECT_EQ(h.image(1, 0), cli::heat_ramp().front());
  EXPECT_EQ(h.image(2, 0), cli::heat_ramp().back());
}

TEST(MakeHeatmap, NothingDrawn) {
  const Image<std::uint32_t> overdraw(2, 2);
  const cli::Heatmap h = cli::make_heatmap(overdraw.view());
  EXPECT_EQ(h.max, 0U);
  EXPECT_EQ(h.sum, 0U);
}

using HeatmapOption = Program;

TEST_F(HeatmapOption, SumOfThePictureIsTheFragments) {
  // `sorted`, like the heat map, draws hidden fragments too, so its statistics count all.
  const std::string said = must(
      "render --look plain builtin:boxes?count=3 builtin:torus_knot?x=1.5,y=1.5 --size 160x120 "
      "--visibility sorted --heatmap h.png --stats s.json");
  const auto stats = json("s.json");
  const auto fragments = stats["fragments"].get<std::uint64_t>();
  const std::size_t at = said.find("light yellow ");
  ASSERT_NE(at, std::string::npos) << said;
  const auto max = static_cast<std::uint32_t>(std::stoul(said.substr(at + 13)));
  EXPECT_TRUE(holds(said, "; " + std::to_string(fragments) + " fragments in all"));

  std::map<std::uint32_t, std::uint32_t> count_of;  // by colour
  const auto key = [](Rgba8 c) { return std::uint32_t{c.r} << 16 | std::uint32_t{c.g} << 8 | c.b; };
  for (std::uint32_t n = 1; n <= max; ++n)
    count_of[key(cli::heat_ramp()[static_cast<std::size_t>(cli::ramp_index(n, max))])] = n;
  ASSERT_EQ(count_of.size(), max) << "two counts share a colour; use a scene with fewer layers";
  count_of[0] = 0;

  std::uint64_t sum = 0, covered = 0;
  const Image<Rgba8> picture = png("h.png");
  for (const Rgba8 c : picture.pixels()) {
    ASSERT_TRUE(count_of.contains(key(c)));
    sum += count_of[key(c)];
    covered += key(c) != 0;
  }
  EXPECT_GT(max, 2U);
  EXPECT_EQ(sum, fragments);
  EXPECT_EQ(covered, stats["pixels_covered"].get<std::uint64_t>());
}

}  // namespace
}  // namespace rastrum::test::heatmap_test
