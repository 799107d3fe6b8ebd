// SPDX-License-Identifier: BSD-3-Clause
// The session of a window without the window: which picture is drawn when and at what resolution,
// screenshots, dropped files, and errors as text.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "event.hpp"
#include "parse/output.hpp"
#include "resolution.hpp"
#include "subject.hpp"
#include "worker.hpp"

namespace rastrum::cli::window {

struct ViewerOptions {
  int width = 1280, height = 720;
  double target_ms = 33;  ///< of a frame while something moves
  /// Whether moving pictures may have fewer pixels.
  bool adaptive = true;
  NumberedName screenshots{"--screenshots", "rastrum_%04d.png"};
};

class Viewer {
 public:
  Viewer(std::unique_ptr<Subject> subject, ViewerOptions options);
  /// Stops the picture that is being drawn.
  ~Viewer();

  void handle(const Event& event);
  void resize(int width, int height);
  /// Replaces the subject's file.
  void open(const std::filesystem::path& file);
  /// Writes a PNG and a .json with the camera once the picture is full and still.
  void screenshot(const std::filesystem::path& file);
  /// The title then describes a pixel of the window.
  void pick(int x, int y);
  /// For a pointer that has left the picture; a move brings it back.
  void point_nowhere() { pointer_.reset(); }
  /// Describes what lies under the pointer, once it and the whole picture rest; null: unknown, or
  /// nothing.
  [[nodiscard]] const Picked* hovered() const;
  /// The pixel of the window under the pointer, if that is over the picture.
  [[nodiscard]] std::optional<std::pair<int, int>> pointer() const { return pointer_; }
  /// Returns the text that draws the visible picture: .sh or .py (Subject::same_picture). Reports
  /// the copy; empty if there is no such text.
  [[nodiscard]] std::string copy(const std::string& ending);
  /// As the option line of a script; an error becomes the message.
  void set_options(const std::string& options);
  /// `dt_s`: seconds since the last call.
  void advance(double dt_s);
  /// Takes finished work and begins the next. Returns whether a picture or message is new.
  bool update();
  /// Updates until the full picture and everything asked for is done.
  void settle();

  [[nodiscard]] Subject& subject() { return *subject_; }
  /// Names the subject, and what was clicked on.
  [[nodiscard]] std::string title() const;
  /// The newest picture, or null before the first; `is_full`: it has all pixels and is no glance.
  [[nodiscard]] const Drawn* picture() const { return picture_.get(); }
  [[nodiscard]] bool is_full() const { return shown_.is_full(); }
  [[nodiscard]] std::uint64_t serial() const { return serial_; }
  [[nodiscard]] const std::vector<float>& history_ms() const { return history_ms_; }
  /// Whether update() should be called soon.
  [[nodiscard]] bool busy() const;
  /// Why the wanted picture is missing, else the last error of a file or an option.
  [[nodiscard]] const std::string& error() const {
    return draw_error_.empty() ? error_ : draw_error_;
  }
  [[nodiscard]] const std::string& notice() const { return notice_; }
  void set_adaptive(bool adaptive) { options_.adaptive = adaptive; }
  [[nodiscard]] const ViewerOptions& options() const { return options_; }
  void set_target(double ms);
  /// Whether the pixel under a resting pointer is looked up.
  void set_hovers(bool hovers) { hovers_ = hovers; }
  [[nodiscard]] bool hovers() const { return hovers_; }

  [[nodiscard]] static std::vector<KeyHelp> keys();

 private:
  struct State {
    std::uint64_t version = ~std::uint64_t{0};
    int width = 0, height = 0;
    std::size_t step = 0;
    bool glance = false;
    [[nodiscard]] bool is_full() const { return step == 0 && !glance; }
    [[nodiscard]] bool same_view(const State& o) const {
      return version == o.version && width == o.width && height == o.height;
    }
  };
  [[nodiscard]] State now() const;
  [[nodiscard]] bool resting() const;
  /// The picture to draw next; may be none.
  [[nodiscard]] std::optional<State> next() const;
  void draw(const State& state);
  /// The begin of the click that `event` ends: a press and a release of the left button in one
  /// place.
  [[nodiscard]] std::optional<std::pair<double, double>> clicked(const Event& event);
  /// A pixel of a picture, and what is there.
  struct Look {
    State view;
    int x = 0, y = 0;
    Picked picked{};
  };
  /// Whether it describes the pixel under the pointer in the present view.
  [[nodiscard]] bool is_under_pointer(const Look& look) const;
  /// Whether the pixel under the pointer has not been looked up.
  [[nodiscard]] bool has_pointer_news() const;
  [[nodiscard]] bool wants_look() const;
  void look();
  void follow_pointer(const Event& event);
  void write_screenshot(const std::filesystem::path& file);
  /// Runs `job` on the worker; its exception becomes the error.
  void submit(Worker::Job job, std::function<void(const std::string& what)> failed);
  [[nodiscard]] std::filesystem::path free_name() const;
  void record();

  std::unique_ptr<Subject> subject_;
  ViewerOptions options_;
  Resolution resolution_;
  State shown_;
  /// A finer picture being drawn of the same view, which stops for anything else. Every other
  /// picture is finished, so that one appears from time to time whatever moves.
  std::optional<State> refining_;
  std::stop_source drawing_;
  bool failed_ = false;  ///< shown_ could not be drawn
  std::uint64_t seen_version_ = 0;
  double still_s_ = 0;
  std::shared_ptr<const Drawn> picture_;
  std::uint64_t serial_ = 0;
  std::vector<float> history_ms_;
  std::string draw_error_, error_, notice_, picked_;
  std::vector<std::filesystem::path> screenshots_, opens_;
  std::optional<std::pair<int, int>> pick_;         ///< asked for; the newest counts
  std::optional<std::pair<double, double>> press_;  ///< of a possible click
  bool hovers_ = true, pressed_ = false;
  std::optional<std::pair<int, int>> pointer_;  ///< if over the picture
  double rested_s_ = 0;
  std::optional<Look> looking_, looked_;  ///< under way; the newest answer
  std::stop_source look_stop_;
  std::filesystem::path recording_;
  Worker worker_;  ///< last: its thread uses the members above
};

}  // namespace rastrum::cli::window
