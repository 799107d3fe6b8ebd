// The window itself: a virtual X server, real keys and buttons by xdotool, and the program's own
// screenshots, which say where the camera stands and are compared with `rastrum render`.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <thread>

#include "program.hpp"
// clang-format off: last, since its names are macros
#include <X11/Xlib.h>
// clang-format on

namespace rastrum::test {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
// A machine that runs everything at once, under a sanitizer, is slow.
constexpr std::chrono::seconds kPatience{60};

/// A process of the test's own, ended with it.
class Process {
 public:
  Process() = default;
  ~Process() { stop(SIGKILL); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// `inherit`: a descriptor that stays open in the child, or −1; stderr goes to `err`.
  void start(const std::vector<std::string>& command, const std::filesystem::path& folder,
             const std::filesystem::path& err, int inherit = -1) {
    std::vector<char*> argv;
    for (const std::string& a : command) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    child_ = ::fork();
    if (child_ != 0) return;
    const int e = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (e < 0 || ::dup2(e, 1) < 0 || ::dup2(e, 2) < 0 || ::chdir(folder.c_str()) != 0) ::_exit(127);
    if (inherit >= 0) ::fcntl(inherit, F_SETFD, 0);
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  [[nodiscard]] bool running() {
    if (child_ <= 0) return false;
    int status = 0;
    if (::waitpid(child_, &status, WNOHANG) != child_) return true;
    ended(status);
    return false;
  }
  void stop(int signal) {
    if (!running()) return;
    ::kill(child_, signal);
    int status = 0;
    ::waitpid(child_, &status, 0);
    ended(status);
  }
  /// As Outcome::status; −1 while it runs.
  [[nodiscard]] int status() const { return status_; }

 private:
  void ended(int status) {
    child_ = -1;
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  pid_t child_ = -1;
  int status_ = -1;
};

bool wait_until(const std::function<bool()>& done) {
  const auto end = Clock::now() + kPatience;
  while (!done()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds(20));
  }
  return true;
}

bool have(const char* program) {
  return std::system((std::string("command -v ") + program + " >/dev/null 2>&1").c_str()) == 0;
}

/// Asks the window to close, as a window manager's button does.
void press_close(const std::string& window) {
  Display* const display = XOpenDisplay(nullptr);
  ASSERT_NE(display, nullptr);
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = std::stoul(window);
  event.xclient.message_type = XInternAtom(display, "WM_PROTOCOLS", 0);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(display, "WM_DELETE_WINDOW", 0));
  XSendEvent(display, event.xclient.window, 0, NoEventMask, &event);
  XCloseDisplay(display);
}

class WindowTest : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
#ifndef RASTRUM_HAS_WINDOW
    GTEST_SKIP() << "built without the window (Debian: libsdl2-dev libimgui-dev)";
#endif
    for (const char* program : {"Xvfb", "xdotool"})
      if (!have(program)) GTEST_SKIP() << program << " is missing (Debian: xvfb, xdotool)";
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    server_.start({"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0", "1024x800x24",
                   "-nolisten", "tcp",
                   // Else it starts anew, and refuses who comes, whenever xdotool leaves it empty.
                   "-noreset"},
                  path(""), path("").string() + "../" + name("Xvfb.err"), ends[1]);
    ::close(ends[1]);
    // The server writes its number once it is there; the end of the pipe if it never is.
    std::array<char, 16> number{};
    const ssize_t n = ::read(ends[0], number.data(), number.size() - 1);
    ::close(ends[0]);
    ASSERT_GT(n, 0) << "Xvfb did not start";
    ::setenv("DISPLAY", (":" + std::to_string(std::atoi(number.data()))).c_str(), 1);
    ::setenv("SDL_VIDEODRIVER", "x11", 1);
    ::unsetenv("DBUS_SESSION_BUS_ADDRESS");
#ifdef RASTRUM_LSAN_SUPPRESSIONS
    ::setenv("LSAN_OPTIONS", "suppressions=" RASTRUM_LSAN_SUPPRESSIONS ":print_suppressions=0", 1);
#endif
  }
  void TearDown() override {
    viewer_.stop(SIGKILL);
    server_.stop(SIGTERM);
    for (const char* file : {"Xvfb.err", "view.err"})
      std::filesystem::remove(path("").string() + "../" + name(file));
    Program::TearDown();
  }

  /// Beside the folder, which is the program's.
  [[nodiscard]] std::string name(const char* file) const {
    return path("").parent_path().filename().string() + "." + file;
  }

  void open(std::vector<std::string> args) {
    args.insert(args.begin(), {RASTRUM_PROGRAM, "view"});
    viewer_.start(args, path(""), path("").string() + "../" + name("view.err"));
    ASSERT_TRUE(wait_until([&] {
      window_ = tool("search --onlyvisible --name '^rastrum '");
      return !window_.empty() || !viewer_.running();
    }));
    ASSERT_FALSE(window_.empty()) << said();
    tool("windowfocus --sync " + window_);
  }
  /// What the program wrote.
  [[nodiscard]] std::string said() const {
    std::ifstream in(path("").string() + "../" + name("view.err"));
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Runs xdotool; its first line.
  static std::string tool(const std::string& args) {
    std::FILE* const pipe = ::popen(("xdotool " + args + " 2>/dev/null").c_str(), "r");
    if (pipe == nullptr) return {};
    std::array<char, 64> text{};
    const bool any = std::fgets(text.data(), text.size(), pipe) != nullptr;
    while (std::fgetc(pipe) != EOF) {
    }
    ::pclose(pipe);
    std::string line = any ? text.data() : "";
    while (!line.empty() && line.back() == '\n') line.pop_back();
    return line;
  }
  /// Presses P and waits for the picture and its camera; its name without the ending.
  std::string screenshot() {
    char stem[32];
    std::snprintf(stem, sizeof stem, "rastrum_%04d", shots_++);
    tool("key p");
    const std::string png_name = std::string(stem) + ".png";
    EXPECT_TRUE(wait_until([&] {
      return std::filesystem::exists(path(png_name)) || !viewer_.running();
    })) << png_name;
    EXPECT_TRUE(viewer_.running()) << said();
    return stem;
  }
  /// Whether a screenshot is, bit for bit, what `rastrum render` draws with its camera.
  void expect_rendered(const std::string& shot, const std::vector<std::string>& options) {
    const Image<Rgba8> picture = png(shot + ".png");
    std::vector<std::string> args{
        "render",       "--quiet",
        "--path",       shot + ".json",
        "--size",       std::to_string(picture.width()) + "x" + std::to_string(picture.height()),
        "--background", "#20242c",
        "-o",           "rendered.png"};
    args.insert(args.end(), options.begin(), options.end());
    must(args);
    EXPECT_TRUE(same_pixels(picture, png("rendered.png"))) << shot;
    std::filesystem::remove(path("rendered.png"));
  }
  [[nodiscard]] nlohmann::ordered_json key_of(const std::string& shot) const {
    return json(shot + ".json")["keys"][0];
  }
  /// Its end, which must be a clean one: under a sanitizer a leak is not.
  void expect_closed() {
    EXPECT_TRUE(wait_until([&] { return !viewer_.running(); }));
    EXPECT_EQ(viewer_.status(), 0) << said();
    EXPECT_EQ(said(), "");
  }

  Process server_, viewer_;
  std::string window_;
  int shots_ = 0;
};

const std::vector<std::string> kTeapot{"builtin:teapot"};

TEST_F(WindowTest, KeysMoveTheCameraAndScreenshotsAreWhatRenderDraws) {
  open({"builtin:teapot", "--size", "400x300"});
  const std::string home = screenshot();
  expect_rendered(home, kTeapot);

  tool("keydown d sleep 0.3 keyup d");
  const std::string right = screenshot();
  expect_rendered(right, kTeapot);
  EXPECT_GT(key_of(right)["eye"][0], key_of(home)["eye"][0]);
  EXPECT_EQ(key_of(right)["eye"][2], key_of(home)["eye"][2]);
  EXPECT_FALSE(same_pixels(png(right + ".png"), png(home + ".png")));

  tool("keydown w sleep 0.3 keyup w");
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
    tool("mousemove --window " + window_ + " 500 300 mousedown " + button +
         " mousemove_relative --sync 60 0 mousemove_relative --sync 10 0 mouseup " + button);
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
  press_close(window_);
  expect_closed();
}

TEST_F(WindowTest, KeysChangeThePicture) {
  open({"builtin:teapot", "--size", "300x200"});
  std::vector<std::string> options{"builtin:teapot"};
  const auto shows = [&](const std::string& keys, std::vector<std::string> more) {
    tool("key " + keys);
    options.insert(options.end(), more.begin(), more.end());
    expect_rendered(screenshot(), options);
  };
  shows("m", {"--shader", "material"});
  shows("l l l l l l", {"--opacity", "0.7"});
  shows("t", {"--transparency", "filter:3"});
  shows("b", {"--samples", "4"});
  shows("n n n", {"--rasterizer", "scanline"});
  // The picture is the same with every rasterizer; that the key did something is in the heat map,
  // which counts all fragments and has other colours.
  const std::string before = screenshot();
  tool("key h");
  const std::string heat = screenshot();
  EXPECT_FALSE(same_pixels(png(before + ".png"), png(heat + ".png")));
  tool("key ctrl+q");
  expect_closed();
}

TEST_F(WindowTest, AResizeKeepsThePictureRight) {
  open({"builtin:teapot", "--size", "640x480"});
  EXPECT_EQ(png(screenshot() + ".png").width(), 640);
  for (const char* size : {"333 250", "900 700", "1 1"}) {
    tool("windowsize --sync " + window_ + " " + size);
    int width = 0;
    std::string shot;
    // The window hears of it when the server gets to it.
    for (int i = 0; i < 50 && width != std::atoi(size); ++i) {
      shot = screenshot();
      width = png(shot + ".png").width();
    }
    EXPECT_EQ(width, std::atoi(size));
    expect_rendered(shot, kTeapot);
  }
  press_close(window_);
  expect_closed();
}

TEST_F(WindowTest, ThePanelChangesThePicture) {
  open({"builtin:teapot", "--size", "700x600"});
  const std::string before = screenshot();
  // Where a click lands depends on ImGui's layout; some row of the panel is the heat map's box, and
  // the picture of the heat map is known.
  must({"render", "builtin:teapot", "--quiet", "--size", "700x600", "--heatmap", "heat.png"});
  const Image<Rgba8> wanted = png("heat.png");
  std::filesystem::remove(path("heat.png"));
  bool found = false;
  for (int y = 300; y < 420 && !found; y += 8) {
    tool("mousemove --window " + window_ + " 26 " + std::to_string(y) +
         " sleep 0.1 mousedown 1 sleep 0.1 mouseup 1 sleep 0.1");
    found = same_pixels(png(screenshot() + ".png"), wanted);
  }
  EXPECT_TRUE(found);
  tool("key ctrl+q");
  expect_closed();
}

TEST_F(WindowTest, AScriptEndsTheWindowItself) {
  write("s.json", R"({"fps": 30, "keys": [{"eye": [6, 4, 6], "target": [0, 1, 0]},
                                          {"time": 0.5, "eye": [-6, 4, 6]}],
      "events": [{"time": 0.2, "screenshot": "a.png"}, {"time": 0.3, "size": [320, 200]},
                 {"time": 0.5, "screenshot": "b.png"}, {"time": 0.6, "quit": true}]})");
  open({"builtin:teapot", "--size", "400x300", "--script", "s.json"});
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
}  // namespace rastrum::test
