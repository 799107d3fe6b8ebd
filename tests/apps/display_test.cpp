// SPDX-License-Identifier: BSD-3-Clause
// `rastrum view` without a display.
#include <cstdlib>

#include "program.hpp"

namespace rastrum::test::display_test {
namespace {

class NoDisplay : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
#ifndef RASTRUM_HAS_WINDOW
    GTEST_SKIP() << "built without the window (Debian: libsdl2-dev libimgui-dev)";
#endif
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"}) ::unsetenv(name);
  }
};

TEST_F(NoDisplay, EndsAtOnceAndSaysWhatToDo) {
  // The files do not exist: the display is checked first.
  for (const std::string args :
       {"view no-such-file.ply", "view --terrain --height no-such-file.png"}) {
    const Outcome r = shell("timeout 20 $RASTRUM " + args);
    EXPECT_EQ(r.status, 1) << "124: it was still running\n" << r.err;
    EXPECT_TRUE(holds(r.err, "rastrum: error: there is no display to open a window on"));
    EXPECT_TRUE(holds(r.err, "`rastrum render`"));
    EXPECT_TRUE(holds(r.err, "ssh -X"));
  }
}

TEST_F(NoDisplay, ADriverThatWasAskedForIsTaken) {
  write("quit.json", R"({"events":[{"time":0,"quit":true}]})");
  ::setenv("SDL_VIDEODRIVER", "dummy", 1);
  const Outcome r = run("view builtin:sphere --size 64x48 --script quit.json");
  ::unsetenv("SDL_VIDEODRIVER");
  EXPECT_EQ(r.status, 0) << r.err;
}

}  // namespace
}  // namespace rastrum::test::display_test
