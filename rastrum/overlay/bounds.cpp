// SPDX-License-Identifier: BSD-3-Clause
// A box of the world with ticks and numbers, behind and around the scene.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/overlay/canvas.hpp>

namespace rastrum::overlay {
namespace {

struct Clip {
  double x, y, z, w;
};
struct Screen {
  double x, y, depth;  ///< px, reversed depth
};

class Box {
 public:
  Box(const Camera& camera, Vec3d low, Vec3d high, int width, int height)
      : to_clip_(world_to_clip(camera, width, height)),
        low_{low.x, low.y, low.z},
        high_{high.x, high.y, high.z},
        width_(width),
        height_(height) {
    find_eye();
  }

  [[nodiscard]] double low(int axis) const { return low_[static_cast<std::size_t>(axis)]; }
  [[nodiscard]] double high(int axis) const { return high_[static_cast<std::size_t>(axis)]; }
  /// Whether the box's face at the high (or low) end of `axis` faces the viewer.
  [[nodiscard]] bool faces_viewer(int axis, bool at_high) const {
    const double side = eye_[axis] - eye_[3] * (at_high ? high(axis) : low(axis));
    return at_high ? side > 0 : side < 0;
  }
  /// The point at `value` of a box edge along `axis`; the other axes are at an end each.
  [[nodiscard]] std::array<double, 3> at(int axis, double value, bool second, bool third) const {
    std::array<double, 3> p{};
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    p[static_cast<std::size_t>(axis)] = value;
    p[static_cast<std::size_t>(b)] = second ? high(b) : low(b);
    p[static_cast<std::size_t>(c)] = third ? high(c) : low(c);
    return p;
  }
  [[nodiscard]] Clip clip(const std::array<double, 3>& p) const {
    double r[4];
    for (int i = 0; i < 4; ++i)
      r[i] = to_clip_.m[i][0] * p[0] + to_clip_.m[i][1] * p[1] + to_clip_.m[i][2] * p[2] +
             to_clip_.m[i][3];
    return {r[0], r[1], r[2], r[3]};
  }
  [[nodiscard]] Screen screen(const Clip& c) const {
    return {(c.x / c.w + 1) / 2 * width_, (1 - c.y / c.w) / 2 * height_, c.z / c.w};
  }
  /// Where `p` lies in the picture; none behind the camera or too far aside for a path.
  [[nodiscard]] std::optional<Screen> seen(const std::array<double, 3>& p) const {
    const Clip c = clip(p);
    if (!(c.w > 0)) return std::nullopt;
    const Screen s = screen(c);
    if (!(std::fabs(s.x) < 1e5 && std::fabs(s.y) < 1e5)) return std::nullopt;
    return s;
  }

 private:
  /// The eye, or the direction towards an orthographic one: the homogeneous point where x, y and w
  /// of clip space are 0, by cofactors of those rows.
  void find_eye() {
    const auto& x = to_clip_.m[0];
    const auto& y = to_clip_.m[1];
    const auto& w = to_clip_.m[3];
    const auto minor = [&](int a, int b, int c) {
      return x[a] * (y[b] * w[c] - y[c] * w[b]) - x[b] * (y[a] * w[c] - y[c] * w[a]) +
             x[c] * (y[a] * w[b] - y[b] * w[a]);
    };
    eye_[0] = minor(1, 2, 3);
    eye_[1] = -minor(0, 2, 3);
    eye_[2] = minor(0, 1, 3);
    eye_[3] = -minor(0, 1, 2);
    const double size = std::fabs(eye_[0]) + std::fabs(eye_[1]) + std::fabs(eye_[2]);
    if (std::fabs(eye_[3]) > 1e-12 * size) {
      for (int i = 0; i < 3; ++i) eye_[i] /= eye_[3];
      eye_[3] = 1;
      return;
    }
    // Depth grows towards the viewer.
    const auto& z = to_clip_.m[2];
    eye_[3] = 0;
    if (z[0] * eye_[0] + z[1] * eye_[1] + z[2] * eye_[2] < 0)
      for (int i = 0; i < 3; ++i) eye_[i] = -eye_[i];
  }

  Mat4d to_clip_;
  std::array<double, 3> low_, high_;
  double width_, height_;
  double eye_[4] = {};
};

/// Cuts a segment to what lies in front of the eye, ignoring the near plane, and around the
/// picture.
std::optional<std::array<Screen, 2>> cut(const Box& box, Clip a, Clip b, double width,
                                         double height) {
  double from = 0, to = 1;
  const auto keep = [&](double fa, double fb) {  // where f >= 0
    if (fa < 0 && fb < 0) to = -1;
    if ((fa < 0) == (fb < 0)) return;
    const double t = fa / (fa - fb);
    if (fa < 0)
      from = std::max(from, t);
    else
      to = std::min(to, t);
  };
  const double margin = 2 * 64 / std::min(width, height) + 1;
  const double nearest = 1e-4 * std::max(std::fabs(a.w), std::fabs(b.w));
  keep(a.w - nearest, b.w - nearest);
  keep(a.x + margin * a.w, b.x + margin * b.w);
  keep(margin * a.w - a.x, margin * b.w - b.x);
  keep(a.y + margin * a.w, b.y + margin * b.w);
  keep(margin * a.w - a.y, margin * b.w - b.y);
  if (!(from < to)) return std::nullopt;
  const auto between = [&](double t) {
    return Clip{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z),
                a.w + t * (b.w - a.w)};
  };
  return std::array{box.screen(between(from)), box.screen(between(to))};
}

/// Blends segments where the picture is not nearer. Depth is linear in the picture.
void draw_segments(const Canvas& canvas, const std::vector<std::array<Screen, 2>>& segments,
                   double width, Rgba8 color, ImageView<const float> depth) {
  for (const std::array<Screen, 2>& s : segments) {
    const double dx = s[1].x - s[0].x, dy = s[1].y - s[0].y, square = dx * dx + dy * dy;
    if (square < 1e-6) continue;
    const auto in_front = [&](int x, int y) {
      const double t =
          std::clamp(((x + 0.5 - s[0].x) * dx + (y + 0.5 - s[0].y) * dy) / square, 0.0, 1.0);
      return s[0].depth + t * (s[1].depth - s[0].depth) >= static_cast<double>(depth(x, y));
    };
    // Half a width more at each end makes corners whole.
    const double more = width / 2 / std::sqrt(square);
    Path path;
    path.add_line(s[0].x - dx * more, s[0].y - dy * more, s[1].x + dx * more, s[1].y + dy * more,
                  width);
    fill(canvas, path, color, depth.empty() ? PixelTest{} : in_front);
  }
}

struct BoxEdge {
  int axis;
  bool second, third;
  std::array<Screen, 2> ends;
  double length;
};

/// The silhouette edge along `axis` that gets the numbers: the lowest flat one or the leftmost
/// upright one.
std::optional<BoxEdge> edge_for_labels(const Box& box, int axis) {
  std::optional<BoxEdge> best;
  double best_rank = 0;
  for (const bool second : {false, true})
    for (const bool third : {false, true}) {
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      if (box.faces_viewer(b, second) == box.faces_viewer(c, third)) continue;
      const auto from = box.seen(box.at(axis, box.low(axis), second, third)),
                 to = box.seen(box.at(axis, box.high(axis), second, third));
      if (!from || !to) continue;
      const double dx = to->x - from->x, dy = to->y - from->y;
      const double length = std::sqrt(dx * dx + dy * dy);
      const double rank =
          std::fabs(dy) > 2 * std::fabs(dx) ? -(from->x + to->x) / 2 : (from->y + to->y) / 2;
      if (best && rank <= best_rank) continue;
      best_rank = rank;
      best = BoxEdge{axis, second, third, {*from, *to}, length};
    }
  return best;
}

struct Taken {
  double left, top, right, bottom;
};

/// The box of letters at (x, y). Its margin keeps numbers of two axes apart.
Taken room_of(double x, double y, const TextExtent& extent, const TextStyle& style) {
  const double air = style.size_px * 0.15, aside = style.size_px * 0.5;
  const double w = extent.width_px, h = extent.height_px;
  const double left = style.align_x == AlignX::left     ? x
                      : style.align_x == AlignX::center ? x - w / 2
                                                        : x - w;
  const double top = style.align_y == AlignY::top      ? y
                     : style.align_y == AlignY::middle ? y - h / 2
                                                       : y - h;
  return {left - aside, top - air, left + w + aside, top + h + air};
}

bool overlap(const Taken& a, const Taken& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

/// Leaves out a number that would overlap an earlier one, as at corners.
void draw_labels(const Canvas& canvas, const Box& box, const BoxEdge& edge, Vec2 centre,
                 const Measures& m, const Look& look, std::string_view name,
                 std::vector<Taken>& taken) {
  const Screen a = edge.ends[0], b = edge.ends[1];
  if (edge.length < 2 * m.letter) return;
  // Labels lie on the side away from the middle of the box.
  double ox = -(b.y - a.y) / edge.length, oy = (b.x - a.x) / edge.length;
  const double mx = (a.x + b.x) / 2, my = (a.y + b.y) / 2;
  if (ox * (mx - static_cast<double>(centre.x)) + oy * (my - static_cast<double>(centre.y)) < 0) {
    ox = -ox;
    oy = -oy;
  }
  TextStyle style = letters(m, look);
  style.align_x = ox > 0.4 ? AlignX::left : ox < -0.4 ? AlignX::right : AlignX::center;
  style.align_y = std::fabs(ox) > 0.4 ? AlignY::middle : oy > 0 ? AlignY::top : AlignY::bottom;
  const double tick = m.letter * 0.4, gap = m.letter * 0.75;
  const int wanted = std::clamp(static_cast<int>(edge.length / (4.5 * m.letter)), 1, 8);
  double widest = 0;
  for (const Tick& t : ticks(box.low(edge.axis), box.high(edge.axis), wanted)) {
    const auto at = box.seen(box.at(edge.axis, t.value, edge.second, edge.third));
    if (!at) continue;
    fill_with_halo(canvas, m, look, look.color, [&](Path& path, double wider) {
      const double reach = tick + wider / 2;
      path.add_line(at->x, at->y, at->x + ox * reach, at->y + oy * reach, m.line + wider);
    });
    const TextExtent extent = measure_text(t.label, m.letter);
    widest = std::max(widest, extent.width_px);
    const double x = at->x + ox * gap, y = at->y + oy * gap;
    const Taken room = room_of(x, y, extent, style);
    if (std::any_of(taken.begin(), taken.end(),
                    [&](const Taken& other) { return overlap(room, other); }))
      continue;
    taken.push_back(room);
    draw_text(canvas, x, y, t.label, style);
  }
  const double out = gap + m.letter * 1.1 +
                     std::fabs(ox) * (widest + half_of_word(name, m.letter)) +
                     std::fabs(oy) * m.letter * 0.7;
  style.align_x = AlignX::center;
  style.align_y = AlignY::middle;
  draw_text(canvas, mx + ox * out, my + oy * out, name, style);
}

}  // namespace

void draw_bounds(const Canvas& canvas, const Camera& camera, Vec3d low, Vec3d high,
                 ImageView<const float> depth, const Look& look, const AxisNames& names) {
  const FloatScope floats;
  check(canvas);
  check_size(depth, canvas.width(), canvas.height(), "draw_bounds: depth");
  for (const auto& [from, to] : {std::pair{low.x, high.x}, {low.y, high.y}, {low.z, high.z}})
    if (!(std::isfinite(from) && std::isfinite(to) && from <= to))
      reject("draw_bounds: the box is not finite or upside down: ", from, " to ", to);
  const Measures m = measures_of(canvas, look);
  const Box box(camera, low, high, canvas.width(), canvas.height());
  std::vector<std::array<Screen, 2>> segments;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool second : {false, true})
      for (const bool third : {false, true}) {
        if (box.faces_viewer((axis + 1) % 3, second) && box.faces_viewer((axis + 2) % 3, third))
          continue;
        const auto segment = cut(box, box.clip(box.at(axis, box.low(axis), second, third)),
                                 box.clip(box.at(axis, box.high(axis), second, third)),
                                 canvas.width(), canvas.height());
        if (segment) segments.push_back(*segment);
      }
  // All halos lie behind all lines.
  if (look.halo.a != 0) draw_segments(canvas, segments, m.line + 2 * m.halo, look.halo, depth);
  draw_segments(canvas, segments, m.line, look.color, depth);
  const auto middle = box.seen({(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2});
  if (!middle) return;
  std::vector<Taken> taken;
  for (int axis = 0; axis < 3; ++axis)
    if (const auto edge = edge_for_labels(box, axis))
      draw_labels(canvas, box, *edge,
                  {static_cast<float>(middle->x), static_cast<float>(middle->y)}, m, look,
                  names[static_cast<std::size_t>(axis)], taken);
}

double room_for_bounds(const Camera& fitted, Vec3d low, Vec3d high, int width, int height) {
  const FloatScope floats;
  const Box box(fitted, low, high, width, height);
  double farthest = 0;
  for (const double x : {low.x, high.x})
    for (const bool second : {false, true})
      for (const bool third : {false, true})
        if (const Clip c = box.clip(box.at(0, x, second, third)); c.w > 0)
          farthest = std::max({farthest, std::fabs(c.x) / c.w, std::fabs(c.y) / c.w});
  // Numbers and names take a tenth of the picture on either side: five letters of 1/40.
  constexpr double kBoxPart = 0.8;
  return std::clamp(farthest / kBoxPart, 1.5, 3.0);
}

}  // namespace rastrum::overlay
