// SPDX-License-Identifier: BSD-3-Clause
// The source's side of XDND 5 (https://freedesktop.org/wiki/Specifications/XDND): enter, position,
// drop. The target asks for the selection and confirms it.
#include <array>
#include <cstdio>
#include <string>

#include "x_server.hpp"
// clang-format off: last, since its names are macros
#include <X11/Xatom.h>
#include <X11/Xlib.h>
// clang-format on

namespace rastrum::test {
namespace {

std::string uri_of(const std::filesystem::path& file) {
  std::string uri = "file://";
  for (const char c : file.string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '/' || c == '.' || c == '-' || c == '_';
    std::array<char, 8> code{};
    std::snprintf(code.data(), code.size(), plain ? "%c" : "%%%02X",
                  plain ? c : static_cast<unsigned char>(c));
    uri += code.data();
  }
  return uri + "\r\n";
}

class Drag {
 public:
  Drag(Display* display, Window target)
      : display_(display),
        target_(target),
        source_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)) {}
  ~Drag() { XDestroyWindow(display_, source_); }
  Drag(const Drag&) = delete;
  Drag& operator=(const Drag&) = delete;

  std::string drop(const std::string& uri) {
    constexpr long kVersion = 5;
    XWindowAttributes size{};
    int x = 0, y = 0;
    Window child = 0;
    if (XGetWindowAttributes(display_, target_, &size) == 0) return "the window is gone";
    XTranslateCoordinates(display_, target_, size.root, size.width / 2, size.height / 2, &x, &y,
                          &child);
    XSetSelectionOwner(display_, atom("XdndSelection"), source_, CurrentTime);
    send("XdndEnter", {0, kVersion << 24, static_cast<long>(atom("text/uri-list")), 0, 0});
    send("XdndPosition",
         {0, 0, static_cast<long>(x) << 16 | y, 0, static_cast<long>(atom("XdndActionCopy"))});
    XEvent event;
    if (!wait_for_message("XdndStatus", event)) return "no answer to XdndPosition";
    if ((event.xclient.data.l[1] & 1) == 0) return "the window does not take the file";
    send("XdndDrop", {0, 0, CurrentTime, 0, 0});
    if (!wait_for(SelectionRequest, event)) return "the window does not ask for the file";
    answer(event.xselectionrequest, uri);
    if (!wait_for_message("XdndFinished", event)) return "no XdndFinished";
    return {};
  }

 private:
  [[nodiscard]] Atom atom(const char* name) const { return XInternAtom(display_, name, False); }
  void send(const char* name, std::array<long, 5> data) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = target_;
    event.xclient.message_type = atom(name);
    event.xclient.format = 32;
    data[0] = static_cast<long>(source_);
    for (std::size_t i = 0; i < data.size(); ++i) event.xclient.data.l[i] = data[i];
    XSendEvent(display_, target_, False, NoEventMask, &event);
    XFlush(display_);
  }
  bool wait_for(int type, XEvent& event) {
    return wait_until([&] { return XCheckTypedWindowEvent(display_, source_, type, &event) != 0; });
  }
  bool wait_for_message(const char* name, XEvent& event) {
    return wait_until([&] {
      while (XCheckTypedWindowEvent(display_, source_, ClientMessage, &event) != 0)
        if (event.xclient.message_type == atom(name)) return true;
      return false;
    });
  }
  void answer(const XSelectionRequestEvent& request, const std::string& uri) {
    XChangeProperty(display_, request.requestor, request.property, request.target, 8,
                    PropModeReplace, reinterpret_cast<const unsigned char*>(uri.data()),
                    static_cast<int>(uri.size()));
    XEvent event{};
    event.xselection.type = SelectionNotify;
    event.xselection.requestor = request.requestor;
    event.xselection.selection = request.selection;
    event.xselection.target = request.target;
    event.xselection.property = request.property;
    event.xselection.time = request.time;
    XSendEvent(display_, request.requestor, False, NoEventMask, &event);
    XFlush(display_);
  }

  Display* display_;
  Window target_, source_;
};

}  // namespace

std::string drop_file(const XServer& server, XWindow window, const std::filesystem::path& file) {
  return Drag(server.display(), window).drop(uri_of(file));
}

}  // namespace rastrum::test
