// SPDX-License-Identifier: BSD-3-Clause
// --time, --animation, and files that move along a path.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "program.hpp"
#include "tests/io/gltf_document.hpp"

namespace rastrum::test::animation_test {
namespace {

/// A square, left of the middle at rest. Animation 0 moves it to the right within a second;
/// animation 1 grows it by a morph target within two.
std::string square() {
  GltfDocument d;
  d.floats({-2, -1, 0, -1, -1, 0, -1, 1, 0, -2, -1, 0, -1, 1, 0, -2, 1, 0}, "VEC3");
  d.floats({0, 0, 0, 3, 0, 0, 3, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0}, "VEC3");
  d.floats({0, 1}, "SCALAR");
  d.floats({0, 0, 0, 3, 0, 0}, "VEC3");
  d.floats({0, 2}, "SCALAR");
  d.floats({0, 1}, "SCALAR");
  return d.text(
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1}]}]}],)"
      R"("nodes":[{"mesh":0}],"animations":[{"name":"walk","samplers":[{"input":2,"output":3}],)"
      R"("channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]},)"
      R"({"name":"grow","samplers":[{"input":4,"output":5}],)"
      R"("channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}]}])");
}

class Animations : public Program {
 protected:
  static constexpr int kWidth = 80, kHeight = 20;

  void SetUp() override {
    Program::SetUp();
    write("s.gltf", square());
  }
  /// The first and last covered column; ten columns are a unit.
  [[nodiscard]] std::pair<int, int> columns(const std::string& ids) const {
    const auto values = npy(ids).values<std::int64_t>();
    std::pair<int, int> range{kWidth, -1};
    for (int i = 0; i < kWidth * kHeight; ++i)
      if (values[static_cast<std::size_t>(i)] >= 0)
        range = {std::min(range.first, i % kWidth), std::max(range.second, i % kWidth)};
    return range;
  }
  [[nodiscard]] Args drawing(const Args& extra) const {
    return "render --look plain s.gltf --eye 0,0,5 --target 0,0,0 --size 80x20 --orthographic 2" +
           extra;
  }
  [[nodiscard]] std::pair<int, int> seen(const Args& extra) const {
    must(drawing(extra + "--ids i.npy"));
    return columns("i.npy");
  }
};

using Columns = std::pair<int, int>;

TEST_F(Animations, TimeIsAMomentOfAnAnimation) {
  for (const auto& [extra, columns] : {std::pair{"", Columns(20, 29)},
                                       {"--time 0", {20, 29}},
                                       {"--time 0.5", {35, 44}},
                                       {"--time 1", {50, 59}},
                                       {"--time 7.5", {35, 44}},  // the animation repeats
                                       {"--time 1 --animation 1", {20, 44}}})
    EXPECT_EQ(seen(extra), columns) << extra;
  const Outcome info = run("info s.gltf");
  EXPECT_TRUE(holds(info.out, "animation 0 walk: 1 s"));
  EXPECT_TRUE(holds(info.out, "animation 1 grow: 2 s"));
}

TEST_F(Animations, APlacedFileMovesInItsPlace) {
  must(
      "render --look plain s.gltf@scale=0.5,y=-20 s.gltf@scale=0.5,x=1 --time 1 --eye 0,0,5 "
      "--target 0,0,0 --size 80x20 --orthographic 2 --ids i.npy");
  EXPECT_EQ(columns("i.npy"), Columns(55, 59)) << "half of three units, beside one";
}

TEST_F(Animations, AlongAPathEachPictureHasItsTime) {
  write("p.json", R"({"keys": [{"time": 0, "eye": [0,0,5], "target": [0,0,0]},)"
                  R"({"time": 1, "eye": [0,0,5], "target": [0,0,0]}]})");
  must(drawing("--path p.json --fps 2 --ids m%d.npy"));
  EXPECT_EQ(columns("m0.npy"), Columns(20, 29));
  EXPECT_EQ(columns("m1.npy"), Columns(35, 44));
  EXPECT_EQ(columns("m2.npy"), Columns(50, 59));
  must(drawing("--path p.json --fps 2 --time 0.5 --ids h%d.npy"));
  EXPECT_EQ(columns("h0.npy"), Columns(35, 44)) << "--time holds them at a moment";
  EXPECT_EQ(columns("h2.npy"), Columns(35, 44));
}

// A lamp moves from x = 0 to x = 3 within a second, in a file without other things.
TEST_F(Animations, LightsGoWithTheirNodes) {
  GltfDocument d;
  d.floats({0, 1}, "SCALAR");
  d.floats({0, 1, 2, 3, 1, 2}, "VEC3");
  write("lamp.gltf",
        d.text(R"("extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":)"
               R"({"lights":[{"type":"point","intensity":9}]}},"nodes":[{"translation":[0,1,2],)"
               R"("extensions":{"KHR_lights_punctual":{"light":0}}}],"animations":[{"samplers":)"
               R"([{"input":0,"output":1}],"channels":[{"sampler":0,"target":{"node":0,)"
               R"("path":"translation"}}]}])"));
  const auto draw = [&](const Args& more) {
    return drawn("render --look plain builtin:sphere --eye 0,0,5 --size 60x40" + more);
  };
  const auto at = [&](const std::string& x) {
    return draw("--light point:" + x + ",1,2:intensity=2.86478886");
  };
  EXPECT_TRUE(same_pixels(draw("lamp.gltf --lights file"), at("0")));
  EXPECT_TRUE(same_pixels(draw("lamp.gltf --lights file --time 1"), at("3")));
  EXPECT_TRUE(same_pixels(draw("lamp.gltf@x=1 --lights file --time 0.5"), at("2.5")));
  write("still.json",
        R"({"interpolation":"linear","keys":[{"time":0,"eye":[0,0,5],"target":[0,0,0]},)"
        R"({"time":1,"eye":[0,0,5],"target":[0,0,0]}]})");
  must(
      "render --look plain builtin:sphere lamp.gltf --lights file --path still.json --fps 2 --size "
      "60x40 -o f%d.png");
  EXPECT_TRUE(same_pixels(png("f1.png"), at("1.5")));
}

TEST_F(Animations, WhatCannotBeMeantIsRefused) {
  const auto refused = [&](const Args& extra, const std::string& words) {
    Program::refused(drawing(extra), words);
  };
  refused("-o p.png --time -1", "--time: must not be negative");
  refused("-o p.png --animation 1", "--animation: needs --time or --path");
  refused("-o p.png --time 1 --animation 2",
          "--animation: there is no animation 2: the files have 2");
  Program::refused("render --look plain builtin:boxes --time 1 -o p.png",
                   "no input has an animation", 0);
}

}  // namespace
}  // namespace rastrum::test::animation_test
