// SPDX-License-Identifier: BSD-3-Clause
// Obstacles of a run: no space for temporary files, messages that quote whole files, camera paths
// without a direction, limits that would change the look.
#include "program.hpp"

namespace rastrum::test::fault_test {
namespace {

using Faults = Program;

TEST_F(Faults, StandardOutputNeedsNoTemporaryFolder) {
  const std::string render = "$RASTRUM render builtin:sphere --size 40x30 --quiet -o ";
  ASSERT_EQ(shell(render + "p.png").status, 0);
  for (const char* folder : {"/nonexistent", "''", "/proc", "\"$PWD\""}) {
    const Outcome r = shell("TMPDIR=" + std::string(folder) + " " + render + "-");
    EXPECT_EQ(r.status, 0) << folder << r.err;
    EXPECT_TRUE(r.out == read("p.png")) << folder;
  }
  const std::string unshare = "unshare -m ";
  if (shell(unshare + "mount -t tmpfs -o ro none /tmp").status != 0)
    GTEST_SKIP() << "this user may not mount: the case without any folder is not tested";
  const Outcome r = shell(unshare +
                          "sh -c 'mount -t tmpfs -o ro none /tmp && "
                          "mount -t tmpfs -o ro none /var/tmp && cd /tmp && " +
                          render + "-'");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_TRUE(r.out == read("p.png"));
}

TEST_F(Faults, MessagesQuoteTenMegabytesInShort) {
  const std::string word(10'000'000, 'w');
  write("a.obj", "v " + word + " 0 0\n");
  write("b.obj", word + " 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl " + word + "\nf 1 2 3\n");
  write("c.json", R"({"keys": [{"eye": ")" + word + R"("}]})");
  write("d.json", "{" + word);
  write("e.json", R"({"keys": [{")" + word + R"(": 1}]})");
  const auto said = [&](const Args& args, const char* file) {
    const Outcome r = run(args);
    EXPECT_LT(r.err.size(), 6000U) << file;
    EXPECT_TRUE(holds(r.err, file));
  };
  said("render a.obj -o p.png", "a.obj");
  said("render b.obj -o p.png", "b.obj");
  for (const char* file : {"c.json", "d.json", "e.json"}) {
    said({"render", "builtin:sphere", "--path", file, "-o", "f%d.png"}, file);
    said({"terrain", "--function", "noise", "--path", file, "-o", "f%d.png"}, file);
  }
  // A long command line is quoted in part, so that the message keeps its end, the remedy.
  const Outcome r = run({"render", "builtin:sphere", "--view", std::string(100'000, 'v')});
  EXPECT_EQ(r.status, 2);
  EXPECT_LT(r.err.size(), 3000U);
  EXPECT_TRUE(holds(r.err, "--view: expected"));
  EXPECT_TRUE(holds(r.err, "bytes left out"));
}

TEST_F(Faults, MessagesOfCameraPathsAndPicturesNameTheFile) {
  write("meet.json", R"({"interpolation": "linear", "keys": [
      {"time": 0, "eye": [0, 0, 1], "target": [0, 0, 0]},
      {"time": 2, "eye": [0, 0, 0], "target": [0, 0, 1]}]})");
  write("long.json", R"({"keys": [{"time": 0, "eye": [0, 0, 3]}, {"time": 1e9}]})");
  const auto said = [&](const Args& args, const std::string& what) {
    const Outcome r = run(args + "--size 8x8 -o f%d.png");
    EXPECT_NE(r.status, 0) << what;
    EXPECT_TRUE(holds(r.err, what));
    EXPECT_FALSE(std::filesystem::exists(path("f0.png"))) << what;
  };
  said("render builtin:sphere --path meet.json --fps 1", "meet.json: at 1.0");
  said("render builtin:sphere --path long.json", "long.json: the path has");
  said("terrain --function noise --path long.json", "long.json: ");
  write("e", "no picture");
  said("render builtin:sphere --light environment:e", "--light: e: ");
}

TEST_F(Faults, AMemoryLimitDoesNotChangeTheLook) {
  const Args render("render builtin:teapot --size 120x90");
  const Image<Rgba8> without = drawn(render);
  for (const std::string limit : {"4M", "64M", "2G"})
    EXPECT_TRUE(same_pixels(drawn(render + ("--memory-limit " + limit)), without)) << limit;
  must("make teapot -o t.ply");
  const Args file("render t.ply --size 120x90");
  EXPECT_TRUE(same_pixels(drawn(file + "--memory-limit 1G --out-of-core always"), drawn(file)));
}

}  // namespace
}  // namespace rastrum::test::fault_test
