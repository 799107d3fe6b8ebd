// SPDX-License-Identifier: BSD-3-Clause
// Letters' sizes and colours, titles and captions.
#include <algorithm>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/overlay/canvas.hpp>

namespace rastrum::overlay {

Look look_on(Vec4 background) {
  const float grey = 0.3F * background.x + 0.59F * background.y + 0.11F * background.z;
  // A mostly transparent background may be put on anything.
  if (!(background.w > 0.5F && grey > 0.5F)) return {};
  return {.color = {25, 27, 32, 255}, .halo = {255, 255, 255, 190}};
}

double letter_px(const Canvas& canvas, const Look& look) {
  const FloatScope floats;
  if (!(look.scale > 0 && look.scale <= 100))
    reject("Look::scale must lie in (0, 100], got ", look.scale);
  const double side = std::min(canvas.width(), canvas.height());
  return std::min(std::max(side / 40, 9.0) * look.scale, 4096.0);
}

void draw_title(const Canvas& canvas, std::string_view text, const Look& look) {
  const FloatScope floats;
  const Measures m = measures_of(canvas, look);
  TextStyle style = letters(m, look);
  style.size_px = m.letter * 1.5;
  style.align_x = AlignX::center;
  style.align_y = AlignY::top;
  draw_text(canvas, canvas.width() / 2.0, m.margin, text, style);
}

void draw_caption(const Canvas& canvas, std::string_view text, Corner corner, const Look& look) {
  const FloatScope floats;
  const Measures m = measures_of(canvas, look);
  TextStyle style = letters(m, look);
  const bool left = is_left(corner), top = is_top(corner);
  style.align_x = left ? AlignX::left : AlignX::right;
  style.align_y = top ? AlignY::top : AlignY::bottom;
  draw_text(canvas, left ? m.margin : canvas.width() - m.margin,
            top ? m.margin : canvas.height() - m.margin, text, style);
}

}  // namespace rastrum::overlay
