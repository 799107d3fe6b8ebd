// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <rastrum/core/reject.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/overlay/coverage.hpp>

namespace rastrum::overlay {
namespace {

constexpr double kMostPx = 1 << 20;

std::int32_t to_fx8(double px) {
  if (!(std::fabs(px) <= kMostPx))
    reject("overlay: a point at ", px, " px, which is not within 2^20 px of the picture");
  return static_cast<std::int32_t>(std::nearbyint(px * 256));
}

Point to_fx8(double x_px, double y_px) {
  return {to_fx8(x_px), to_fx8(y_px)};
}

}  // namespace

void Path::move_to(Point point) {
  begins_.push_back(points_.size());
  points_.push_back(point);
}

void Path::line_to(Point point) {
  if (begins_.empty()) begins_.push_back(0);
  points_.push_back(point);
}

void Path::move_to(double x_px, double y_px) {
  move_to(to_fx8(x_px, y_px));
}

void Path::line_to(double x_px, double y_px) {
  line_to(to_fx8(x_px, y_px));
}

void Path::add_rectangle(double x0_px, double y0_px, double x1_px, double y1_px) {
  if (x0_px > x1_px) std::swap(x0_px, x1_px);
  if (y0_px > y1_px) std::swap(y0_px, y1_px);
  move_to(x0_px, y0_px);
  line_to(x1_px, y0_px);
  line_to(x1_px, y1_px);
  line_to(x0_px, y1_px);
}

void Path::add_line(double x0_px, double y0_px, double x1_px, double y1_px, double width_px) {
  const double dx = x1_px - x0_px, dy = y1_px - y0_px, length = std::sqrt(dx * dx + dy * dy);
  if (length == 0) return;
  const double nx = -dy / length * (width_px / 2), ny = dx / length * (width_px / 2);
  // Oriented as discs and rectangles are, so that overlaps do not cancel.
  move_to(x0_px - nx, y0_px - ny);
  line_to(x1_px - nx, y1_px - ny);
  line_to(x1_px + nx, y1_px + ny);
  line_to(x0_px + nx, y0_px + ny);
}

void Path::add_disc(double x_px, double y_px, double radius_px) {
  // A chord over an angle a lies r (1 − cos(a/2)) below its arc. Doubling the sides halves the
  // angle.
  int sides = 8;
  double c = 0.70710678118654752, s = 0.70710678118654752;  // of 45°
  while (radius_px * (1 - std::sqrt((1 + c) / 2)) > 1.0 / 16 && sides < 1024) {
    const double half = std::sqrt((1 + c) / 2);
    s = s / (2 * half);
    c = half;
    sides *= 2;
  }
  double x = radius_px, y = 0;
  for (int i = 0; i < sides; ++i) {
    if (i == 0)
      move_to(x_px + x, y_px + y);
    else
      line_to(x_px + x, y_px + y);
    const double turned = x * c - y * s;
    y = x * s + y * c;
    x = turned;
  }
}

std::vector<Edge> edges_of(const Path& path, std::int32_t lines) {
  std::vector<Edge> edges;
  const std::vector<Point>& points = path.points();
  for (std::size_t p = 0; p < path.begins().size(); ++p) {
    const std::size_t begin = path.begins()[p],
                      end = p + 1 < path.begins().size() ? path.begins()[p + 1] : points.size();
    for (std::size_t i = begin; i < end; ++i) {
      Point a = points[i], b = points[i + 1 < end ? i + 1 : begin];
      const std::int32_t winding = a.y < b.y ? 1 : -1;
      if (winding < 0) std::swap(a, b);
      // Line j is at y = 4 j + 2; an edge has those with a.y <= y < b.y.
      const auto first_at = [](std::int32_t y) { return (y + 1) >> 2; };
      const std::int32_t first = std::max(first_at(a.y), 0), last = std::min(first_at(b.y), lines);
      if (first >= last) continue;
      const std::int64_t height = b.y - a.y, dx = b.x - a.x;
      const auto floor_div = [&](std::int64_t n) {
        return n / height - static_cast<std::int64_t>(n % height < 0);
      };
      const std::int64_t at = dx * (first * kLineStep + kLineStep / 2 - a.y), step = dx * kLineStep;
      const std::int64_t x = floor_div(at), dstep = floor_div(step);
      edges.push_back({.first = first,
                       .last = last,
                       .x = static_cast<std::int32_t>(a.x + x),
                       .rest = at - x * height,
                       .step = static_cast<std::int32_t>(dstep),
                       .step_rest = step - dstep * height,
                       .height = height,
                       .winding = winding});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.first != b.first ? a.first < b.first : a.x < b.x;
  });
  return edges;
}

}  // namespace rastrum::overlay
