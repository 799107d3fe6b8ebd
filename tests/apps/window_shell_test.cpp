// SPDX-License-Identifier: BSD-3-Clause
// The window itself: keys, the mouse, sizes, dropped files. Screenshots give the camera and are
// compared with `rastrum render`.
#include <array>

#include <rastrum/io.hpp>

#include "window_program.hpp"

namespace rastrum::test::window_shell_test {
namespace {

TEST_F(WindowTest, KeysMoveTheCameraAndScreenshotsAreWhatRenderDraws) {
  open("builtin:teapot --size 700x500");
  const std::string home = screenshot();
  expect_rendered(home, kTeapot);

  hold("d", home);
  const std::string right = screenshot();
  expect_rendered(right, kTeapot);
  EXPECT_GT(key_of(right)["eye"][0], key_of(home)["eye"][0]);
  EXPECT_EQ(key_of(right)["eye"][2], key_of(home)["eye"][2]);
  EXPECT_FALSE(same_pixels(png(right + ".png"), png(home + ".png")));

  hold("w", right);
  const std::string nearer = screenshot();
  expect_rendered(nearer, kTeapot);
  EXPECT_LT(key_of(nearer)["eye"][2], key_of(right)["eye"][2]);

  tool("key Home");
  const std::string again = screenshot();
  EXPECT_EQ(key_of(again), key_of(home));
  EXPECT_TRUE(same_pixels(png(again + ".png"), png(home + ".png")));
  tool("key ctrl+q");
  expect_closed();
}

TEST_F(WindowTest, TheMouseOrbitsPansAndZooms) {
  open("builtin:teapot --size 700x500");
  const auto home = key_of(screenshot());
  // Right of the panel.
  const auto drag = [&](const std::string& button) {
    at_window("500 300", "mousedown " + button +
                             " mousemove_relative --sync 60 0 mousemove_relative --sync 10 0"
                             " mouseup " +
                             button);
  };
  drag("1");
  const auto orbited = key_of(screenshot());
  EXPECT_EQ(orbited["target"], home["target"]);
  EXPECT_NE(orbited["eye"], home["eye"]);
  drag("2");
  const auto panned = key_of(screenshot());
  EXPECT_NE(panned["target"], orbited["target"]);
  tool("key Home");
  tool("click 4");
  const std::string zoomed = screenshot();
  EXPECT_LT(key_of(zoomed)["eye"][2], home["eye"][2]);
  expect_rendered(zoomed, kTeapot);
  server_->close(window_);
  expect_closed();
}

TEST_F(WindowTest, KeysChangeThePicture) {
  open("builtin:teapot --size 300x200");
  Args options = kTeapot;
  const auto draws = [&](const std::string& keys, Args more) {
    tool("key " + keys);
    options = options + more;
    expect_rendered(screenshot(), options);
  };
  draws("m", "--shader material");
  draws("l l l l l l", "--opacity 0.7");
  draws("t", "--transparency filter:3");
  draws("b", "--samples 4");
  // The heat map of the scene: its picture is another output of the same frame.
  tool("key h");
  const std::string heat = screenshot();
  must("render --look plain" + options + ("--path " + heat + ".json") +
       "--size 300x200 --quiet -o x.png --heatmap heat.png");
  EXPECT_TRUE(same_pixels(png(heat + ".png"), png("heat.png")));
  EXPECT_FALSE(same_pixels(png(heat + ".png"), png("x.png")));
  draws("h", {});
  // A rasterizer without samples draws nothing, so there is no screenshot to wait for.
  tool("key n n n");
  EXPECT_TRUE(comes_true([&] { return shows_error(300, 200); }));
  tool("key shift+n shift+n shift+n");
  EXPECT_TRUE(comes_true([&] { return !shows_error(300, 200); }));
  draws("m shift+m", {});
  tool("key ctrl+q");
  expect_closed();
}

// On a busy machine the program wakes up to many key events at once.
TEST_F(WindowTest, KeysThatComeAtOnceAreTakenOneByOne) {
  open("builtin:teapot --size 300x200");
  screenshot();
  const auto while_it_sleeps = [&](const std::string& keys) {
    viewer_.signal(SIGSTOP);
    tool("key " + keys);
    viewer_.signal(SIGCONT);
  };
  while_it_sleeps("b b shift+b");
  expect_rendered(screenshot(), "builtin:teapot --samples 4");
  while_it_sleeps("ctrl+q");
  expect_closed();
}

TEST_F(WindowTest, AResizeKeepsThePictureRight) {
  open("builtin:teapot --size 640x480");
  EXPECT_EQ(png(screenshot() + ".png").width(), 640);
  std::string last;
  for (const auto& size :
       {std::array{333, 250}, {1, 1}, {901, 703}, {3, 700}, {640, 1}, {640, 480}}) {
    server_->resize(window_, size[0], size[1]);
    // A key may arrive before the window hears of the change from the server.
    std::string shot;
    EXPECT_TRUE(comes_true([&] {
      shot = screenshot();
      const Image<Rgba8> picture = png(shot + ".png");
      return HasFailure() || (picture.width() == size[0] && picture.height() == size[1]);
    })) << size[0]
        << " x " << size[1];
    expect_rendered(shot, kTeapot);
    last = shot;
  }
  EXPECT_TRUE(same_pixels(png("rastrum_0000.png"), png(last + ".png")));
  server_->close(window_);
  expect_closed();
}

TEST_F(WindowTest, AMeshIsDropped) {
  must({"make", "torus_knot", "-o", "a knot.ply"});
  write("bad.ply", "ply\nnonsense");
  open("builtin:teapot --size 700x500");
  const std::string home = screenshot();
  EXPECT_FALSE(shows_error(700, 500));
  drop("bad.ply");
  EXPECT_TRUE(comes_true([&] { return shows_error(700, 500); }));
  expect_title("builtin:teapot");
  const std::string still = screenshot();
  EXPECT_TRUE(same_pixels(png(still + ".png"), png(home + ".png"))) << "the picture stays";

  drop("a knot.ply");
  expect_title(path("a knot.ply").string());
  expect_rendered(screenshot(), {"a knot.ply"});
  EXPECT_TRUE(comes_true([&] { return !shows_error(700, 500); }));
  tool("key ctrl+q");
  expect_closed();
}

TEST_F(WindowTest, AHeightMapIsDropped) {
  Image<Rgba8> hills(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const auto h = static_cast<std::uint8_t>((x - 32) * (y - 32) / 16 + 64);
      hills(x, y) = {h, h, h, 255};
    }
  io::write_png(path("hills.png"), hills.view());
  write("bad.png", "\x89PNG and no more");
  open("--terrain --function wavy --size 700x500");
  expect_title("wavy");
  const std::string home = screenshot();
  expect_drawn("terrain", home, "--function wavy");
  drop("bad.png");
  EXPECT_TRUE(comes_true([&] { return shows_error(700, 500); }));
  expect_title("wavy");
  const std::string still = screenshot();
  EXPECT_TRUE(same_pixels(png(still + ".png"), png(home + ".png"))) << "the picture stays";

  drop("hills.png");
  expect_title(path("hills.png").string());
  expect_drawn("terrain", screenshot(), "--height hills.png");
  EXPECT_TRUE(comes_true([&] { return !shows_error(700, 500); }));
  server_->close(window_);
  expect_closed();
}

TEST_F(WindowTest, AScriptEndsTheWindowItself) {
  write("s.json", R"({"fps": 30, "keys": [{"eye": [6, 4, 6], "target": [0, 1, 0]},
                                          {"time": 0.5, "eye": [-6, 4, 6]}],
      "events": [{"time": 0.2, "screenshot": "a.png"}, {"time": 0.3, "size": [320, 200]},
                 {"time": 0.5, "screenshot": "b.png"}, {"time": 0.6, "quit": true}]})");
  start("builtin:teapot --size 400x300 --script s.json");
  expect_closed();
  expect_rendered("a", kTeapot);
  expect_rendered("b", kTeapot);
  EXPECT_EQ(png("b.png").width(), 320);
}

TEST_F(WindowTest, WithoutADisplayItSaysSo) {
  ::setenv("DISPLAY", ":98765", 1);
  refused("view builtin:teapot", "there is no display", 1);
}

}  // namespace
}  // namespace rastrum::test::window_shell_test
