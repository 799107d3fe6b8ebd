// SPDX-License-Identifier: BSD-3-Clause
// A wrong command line ends with status 2 and a message that names the option.
#include <utility>
#include <vector>

#include <rastrum/version.hpp>
#include "parse/arguments.hpp"

#include "program.hpp"

namespace rastrum::test::arguments_test {
namespace {

using WrongArguments = Program;

TEST_F(WrongArguments, NameTheOptionAndLoadNothing) {
  const std::vector<std::pair<std::string, Args>> wrong = {
      {"--size", {"0x10", "10x0", "-1x5", "10", "10x", "x10", "32769x1", "1x99999", "1e2x5", ""}},
      {"--eye", {"1,2", "1,2,3,4", "a,b,c", "1,,3", "nan,0,0", "1, 2,3"}},
      {"--target", "1 0,0,inf"},
      {"--up", {"0 1 0"}},
      {"--fov", "0 180 -10 wide nan"},
      {"--near", "0 -1 near"},
      {"--far", "-inf nan far"},
      {"--orthographic", "0 -2 tall"},
      {"--camera", "-1 one 99999999999"},
      {"--rasterizer", {"fast", ""}},
      {"--device", "gpu Threads"},
      {"--threads", "0 -1 2.5 many"},
      {"--memory-limit", "0 -1 2.5M K 8T 8m 99999999999999999999 99999999999G"},
      {"--isa", "mmx"},
      {"--shader", "toon"},
      {"--normals", "smooth"},
      {"--cull", "both"},
      {"--background", "rde #12345 #1234567 #12345g 11223 #+1+2+3"},
      {"--frames", "0 -3 x"},
      {"--opacity", "-0.1 1.1 half nan"},
      {"--transparency", {"sorted", "filter", "filter:0", "filter:65", ""}},
      {"--alpha-threshold", "0 -1 1.5 x"},
      {"--samples", "0 2 32 four"},
      {"--shadow-size", "0 63 8193 100.5 fine"},
      {"--shadow-distance", "0 -1 inf far"},
      {"--show-errors", "e.npy"},
      {"--format", {"mesh", ""}},
      {"--depth", "d.png d d.npy.gz"},
      {"--ids", "i.exr"},
      {"--heatmap", "h.npy"},
      {"--stats", "s.txt s"},
      {"--trace", "t"},
      {"-o", {"picture", "p.jpg", ".png", ""}},
  };
  for (const auto& [option, values] : wrong)
    for (const std::string& value : values) {
      Args args{"render", "no-such-file.obj", option, value};
      if (option != "-o") args = args + "-o p.png";
      const Outcome r = run(args);
      EXPECT_EQ(r.status, 2) << option << " '" << value << "'\n" << r.err;
      EXPECT_EQ(r.err.find("rastrum: error: " + option + ":"), 0U) << r.err;
      EXPECT_FALSE(holds(r.err, "no-such-file")) << "it was read first: " << r.err;
    }
  EXPECT_TRUE(files().empty());
}

TEST_F(WrongArguments, ThatContradictEachOther) {
  const std::vector<std::pair<std::string, Args>> wrong = {
      {"--fit", "--fit --eye 1,2,3"},
      {"--fit", "--fit --camera 0"},
      {"--far", "--near 2 --far 1"},
      {"--far", "--orthographic 2 --far inf"},
      {"--orthographic", "--camera 0 --orthographic 2"},
      {"--depth", "--depth same.npy --ids ./same.npy"},
      {"--foo", "--foo"},
      {"--size", "--size 8x8 --size 9x9"},
      {"--size", "--size"},
  };
  for (const auto& [option, extra] : wrong) {
    const Outcome r = run("render no-such-file.obj -o p.png" + extra);
    EXPECT_EQ(r.status, 2) << option << "\n" << r.err;
    EXPECT_EQ(r.err.find("rastrum: error: "), 0U);
    const bool named = r.err.find(option) != std::string::npos ||
                       (option == "--depth" && r.err.find("same.npy") != std::string::npos);
    EXPECT_TRUE(named) << r.err;
  }
}

TEST_F(WrongArguments, ThatTheSceneShows) {
  const auto fails = [&](const Args& args, const std::string& says) {
    refused("render" + args + "-o p.png --size 16x16", says);
  };
  fails("builtin:sphere --camera 0", "--camera: the inputs have no camera");
  fails("builtin:sphere --eye 0,0,0", "--eye: eye and target must differ");
  fails("builtin:sphere --eye 0,5,0 --target 0,0,0", "--up: is needed");
  fails("builtin:sphere --up 0,0,0", "--up: must not be");
  fails("builtin:sphere --far 0.001", "--far: the near plane");
  fails({"builtin:cube"}, "builtin:cube: no shape 'cube'; known are teapot");
  fails({"builtin:sphere?rings=x"}, "builtin:sphere?rings=x: ");
  fails({"builtin:sphere?scale=0"}, "scale must not be 0");
  fails({"builtin:sphere?x=left"}, ": x: expected a number, got 'left'");
  EXPECT_TRUE(files().empty());
}

TEST_F(WrongArguments, NothingToDo) {
  for (const char* line : {"", "paint", "render -o p.png"}) EXPECT_EQ(run(line).status, 2) << line;
  refused("render builtin:sphere", "-o: say where the picture goes");
}

TEST_F(WrongArguments, AreToldFromFilesThatCannotBeRead) {
  const Outcome r = run("render no-such-file.obj -o p.png");
  EXPECT_EQ(r.status, 1);
  EXPECT_EQ(r.err.find("rastrum: error: no-such-file.obj"), 0U) << r.err;
}

TEST_F(WrongArguments, HelpAndVersionSucceed) {
  EXPECT_EQ(run("--version").out, std::string("rastrum ").append(version()) + "\n");
  for (const std::string command : {"render", "info", "make"}) {
    const Outcome r = run({command, "--help"});
    EXPECT_EQ(r.status, 0);
    EXPECT_TRUE(holds(r.out, "Examples:\n  rastrum " + command));
  }
  EXPECT_TRUE(holds(run("--help").out, "Examples:"));
  EXPECT_TRUE(holds(run("make --help").out, "torus_knot?p=2"));
}

// tests/core/color_test.cpp tests which texts are colours.
TEST(ParseColor, DigitsToDisplayValues) {
  EXPECT_EQ(cli::parse_color("", "#0033FF80"), (Vec4{0, 0.2F, 1, 128 / 255.0F}));
  EXPECT_EQ(cli::parse_color("", "#ffffff").w, 1.0F);
  EXPECT_THROW((void)cli::parse_color("", "bluee"), cli::UsageError);
}

}  // namespace
}  // namespace rastrum::test::arguments_test
