// SPDX-License-Identifier: BSD-3-Clause
// The base of all camera controls: held keys, a drag, and a count of changes.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>

#include "event.hpp"

namespace rastrum::cli::window {

class CameraControl {
 public:
  virtual ~CameraControl() = default;
  void handle(const Event& event);
  virtual void go_home() = 0;
  [[nodiscard]] unsigned long version() const { return version_; }

 protected:
  /// Whether a moving key of `keys` or a drag is held.
  [[nodiscard]] bool moves(std::span<const KeyHelp> keys) const;
  [[nodiscard]] bool held(std::string_view key) const { return held_.contains(key); }
  /// 1, −1 or, if both are held, 0.
  [[nodiscard]] double way(const char* forth, const char* back) const {
    return static_cast<double>(held(forth)) - static_cast<double>(held(back));
  }
  /// Shift multiplies the speed.
  [[nodiscard]] double pace() const { return held("left shift") || held("right shift") ? 4 : 1; }
  virtual void begin_drag(const Event& /*press*/) {}
  virtual void drag(double dx_px, double dy_px) = 0;
  virtual void wheel(double notches) = 0;

  unsigned long version_ = 0;

 private:
  std::set<std::string, std::less<>> held_;
  bool dragging_ = false;
  double x_ = 0, y_ = 0;
};

}  // namespace rastrum::cli::window
