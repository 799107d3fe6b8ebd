// SPDX-License-Identifier: BSD-3-Clause
// A person's input, free of any window library, so that scripts and tests can give it.
#pragma once

#include <string>
#include <string_view>

namespace rastrum::cli::window {

enum class Button { left, middle, right };

struct Event {
  enum class Kind {
    key_down,     ///< once per press, whatever the keyboard repeats
    key_up,       ///
    button_down,  ///< at x, y
    button_up,    ///
    move,         ///< the pointer, to x, y
    wheel,        ///< by y notches away from the person
    leave,        ///< the window lost the keyboard: all keys and buttons are up
  };
  Kind kind = Kind::leave;
  std::string key{};  ///< lower case: "w", "left", "page up", "f1", "="
  Button button = Button::left;
  double x = 0, y = 0;  ///< pixels from the window's upper left corner
  bool shift = false, ctrl = false;
};

/// A line of the list of keys, for the panel, --help and the script reader.
struct KeyHelp {
  std::string_view keys;  ///< names of Event::key, separated by ", "
  std::string_view what;

  template <class F>
  void each(F&& f) const {
    constexpr std::string_view kSeparator = ", ";
    std::string_view rest = keys;
    for (std::size_t end; (end = rest.find(kSeparator)) != std::string_view::npos;
         rest.remove_prefix(end + kSeparator.size()))
      f(rest.substr(0, end));
    f(rest);
  }
  [[nodiscard]] bool has(std::string_view key) const {
    bool found = false;
    each([&](std::string_view k) { found = found || k == key; });
    return found;
  }
};

}  // namespace rastrum::cli::window
