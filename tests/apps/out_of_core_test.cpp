// SPDX-License-Identifier: BSD-3-Clause
// `rastrum render` of a mapped file writes the same bytes as of a file in memory.
// Refusals name the option or the file.
#include <string>

#include <rastrum/mesh.hpp>

#include "program.hpp"
#include "tests/out_of_core/large_files.hpp"

namespace rastrum::test::apps_out_of_core_test {
namespace {

using OutOfCoreProgram = Program;

TEST_F(OutOfCoreProgram, WritesTheBytesOfAFileThatIsRead) {
  must("make builtin:teapot?n=6 -o t.ply");
  for (const std::string look :
       {"", "--look studio", "--normals face --opacity 0.3",
        "--normals crease --eye 2,3,5 --target 0,1,0", "--shader depth --fit sphere",
        "--title Words --axes --samples 4 --opacity 0.5"})
    for (const std::string input : {"t.ply", "t.ply@x=2,rz=30,color=#aa4422,opacity=0.6"}) {
      for (const std::string kind : {"never", "always"})
        must("render " + input + " --quiet --size 96x64 --out-of-core " + kind + " -o " + kind +
             ".png --ids " + kind + ".npy --depth " + kind + "_d.npy " + look);
      for (const std::string file : {".png", ".npy", "_d.npy"})
        EXPECT_EQ(read("always" + file), read("never" + file))
            << input << " " << look << " " << file;
    }
}

TEST_F(OutOfCoreProgram, DrawsTheBackgroundOfAFileWithoutTriangles) {
  write("e.stl", std::string(84, '\0'));
  must("render e.stl --out-of-core always --eye 0,0,5 -o e.png");
  EXPECT_FALSE(read("e.png").empty());
}

TEST_F(OutOfCoreProgram, SaysWhatItDidAndRefusesByName) {
  must("make builtin:teapot?n=6 -o t.ply");
  const std::string err = must("render t.ply --out-of-core always -o p.png --stats s.json");
  EXPECT_TRUE(holds(err, "out of core in 2048 MiB"));
  const auto stats = json("s.json");
  EXPECT_EQ(stats["triangles"]["input"], 64 * 36);
  EXPECT_EQ(stats["out_of_core"]["bands"], 1);
  for (const std::string args :
       {"--turntable 3", "--heatmap h.png", "--bounds", "--edges", "--shader id", "--frames 2",
        "--rasterizer tiled", "--transparency wboit", "--shadows --lights studio"}) {
    const std::string option = args == "--shader id" ? args : args.substr(0, args.find(' '));
    EXPECT_TRUE(holds(refused("render t.ply --out-of-core always -o q_%d.png " + args, option, 1),
                      "cannot be used out of core"));
  }
  write("a.ply", "ply\nformat ascii 1.0\n");
  EXPECT_EQ(run("render a.ply --out-of-core always -o r.png").status, 1);
  EXPECT_EQ(run("render t.ply --out-of-core always --memory-limit 9M -o r.png").status, 1);
  for (const std::string& name : files()) EXPECT_FALSE(holds(name, "r.png"));
}

TEST_F(OutOfCoreProgram, ALargePictureIsDrawnInBandsOfRows) {
  must("make builtin:teapot?n=6 -o t.ply");
  const std::string all = "render t.ply --look plain --size 3000x2500 ";
  must(all + "-o read.png --depth read_d.npy --ids read_i.npy");
  // The picture's images alone are 120 MB.
  must(all +
       "-o mapped.png --depth mapped_d.npy --ids mapped_i.npy --out-of-core always "
       "--memory-limit 80M");
  for (const char* file : {".png", "_d.npy", "_i.npy"})
    EXPECT_TRUE(read(std::string("read") + file) == read(std::string("mapped") + file)) << file;
  // An option that needs the whole picture is refused before the picture takes memory.
  const std::string said = refused(
      "render t.ply --look studio --size 32768x32768 --out-of-core always --memory-limit 1G -o "
      "w.png",
      "--memory-limit: 1024 MiB cannot hold a picture of 32768x32768", 1);
  EXPECT_TRUE(holds(said, "--look plain"));
}

TEST_F(OutOfCoreProgram, ReadsASmallFileOfManyNodes) {
  // The file is a quarter of the limit, so it may be large, but its nodes alone exceed the limit.
  Mesh mesh;
  mesh.positions.resize((std::size_t{17} << 20) / 24);
  mesh.positions[1] = {1, 0, 0};
  mesh.positions[2] = {0, 1, 0};
  mesh.indices = {0, 1, 2};
  std::vector<std::string> nodes(150'000, "{}");
  nodes.back() = R"({"mesh":0})";
  write("n.glb", glb_of(mesh, false, "", nodes));
  const Args render("render n.glb --eye 0,0,3 --target 0,0,0 --size 60x40 --look plain");
  must(render + "-o read.png");
  const std::string said = must(render + "--memory-limit 64M -o p.png");
  EXPECT_TRUE(holds(said, "its nodes and JSON take about"));
  EXPECT_TRUE(holds(said, "the file is read whole, beyond the memory limit"));
  EXPECT_EQ(read("p.png"), read("read.png"));
  // A command line that asks for out of core gets an error.
  EXPECT_EQ(run(render + "--out-of-core always --memory-limit 64M -o q.png").status, 1);
}

}  // namespace
}  // namespace rastrum::test::apps_out_of_core_test
