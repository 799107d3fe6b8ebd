// SPDX-License-Identifier: BSD-3-Clause
// A window under a virtual X server, with real keys and buttons by xdotool, for the window's tests.
//
// No test depends on time: tests wait for the picture on the screen, the window's title or a file,
// or for the program's end.
#pragma once

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "program.hpp"
#include "x_server.hpp"

namespace rastrum::test {

/// The width of the panel; the picture is right of it.
inline constexpr int kPanel_px = 345;
/// The height of a part's head in the panel, and the distance between rows.
inline constexpr int kHead_px = 19, kRow_px = 23;

inline bool have_program(const char* program) {
  return std::system((std::string("command -v ") + program + " >/dev/null 2>&1").c_str()) == 0;
}

class WindowTest : public Program {
 protected:
  static void TearDownTestSuite() { server_.reset(); }
  void SetUp() override {
    Program::SetUp();
#ifndef RASTRUM_HAS_WINDOW
    GTEST_SKIP() << "built without the window (Debian: libsdl2-dev libimgui-dev)";
#endif
    for (const char* program : {"Xvfb", "xdotool"})
      if (!have_program(program)) GTEST_SKIP() << program << " is missing (Debian: xvfb, xdotool)";
    if (!server_) server_ = std::make_unique<XServer>();
    if (server_->display() == nullptr)
      GTEST_SKIP() << "Xvfb does not start here: " << server_->said();
    ::setenv("DISPLAY", server_->name().c_str(), 1);
    ::setenv("SDL_VIDEODRIVER", "x11", 1);
    ::unsetenv("DBUS_SESSION_BUS_ADDRESS");
    ::setenv("LSAN_OPTIONS", "suppressions=" RASTRUM_LSAN_SUPPRESSIONS ":print_suppressions=0", 1);
  }
  void TearDown() override {
    viewer_.stop(SIGKILL);
    std::filesystem::remove(err());
    Program::TearDown();
  }

  [[nodiscard]] std::filesystem::path err() const {
    return beside(".view.err");
  }

  void start(Args args) {
    // Pictures are small and drawn often, so they do without the studio.
    if (std::ranges::find(args, "--terrain") == args.end()) args = args + "--look plain";
    args.insert(args.begin(), {RASTRUM_PROGRAM, "view"});
    viewer_.start(args, path(""), err());
  }
  /// The same, and waits until the window has the keyboard.
  void open(Args args) {
    start(std::move(args));
    ASSERT_TRUE(comes_true([&] {
      window_ = server_->window_of(viewer_.id());
      return window_ != 0 && server_->focus(window_);
    })) << said();
    // In the corner, where nothing is below it.
    at_window("2 2", "");
  }
  /// Waits until `what` is true or the program ends.
  bool comes_true(const std::function<bool()>& what) {
    bool is_true = false;
    wait_until([&] {
      is_true = what();
      return is_true || !viewer_.running();
    });
    return is_true;
  }
  /// The text that the program wrote to stderr.
  [[nodiscard]] std::string said() const {
    return slurp(err());
  }
  static void tool(const std::string& args) {
    EXPECT_EQ(std::system(("xdotool " + args + " >/dev/null 2>&1").c_str()), 0) << args;
  }
  void at_window(const std::string& place, const std::string& actions) const {
    tool("mousemove --window " + std::to_string(window_) + " " + place + " " + actions);
  }
  /// Presses P and waits for the picture and its camera; its name without the ending.
  std::string screenshot() {
    char stem[32];
    std::snprintf(stem, sizeof stem, "rastrum_%04d", shots_++);
    tool("key p");
    const std::string png_name = std::string(stem) + ".png";
    EXPECT_TRUE(comes_true([&] { return std::filesystem::exists(path(png_name)); }))
        << png_name << said();
    return stem;
  }
  /// The part of the screen that shows only the picture.
  [[nodiscard]] Image<Rgba8> seen(const Image<Rgba8>& like) const {
    return server_->pixels(window_, kPanel_px, 0, like.width() - kPanel_px, like.height());
  }
  [[nodiscard]] bool shows(const Image<Rgba8>& picture) const {
    Image<Rgba8> part(picture.width() - kPanel_px, picture.height());
    for (int y = 0; y < part.height(); ++y)
      for (int x = 0; x < part.width(); ++x) part(x, y) = picture(x + kPanel_px, y);
    return same_pixels(part, seen(picture));
  }
  /// Holds a key until the screen differs from `shot`.
  void hold(const std::string& key, const std::string& shot) {
    const Image<Rgba8> picture = png(shot + ".png");
    EXPECT_TRUE(comes_true([&] { return shows(picture); })) << shot;
    tool("keydown " + key);
    EXPECT_TRUE(comes_true([&] { return !shows(picture); })) << key;
    tool("keyup " + key);
  }
  /// Expects that a screenshot equals, bit for bit, `rastrum COMMAND`'s picture with its camera.
  void expect_drawn(const std::string& command, const std::string& shot, const Args& options) {
    const Image<Rgba8> picture = png(shot + ".png");
    const std::string size =
        std::to_string(picture.width()) + "x" + std::to_string(picture.height());
    const Args args(command + " --path " + shot + ".json --size " + size +
                    (command == "render" ? " --look plain" : ""));
    EXPECT_TRUE(same_pixels(picture, drawn(args + options))) << shot;
  }
  void expect_rendered(const std::string& shot, const Args& options) {
    expect_drawn("render", shot, options + "--quiet --background #20242c");
  }
  /// Expects that the command line beside a screenshot draws it again.
  void expect_line_draws(const std::string& shot) {
    const Image<Rgba8> picture = png(shot + ".png");
    std::filesystem::rename(path(shot + ".png"), path("shown.png"));
    const std::string line = read(shot + ".sh");
    run_line(line);
    EXPECT_TRUE(same_pixels(picture, png(shot + ".png"))) << line;
    std::filesystem::rename(path("shown.png"), path(shot + ".png"));
  }
  /// Where the heads of the panel's parts begin, px from the top.
  [[nodiscard]] std::vector<int> heads() const {
    constexpr int kRight_px = 310, kTitle_px = 30, kHeight_px = 780, kBlue = 45;
    const Image<Rgba8> column = server_->pixels(window_, kRight_px, 0, 1, kHeight_px);
    std::vector<int> found;
    for (int y = kTitle_px, begin = -1; y < column.height(); ++y) {
      const Rgba8 p = column(0, y);
      if (p.b > p.r + kBlue) {
        if (begin < 0) begin = y;
      } else if (begin >= 0) {
        // The bars of stages are lower.
        if (y - begin >= kHead_px - 2) found.push_back(begin);
        begin = -1;
      }
    }
    return found;
  }
  [[nodiscard]] nlohmann::ordered_json key_of(const std::string& shot) const {
    return json(shot + ".json")["keys"][0];
  }
  void drop(const std::string& name) {
    EXPECT_EQ(drop_file(*server_, window_, path(name)), "") << name << said();
  }
  void expect_title(const std::string& what) {
    EXPECT_TRUE(comes_true([&] { return server_->title(window_) == "rastrum " + what; }))
        << server_->title(window_) << said();
  }
  /// Whether a message in the colour of errors is on the screen.
  [[nodiscard]] bool shows_error(int width, int height) const {
    const auto near = [](int a, int b) { return a >= b - 2 && a <= b + 2; };
    int red = 0;
    const Image<Rgba8> screen = server_->pixels(window_, 0, 0, width, height);
    for (const Rgba8 p : screen.pixels()) red += near(p.r, 255) && near(p.g, 115) && near(p.b, 102);
    return red > 50;
  }
  /// Expects a clean end. Under a sanitizer a leak is not clean.
  void expect_closed() {
    EXPECT_TRUE(wait_until([&] { return !viewer_.running(); }));
    EXPECT_EQ(viewer_.status(), 0) << said();
    EXPECT_EQ(said(), "");
  }

  static inline std::unique_ptr<XServer> server_;
  Process viewer_;
  XWindow window_ = 0;
  int shots_ = 0;
};

inline const Args kTeapot{"builtin:teapot"};

}  // namespace rastrum::test
