// SPDX-License-Identifier: BSD-3-Clause
#include "camera_control.hpp"

#include <algorithm>

namespace rastrum::cli::window {

void CameraControl::handle(const Event& event) {
  switch (event.kind) {
    case Event::Kind::key_down:
      if (event.ctrl) return;
      if (event.key == "home") return go_home();
      held_.insert(event.key);
      return;
    case Event::Kind::key_up:
      held_.erase(event.key);
      return;
    case Event::Kind::button_down:
      dragging_ = true;
      x_ = event.x;
      y_ = event.y;
      return begin_drag(event);
    case Event::Kind::button_up:
      dragging_ = false;
      return;
    case Event::Kind::move:
      if (dragging_ && (event.x != x_ || event.y != y_)) drag(event.x - x_, event.y - y_);
      x_ = event.x;
      y_ = event.y;
      return;
    case Event::Kind::wheel:
      return wheel(event.y);
    case Event::Kind::leave:
      held_.clear();
      dragging_ = false;
      return;
  }
}

bool CameraControl::moves(std::span<const KeyHelp> keys) const {
  return dragging_ || std::ranges::any_of(held_, [&](const std::string& key) {
           return !key.ends_with(" shift") &&
                  std::ranges::any_of(keys, [&](const KeyHelp& help) { return help.has(key); });
         });
}

}  // namespace rastrum::cli::window
