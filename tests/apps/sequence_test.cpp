// SPDX-License-Identifier: BSD-3-Clause
// --turntable, and the camera in --stats and --depth-unit.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "program.hpp"

namespace rastrum::test::sequence_test {
namespace {

using Sequences = Program;

TEST_F(Sequences, ATurntableTurnsTheSceneAndKeepsItsSize) {
  // A flag beside the axis: from −z it is on the other side, at quarter turns edge-on.
  write("f.obj", "v 1 -1 0\nv 3 -1 0\nv 3 1 0\nv 1 1 0\nf 1 2 3 4\nv -3 0 0\nv -3 0 0\nf 5 6 6\n");
  const std::string said = must(
      "render --look plain f.obj --turntable 4 -o t%02d.png --ids i%02d.npy --stats s.json --size "
      "120x60");
  EXPECT_TRUE(holds(said, "t%02d.png: 4 pictures of 120x60"));
  const auto columns = [&](const std::string& name) {
    const auto ids = npy(name).values<std::int64_t>();
    std::pair<int, int> range{120, -1};
    for (int i = 0; i < 120 * 60; ++i)
      if (ids[static_cast<std::size_t>(i)] >= 0)
        range = {std::min(range.first, i % 120), std::max(range.second, i % 120)};
    return range;
  };
  const auto right = columns("i00.npy"), left = columns("i02.npy");
  EXPECT_GT(right.first, 60);
  EXPECT_LT(left.second, 60);
  EXPECT_NEAR(right.first, 119 - left.second, 1);
  EXPECT_NEAR(right.second, 119 - left.first, 1);
  EXPECT_EQ(columns("i01.npy").second, -1) << "edge on";
  // All pictures share the size of a fit for all angles, and one camera.
  const auto cameras = json("s.json")["cameras"];
  ASSERT_EQ(cameras.size(), 4U);
  for (const auto& c : cameras) EXPECT_EQ(c, cameras[0]);
  EXPECT_EQ(json("s.json")["frame_ms"]["frames"], 4);
}

TEST_F(Sequences, TheFirstPictureOfATurntableIsThePlainOne) {
  for (const char* camera :
       {"--fit sphere", "--eye 1,2,6 --target 0.2,0.1,0 --up 0.1,1,0 --near 1"}) {
    const Args args = Args("render --look plain builtin:teapot?n=3 --size 64x48") + camera;
    const Image<Rgba8> plain = drawn(args);
    must(args + "-o t%d.png --turntable 3");
    EXPECT_TRUE(same_pixels(png("t0.png"), plain));
    EXPECT_FALSE(same_pixels(png("t1.png"), plain));
  }
}

TEST_F(Sequences, ATurntableOfAnOwnCameraCutsNothingOff) {
  // The scene is away from its target: the near plane must also fit when the scene comes to the
  // front.
  must(
      "render --look plain builtin:sphere?x=3 --eye 0,0,9 --target 0,0,0 --turntable 8 --ids "
      "i%d.npy --stats s.json --size 64x64");
  const auto cameras = json("s.json")["cameras"];
  EXPECT_LE(cameras[0]["near"].get<double>(), 5);
  for (int i = 0; i < 8; ++i) {
    const auto ids = npy("i" + std::to_string(i) + ".npy").values<std::int64_t>();
    EXPECT_GT(std::ranges::count_if(ids, [](auto id) { return id >= 0; }), 50) << i;
  }
}

TEST_F(Sequences, ATurntableAsAFilm) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
  must("render --look plain builtin:teapot?n=3 --turntable 5 --fps 10 -o t.mp4 --size 64x48");
  EXPECT_EQ(files(), Args("t.mp4"));
  EXPECT_GT(read("t.mp4").size(), 500U);
}

TEST_F(Sequences, RefuseWhatCannotBeMeant) {
  const auto refused = [&](const Args& extra, const std::string& words) {
    Program::refused("render --look plain builtin:boxes --turntable 4" + extra, words);
    EXPECT_TRUE(files().empty());
  };
  refused("-o t.png", "-o: there are 4 pictures: number them, as in frame_%04d.png");
  refused("-o t%d.png --frames 3", "--frames: cannot go with --turntable");
  refused("-o t%d.png --path p.json", "--turntable: cannot go with --path");
  refused("-o t%d.png --camera 0", "--turntable: the camera of a file has no target");
  refused("-o t%d.png --turntable 0", "--turntable");
  Program::refused("render --look plain builtin:boxes -o p.png --fps 3",
                   "--fps: needs --path or --turntable");
}

class DepthUnit : public Program {
 protected:
  /// A wall at z = 2 in the middle of the picture, seen from z = 12.
  void SetUp() override {
    Program::SetUp();
    write("w.obj", "v -1 -1 2\nv 1 -1 2\nv 1 1 2\nv -1 1 2\nf 1 2 3 4\n");
  }
  [[nodiscard]] std::vector<float> depths(const Args& extra) const {
    must("render --look plain w.obj --eye 0,0,12 --target 0,0,0 --size 31x31 --depth d.npy" +
         extra);
    return npy("d.npy").values<float>();
  }
};

TEST_F(DepthUnit, WorldIsTheDistanceAlongTheViewAxis) {
  constexpr std::size_t kMiddle = 15 * 31 + 15;
  for (const char* camera : {"", "--near 0.5", "--near 2 --far 30", "--orthographic 6",
                             "--orthographic 6 --near -5 --far 500"}) {
    const std::vector<float> d = depths(Args(camera) + "--depth-unit world");
    EXPECT_NEAR(d[kMiddle], 10, 2e-4);
    EXPECT_TRUE(std::isinf(d[0]) && d[0] > 0) << "where nothing is";
    for (const float z : d) EXPECT_TRUE(std::isinf(z) || std::abs(z - 10) < 2e-4F) << z;
  }
}

TEST_F(DepthUnit, ReversedIsWhatItWasAndStatsHaveTheFormula) {
  const std::vector<float> plain = depths("--stats s.json");
  EXPECT_EQ(depths("--depth-unit reversed"), plain);
  const auto camera = json("s.json")["cameras"][0];
  EXPECT_EQ(camera["far"], "inf");
  EXPECT_NEAR(camera["near"].get<double>() / static_cast<double>(plain[15 * 31 + 15]), 10, 1e-4);
  EXPECT_EQ(camera["eye"], (nlohmann::ordered_json{0, 0, 12}));
}

TEST_F(DepthUnit, BelongsToDepth) {
  refused("render --look plain w.obj -o p.png --depth-unit world", "--depth-unit: needs --depth");
}

}  // namespace
}  // namespace rastrum::test::sequence_test
