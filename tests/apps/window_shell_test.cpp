// The window itself: a virtual X server, real keys and buttons by xdotool, files dropped as a file
// manager does, and the program's own screenshots, which say where the camera stands and are
// compared with `rastrum render`.
//
// Nothing here waits for a time to pass: what is waited for is the picture on the screen, the
// window's title or a file, and whatever ends the program ends the waiting.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <rastrum/io.hpp>

#include "program.hpp"
#include "x_server.hpp"

namespace rastrum::test::window_shell_test {
namespace {

/// The panel's column; what is right of it is the picture.
constexpr int kPanel_px = 345;
/// Of a part's head in the panel, and from one row to the next.
constexpr int kHead_px = 19, kRow_px = 23;

bool have(const char* program) {
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
      if (!have(program)) GTEST_SKIP() << program << " is missing (Debian: xvfb, xdotool)";
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

  /// Beside the folder, which is the program's.
  [[nodiscard]] std::filesystem::path err() const {
    return path("").parent_path().string() + ".view.err";
  }

  void start(std::vector<std::string> args) {
    // Small pictures that are drawn often: without a studio.
    if (std::ranges::find(args, "--terrain") == args.end())
      args.insert(args.end(), {"--look", "plain"});
    args.insert(args.begin(), {RASTRUM_PROGRAM, "view"});
    viewer_.start(args, path(""), err());
  }
  /// The same, until its window has the keyboard.
  void open(std::vector<std::string> args) {
    start(std::move(args));
    ASSERT_TRUE(comes_true([&] {
      window_ = server_->window_of(viewer_.id());
      return window_ != 0 && server_->focus(window_);
    })) << said();
  }
  /// Waits, as long as the program runs.
  bool comes_true(const std::function<bool()>& what) {
    bool is_true = false;
    wait_until([&] {
      is_true = what();
      return is_true || !viewer_.running();
    });
    return is_true;
  }
  /// What the program wrote.
  [[nodiscard]] std::string said() const {
    std::ifstream in(err());
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Runs xdotool.
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
  /// The screen where it shows the picture and nothing else.
  [[nodiscard]] Image<Rgba8> seen(const Image<Rgba8>& like) const {
    return server_->pixels(window_, kPanel_px, 0, like.width() - kPanel_px, like.height());
  }
  [[nodiscard]] bool shows(const Image<Rgba8>& picture) const {
    Image<Rgba8> part(picture.width() - kPanel_px, picture.height());
    for (int y = 0; y < part.height(); ++y)
      for (int x = 0; x < part.width(); ++x) part(x, y) = picture(x + kPanel_px, y);
    return same_pixels(part, seen(picture));
  }
  /// Holds a key until something else than `shot` is on the screen.
  void hold(const std::string& key, const std::string& shot) {
    const Image<Rgba8> picture = png(shot + ".png");
    EXPECT_TRUE(comes_true([&] { return shows(picture); })) << shot;
    tool("keydown " + key);
    EXPECT_TRUE(comes_true([&] { return !shows(picture); })) << key;
    tool("keyup " + key);
  }
  /// Whether a screenshot is, bit for bit, what `rastrum COMMAND` draws with its camera.
  void expect_drawn(const std::string& command, const std::string& shot,
                    const std::vector<std::string>& options) {
    const Image<Rgba8> picture = png(shot + ".png");
    const std::string size =
        std::to_string(picture.width()) + "x" + std::to_string(picture.height());
    std::vector<std::string> args{command, "--path", shot + ".json", "--size",
                                  size,    "-o",     "rendered.png"};
    if (command == "render") args.insert(args.end(), {"--look", "plain"});
    args.insert(args.end(), options.begin(), options.end());
    must(args);
    EXPECT_TRUE(same_pixels(picture, png("rendered.png"))) << shot;
    std::filesystem::remove(path("rendered.png"));
  }
  void expect_rendered(const std::string& shot, std::vector<std::string> options) {
    options.insert(options.end(), {"--quiet", "--background", "#20242c"});
    expect_drawn("render", shot, options);
  }
  /// Whether the command line beside a screenshot draws it again.
  void expect_line_draws(const std::string& shot) {
    const Image<Rgba8> picture = png(shot + ".png");
    std::filesystem::rename(path(shot + ".png"), path("shown.png"));
    const std::string line = read(shot + ".sh");
    const std::string command = "cd '" + path("").string() + "' && " RASTRUM_PROGRAM +
                                line.substr(std::string("rastrum").size(), line.size() - 8) +
                                " --quiet";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    EXPECT_TRUE(same_pixels(picture, png(shot + ".png"))) << line;
    std::filesystem::rename(path("shown.png"), path(shot + ".png"));
  }
  /// Where the heads of the panel's parts begin, px from above.
  [[nodiscard]] std::vector<int> heads() const {
    constexpr int kRight_px = 310, kTitle_px = 30, kHeight_px = 780, kBlue = 45;
    const Image<Rgba8> column = server_->pixels(window_, kRight_px, 0, 1, kHeight_px);
    std::vector<int> found;
    for (int y = kTitle_px, begin = -1; y < column.height(); ++y) {
      const Rgba8 p = column(0, y);
      if (p.b > p.r + kBlue) {
        if (begin < 0) begin = y;
      } else if (begin >= 0) {
        // Bars of stages are lower.
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
  /// Its end, which must be a clean one: under a sanitizer a leak is not.
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

const std::vector<std::string> kTeapot{"builtin:teapot"};

TEST_F(WindowTest, KeysMoveTheCameraAndScreenshotsAreWhatRenderDraws) {
  open({"builtin:teapot", "--size", "700x500"});
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
  open({"builtin:teapot", "--size", "700x500"});
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
  open({"builtin:teapot", "--size", "300x200"});
  std::vector<std::string> options{"builtin:teapot"};
  const auto draws = [&](const std::string& keys, std::vector<std::string> more) {
    tool("key " + keys);
    options.insert(options.end(), more.begin(), more.end());
    expect_rendered(screenshot(), options);
  };
  draws("m", {"--shader", "material"});
  draws("l l l l l l", {"--opacity", "0.7"});
  draws("t", {"--transparency", "filter:3"});
  draws("b", {"--samples", "4"});
  // The heat map of all that: its picture is another output of the same frame.
  tool("key h");
  const std::string heat = screenshot();
  std::vector<std::string> heat_options = options;
  heat_options.insert(heat_options.end(), {"--path", heat + ".json", "--size", "300x200", "--quiet",
                                           "-o", "x.png", "--heatmap", "heat.png"});
  heat_options.insert(heat_options.begin(), {"render", "--look", "plain"});
  must(heat_options);
  EXPECT_TRUE(same_pixels(png(heat + ".png"), png("heat.png")));
  EXPECT_FALSE(same_pixels(png(heat + ".png"), png("x.png")));
  draws("h", {});
  // A rasterizer that has no samples draws nothing, so that there is no screenshot to wait for.
  tool("key n n n");
  EXPECT_TRUE(comes_true([&] { return shows_error(300, 200); }));
  tool("key shift+n shift+n shift+n");
  EXPECT_TRUE(comes_true([&] { return !shows_error(300, 200); }));
  draws("m shift+m", {});
  tool("key ctrl+q");
  expect_closed();
}

// What a machine with other things to do makes of typing: the program wakes up to many events.
TEST_F(WindowTest, KeysThatComeAtOnceAreTakenOneByOne) {
  open({"builtin:teapot", "--size", "300x200"});
  screenshot();
  const auto while_it_sleeps = [&](const std::string& keys) {
    viewer_.signal(SIGSTOP);
    tool("key " + keys);
    viewer_.signal(SIGCONT);
  };
  while_it_sleeps("b b shift+b");
  expect_rendered(screenshot(), {"builtin:teapot", "--samples", "4"});
  while_it_sleeps("ctrl+q");
  expect_closed();
}

TEST_F(WindowTest, AResizeKeepsThePictureRight) {
  open({"builtin:teapot", "--size", "640x480"});
  EXPECT_EQ(png(screenshot() + ".png").width(), 640);
  std::string last;
  for (const auto& size :
       {std::array{333, 250}, {1, 1}, {901, 703}, {3, 700}, {640, 1}, {640, 480}}) {
    server_->resize(window_, size[0], size[1]);
    // The window hears of it when the server gets to it: a key may come before.
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
  open({"builtin:teapot", "--size", "700x500"});
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
  open({"--terrain", "--function", "wavy", "--size", "700x500"});
  expect_title("wavy");
  const std::string home = screenshot();
  expect_drawn("terrain", home, {"--function", "wavy"});
  drop("bad.png");
  EXPECT_TRUE(comes_true([&] { return shows_error(700, 500); }));
  expect_title("wavy");
  const std::string still = screenshot();
  EXPECT_TRUE(same_pixels(png(still + ".png"), png(home + ".png"))) << "the picture stays";

  drop("hills.png");
  expect_title(path("hills.png").string());
  expect_drawn("terrain", screenshot(), {"--height", "hills.png"});
  EXPECT_TRUE(comes_true([&] { return !shows_error(700, 500); }));
  server_->close(window_);
  expect_closed();
}

TEST_F(WindowTest, WithoutThePanelThePictureIsOnTheScreen) {
  open({"builtin:teapot", "--size", "700x500"});
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
  open({"builtin:teapot", "--size", "700x500"});
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
  open({"builtin:teapot", "--size", "900x780"});
  std::string shot = screenshot();
  const auto changes = [&](const std::string& what, const std::string& place,
                           const std::string& action) {
    const Image<Rgba8> before = png(shot + ".png");
    EXPECT_TRUE(comes_true([&] { return shows(before); })) << what;
    at_window(place, action);
    EXPECT_TRUE(comes_true([&] { return !shows(before); })) << what;
    // A screenshot is of the picture that is wanted then, so it waits for the panel's frames.
    shot = screenshot();
    expect_line_draws(shot);
    EXPECT_NE(read(shot + ".sh").find(what), std::string::npos) << read(shot + ".sh");
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

TEST_F(WindowTest, AScriptEndsTheWindowItself) {
  write("s.json", R"({"fps": 30, "keys": [{"eye": [6, 4, 6], "target": [0, 1, 0]},
                                          {"time": 0.5, "eye": [-6, 4, 6]}],
      "events": [{"time": 0.2, "screenshot": "a.png"}, {"time": 0.3, "size": [320, 200]},
                 {"time": 0.5, "screenshot": "b.png"}, {"time": 0.6, "quit": true}]})");
  start({"builtin:teapot", "--size", "400x300", "--script", "s.json"});
  expect_closed();
  expect_rendered("a", kTeapot);
  expect_rendered("b", kTeapot);
  EXPECT_EQ(png("b.png").width(), 320);
}

TEST_F(WindowTest, WithoutADisplayItSaysSo) {
  ::setenv("DISPLAY", ":98765", 1);
  const Outcome r = run({"view", "builtin:teapot"});
  EXPECT_EQ(r.status, 1);
  EXPECT_NE(r.err.find("there is no display"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace rastrum::test::window_shell_test
