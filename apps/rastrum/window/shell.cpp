// SPDX-License-Identifier: BSD-3-Clause
#include "shell.hpp"

#include <SDL.h>
#include <backends/imgui_impl_sdl.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include <rastrum/error.hpp>

#include "imgui_sdl.hpp"
#include "panel.hpp"
#include "parse/arguments.hpp"

namespace rastrum::cli::window {
namespace {

constexpr int kIdle_ms = 10;        ///< between polls if nothing moves
constexpr int kFrame_ms = 2;        ///< if something does
constexpr double kLongest_s = 0.1;  ///< a step of motion, so that a pause is no leap
constexpr int kImguiFrames = 3;     ///< that ImGui needs to settle after an event

[[noreturn]] void fail(const char* what) {
  throw Error(Errc::no_device, std::string(what) + ": " + SDL_GetError());
}

/// Whether pictures of this SDL driver can be visible.
bool is_visible(const std::string& driver) {
  return driver != "offscreen" && driver != "dummy" && driver != "evdev";
}

/// ImGui, the window and what belongs to it, undone in reverse.
class Screen {
 public:
  Screen(const std::string& what, int width, int height) {
    window_ = SDL_CreateWindow(title_of(what).c_str(), SDL_WINDOWPOS_UNDEFINED,
                               SDL_WINDOWPOS_UNDEFINED, width, height, SDL_WINDOW_RESIZABLE);
    if (window_ == nullptr) undo_and_fail("the window cannot be opened");
    // The CPU makes the pictures, so this only copies. SDL_RENDER_DRIVER chooses another renderer.
    renderer_ = SDL_CreateRenderer(window_, -1, SDL_RENDERER_SOFTWARE);
    if (renderer_ == nullptr) undo_and_fail("the window cannot be drawn to");
    SDL_EventState(SDL_DROPFILE, SDL_ENABLE);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // no file in the current directory
    ImGui::StyleColorsDark();
    ImGui_ImplSDL2_InitForSDLRenderer(window_);
    fonts_.emplace(renderer_);
  }
  ~Screen() { undo(); }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  [[nodiscard]] SDL_Window* window() { return window_; }
  void set_title(const std::string& what) {
    const std::string title = title_of(what);
    if (title != SDL_GetWindowTitle(window_)) SDL_SetWindowTitle(window_, title.c_str());
  }
  [[nodiscard]] std::pair<int, int> size() const {
    int width = 0, height = 0;
    SDL_GetRendererOutputSize(renderer_, &width, &height);
    return {width, height};
  }

  /// The picture over the whole window, then ImGui's lists.
  void present(const Drawn* picture, std::uint64_t serial) {
    SDL_SetRenderDrawColor(renderer_, 0, 0, 0, 255);
    SDL_RenderClear(renderer_);
    if (picture != nullptr) {
      if (serial != shown_) upload(*picture);
      shown_ = serial;
      SDL_RenderCopy(renderer_, texture_, nullptr, nullptr);
    }
    ImGui::Render();
    draw_imgui(renderer_, *ImGui::GetDrawData());
    SDL_RenderPresent(renderer_);
  }

 private:
  static std::string title_of(const std::string& what) {
    return std::string("rastrum ").append(what);
  }
  void upload(const Drawn& picture) {
    const int w = picture.image.width(), h = picture.image.height();
    if (texture_ == nullptr || w != width_ || h != height_) {
      if (texture_ != nullptr) SDL_DestroyTexture(texture_);
      texture_ =
          SDL_CreateTexture(renderer_, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STREAMING, w, h);
      if (texture_ == nullptr) fail("the picture cannot be shown");
      SDL_SetTextureScaleMode(texture_, SDL_ScaleModeLinear);
      width_ = w;
      height_ = h;
    }
    SDL_SetTextureBlendMode(texture_, picture.opaque ? SDL_BLENDMODE_NONE : SDL_BLENDMODE_BLEND);
    SDL_UpdateTexture(texture_, nullptr, picture.image.pixels().data(),
                      w * static_cast<int>(sizeof(Rgba8)));
  }
  void undo() {
    if (fonts_) {
      fonts_.reset();
      ImGui_ImplSDL2_Shutdown();
      ImGui::DestroyContext();
    }
    if (texture_ != nullptr) SDL_DestroyTexture(texture_);
    if (renderer_ != nullptr) SDL_DestroyRenderer(renderer_);
    if (window_ != nullptr) SDL_DestroyWindow(window_);
  }
  [[noreturn]] void undo_and_fail(const char* what) {
    const std::string why = SDL_GetError();
    undo();
    throw Error(Errc::no_device, std::string(what) + ": " + why);
  }

  SDL_Window* window_ = nullptr;
  SDL_Renderer* renderer_ = nullptr;
  SDL_Texture* texture_ = nullptr;
  int width_ = 0, height_ = 0;
  std::uint64_t shown_ = 0;
  std::optional<ImguiFonts> fonts_;
};

std::string key_name(const SDL_Keysym& key) {
  std::string name = lower(SDL_GetKeyName(key.sym));
  // Plus is on the key of the equals sign, or has its own beside the numbers.
  if (name == "keypad +" || name == "+") return "=";
  if (name == "keypad -") return "-";
  return name;
}

Button button_of(Uint8 button) {
  if (button == SDL_BUTTON_MIDDLE) return Button::middle;
  return button == SDL_BUTTON_RIGHT ? Button::right : Button::left;
}

class Shell {
 public:
  Shell(std::unique_ptr<Subject> subject, const ViewerOptions& viewer, const ShellOptions& options,
        const Controls& controls)
      : screen_(subject->title(), viewer.width, viewer.height),
        viewer_(std::move(subject), viewer),
        controls_(controls) {
    if (options.script) replay_.emplace(*options.script, viewer_);
  }

  void run() {
    auto before = Clock::now();
    int redraws = kImguiFrames;
    while (!quit_) {
      const bool active = replay_ || viewer_.busy() || redraws > 0;
      if (wait_for_events(replay_ ? 0 : active ? kFrame_ms : kIdle_ms)) redraws = kImguiFrames;
      const auto now = Clock::now();
      const double dt_s = std::chrono::duration<double>(now - before).count();
      before = now;
      if (replay_) {
        replay_step();
        redraws = kImguiFrames;
      } else {
        viewer_.advance(std::min(dt_s, kLongest_s));
        if (viewer_.update()) redraws = kImguiFrames;
      }
      if (redraws > 0) {
        present();
        --redraws;
      }
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// Whether an event may change the picture. Polls and sleeps: if SDL waits it wakes itself by
  /// messages to the window over its own connection, and one that the X server reads after the
  /// window is gone ends the program with an error.
  bool wait_for_events(int timeout_ms) {
    SDL_Event event;
    bool any = false;
    if (SDL_PollEvent(&event) == 0) {
      if (timeout_ms == 0) return false;
      SDL_Delay(static_cast<Uint32>(timeout_ms));
      if (SDL_PollEvent(&event) == 0) return false;
    }
    do {
      any = true;
      take(event);
    } while (SDL_PollEvent(&event) == 1);
    return any;
  }

  void take(const SDL_Event& event) {
    ImGui_ImplSDL2_ProcessEvent(&event);
    // SDL_GetModState() is of the newest event that SDL has read, perhaps many after this one.
    if (event.type == SDL_KEYDOWN || event.type == SDL_KEYUP) modifiers_ = event.key.keysym.mod;
    Event e;
    e.shift = (modifiers_ & KMOD_SHIFT) != 0;
    e.ctrl = (modifiers_ & KMOD_CTRL) != 0;
    switch (event.type) {
      case SDL_QUIT:
        quit_ = true;
        return;
      case SDL_WINDOWEVENT:
        return take_window(event.window);
      case SDL_DROPFILE:
        viewer_.open(event.drop.file);
        SDL_free(event.drop.file);
        return;
      case SDL_KEYDOWN:
      case SDL_KEYUP:
        e.key = key_name(event.key.keysym);
        e.kind = event.type == SDL_KEYDOWN ? Event::Kind::key_down : Event::Kind::key_up;
        if (event.key.repeat != 0) return;
        return take_key(e);
      case SDL_MOUSEBUTTONDOWN:
      case SDL_MOUSEBUTTONUP:
        e.kind =
            event.type == SDL_MOUSEBUTTONDOWN ? Event::Kind::button_down : Event::Kind::button_up;
        e.button = button_of(event.button.button);
        e.x = event.button.x;
        e.y = event.button.y;
        // A press on the panel belongs to it; a release always ends a drag.
        if (e.kind == Event::Kind::button_down && is_panels(event.button.x, event.button.y)) return;
        return send(e);
      case SDL_MOUSEMOTION:
        e.kind = Event::Kind::move;
        e.x = event.motion.x;
        e.y = event.motion.y;
        send(e);
        // The resting place counts, and ImGui learns of it too late.
        if (!replay_ && panel_ && (list_ || area_.holds(event.motion.x, event.motion.y)))
          viewer_.point_nowhere();
        return;
      case SDL_MOUSEWHEEL:
        e.kind = Event::Kind::wheel;
        e.y = double{event.wheel.preciseY};
        if (is_panels(event.wheel.mouseX, event.wheel.mouseY)) return;
        return send(e);
      default:
        return;
    }
  }

  /// ImGui tells only after a frame who has the mouse, and a press may come with the motion that
  /// leads to it. Parts outside of the panel's area, such as a list, have the mouse already.
  [[nodiscard]] bool is_panels(int x, int y) const {
    return panel_ && (ImGui::GetIO().WantCaptureMouse || area_.holds(x, y));
  }

  void take_window(const SDL_WindowEvent& event) {
    if (event.event == SDL_WINDOWEVENT_SIZE_CHANGED) {
      const auto [width, height] = screen_.size();
      viewer_.resize(width, height);
    } else if (event.event == SDL_WINDOWEVENT_FOCUS_LOST) {
      send({.kind = Event::Kind::leave});
    } else if (event.event == SDL_WINDOWEVENT_LEAVE && !replay_) {
      viewer_.point_nowhere();
    }
  }

  void take_key(const Event& e) {
    const bool down = e.kind == Event::Kind::key_down;
    if (down && e.ctrl && e.key == "q") {
      quit_ = true;
      return;
    }
    if (down && e.ctrl && e.key == "c" && !ImGui::GetIO().WantTextInput) {
      if (const std::string text = viewer_.copy(e.shift ? ".py" : ".sh"); !text.empty())
        SDL_SetClipboardText(text.c_str());
      return;
    }
    // While a text is edited keys are text, but their releases count.
    if (down && ImGui::GetIO().WantTextInput) return;
    if (down && e.key == "tab") {
      panel_ = !panel_;
      return;
    }
    send(e);
  }

  /// A person's events would spoil a replay.
  void send(const Event& e) {
    if (!replay_) viewer_.handle(e);
  }

  void replay_step() {
    const auto begin = Clock::now();
    replay_->step();
    if (const auto size = replay_->take_size())
      SDL_SetWindowSize(screen_.window(), size->first, size->second);
    quit_ = quit_ || replay_->quit();
    // No faster than its own time; SDL sleeps in whole milliseconds.
    const double left_ms = 1000 / replay_->fps() -
                           std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    if (left_ms >= 1) SDL_Delay(static_cast<Uint32>(left_ms));
    if (replay_->finished()) replay_.reset();
  }

  void present() {
    screen_.set_title(viewer_.title());
    ImGui_ImplSDL2_NewFrame();
    ImGui::NewFrame();
    if (panel_)
      area_ = draw_panel(viewer_, controls_);
    else
      draw_messages(viewer_);
    list_ = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    draw_hovered(viewer_);
    screen_.present(viewer_.picture(), viewer_.serial());
  }

  Screen screen_;
  Viewer viewer_;
  const Controls& controls_;
  std::optional<Replay> replay_;
  unsigned modifiers_ = 0;  ///< at the event being taken
  bool panel_ = true;
  Area area_;          ///< of the panel, when last drawn
  bool list_ = false;  ///< of the panel is open
  bool quit_ = false;
};

}  // namespace

Display::Display() {
  SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
  // A software renderer would go through OpenGL to the screen, which users may lack.
  SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // Ctrl-C in the terminal ends the program
  const char* const asked = SDL_getenv("SDL_VIDEODRIVER");
  const bool begun = SDL_Init(SDL_INIT_VIDEO) == 0;
  if (begun && (asked != nullptr || is_visible(SDL_GetCurrentVideoDriver()))) return;
  std::string why = begun ? "DISPLAY and WAYLAND_DISPLAY lead to none" : SDL_GetError();
  SDL_Quit();
  throw Error(
      Errc::no_device,
      "there is no display to open a window on (" + why +
          "): `rastrum render` and `rastrum terrain` draw the same into files, and `ssh -X` "
          "brings the window to where you sit");
}

Display::~Display() {
  SDL_Quit();
}

void run_shell(std::unique_ptr<Subject> subject, const ViewerOptions& viewer,
               const ShellOptions& options, const Controls& controls) {
  Shell(std::move(subject), viewer, options, controls).run();
}

}  // namespace rastrum::cli::window
