// SPDX-License-Identifier: BSD-3-Clause
// INPUT@name=value,…: the place and look of an input.
#include "parse/input_spec.hpp"

#include <algorithm>
#include <array>
#include <set>

#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

#include "job/inputs.hpp"
#include "parse/arguments.hpp"
#include "program.hpp"

#include "tests/support/matrices.hpp"

namespace rastrum::test::placement_test {
namespace {

TEST(ParseInput, KeysFollowAnAt) {
  const cli::InputSpec s = cli::parse_input(
      "dir.d/shell.ply@x=1,y=-2,z=0.5,scale=2,rx=10,ry=20,rz=30,color=#ff8000,opacity=0.25");
  EXPECT_EQ(s.source, "dir.d/shell.ply");
  EXPECT_EQ(s.placement, (cli::Placement{1, -2, 0.5, 2, 10, 20, 30}));
  EXPECT_EQ(s.look.opacity, 0.25);
  ASSERT_TRUE(s.look.color);
  EXPECT_EQ(s.look.color->x, 1);
  const cli::InputSpec plain = cli::parse_input("shell.ply");
  EXPECT_EQ(plain.source, "shell.ply");
  EXPECT_EQ(plain.placement, cli::Placement{});
  EXPECT_FALSE(plain.look.given());
}

TEST(ParseInput, ABuiltinTakesThemAmongItsParameters) {
  for (const char* text : {"builtin:sphere?rings=4,x=3,segments=5,scale=0.5,color=#ff0000",
                           "builtin:sphere?rings=4&segments=5@x=3,scale=0.5,color=#ff0000",
                           "builtin:sphere?x=3,rings=4,segments=5@scale=0.5,color=#ff0000"}) {
    const cli::InputSpec s = cli::parse_input(text);
    EXPECT_EQ(s.source, "builtin:sphere?rings=4&segments=5") << text;
    EXPECT_EQ(s.placement, (cli::Placement{.x = 3, .scale = 0.5})) << text;
    EXPECT_TRUE(s.look.color) << text;
  }
}

TEST(ParseInput, RefusesWhatIsNone) {
  for (const char* text :
       {"a.ply@x=", "a.ply@x=1,", "a.ply@x=1,y", "a.ply@size=3", "a.ply@scale=0", "a.ply@opacity=2",
        "a.ply@color=blau", "builtin:sphere@", "builtin:sphere@rings=3"})
    EXPECT_THROW((void)cli::parse_input(text), cli::UsageError) << text;
  // Without a list of values after the @ and a file before it, the text is a file's name.
  EXPECT_EQ(cli::parse_input("me@home.ply").source, "me@home.ply");
}

TEST(Placement, ScalesThenTurnsAboutXYZThenMoves) {
  expect_near(cli::Placement{}.matrix(), Mat4d::identity(), 0);
  const cli::Placement p{4, 5, 6, 3, 90, 90, 0};
  // (1, 0, 0): scaled to 3, about x the same, about y to −z. (0, 1, 0): to z, to x.
  const Mat4d m{{{0, 3, 0, 4}, {0, 0, -3, 5}, {-3, 0, 0, 6}, {0, 0, 0, 1}}};
  expect_near(p.matrix(), m, 0);
}

class PlacedInputs : public Program {
 protected:
  [[nodiscard]] Image<Rgba8> drawn(const Args& args) const {
    return Program::drawn("render --look plain --size 96x64" + args);
  }
};

TEST_F(PlacedInputs, AFileStandsWhereABuiltinWould) {
  must("make teapot?n=3 -o t.ply");
  const std::string at = "x=2,y=-1,z=0.5,scale=0.75,rx=90,ry=30,rz=-15";
  const Image<Rgba8> placed = drawn({"builtin:boxes?count=1", "t.ply@" + at});
  EXPECT_TRUE(same_pixels(placed, drawn({"builtin:boxes?count=1", "builtin:teapot?n=3," + at})));
  EXPECT_FALSE(same_pixels(placed, drawn({"builtin:boxes?count=1", "t.ply"})));
  // make and info read inputs like render.
  must({"make", "t.ply@" + at, "-o", "placed.ply"});
  must({"make", "teapot?n=3@" + at, "-o", "shape.ply"});
  EXPECT_EQ(read("placed.ply").size(), read("shape.ply").size());
  EXPECT_EQ(run({"info", "t.ply@" + at}).status, 0);
}

TEST_F(PlacedInputs, AFileThatIsCalledSoIsMeant) {
  must("make sphere?rings=4,segments=5 -o s.ply");
  std::filesystem::copy_file(path("s.ply"), path("s@x=3.ply"));
  std::filesystem::copy_file(path("s.ply"), path("a@b.ply"));
  const Image<Rgba8> plain = drawn({"s.ply"});
  EXPECT_TRUE(same_pixels(drawn({"s@x=3.ply"}), plain));
  EXPECT_TRUE(same_pixels(drawn({"a@b.ply@x=0"}), plain));
  refused("render --look plain me@home.ply -o p.png", "me@home.ply", 1);
  refused("render --look plain s.ply@opacty=1 -o p.png",
          "s.ply@opacty=1: expected x, y, z, scale, rx, ry, rz, color and opacity");
}

TEST_F(PlacedInputs, OpacityIsOfOneInput) {
  // A wall in front of a wall: the first one lets the second one show through.
  write("w.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
  const Image<Rgba8> glass = drawn({"w.obj@opacity=0.25"});
  EXPECT_EQ(glass(48, 32).a, 64);
  const Image<Rgba8> both = drawn({"w.obj@opacity=0.25,z=0.5", "w.obj"});
  EXPECT_EQ(both(48, 32).a, 255);
  // The same as --opacity, for this input alone; the two are multiplied.
  EXPECT_TRUE(same_pixels(glass, drawn("w.obj --opacity 0.25")));
  EXPECT_TRUE(same_pixels(drawn("w.obj@opacity=0.5 --opacity 0.5"), glass));
  EXPECT_EQ(drawn({"w.obj@color=#ff000080"})(48, 32).a, 128);
}

TEST_F(PlacedInputs, ColorIsOfOneInput) {
  for (const std::string shader : {"auto", "flat", "phong", "material"}) {
    SCOPED_TRACE(shader);
    const Image<Rgba8> p = drawn({"builtin:sphere?x=-1.5,color=#ff0000",
                                  "builtin:sphere@x=1.5,color=#0000ff", "--shader", shader});
    int red = 0, blue = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 96; ++x) {
        red += x < 48 && p(x, y).r > 2 * p(x, y).b;
        blue += x >= 48 && p(x, y).b > 2 * p(x, y).r;
        EXPECT_FALSE(x < 46 && p(x, y).b > p(x, y).r);
      }
    EXPECT_GT(red, 300);
    EXPECT_GT(blue, 300);
  }
  // The colour appears unchanged.
  EXPECT_EQ(drawn("builtin:sphere@color=#88aaff --shader flat")(48, 32),
            (Rgba8{0x88, 0xaa, 0xff, 255}));
}

TEST_F(PlacedInputs, ColorTakesThePlaceOfTheFiles) {
  write("m.mtl", "newmtl green\nKd 0 1 0\nd 0.5\n");
  write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl green\nf 1 2 3\n");
  const Image<Rgba8> own = drawn({"m.obj"}), red = drawn({"m.obj@color=#ff0000"});
  bool seen = false;
  for (std::size_t i = 0; i < own.pixels().size(); ++i) {
    if (own.pixels()[i].a == 0) continue;
    seen = true;
    EXPECT_GT(own.pixels()[i].g, own.pixels()[i].r);
    EXPECT_GT(red.pixels()[i].r, red.pixels()[i].g);
    EXPECT_EQ(red.pixels()[i].a, own.pixels()[i].a) << "its transparency stays";
  }
  EXPECT_TRUE(seen);
}

TEST_F(PlacedInputs, ThoseThatSayNothingLookAsBefore) {
  // A look is not a file's material, so the shader stays phong.
  const Image<Rgba8> alone = drawn({"builtin:teapot?n=3", "builtin:boxes?count=1,x=9"});
  const Image<Rgba8> beside =
      drawn({"builtin:teapot?n=3", "builtin:boxes?count=1,x=9,color=#00ff00"});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 40; ++x) {
      const Rgba8 a = alone(x, y), b = beside(x, y);
      EXPECT_LE(std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b),
                          std::abs(a.a - b.a)}),
                1)
          << x << "," << y;
    }
}

TEST_F(PlacedInputs, ObjectsAndStatisticsTellInputsApart) {
  must(
      "render --look plain builtin:sphere?x=-2 builtin:boxes?count=1 builtin:sphere?x=2,rings=4 "
      "--objects o.npy --ids i.npy --stats s.json --size 96x64");
  EXPECT_TRUE(holds(npy("o.npy").header, "'<i4'"));
  const auto objects = npy("o.npy").values<std::int32_t>();
  const auto ids = npy("i.npy").values<std::int64_t>();
  const auto parts = json("s.json")["inputs"];
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[2]["name"], "builtin:sphere?x=2,rings=4");
  EXPECT_EQ(parts[1]["triangles"], 12);
  std::set<std::int32_t> seen;
  ASSERT_EQ(objects.size(), ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    seen.insert(objects[i]);
    if (ids[i] < 0) {
      EXPECT_EQ(objects[i], -1);
      continue;
    }
    const auto& part = parts[static_cast<std::size_t>(objects[i])];
    EXPECT_GE(ids[i], part["first_id"].get<std::int64_t>());
    EXPECT_LT(ids[i], part["first_id"].get<std::int64_t>() + part["triangles"].get<std::int64_t>());
  }
  EXPECT_EQ(seen, (std::set<std::int32_t>{-1, 0, 1, 2}));
}

TEST(InputsOfIds, InputsWithoutTrianglesHaveNone) {
  const std::vector<cli::InputPart> parts{{"a", 0, 0}, {"b", 0, 2}, {"c", 2, 0}, {"d", 2, 1}};
  Image<std::int64_t> ids(4, 1);
  for (int x = 0; x < 4; ++x) ids(x, 0) = x - 1;
  const Image<std::int32_t> inputs = cli::inputs_of_ids(ids.view(), parts);
  EXPECT_TRUE(std::ranges::equal(inputs.pixels(), std::array{-1, 1, 1, 3}));
}

}  // namespace
}  // namespace rastrum::test::placement_test
