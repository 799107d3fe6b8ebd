// SPDX-License-Identifier: BSD-3-Clause
// Text and effects as options of the program: only colours change, and nonsense is refused.
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "program.hpp"

namespace rastrum::test::annotations_test {
namespace {

using Annotations = Program;

const Args kScene(
    "render --look plain builtin:gyroid?cells=16 --eye 4,3,5 --target 0,0,0 --size 240x180");

TEST_F(Annotations, ChangeColoursAlone) {
  must(kScene + "-o plain.png --depth d0.npy --ids i0.npy");
  const Image<Rgba8> plain = png("plain.png");
  const Args all("--axes --bounds --occlusion --edl --silhouettes --edges");
  for (const std::string& option : all) {
    must(kScene + option + "-o a.png --depth d1.npy --ids i1.npy --image view-depth=v.npy");
    EXPECT_FALSE(same_pixels(plain, png("a.png"))) << option;
    EXPECT_EQ(read("d0.npy"), read("d1.npy")) << option;
    EXPECT_EQ(read("i0.npy"), read("i1.npy")) << option;
  }
  EXPECT_FALSE(same_pixels(
      plain, drawn(kScene + Args{"--title", "α = 3°", "--caption", "one", "--caption", "two"})));
  // Thread counts and instruction sets change nothing, and timed frames are annotated too.
  std::set<std::string> pictures;
  for (const Args& how : std::vector<Args>{{}, "--threads 1", "--isa scalar", "--frames 2"}) {
    must(kScene + all + how + "-o a.png");
    pictures.insert(read("a.png"));
  }
  EXPECT_EQ(pictures.size(), 1U);
}

TEST_F(Annotations, FloatsAreAnnotatedToo) {
  must(kScene + "-o plain.npy");
  must(kScene + "--title Boxes --occlusion -o a.npy");
  EXPECT_NE(read("plain.npy"), read("a.npy"));
}

// The extremes of a file's coordinates. The default picture has occlusion.
TEST_F(Annotations, OfScenesOfAnySize) {
  for (const std::string size : {"1e-30", "1e30"}) {
    write("size.obj", "v " + size + " 0 0\nv 0 " + size + " 0\nv 0 0 " + size + "\nf 1 2 3\n");
    EXPECT_GT(drawn("render size.obj --size 40x30 --bounds --axes")(20, 15).a, 0) << size;
  }
}

TEST_F(Annotations, AreInEachPictureOfATurn) {
  must("render --look plain builtin:teapot --size 80x60 --bounds --turntable 2 -o t_%d.png");
  EXPECT_FALSE(same_pixels(png("t_0.png"), png("t_1.png")));
}

TEST_F(Annotations, TerrainHasWords) {
  const Args scene("terrain --function noise --size 160x120");
  EXPECT_FALSE(same_pixels(drawn(scene + "--title Noise"), drawn(scene)));
}

TEST_F(Annotations, SayWhatTheFontHasNot) {
  // Invalid UTF-8, control characters, combining marks, right-to-left text.
  for (const auto& [option, text, code] : {std::array{"--title", "漢 a", "U+6F22"},
                                           {"--bar", "a\xff", "U+FFFD"},
                                           {"--bar", "\x01", "U+0001"},
                                           {"--bar", "e\xcc\x81", "U+0301"},
                                           {"--bar", "\xd7\xa9", "U+05E9"}}) {
    const std::string said = must(kScene + "--scalars z -o a.png" + Args{option, text});
    EXPECT_TRUE(holds(said, std::string("the font has no ") + code));
  }
}

TEST_F(Annotations, RefuseWhatCannotBeMeant) {
  for (const auto& [options, says] :
       {std::pair{"--axes --depth d.npy", "--axes"},
        {"--title a --depth d.npy", "--title"},
        {"--occlusion-radius 2 -o a.png", "--occlusion-radius"},
        {"--occlusion --occlusion-radius -2 -o a.png", "--occlusion-radius"},
        {"--occlusion --occlusion-radius 0 -o a.png", "--occlusion-radius"},
        {"--occlusion --occlusion-radius nan -o a.png", "--occlusion-radius"},
        {"--occlusion --occlusion-strength 17 -o a.png",
         "--occlusion-strength: must lie above 0, up to 16"},
        {"--edl --edl-strength 1e9 -o a.png", "--edl-strength: must lie above 0, up to 100"},
        {"--edl-strength 2 -o a.png", "--edl-strength"},
        {"--edge-angle 30 -o a.png", "--edge-angle"},
        {"--edges --edge-angle 181 -o a.png", "--edge-angle"},
        {"--edges --edge-width 0 -o a.png", "--edge-width"},
        {"--edges --depth d.npy", "--edges"},
        {"--text-scale 2 -o a.png", "--text-scale"},
        {"--title a --text-scale 0 -o a.png", "--text-scale"}})
    refused(kScene + options, says);
  refused("terrain --function noise --title a --depth d.npy", "--title");
}

}  // namespace
}  // namespace rastrum::test::annotations_test
