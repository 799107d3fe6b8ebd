// SPDX-License-Identifier: BSD-3-Clause
// When writing fails: status 1, a message that names the file, and nothing half written.
#include <unistd.h>

#include "program.hpp"

namespace rastrum::test::failure_test {
namespace {

using Failure = Program;

/// Every output, each alone beside a small scene.
const std::vector<std::pair<std::string, Args>> kOutputs = {
    {"p.png", "-o p.png --shader id"}, {"p.exr", "-o p.exr"},        {"p.npy", "-o p.npy"},
    {"d.npy", "--depth d.npy"},        {"d.exr", "--depth d.exr"},   {"i.npy", "--ids i.npy"},
    {"h.png", "--heatmap h.png"},      {"s.json", "--stats s.json"}, {"t.json", "--trace t.json"},
};

Args render(const Args& output) {
  return "render builtin:soup?count=500 --size 200x200" + output;
}

/// Otherwise eight ranks would write the same file.
TEST_F(Failure, OneOfSeveralRanksWritesNothing) {
  const std::string render = R"("$RASTRUM" render builtin:boxes --size 20x20 -o p.png)";
  for (const std::string name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const Outcome r = shell(name + "=8 " + render);
    EXPECT_EQ(r.status, 1) << r.err;
    EXPECT_TRUE(holds(r.err, "one of 8"));
    EXPECT_TRUE(holds(r.err, "unset " + name));
    EXPECT_EQ(files(), Args{});
    EXPECT_EQ(shell(name + "=1 " + render).status, 0);
    EXPECT_EQ(files(), Args("p.png"));
    std::filesystem::remove(path("p.png"));
  }
}

TEST_F(Failure, DiskFullLeavesNothing) {
  for (const auto& [file, output] : kOutputs) {
    const Outcome r = run(render(output), {.file_bytes = 300});
    EXPECT_EQ(r.status, 1) << file << "\n" << r.err;
    EXPECT_TRUE(holds(r.err, "rastrum: error: "));
    EXPECT_TRUE(holds(r.err, file));
    EXPECT_EQ(files(), Args{}) << file;
  }
}

TEST_F(Failure, DiskFullLeavesTheOldFile) {
  for (const auto& [file, output] : kOutputs) {
    write(file, "old");
    EXPECT_EQ(run(render(output), {.file_bytes = 300}).status, 1) << file;
    EXPECT_EQ(read(file), "old") << file;
    EXPECT_EQ(files(), Args{file});
    std::filesystem::remove(path(file));
  }
}

TEST_F(Failure, OfOneOutputLeavesNoneOfThem) {
  // The picture fits, the next output does not.
  const Outcome r = run("render builtin:sphere --size 64x64 -o p.png --ids i.npy --stats s.json",
                        {.file_bytes = 20000});
  EXPECT_EQ(r.status, 1) << r.err;
  EXPECT_TRUE(holds(r.err, "i.npy"));
  EXPECT_EQ(files(), Args{});
}

TEST_F(Failure, DeviceFull) {
  for (const auto& [file, output] : kOutputs) {
    std::filesystem::create_symlink("/dev/full", path(file));
    refused(render(output), file, 1);
    EXPECT_EQ(files(), Args{file});
    std::filesystem::remove(path(file));
  }
}

TEST_F(Failure, StandardOutputFull) {
  const Outcome r = run("render builtin:sphere --size 8x8 --stats -", {.stdout_full = true});
  EXPECT_EQ(r.status, 1);
  EXPECT_TRUE(holds(r.err, "standard output"));
}

TEST_F(Failure, DirectoriesAreCheckedBeforeAnythingIsLoaded) {
  write("plain", "");
  std::filesystem::create_directory(path("folder.png"));
  for (const std::string file : {"missing/p.png", "plain/p.png", "folder.png"}) {
    const Outcome r = run({"render", "no-such-file.obj", "-o", file});
    EXPECT_EQ(r.status, 1) << file;
    EXPECT_EQ(r.err.find("rastrum: error: -o: " + file + " cannot be written"), 0U) << r.err;
  }
  for (const std::string output :
       {"--depth missing/x.npy", "--ids missing/x.npy", "--stats missing/x.json",
        "--trace missing/x.json", "--heatmap missing/x.png"})
    EXPECT_EQ(run("render no-such-file.obj " + output)
                  .err.find("rastrum: error: " + output.substr(0, output.find(' '))),
              0U)
        << output;
  EXPECT_EQ(run("make sphere -o missing/x.ply").status, 1);
  EXPECT_EQ(files(), (Args("folder.png plain")));
}

TEST_F(Failure, ADirectoryThatIsNotWritable) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  std::filesystem::create_directory(path("locked"));
  std::filesystem::permissions(
      path("locked"), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  refused("render no-such-file.obj -o locked/p.png", "locked", 1);
}

TEST_F(Failure, MakeLeavesNothing) {
  const Outcome r = run("make sphere -o s.ply", {.file_bytes = 300});
  EXPECT_EQ(r.status, 1);
  EXPECT_TRUE(holds(r.err, "s.ply"));
  EXPECT_EQ(files(), Args{});
}

TEST_F(Failure, OfOneInputStopsTheRender) {
  write("bad.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
  refused("render builtin:sphere bad.ply -o p.png", "bad.ply", 1);
  EXPECT_EQ(files(), Args("bad.ply"));
}

}  // namespace
}  // namespace rastrum::test::failure_test
