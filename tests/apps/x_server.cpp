// SPDX-License-Identifier: BSD-3-Clause
#include "x_server.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>
// clang-format off: last, since its names are macros
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
// clang-format on

namespace rastrum::test {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
constexpr std::chrono::seconds kPatience{150};

/// A property of 32-bit numbers or of text; null if the window has none of that type.
struct Property {
  Property(Display* display, Window window, const char* name, Atom type) {
    Atom actual = 0;
    int format = 0;
    unsigned long left = 0;
    if (XGetWindowProperty(display, window, XInternAtom(display, name, False), 0, 1024, False, type,
                           &actual, &format, &count, &left, &data) != 0 ||
        actual != type)
      count = 0;
  }
  ~Property() {
    if (data != nullptr) XFree(data);
  }
  Property(const Property&) = delete;
  Property& operator=(const Property&) = delete;

  unsigned char* data = nullptr;
  unsigned long count = 0;
};

}  // namespace

bool wait_until(const std::function<bool()>& done) {
  const auto end = Clock::now() + kPatience;
  while (!done()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds(20));
  }
  return true;
}

Process::~Process() {
  stop(SIGKILL);
}

void Process::start(const std::vector<std::string>& command, const std::filesystem::path& folder,
                    const std::filesystem::path& said, int inherit) {
  std::vector<char*> argv;
  for (const std::string& a : command) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  status_ = -1;
  child_ = ::fork();
  if (child_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // ends the server with a killed test
  const int e = ::open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (e < 0 || ::dup2(e, 1) < 0 || ::dup2(e, 2) < 0 || ::chdir(folder.c_str()) != 0) ::_exit(127);
  if (inherit >= 0) ::fcntl(inherit, F_SETFD, 0);
  ::execvp(argv[0], argv.data());
  ::_exit(127);
}

bool Process::running() {
  if (child_ <= 0) return false;
  int status = 0;
  if (::waitpid(child_, &status, WNOHANG) != child_) return true;
  ended(status);
  return false;
}

void Process::signal(int number) const {
  if (child_ > 0) ::kill(child_, number);
}

void Process::stop(int signal) {
  if (!running()) return;
  ::kill(child_, signal);
  int status = 0;
  ::waitpid(child_, &status, 0);
  ended(status);
}

void Process::ended(int status) {
  child_ = -1;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

XServer::XServer() {
  // A window may vanish before a request arrives, which must not end the test.
  XSetErrorHandler([](Display*, XErrorEvent*) { return 0; });
  // Numbers of this process, far from those that a server tries when it searches for a free one.
  // While it searches it steals the sockets of others.
  constexpr int kFirst = 2000, kNumbers = 40000, kTries = 5, kStride = 7919;
  for (int i = 0; i < kTries; ++i)
    if (!fails_with(kFirst + (static_cast<int>(::getpid()) + i * kStride) % kNumbers)) return;
}

XServer::~XServer() {
  if (display_ != nullptr) XCloseDisplay(display_);
  process_.stop(SIGTERM);
}

std::string XServer::said() const {
  return slurp(folder_.path("said"));
}

bool XServer::fails_with(int number) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return false;
  name_ = std::string(":").append(std::to_string(number));
  process_.start({"Xvfb", name_, "-displayfd", std::to_string(ends[1]), "-screen", "0",
                  "1024x800x24", "-nolisten", "tcp",
                  // A slow machine must not repeat keys, and the server must not restart when its
                  // last client leaves.
                  "-r", "-noreset"},
                 folder_.path(""), folder_.path("said"), ends[1]);
  ::close(ends[1]);
  // The server writes its number and, once it listens, separately the end of the line. It dies if
  // nobody reads that far.
  bool listens = false, answers = true;
  while (!listens && answers) {
    pollfd ready{ends[0], POLLIN, 0};
    const auto patience = std::chrono::duration_cast<milliseconds>(kPatience).count();
    char byte = 0;
    answers = ::poll(&ready, 1, static_cast<int>(patience)) > 0;
    if (!answers || ::read(ends[0], &byte, 1) != 1) break;
    listens = byte == '\n';
  }
  ::close(ends[0]);
  if (listens)
    wait_until([&] {
      display_ = XOpenDisplay(name_.c_str());
      return display_ != nullptr || !process_.running();
    });
  if (display_ == nullptr) process_.stop(SIGKILL);
  return answers && !listens;
}

XWindow XServer::window_of(pid_t process) const {
  Window root = 0, parent = 0, found = 0;
  Window* children = nullptr;
  unsigned count = 0;
  if (XQueryTree(display_, DefaultRootWindow(display_), &root, &parent, &children, &count) == 0)
    return 0;
  for (unsigned i = 0; i < count && found == 0; ++i) {
    const Property pid(display_, children[i], "_NET_WM_PID", XA_CARDINAL);
    XWindowAttributes attributes{};
    // Xlib returns 32-bit numbers as longs.
    if (pid.count == 1 && *reinterpret_cast<const long*>(pid.data) == process &&
        XGetWindowAttributes(display_, children[i], &attributes) != 0 &&
        attributes.map_state == IsViewable)
      found = children[i];
  }
  if (children != nullptr) XFree(children);
  return found;
}

std::string XServer::title(XWindow window) const {
  const Property text(display_, window, "_NET_WM_NAME",
                      XInternAtom(display_, "UTF8_STRING", False));
  return {reinterpret_cast<const char*>(text.data), text.count};
}

bool XServer::focus(XWindow window) const {
  XSetInputFocus(display_, window, RevertToParent, CurrentTime);
  Window now = 0;
  int revert = 0;
  XGetInputFocus(display_, &now, &revert);
  return now == window;
}

void XServer::resize(XWindow window, int width, int height) const {
  XResizeWindow(display_, window, static_cast<unsigned>(width), static_cast<unsigned>(height));
  XSync(display_, False);
}

void XServer::close(XWindow window) const {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = window;
  event.xclient.message_type = XInternAtom(display_, "WM_PROTOCOLS", False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(display_, "WM_DELETE_WINDOW", False));
  XSendEvent(display_, window, False, NoEventMask, &event);
  XSync(display_, False);
}

std::string XServer::clipboard() const {
  const Atom text = XInternAtom(display_, "UTF8_STRING", False);
  const Window mine =
      XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
  XConvertSelection(display_, XInternAtom(display_, "CLIPBOARD", False), text,
                    XInternAtom(display_, "RASTRUM_TEXT", False), mine, CurrentTime);
  XEvent answer{};
  std::string found;
  // The owner of the clipboard answers, or the server if there is none.
  if (wait_until([&] {
        return XCheckTypedWindowEvent(display_, mine, SelectionNotify, &answer) == True;
      }) &&
      answer.xselection.property != 0) {
    const Property property(display_, mine, "RASTRUM_TEXT", text);
    if (property.data != nullptr)
      found.assign(reinterpret_cast<const char*>(property.data), property.count);
  }
  XDestroyWindow(display_, mine);
  XSync(display_, False);
  return found;
}

Image<Rgba8> XServer::pixels(XWindow window, int x0, int y0, int width, int height) const {
  XImage* const x_image = XGetImage(display_, window, x0, y0, static_cast<unsigned>(width),
                                    static_cast<unsigned>(height), AllPlanes, ZPixmap);
  if (x_image == nullptr) return {};
  Image<Rgba8> image(width, height);
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

}  // namespace rastrum::test
