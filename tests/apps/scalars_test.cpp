// SPDX-License-Identifier: BSD-3-Clause
// Numbers as colours by the program's options: of files, of positions, with a bar, and refusals.
#include <cmath>
#include <string>
#include <vector>

#include "flatten.hpp"
#include "program.hpp"

namespace rastrum::test::scalars_program_test {
namespace {

using Scalars = Program;

constexpr const char* kFile =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nproperty float heat\nelement face 2\n"
    "property list uchar int vertex_indices\nproperty uchar part\nend_header\n"
    "0 0 0 0\n1 0 0 1\n1 1 0 1\n0 1 0 nan\n3 0 1 2 4\n3 0 2 3 9\n";

TEST_F(Scalars, OfAFileAreDrawnAndListed) {
  write("s.ply", kFile);
  const std::string info = run("info s.ply").out;
  EXPECT_TRUE(holds(info, "scalars heat: 4 values, 0 to 1, 1 not finite"));
  EXPECT_TRUE(holds(info, "scalars part: 2 values, 4 to 9"));
  const auto drawn = [&](const Args& more) {
    must("render --look plain s.ply --shader flat --size 64x64 --transparency exact" + more +
         "--output a.png");
    return png("a.png");
  };
  // Numbers below the diagonal; above it the corner without one.
  const Image<Rgba8> heat = drawn("--scalars heat --cmap gray --nan-color #ff0000");
  EXPECT_EQ(heat(20, 10), (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(heat(40, 58).r, heat(40, 58).g);
  EXPECT_LT(heat(20, 58).r, heat(40, 58).r);
  const Image<Rgba8> part = drawn("--scalars part --cmap #0000ff,#00ff00 --steps 2");
  EXPECT_EQ(part(40, 58), (Rgba8{0, 0, 255, 255}));
  EXPECT_EQ(part(20, 10), (Rgba8{0, 255, 0, 255}));
  const Image<Rgba8> named = drawn("--scalars part --categories 9,4 --cmap #ff0000,#00ff00");
  EXPECT_EQ(named(20, 10), (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(named(40, 58), (Rgba8{0, 255, 0, 255}));
  const Image<Rgba8> faint = drawn("--scalars part --scalar-opacity 4:0,9:1");
  EXPECT_EQ(faint(40, 58).a, 0);
  EXPECT_EQ(faint(20, 10).a, 255);
}

TEST_F(Scalars, StayWithTheirMeshes) {
  write("s.ply", kFile);
  must("make s.ply@x=5 -o one.ply");
  EXPECT_TRUE(holds(run("info one.ply").out, "scalars part: 2 values, 4 to 9"));
  must("make s.ply --subdivide 2 -o many.ply");
  const std::string info = run("info many.ply").out;
  EXPECT_TRUE(holds(info, "scalars part: 32 values, 4 to 9"));
  EXPECT_TRUE(holds(info, "scalars heat: 25 values, 0 to 1"));
  // Several meshes together keep the scalars that all of them have.
  Scene two;
  two.meshes.resize(2);
  two.instances.resize(2);
  two.instances[1].mesh = 1;
  for (Mesh& mesh : two.meshes) {
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.scalars = {{"heat", {1, 2, 3}}};
  }
  const cli::Flattened same = cli::flatten(two);
  EXPECT_EQ(same.mesh.scalars.at(0).values, (std::vector<double>{1, 2, 3, 1, 2, 3}));
  EXPECT_TRUE(same.warnings.empty());
  two.meshes[1].scalars[0].name = "cold";
  const cli::Flattened apart = cli::flatten(two);
  EXPECT_TRUE(apart.mesh.scalars.empty());
  ASSERT_EQ(apart.warnings.size(), 1U);
  EXPECT_TRUE(holds(apart.warnings[0], "the scalars are left out"));
}

TEST_F(Scalars, OfPlacesAreThoseOfTheWorld) {
  must(
      "render --look plain builtin:teapot?y=7 --scalars y --size 64x48 --image scalars=s.npy "
      "--image positions=p.npy");
  const std::vector<float> s = npy("s.npy").values<float>(), p = npy("p.npy").values<float>();
  int seen = 0;
  for (std::size_t i = 0; i < 64 * 48; ++i) {
    if (std::isnan(s[i])) continue;
    ASSERT_NEAR(s[i], p[3 * i + 1], 1e-5);
    ++seen;
  }
  EXPECT_GT(seen, 500);
}

TEST_F(Scalars, HaveABarAndIsolines) {
  const Args base("render --look plain builtin:sphere --scalars y --size 160x120 --eye 0,0,4");
  const Image<Rgba8> plain = drawn(base);
  for (const char* more :
       {"--bar Height --bar-unit m", "--isolines 5", "--isolines 0.25, --isoline-width 3",
        "--log --range 0.1,1", "--symmetric --cmap RdBu_r"})
    EXPECT_FALSE(same_pixels(plain, drawn(base + more))) << more;
}

TEST_F(Scalars, RefuseWhatCannotBeMeant) {
  const auto refused = [&](const Args& more, const std::string& part, int status = 2) {
    Program::refused("render --look plain builtin:boxes -o a.png" + more, part, status);
  };
  refused("--scalars heat", "there are none but those of every scene: x, y, z, distance", 1);
  refused("--cmap viridis", "say which, as in --scalars z");
  refused("--log", "--log");
  refused("--scalars z --cmap vridis", "there are, each also with _r for its reverse");
  refused("--scalars z --range 2,1", "must not be above the second");
  refused("--scalars z --range 2", "LOW,HIGH");
  refused("--scalars z --range nan,1", "--range");
  refused("--scalars z --log --range -1,1", "must lie above 0");
  refused("--scalars z --scalar-opacity 1:0,0:1", "must rise");
  refused("--scalars z --scalar-opacity 1", "VALUE:OPACITY");
  refused("--scalars z --bar-unit m", "needs --bar");
  refused("--scalars z --scalar-opacity 0:2", "--scalar-opacity: [0]");
  refused("--scalars z --isoline-width 3", "--isoline-width: needs --isolines");
  refused("--scalars z --isolines 3 --isoline-width 0", "--isoline-width: must lie in (0, 64]");
  refused({"--scalars", ""}, "--scalars: the name is empty");
  refused("--scalars distence", "did you mean 'distance'?", 1);
  refused("--scalars z --cmap Viridis", "did you mean 'viridis'?");
  refused("--scalars z --cmap coolwarn_r", "did you mean 'coolwarm_r'?");
  refused({"--scalars", "z", "--cmap", ""}, "--cmap");
  refused({"--scalars", "z", "--range", ""}, "--range");
  refused("--scalars z --range -1e308,1e308", "--range: too wide");
  refused("--scalars z --range 0,inf", "--range");
  refused("--scalars z --steps 0", "--steps");
  refused("--scalars z --steps 1000000000", "--steps");
  refused("--scalars z --categories 1,1", "--categories: [1]: is there already");
  refused("--scalars z --isolines nan,", "--isolines");
}

}  // namespace
}  // namespace rastrum::test::scalars_program_test
