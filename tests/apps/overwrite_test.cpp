// SPDX-License-Identifier: BSD-3-Clause
// An output that is an input, or another output, is refused before anything is written.
#include <filesystem>
#include <map>

#include "program.hpp"

namespace rastrum::test::overwrite_test {
namespace {

namespace fs = std::filesystem;

class Overwrite : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    must("make sphere -o t.ply");
    write("t.obj", "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
    write("t.mtl", "newmtl m\nmap_Kd skin.png\n");
    must("render builtin:sphere --size 8x4 -o skin.png --depth h.npy");
    write("path.json", R"({"keys": [{"time": 0, "eye": [0, 0, 3], "target": [0, 0, 0]},
                                    {"time": 1, "eye": [0, 0, 2], "target": [0, 0, 0]}]})");
    write("fly.json", R"({"keys": [{"time": 0}, {"time": 1, "x": 5}]})");
    fs::create_hard_link(path("fly.json"), path("fly_stats.json"));
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::string npy("\x93NUMPY\x01\x00\x76\x00", 10);
    npy += "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 3, 3), }";
    npy.resize(127, ' ');
    npy += "\n";
    npy.append(reinterpret_cast<const char*>(corners), sizeof corners);
    write("t.npy", npy);
    fs::create_symlink("t.npy", path("link.npy"));
    fs::create_hard_link(path("t.npy"), path("hard.npy"));
    fs::create_hard_link(path("t.ply"), path("hard.ply"));
    fs::create_symlink(path("."), path("here"));
    fs::create_hard_link(path("skin.png"), path("turn_2.png"));
    fs::create_hard_link(path("path.json"), path("stats.json"));
  }

  /// The command fails, the message names `file`, and no file has changed.
  void refused(const Args& args, const std::string& option, const std::string& file,
               const char* why = "is an input of this run") {
    const auto all = [&] {
      std::map<std::string, std::string> contents;
      for (const std::string& name : files())
        contents[name] = fs::is_regular_file(path(name)) ? read(name) : "";
      return contents;
    };
    const auto before = all();
    const std::string said = Program::refused(args, "rastrum: error: " + option + ": " + file);
    EXPECT_TRUE(holds(said, why)) << args;
    EXPECT_TRUE(all() == before) << args;
  }
};

TEST_F(Overwrite, OfAnInputIsRefusedForEveryOutput) {
  for (const std::string file : {"t.npy", "./t.npy", "here/t.npy", "link.npy", "hard.npy"})
    refused({"render", "t.npy", "-o", file}, "-o", file);
  refused("render t.npy@x=2 -o t.npy", "-o", "t.npy");
  refused("render link.npy -o t.npy", "-o", "t.npy");
  for (const std::string option : {"--depth", "--ids", "--objects"})
    refused({"render", "t.npy", option, "t.npy"}, option, "t.npy");
  refused("render t.npy --image normals=t.npy", "--image normals", "t.npy");
  refused("render t.npy --out-of-core always -o t.npy", "-o", "t.npy");
  refused("render t.ply builtin:sphere --format ply --output-format png -o hard.ply", "-o",
          "hard.ply");
  refused("make t.ply -o t.ply", "-o", "t.ply");
  refused("make t.ply --subdivide 1 -o hard.ply", "-o", "hard.ply");
}

TEST_F(Overwrite, OfAFileThatAnInputOrAnOptionNamesIsRefused) {
  refused("render t.obj -o skin.png", "-o", "skin.png");
  refused("render t.obj --heatmap skin.png", "--heatmap", "skin.png");
  refused("render t.obj --show-errors turn_2.png --opacity 0.5", "--show-errors", "turn_2.png");
  refused("render t.ply --light environment:skin.png -o skin.png", "-o", "skin.png");
  for (const std::string option : {"--stats", "--trace"})
    refused({"render", "t.ply", "--path", "path.json", "--fps", "2", "-o", "f%d.png", option,
             "stats.json"},
            option, "stats.json");
  refused("terrain --height h.npy --depth h.npy", "--depth", "h.npy");
  refused("terrain --height h.npy --color skin.png -o turn_2.png", "-o", "turn_2.png");
  refused("terrain --function noise --mesh t.npy@x=1,y=1 --depth hard.npy", "--depth", "hard.npy");
  refused("terrain --function noise --path fly.json --stats fly_stats.json", "--stats",
          "fly_stats.json");
}

TEST_F(Overwrite, OfANumberedPictureIsRefusedBeforeTheFirstIsWritten) {
  refused("render t.obj --turntable 3 -o turn_%d.png", "-o", "turn_2.png");
  // It works if no picture has that number.
  must("render t.obj --turntable 2 --size 8x8 -o turn_%d.png");
}

TEST_F(Overwrite, OfAnotherOutputIsRefused) {
  write("one.npy", "");
  fs::create_hard_link(path("one.npy"), path("other.npy"));
  refused("render t.ply -o one.npy --depth other.npy", "--depth", "other.npy",
          "also the file of -o");
  refused("render t.ply --turntable 2 -o s%01d.npy --depth s%d.npy", "--depth", "s0.npy",
          "also the file of -o");
  refused("render t.ply --turntable 11 -o s%02d.npy --depth s%d.npy", "--depth", "s10.npy",
          "also the file of -o");
  refused("render t.ply --turntable 2 --output-format png -o s%d.json --stats s1.json", "-o",
          "s1.json", "also the file of --stats");
}

}  // namespace
}  // namespace rastrum::test::overwrite_test
