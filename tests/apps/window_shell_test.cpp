// The window itself: a virtual X server, real keys and buttons by xdotool, and the program's own
// screenshots, which say where the camera stands and are compared with `rastrum render`.
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <thread>

#include "program.hpp"
// clang-format off: last, since its names are macros
#include <X11/Xlib.h>
#include <X11/Xutil.h>
// clang-format on

namespace rastrum::test {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
// A machine that runs everything at once, under a sanitizer, is slow.
constexpr std::chrono::seconds kPatience{150};

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
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves none behind
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

/// A virtual X server for all cases of this process, with a connection of the test's own.
class Server {
 public:
  Server() {
    char folder[] = "/tmp/rastrum-xvfb-XXXXXX";
    if (::mkdtemp(folder) == nullptr) return;
    log_ = folder;
    // Numbers of this process, far from those that a server searching for one tries: while it
    // searches it takes the sockets of others away.
    constexpr int kFirst = 2000, kNumbers = 40000, kTries = 5, kStride = 7919;
    for (int i = 0; i < kTries && display_ == nullptr; ++i)
      try_number(kFirst + (static_cast<int>(::getpid()) + i * kStride) % kNumbers);
  }
  ~Server() {
    if (display_ != nullptr) XCloseDisplay(display_);
    process_.stop(SIGTERM);
    if (!log_.empty()) std::filesystem::remove_all(log_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Null where there is no server.
  [[nodiscard]] Display* display() const { return display_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string said() const {
    std::ifstream in(log_ / "err");
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  void try_number(int number) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return;
    name_ = std::string(":").append(std::to_string(number));
    process_.start({"Xvfb", name_, "-displayfd", std::to_string(ends[1]), "-screen", "0",
                    "1024x800x24", "-nolisten", "tcp",
                    // No key repeats because this machine was busy between press and release; and
                    // the server does not start anew when its last client leaves.
                    "-r", "-noreset"},
                   log_, log_ / "err", ends[1]);
    ::close(ends[1]);
    // It writes its number and, in a write of its own, the end of the line once it listens; where
    // nobody reads that to the end it dies.
    char byte = 0;
    bool listens = false;
    while (!listens && ::read(ends[0], &byte, 1) == 1) listens = byte == '\n';
    ::close(ends[0]);
    if (listens)
      wait_until([&] {
        display_ = XOpenDisplay(name_.c_str());
        return display_ != nullptr || !process_.running();
      });
    if (display_ == nullptr) process_.stop(SIGKILL);
  }

  std::filesystem::path log_;
  std::string name_;
  Process process_;
  Display* display_ = nullptr;
};

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
    if (!server_) server_ = std::make_unique<Server>();
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

  void open(std::vector<std::string> args) {
    args.insert(args.begin(), {RASTRUM_PROGRAM, "view"});
    viewer_.start(args, path(""), err());
    ASSERT_TRUE(wait_until([&] {
      window_ = tool("search --onlyvisible --name '^rastrum '");
      return !window_.empty() || !viewer_.running();
    }));
    ASSERT_FALSE(window_.empty()) << said();
    // No window manager gives it the keyboard. Until it is mapped the server refuses, too.
    ASSERT_TRUE(wait_until([&] {
      tool("windowfocus " + window_);
      Window focus = 0;
      int revert = 0;
      XGetInputFocus(server_->display(), &focus, &revert);
      return focus == std::stoul(window_) || !viewer_.running();
    }));
    ASSERT_TRUE(viewer_.running()) << said();
  }
  /// Asks the window to close, as a window manager's button does.
  void press_close() {
    Display* const display = server_->display();
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = std::stoul(window_);
    event.xclient.message_type = XInternAtom(display, "WM_PROTOCOLS", 0);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display, "WM_DELETE_WINDOW", 0));
    XSendEvent(display, event.xclient.window, 0, NoEventMask, &event);
    XFlush(display);
  }
  /// What the window shows, as the server has it.
  [[nodiscard]] Image<Rgba8> screen(int width, int height) const {
    Image<Rgba8> image(width, height);
    XImage* const x_image =
        XGetImage(server_->display(), std::stoul(window_), 0, 0, static_cast<unsigned>(width),
                  static_cast<unsigned>(height), AllPlanes, ZPixmap);
    if (x_image == nullptr) return image;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const unsigned long p = XGetPixel(x_image, x, y);
        image(x, y) = {static_cast<std::uint8_t>(p >> 16 & 255),
                       static_cast<std::uint8_t>(p >> 8 & 255), static_cast<std::uint8_t>(p & 255),
                       255};
      }
    XDestroyImage(x_image);
    return image;
  }
  /// What the program wrote.
  [[nodiscard]] std::string said() const {
    std::ifstream in(err());
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

  static inline std::unique_ptr<Server> server_;
  Process viewer_;
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
  press_close();
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
  tool("key ctrl+q");
  expect_closed();
}

TEST_F(WindowTest, AResizeKeepsThePictureRight) {
  open({"builtin:teapot", "--size", "640x480"});
  EXPECT_EQ(png(screenshot() + ".png").width(), 640);
  for (const auto& [width, height] : {std::pair{333, 250}, {900, 700}, {60, 40}}) {
    XResizeWindow(server_->display(), std::stoul(window_), static_cast<unsigned>(width),
                  static_cast<unsigned>(height));
    XSync(server_->display(), False);
    // The window hears of it when the server gets to it.
    std::string shot;
    const int wanted = width;
    EXPECT_TRUE(wait_until([&] {
      shot = screenshot();
      return png(shot + ".png").width() == wanted || testing::Test::HasFailure();
    }));
    EXPECT_EQ(png(shot + ".png").height(), height);
    expect_rendered(shot, kTeapot);
  }
  press_close();
  expect_closed();
}

TEST_F(WindowTest, WithoutThePanelThePictureIsOnTheScreen) {
  open({"builtin:teapot", "--size", "700x500"});
  const Image<Rgba8> picture = png(screenshot() + ".png");
  EXPECT_FALSE(same_pixels(screen(700, 500), picture)) << "the panel lies over it";
  tool("key Tab");
  EXPECT_TRUE(wait_until([&] { return same_pixels(screen(700, 500), picture); }));
  tool("key ctrl+q");
  expect_closed();
}

TEST_F(WindowTest, ADragOnThePanelIsThePanels) {
  open({"builtin:teapot", "--size", "700x500"});
  const auto home = key_of(screenshot());
  tool("mousemove --window " + window_ +
       " 100 60 mousedown 1 mousemove_relative --sync 60 0 mousemove_relative --sync 10 0 mouseup "
       "1");
  EXPECT_EQ(key_of(screenshot()), home);
  tool("mousemove --window " + window_ + " 100 60 click 4");
  EXPECT_EQ(key_of(screenshot()), home);
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
