// SPDX-License-Identifier: BSD-3-Clause
// The triad of axes in a corner: the camera's rotation alone, so it never moves.
#include <algorithm>
#include <cmath>
#include <string_view>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/overlay/canvas.hpp>

namespace rastrum::overlay {
namespace {

struct Axis {
  std::string_view name;
  Rgba8 color;
  double x, y, towards;  ///< in the picture, y down; towards the viewer
};

void add_arrow(Path& path, double x, double y, const Axis& axis, double length, double line,
               double head, double wider) {
  const double across = std::sqrt(axis.x * axis.x + axis.y * axis.y);
  if (across * length < 1) {  // it points at the viewer, or away
    path.add_disc(x, y, head * 0.5 + wider / 2);
    return;
  }
  const double ux = axis.x / across, uy = axis.y / across, reach = across * length;
  const double tip = std::min(head * 1.6, reach), wing = head / 2 * tip / (head * 1.6);
  const double hx = x + ux * reach, hy = y + uy * reach, bx = hx - ux * tip, by = hy - uy * tip;
  path.add_line(x, y, bx, by, line + wider);
  const double w = wing + wider / 2, far = wider * 0.7;
  path.move_to(hx + ux * far, hy + uy * far);
  path.line_to(bx - ux * wider / 2 - uy * w, by - uy * wider / 2 + ux * w);
  path.line_to(bx - ux * wider / 2 + uy * w, by - uy * wider / 2 - ux * w);
}

}  // namespace

void draw_axes(const Canvas& canvas, const Camera& camera, Corner corner, const Look& look,
               const AxisNames& names) {
  const FloatScope floats;
  check(canvas);
  const Measures m = measures_of(canvas, look);
  const Mat4d to_camera = world_to_camera(camera);
  Axis axes[] = {{names[0], {226, 74, 61, 255}, 0, 0, 0},
                 {names[1], {104, 178, 62, 255}, 0, 0, 0},
                 {names[2], {72, 134, 235, 255}, 0, 0, 0}};
  for (int i = 0; i < 3; ++i) {
    axes[i].x = to_camera.m[0][i];
    axes[i].y = -to_camera.m[1][i];
    axes[i].towards = to_camera.m[2][i];
  }
  std::stable_sort(std::begin(axes), std::end(axes),
                   [](const Axis& a, const Axis& b) { return a.towards < b.towards; });
  const double length = m.letter * 2.6, room = m.margin + length + m.letter * 0.7;
  const bool left = is_left(corner), top = is_top(corner);
  const double x = left ? room : canvas.width() - room, y = top ? room : canvas.height() - room;
  const double line = std::max(1.5, m.letter / 7), head = m.letter * 0.55;
  for (const Axis& axis : axes) {
    fill_with_halo(canvas, m, look, axis.color, [&](Path& path, double wider) {
      add_arrow(path, x, y, axis, length, line, head, wider);
    });
    TextStyle style = letters(m, look);
    style.color = axis.color;
    style.align_x = AlignX::center;
    style.align_y = AlignY::middle;
    const double across = std::sqrt(axis.x * axis.x + axis.y * axis.y);
    if (across < 0.05) continue;
    const double reach = across * length + m.letter * 0.65 +
                         std::fabs(axis.x / across) * half_of_word(axis.name, m.letter);
    draw_text(canvas, x + axis.x / across * reach, y + axis.y / across * reach, axis.name, style);
  }
}

}  // namespace rastrum::overlay
