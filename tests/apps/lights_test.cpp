// SPDX-License-Identifier: BSD-3-Clause
// Lights as options of the program.
#include <string>
#include <utility>

#include "program.hpp"

namespace rastrum::test::lights_test {
namespace {

using LightOptions = Program;

const Args kScene("render --look plain builtin:teapot --size 120x90");

TEST_F(LightOptions, LightThePictureAndNothingElse) {
  const auto draw = [&](const std::string& options) { return drawn(kScene + options); };
  const Image<Rgba8> plain = draw("--depth d0.npy");
  for (const std::string light :
       {"ambient:intensity=0.5", "hemisphere:0,0,1:below=#402000:color=skyblue",
        "directional:0,-1,-1", "point:2,2,2:intensity=4:range=9",
        "spot:0,3,3:towards=0,-1,-1:inner=5:outer=20:intensity=9", "headlight:intensity=0.7"}) {
    EXPECT_FALSE(same_pixels(plain, draw("--depth d1.npy --light " + light))) << light;
    EXPECT_EQ(read("d0.npy"), read("d1.npy")) << light;
  }
  EXPECT_FALSE(same_pixels(draw("--lights studio"), draw("--lights studio --shadows")));
  EXPECT_TRUE(same_pixels(plain, draw("--lights default")));
  EXPECT_TRUE(same_pixels(draw("--lights headlight"), draw("--light directional:of=camera")));
}

TEST_F(LightOptions, EnvironmentsAreFilesOrOurOwn) {
  // A picture of one grey, with the header and runs of the format.
  std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n";
  for (int i = 0; i < 32 * 64; ++i) hdr += "\x60\x60\x60\x80";
  write("grey.hdr", hdr);
  const Image<Rgba8> grey = drawn(kScene + "--light environment:grey.hdr --shader lambert");
  const Image<Rgba8> ambient = drawn(kScene + "--light ambient:intensity=0.375 --shader lambert");
  for (std::size_t i = 0; i < grey.pixels().size(); ++i)
    ASSERT_NEAR(grey.pixels()[i].r, ambient.pixels()[i].r, 1);
  const auto corner = [&](const Args& options) { return drawn(kScene + options)(0, 0); };
  EXPECT_EQ(corner("--light environment:grey.hdr").a, 0);
  EXPECT_EQ(corner("--light environment:grey.hdr --environment-behind"),
            (Rgba8{165, 165, 165, 255}));
  EXPECT_NE(corner("--light environment:room:turn=90:up=0,0,1 --environment-behind"),
            corner("--light environment:room --environment-behind"));
}

constexpr const char* kBefore = "--fit sphere --view front --samples 1 --shader phong";

TEST_F(LightOptions, StudioIsWhatItSays) {
  const auto draw = [&](const Args& options) {
    return drawn("render builtin:teapot --size 120x90" + options);
  };
  const Image<Rgba8> said = draw("--view iso --fov 30 --lights studio --occlusion --samples 4");
  EXPECT_TRUE(same_pixels(draw("--look studio"), said));
  // A command line that asks only for a picture also gets the studio look …
  EXPECT_TRUE(same_pixels(draw({}), said));
  EXPECT_FALSE(same_pixels(draw("--look plain"), said));
  // … unless options say otherwise. The last row is the plain picture, by its name.
  for (const auto& [options, same] :
       {std::pair{"--look studio --view top --samples 1 --lights headlight",
                  "--look plain --view top --lights headlight --occlusion"},
        {"--shader phong", "--look plain --view iso --fov 30 --samples 4"},
        {"--lights default", "--look plain --view iso --fov 30 --samples 4"},
        {kBefore, "--look plain --fit sphere"}})
    EXPECT_TRUE(same_pixels(draw(options), draw(same))) << options;
}

// Pins the default pictures from before lights could be chosen. The digests are those of `rastrum
// render builtin:SHAPE --size 120x90 --hash` of 9d2794e (2026-11-23), with and without `--fit
// sphere`; spheres and tube are of 2026-11-28, when fits stopped rounding to float32.
TEST_F(LightOptions, ThePictureOfBeforeIsThereByItsName) {
  const struct {
    std::string shape, sphere, tight;
  } kDigests[] = {
      {"teapot", "f9e3b6772bb9c951db7c0bc8e60841c0bad4011b3d3a38590ee6793a8469d69f",
       "78639677292b44ce32e4e9a6c3095beb0f995e5cf9744dad321dca49523030f8"},
      {"torus_knot", "9ecb00886e9c84c090206de0684f1b20df5feab51bcd09cf176e1c0b1bd9aa67",
       "b1a68bef41efbb8785189068ca7534ece3413178683d7720584d2ec78b213ac6"},
      {"gyroid?cells=24", "28116e9fbc9c6c11d9b280592096358d41270c212ea49dc85183e3a0601f5e3c",
       "1a32ca10780b4d0bae7a8268fb0a3b999f06c52910e28bc51ad115db8bb35aab"},
      {"spheres", "2f28d2cb460351d02fa9dc48b3413a3afb51cc7bf4516390460d5bee0d1a13ef",
       "14abe0e1f21fe86e9f477decac5715cd76046b2889ef91f74570326fadd33e83"},
      {"tube", "49e7dd6fe776d957df6a9de411c626a86842b14f0f90a1e068d814f5d3c2b6f2",
       "2e87bc8e9ff7d217464b9b201c005de33a10bdf99cbff0d8e915e59a80e82923"}};
  const auto hash = [&](const std::string& shape, const Args& how) {
    const Outcome outcome =
        run(Args("render --size 120x90 --hash -o b.png builtin:" + shape) + how);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out.substr(0, 64);
  };
  for (const auto& [shape, sphere, tight] : kDigests) {
    EXPECT_EQ(hash(shape, kBefore), sphere) << shape;
    EXPECT_EQ(hash(shape, "--look plain"), tight) << shape;
  }
}

// Frames with numbers, and frames for comparison, have one sample and the fixed light.
TEST_F(LightOptions, MoreThanAPictureIsPlain) {
  const Args teapot("render builtin:teapot --size 120x90");
  const Image<Rgba8> plain = drawn(teapot + "--look plain --view iso --fov 30");
  for (const char* more : {"--ids i.npy", "--depth d.npy", "--image normals=n.npy",
                           "--heatmap h.png", "--rasterizer tiled"})
    EXPECT_TRUE(same_pixels(drawn(teapot + more), plain)) << more;
}

TEST_F(LightOptions, RefuseWhatCannotBeMeant) {
  const auto refused = [&](const Args& args, const std::string& part) {
    Program::refused(kScene + args + "-o a.png", part);
  };
  refused("--light laser:1,2,3", "--light: expected ambient, hemisphere");
  refused("--light point:1,2", "--light");
  refused("--light environment", "its environment has no picture");
  refused("--light environment:none.hdr", "none.hdr");
  refused("--light environment:room:range=2", "has no 'range=2'");
  refused("--light headlight --environment-behind", "--environment-behind: needs an environment");
  refused("--light ambient:1,2,3", "has no place");
  refused("--light point:1,2,3:outer=4", "has no 'outer=4'");
  refused("--light point:1,2,3:range=-4", "its range");
  refused("--light directional:0,0,0", "its direction");
  refused("--light headlight:intensity=-1", "its intensity");
  refused("--light headlight:intensity=nan", "--light");
  refused("--light spot:0,0,1:inner=30:outer=20", "its cone");
  refused("--light headlight:of=me", "of= is camera or world");
  refused("--shadows", "--shadows: needs lights");
  refused("--lights studio --shadow-size 512", "--shadow-size: needs --shadows");
  refused("--lights disco", "--lights");
  refused("--lights file", "have no lights");
}

}  // namespace
}  // namespace rastrum::test::lights_test
