// SPDX-License-Identifier: BSD-3-Clause
// Declarations that the drawing functions share.
#pragma once

#include <cmath>

#include <rastrum/overlay.hpp>

namespace rastrum::overlay {

/// Throws Error{invalid_argument} if the views differ in size or have rows that overlap.
void check(const Canvas& canvas);

/// Lengths in px, from the size of letters.
struct Measures {
  double letter, line, halo, margin;
};
[[nodiscard]] inline Measures measures_of(const Canvas& canvas, const Look& look) {
  const double letter = letter_px(canvas, look);
  return {letter, std::fmax(1, std::nearbyint(letter / 14)), letter * 0.11, letter};
}

[[nodiscard]] constexpr bool is_left(Corner corner) {
  return corner == Corner::bottom_left || corner == Corner::top_left;
}
[[nodiscard]] constexpr bool is_top(Corner corner) {
  return corner == Corner::top_left || corner == Corner::top_right;
}

[[nodiscard]] inline TextStyle letters(const Measures& m, const Look& look) {
  return {.size_px = m.letter, .color = look.color, .halo_px = m.halo, .halo = look.halo};
}

/// Blends the halo of the shape that `add(path, wider)` adds, then the shape.
template <class Add>
void fill_with_halo(const Canvas& canvas, const Measures& m, const Look& look, Rgba8 color,
                    Add&& add, PixelTest test = {}) {
  if (look.halo.a != 0) {
    Path halo;
    add(halo, 2 * m.halo);
    fill(canvas, halo, look.halo, test);
  }
  Path path;
  add(path, 0);
  fill(canvas, path, color, test);
}

/// How far an axis's name reaches to each side of its place; a single letter has room anyway.
[[nodiscard]] inline double half_of_word(std::string_view name, double size_px) {
  return name.size() > 1 ? measure_text(name, size_px).width_px / 2 : 0;
}

}  // namespace rastrum::overlay
