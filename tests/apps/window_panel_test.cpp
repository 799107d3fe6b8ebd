// SPDX-License-Identifier: BSD-3-Clause
// The window's panel, and the tooltip at the pointer.
#include "window_program.hpp"

namespace rastrum::test::window_panel_test {
namespace {

TEST_F(WindowTest, WithoutThePanelThePictureIsOnTheScreen) {
  open("builtin:teapot --size 700x500");
  const Image<Rgba8> picture = png(screenshot() + ".png");
  const auto screen = [&] { return server_->pixels(window_, 0, 0, 700, 500); };
  EXPECT_TRUE(comes_true([&] { return shows(picture); }));
  EXPECT_FALSE(same_pixels(screen(), picture)) << "the panel lies over it";
  tool("key Tab");
  EXPECT_TRUE(comes_true([&] { return same_pixels(screen(), picture); }));
  tool("key ctrl+q");
  expect_closed();
}

TEST_F(WindowTest, ADragOnThePanelIsThePanels) {
  open("builtin:teapot --size 700x500");
  const auto home = key_of(screenshot());
  at_window("100 60",
            "mousedown 1 mousemove_relative --sync 60 0 mousemove_relative --sync 10 0 mouseup 1");
  EXPECT_EQ(key_of(screenshot()), home);
  at_window("100 60", "click 4");
  EXPECT_EQ(key_of(screenshot()), home);
  tool("key ctrl+q");
  expect_closed();
}

// A part of the panel is found by its head, which is as wide as the panel.
TEST_F(WindowTest, ThePanelChangesThePicture) {
  open("builtin:teapot --size 900x780");
  std::string shot = screenshot();
  const auto changes = [&](const std::string& what, const std::string& place,
                           const std::string& action) {
    const Image<Rgba8> before = png(shot + ".png");
    EXPECT_TRUE(comes_true([&] { return shows(before); })) << what;
    at_window(place, action);
    EXPECT_TRUE(comes_true([&] { return !shows(before); })) << what;
    // A screenshot is of the wanted picture, so it waits for the panel's frames.
    shot = screenshot();
    expect_line_draws(shot);
    EXPECT_TRUE(holds(read(shot + ".sh"), what));
  };
  // Opens or closes a part and waits for its place on the screen.
  const auto turn = [&](std::size_t part) {
    std::vector<int> before;
    ASSERT_TRUE(comes_true([&] { return (before = heads()).size() == 6; }));
    at_window("200 " + std::to_string(before[part] + kHead_px / 2), "click 1");
    EXPECT_TRUE(comes_true([&] {
      const std::vector<int> now = heads();
      return now.size() == before.size() && now[part + 1] != before[part + 1];
    })) << part;
  };
  const auto row = [&](std::size_t part, int i) {
    return heads()[part] + kRow_px * (i + 1) + kHead_px / 2;
  };
  constexpr std::size_t kNumbers = 0, kLines = 2, kSections = 3;

  turn(kLines);
  changes("--silhouettes", "26 " + std::to_string(row(kLines, 0)), "click 1");
  turn(kLines);
  turn(kSections);
  changes("--clip-plane -1,0,0,", "26 " + std::to_string(row(kSections, 0)), "click 1");
  const std::string half = read(shot + ".sh");
  // The slider, beside its switch.
  changes("--clip-plane -1,0,0,", "150 " + std::to_string(row(kSections, 0)), "click 1");
  EXPECT_NE(read(shot + ".sh"), half);
  changes("--clip-plane 0,0,-1,", "26 " + std::to_string(row(kSections, 3)), "click 1");
  turn(kSections);
  turn(kNumbers);
  // The list opens below: none, x, y, z, distance.
  const int list = row(kNumbers, 0);
  at_window("60 " + std::to_string(list), "click 1");
  changes("--scalars y --cmap viridis",
          "60 " + std::to_string(list + kHead_px / 2 + 8 + 17 * 2 + 6), "click 1");

  tool("key ctrl+c");
  std::string copied;
  EXPECT_TRUE(comes_true([&] { return !(copied = server_->clipboard()).empty(); }));
  std::string line = read(shot + ".sh");
  line.replace(line.find(shot + ".png"), shot.size() + 4, "picture.png");
  EXPECT_EQ(copied, line);
  tool("key shift+ctrl+c");
  EXPECT_TRUE(comes_true([&] { return server_->clipboard().starts_with("import rastrum"); }));
  tool("key ctrl+q");
  expect_closed();
}

// The tooltip is beside the pointer, over the picture.
TEST_F(WindowTest, AnythingUnderAPointerThatRestsIsSaid) {
  open("builtin:sphere --size 700x500 --scalars z");
  const Image<Rgba8> picture = png(screenshot() + ".png");
  EXPECT_TRUE(comes_true([&] { return shows(picture); }));
  at_window("480 250", "");
  EXPECT_TRUE(comes_true([&] { return !shows(picture); }));
  at_window("690 490", "");
  EXPECT_TRUE(comes_true([&] { return shows(picture); })) << "nothing is there";
  // Comes directly from the panel, which uses the pointer itself.
  at_window("100 20", "click 1 click 1");
  at_window("480 250", "");
  EXPECT_TRUE(comes_true([&] { return !shows(picture); }));
  tool("key ctrl+q");
  expect_closed();
}

}  // namespace
}  // namespace rastrum::test::window_panel_test
