// SPDX-License-Identifier: BSD-3-Clause
// The subject of a window: meshes or a terrain, with camera and options.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/frame.hpp>
#include <rastrum/image.hpp>

#include "event.hpp"
#include "worker.hpp"

namespace rastrum::cli::window {

/// Numbers beside a picture.
struct Figures {
  double frame_ms = 0;
  std::vector<StageTime> stages;
  std::vector<std::pair<std::string, std::string>> rows;  ///< name, value
};

struct Drawn {
  Image<Rgba8> image;
  bool opaque = true;  ///< all alpha is 255
  Figures figures;
};

/// Describes what lies under a pixel; all empty: nothing.
struct Picked {
  std::string value;  ///< with its unit, if numbers are shown
  std::string what, where;

  [[nodiscard]] bool any() const { return !what.empty(); }
  [[nodiscard]] std::string line() const {
    if (!any()) return "nothing is there";
    return what + (where.empty() ? "" : " at " + where) + (value.empty() ? "" : ", " + value);
  }
};

/// Call all members on the window's thread. The functions that `draw` and `open` return run on the
/// worker's.
class Subject {
 public:
  Subject() = default;
  virtual ~Subject() = default;
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;

  virtual void handle(const Event& event) = 0;
  virtual void advance(double dt_s) = 0;
  virtual void resize(int width, int height) = 0;
  /// Whether the next picture differs from this one by itself.
  [[nodiscard]] virtual bool moving() const = 0;
  /// Changes whenever the picture would.
  [[nodiscard]] virtual std::uint64_t version() const = 0;

  /// Draws the present picture at this size; the function owns all that it needs. Throws Error.
  /// `glance`: quickly, without slow parts.
  [[nodiscard]] virtual std::function<Drawn()> draw(int width, int height, bool glance) = 0;
  /// Whether a glance differs from a whole picture of its size.
  [[nodiscard]] virtual bool has_glances() const { return false; }
  /// Describes what lies under pixel (x, y) of the present picture of this size; the function owns
  /// all that it needs, and throws Error. Empty if the subject cannot tell.
  [[nodiscard]] virtual std::function<Picked()> pick(int x, int y, int width, int height) = 0;
  /// Reads a file and, back on the window's thread, shows it. Throws Error.
  [[nodiscard]] virtual Worker::Job open(const std::filesystem::path& file) = 0;
  /// Options as on the command line, such as "--shader normal --opacity 0.5". Throws Error and
  /// changes nothing then.
  virtual void set_options(const std::string& options) = 0;

  /// A path file with the present camera, which draws the same picture again.
  virtual void write_camera(const std::filesystem::path& file) const = 0;
  /// Texts of scripts with their files' endings, which draw the present picture of this size into
  /// `png`.
  using Texts = std::vector<std::pair<std::string, std::string>>;
  [[nodiscard]] virtual Texts same_picture(int width, int height, const std::string& png) const {
    static_cast<void>(width), static_cast<void>(height), static_cast<void>(png);
    return {};
  }
  /// Appends the camera to the recorded path and writes it all.
  virtual void record(const std::filesystem::path& file) = 0;
  /// Reads a path to follow. Returns its first and last second. Throws Error.
  virtual std::pair<double, double> follow(const std::filesystem::path& file) = 0;
  /// Goes to the path's place at `time_s`; requires follow().
  virtual void go_to(double time_s) = 0;

  [[nodiscard]] virtual std::string title() const = 0;
  [[nodiscard]] virtual std::vector<KeyHelp> keys() const = 0;
};

/// Between two keys that a person records.
inline constexpr double kRecordStep_s = 2;

}  // namespace rastrum::cli::window
