// SPDX-License-Identifier: BSD-3-Clause
// Standard output and input as files: a pipe carries the bytes of the file.
#include <array>
#include <cstdlib>

#include "program.hpp"

namespace rastrum::test::pipe_test {
namespace {

class Pipes : public Program {
 protected:
  std::string sh(const std::string& script) const {
    const Outcome r = shell(script);
    EXPECT_EQ(r.status, 0) << script << "\n" << r.err;
    return r.out;
  }
};

TEST_F(Pipes, StandardOutputHoldsTheFile) {
  const std::string render = "$RASTRUM render builtin:boxes?count=2 --size 40x30 --quiet ";
  for (const auto& [option, name, format] :
       std::vector<std::array<std::string, 3>>{{"-o", "p.png", ""},
                                               {"-o", "p.png", " --output-format png"},
                                               {"-o", "p.npy", " --output-format npy"},
                                               {"--depth", "d.npy", ""},
                                               {"--ids", "i.npy", ""},
                                               {"--heatmap", "h.png", ""}}) {
    sh(render + option + " " + name);
    EXPECT_TRUE(sh(render + option + " -" + format) == read(name)) << option << " " << name;
    EXPECT_TRUE(sh(render + option + " /dev/stdout" + format + " | cat") == read(name)) << name;
  }
  sh("$RASTRUM make 'torus_knot?segments=9,sides=4' --quiet -o k.ply");
  EXPECT_TRUE(sh("$RASTRUM make 'torus_knot?segments=9,sides=4' --quiet -o -") == read("k.ply"));
  sh("$RASTRUM terrain --function noise --size 40x30 --quiet -o t.png");
  EXPECT_TRUE(sh("$RASTRUM terrain --function noise --size 40x30 -o - 2>/dev/null") ==
              read("t.png"));
}

TEST_F(Pipes, OpenExrThatSeeksGoesIntoOneToo) {
#ifdef RASTRUM_HAS_OPENEXR
  const std::string render = "$RASTRUM render builtin:sphere --size 40x30 --quiet -o ";
  sh(render + "p.exr");
  EXPECT_TRUE(sh(render + "- --output-format exr | cat") == read("p.exr"));
  sh("mkfifo f.exr; cat f.exr > q.exr & " + render + "f.exr && wait");
  EXPECT_EQ(read("q.exr"), read("p.exr"));
#else
  GTEST_SKIP() << "built without OpenEXR";
#endif
}

TEST_F(Pipes, AMeshComesThroughStandardInput) {
  sh("$RASTRUM make boxes?count=3 -o b.ply --quiet");
  sh("$RASTRUM render b.ply --size 40x30 -o p.png --quiet");
  for (const char* script :
       {"$RASTRUM make boxes?count=3 -o - --quiet | $RASTRUM render - --format ply",
        "cat b.ply | $RASTRUM render /dev/stdin --format ply",
        "$RASTRUM render - --format ply < b.ply",
        "mkfifo f; cat b.ply > f & $RASTRUM render f --format ply",
        "cp b.ply b.tmp; $RASTRUM render b.tmp --format ply"})
    EXPECT_TRUE(sh(std::string(script) + " --size 40x30 -o - --quiet") == read("p.png")) << script;
  const std::string info = sh("cat b.ply | $RASTRUM info - --format ply");
  EXPECT_TRUE(holds(info, "324 triangles"));
  sh("cat b.ply | $RASTRUM make - --format ply -o c.ply --quiet");
  EXPECT_EQ(read("c.ply"), read("b.ply"));
}

TEST_F(Pipes, TexturesAndTheLikeLieInTheCurrentDirectory) {
  write("m.mtl", "newmtl red\nKd 0.8 0.1 0.1\n");
  write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
  sh("$RASTRUM render m.obj --size 20x20 -o m.png --quiet");
  EXPECT_TRUE(sh("$RASTRUM render - --format obj --size 20x20 -o - --quiet < m.obj") ==
              read("m.png"));
}

TEST_F(Pipes, AreRefusedWhereTheyCannotBeMeant) {
  const auto refused = [&](const std::string& args, const std::string& says) {
    const Outcome r = shell("$RASTRUM " + args + " </dev/null");
    EXPECT_EQ(r.status, 2) << args << r.err;
    EXPECT_EQ(r.out, "");
    EXPECT_TRUE(holds(r.err, says));
  };
  refused("render builtin:sphere -o - --stats -",
          "--stats: standard output is also the file of -o");
  refused("terrain --function noise -o - --stats -",
          "--stats: standard output is also the file of -o");
  refused("render builtin:sphere -o - --depth /dev/stdout", "--depth: standard output is also");
  refused("render - -o p.png", "--format ply");
  refused("render /dev/stdin -o p.png", "--format ply");
  refused("info -", "--format ply");
  refused("render - - --format ply -o p.png", "standard input can be read only once");
  refused("render - --format mesh -o p.png", "--format: expected one of obj, ply");
  refused("render builtin:sphere -o p.png --output-format npy", "-o: the name of p.png says .png");
  refused("render builtin:sphere --depth d.npy --output-format npy", "--output-format: needs -o");
  EXPECT_TRUE(files().empty());
}

TEST_F(Pipes, ATerminalIsNotShownBytes) {
  if (std::system("script -qec true /dev/null </dev/null >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "script is missing (Debian: bsdutils), or there are no terminals (/dev/pts)";
  const Outcome r = shell("script -qec '\"$RASTRUM\" make sphere -o -' /dev/null </dev/null 2>&1");
  EXPECT_EQ(r.status, 2) << r.out;
  EXPECT_TRUE(holds(r.out, "-o: standard output is a terminal"));
  EXPECT_FALSE(holds(r.out, "element vertex"));
}

TEST_F(Pipes, AnErrorSendsNothing) {
  write("bad.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
  const Outcome r = shell("$RASTRUM render - --format ply -o - < bad.ply");
  EXPECT_EQ(r.status, 1);
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(r.err.find("rastrum: error: standard input:4: "), 0U) << r.err;
}

TEST_F(Pipes, AReaderThatHasGoneEndsTheProgramQuietly) {
  // More than a pipe holds.
  const std::string args = " --size 400x400 --output-format npy -o - --depth d.npy";
  const Outcome r =
      shell("($RASTRUM render builtin:sphere --quiet" + args + "; echo $? >s) | head -c 6");
  EXPECT_EQ(r.out, "\x93NUMPY");
  EXPECT_EQ(r.err, "");
  EXPECT_EQ(read("s"), "141\n") << "128 + SIGPIPE, as of other programs";
  EXPECT_EQ(files(), Args("s")) << "all outputs or none";
  // With the signal ignored there is an error instead, as with other programs.
  const Outcome ignored = shell("trap '' PIPE; ($RASTRUM render builtin:sphere --quiet" + args +
                                "; echo $? >s) | head -c 6");
  EXPECT_TRUE(holds(ignored.err, "standard output: cannot be written: Broken pipe"));
  EXPECT_EQ(read("s"), "1\n");
  EXPECT_EQ(files(), Args("s"));
}

TEST_F(Pipes, WhatInfoPrintsHasArrived) {
  const Outcome full = run("info builtin:sphere", {.stdout_full = true});
  EXPECT_EQ(full.status, 1);
  EXPECT_TRUE(holds(full.err, "standard output"));
}

}  // namespace
}  // namespace rastrum::test::pipe_test
