// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/cull/cluster_view.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rastrum::raster {
namespace {

constexpr double kUlp = 0x1p-24;
/// The error of clip coordinates, relative to the sum of their terms' sizes.
constexpr double kClipError = 16 * kUlp;
/// Far above the loss by float32's subnormals, far below what a picture shows.
constexpr double kTiny = 0x1p-120;
/// A larger float is taken to overflow.
constexpr double kLargest = 0x1p120;

struct Minor {
  double value, size;
};
Minor minor_of(const Mat4d& m, int column) {
  int c[3];
  for (int i = 0, k = 0; i < 4; ++i)
    if (i != column) c[k++] = i;
  const auto &x = m.m[0], &y = m.m[1], &w = m.m[3];
  const double terms[6] = {x[c[0]] * y[c[1]] * w[c[2]], x[c[1]] * y[c[2]] * w[c[0]],
                           x[c[2]] * y[c[0]] * w[c[1]], x[c[2]] * y[c[1]] * w[c[0]],
                           x[c[1]] * y[c[0]] * w[c[2]], x[c[0]] * y[c[2]] * w[c[1]]};
  Minor out{((terms[0] + terms[1]) + terms[2]) - ((terms[3] + terms[4]) + terms[5]), 0};
  for (const double t : terms) out.size += std::abs(t);
  return out;
}

}  // namespace

ClusterView::ClusterView(const Mat4d& to_clip, bool wide, Viewport viewport, bool faces)
    : m_(wide ? to_clip : Mat4d(Mat4(to_clip))), viewport_(viewport) {
  for (int i = 0; i < 4; ++i)
    rows_[i] = length(Vec3d{m_.m[i][0], m_.m[i][1], m_.m[i][2]}) * (1 + 0x1p-40);
  if (!faces) return;
  const Minor e[4] = {minor_of(m_, 0), minor_of(m_, 1), minor_of(m_, 2), minor_of(m_, 3)};
  eye_ = {e[0].value, -e[1].value, e[2].value};
  eye_w_ = -e[3].value;
  eye_error_ = 0x1p-44 * (e[0].size + e[1].size + e[2].size);
  eye_w_error_ = 0x1p-44 * e[3].size;
}

BoxPlace ClusterView::place(Vec3 min, Vec3 max) const {
  BoxPlace out;
  const Vec3d low(min), high(max);
  const Vec3d most{std::max(std::abs(low.x), std::abs(high.x)),
                   std::max(std::abs(low.y), std::abs(high.y)),
                   std::max(std::abs(low.z), std::abs(high.z))};
  double corner[4][8], error[4];
  for (int i = 0; i < 4; ++i) {
    const auto& r = m_.m[i];
    error[i] = kClipError * (std::abs(r[0]) * most.x + std::abs(r[1]) * most.y +
                             std::abs(r[2]) * most.z + std::abs(r[3])) +
               kTiny;
    const double x[2] = {r[0] * low.x, r[0] * high.x};
    const double y[2] = {r[1] * low.y, r[1] * high.y};
    const double z[2] = {r[2] * low.z + r[3], r[2] * high.z + r[3]};
    for (int c = 0; c < 8; ++c) corner[i][c] = (x[c & 1] + y[c >> 1 & 1]) + z[c >> 2];
  }
  const auto &cx = corner[0], &cy = corner[1], &cz = corner[2], &cw = corner[3];
  // The extremes of w + x and the like over the corners. All negative: outside. All least ones
  // positive: inside.
  double largest[6], least[6];
  std::fill_n(largest, 6, -std::numeric_limits<double>::infinity());
  std::fill_n(least, 6, std::numeric_limits<double>::infinity());
  for (int c = 0; c < 8; ++c) {
    const double v[6] = {cw[c] + cx[c], cw[c] - cx[c], cw[c] + cy[c],
                         cw[c] - cy[c], cw[c] - cz[c], cw[c]};
    for (int k = 0; k < 6; ++k) {
      largest[k] = largest[k] > v[k] ? largest[k] : v[k];
      least[k] = least[k] < v[k] ? least[k] : v[k];
    }
  }
  // A comparison may miss a NaN in a sum, but not an error that is not finite.
  const double sizes = (error[0] + error[1]) + (error[2] + error[3]);
  if (!(sizes < kLargest)) return out;
  const double with_w[6] = {error[0] + error[3], error[0] + error[3], error[1] + error[3],
                            error[1] + error[3], error[2] + error[3], error[3]};
  bool inside = true;
  for (int k = 0; k < 6; ++k) {
    // Twice: the float32 values differ, and by 16u more.
    out.outside = out.outside || largest[k] < -2 * with_w[k];
    inside = inside && least[k] > 2 * with_w[k];
  }
  out.inside = inside && !out.outside;
  out.w_min = least[5] - error[3];
  if (out.outside || !(out.w_min > kTiny) || !(least[4] > with_w[4])) return out;

  double x_min = std::numeric_limits<double>::infinity(), x_max = -x_min;
  double y_min = x_min, y_max = x_max, z_min = x_min, z_max = x_max, w_max = 0;
  for (int c = 0; c < 8; ++c) {
    const double inverse = 1 / cw[c];
    const double x = cx[c] * inverse, y = cy[c] * inverse, z = cz[c] * inverse;
    x_min = std::min(x_min, x);
    x_max = std::max(x_max, x);
    y_min = std::min(y_min, y);
    y_max = std::max(y_max, y);
    z_min = std::min(z_min, z);
    z_max = std::max(z_max, z);
    w_max = std::max(w_max, cw[c]);
  }
  out.w_max = w_max + error[3];
  const double hw = viewport_.half_width, hh = viewport_.half_height;
  out.x_ndc = std::max(std::abs(x_min), std::abs(x_max));
  out.y_ndc = std::max(std::abs(y_min), std::abs(y_max));
  out.z_ndc = std::max(std::abs(z_min), std::abs(z_max));
  const auto of = [&](int row, double ndc) {
    return (error[row] + ndc * error[3]) / out.w_min + 8 * kUlp * (ndc + 1);
  };
  constexpr double kSnap = 0.5 / kSubpixels * (1 + 0x1p-20);
  out.x_error = kSnap + hw * of(0, out.x_ndc);
  out.y_error = kSnap + hh * of(1, out.y_ndc);
  out.z_error = of(2, out.z_ndc);
  const double left = x_min * hw + hw - out.x_error, right = x_max * hw + hw + out.x_error;
  const double top = hh - y_max * hh - out.y_error, bottom = hh - y_min * hh + out.y_error;
  // Well inside the guard band and far from overflow.
  if (!(left > kGuardMinPx + 1 && right < kGuardMaxPx - 1 && top > kGuardMinPx + 1 &&
        bottom < kGuardMaxPx - 1 && out.z_ndc + out.z_error < kLargest))
    return out;
  out.whole = true;
  out.pixels = {static_cast<int>(std::floor(left - 0.5)), static_cast<int>(std::floor(top - 0.5)),
                static_cast<int>(std::ceil(right + 0.5)),
                static_cast<int>(std::ceil(bottom + 0.5))};
  out.z_range = (z_max - z_min) + 2 * out.z_error;
  out.highest = static_cast<float>(z_max + out.z_error + 0x1p-22 * out.z_ndc + kTiny);
  return out;
}

double ClusterView::steepest(int row, double ndc, const BoxPlace& at) const {
  return (rows_[row] + ndc * rows_[3]) / at.w_min;
}

bool ClusterView::faces_away(const MeshCluster& cluster, const BoxPlace& at, Cull cull) const {
  if (cull == Cull::none || !(cluster.cosine > 0) || !(cluster.least_height > 0)) return false;
  const Vec3d low(cluster.min), high(cluster.max);
  const Vec3d centre = (low + high) * 0.5;
  const double radius = length(high - low) * (0.5 * (1 + 0x1p-40)) + 0x1p-48 * length(centre);
  const Vec3d v = eye_ - centre * eye_w_;
  const double distance = length(v);
  if (!(distance > 0)) return false;
  const double unsure = eye_error_ + eye_w_error_ * (length(centre) + radius) +
                        0x1p-44 * (length(eye_) + std::abs(eye_w_) * length(centre));
  // Front faces have D > 0. Cull::back culls the others.
  const double side = cull == Cull::back ? -1 : 1;
  const double cos_phi =
      std::clamp(side * dot(Vec3d(cluster.axis), v) / (distance * length(Vec3d(cluster.axis))),
                 -1.0, 1.0) -
      1e-7;
  const double sin_phi = std::sqrt(std::max(0.0, 1 - cos_phi * cos_phi));
  // cos(φ + α) falls with φ while φ + α < π.
  if (!(cos_phi > 0)) return false;
  const double f = distance * (cos_phi * cluster.cosine - sin_phi * cluster.sine - 1e-7) -
                   std::abs(eye_w_) * radius - unsure;
  if (!(f > 0)) return false;
  const double hw = viewport_.half_width, hh = viewport_.half_height;
  const double gx = hw * steepest(0, at.x_ndc, at), gy = hh * steepest(1, at.y_ndc, at);
  const double h = cluster.least_height;
  const double area = f * h * hw * hh / (at.w_max * at.w_max * at.w_max) * (1 - 0x1p-40);
  return area > 4 * (gx * at.y_error + gy * at.x_error) + 8 * at.x_error * at.y_error / h;
}

bool ClusterView::leans_away(const MeshCluster& cluster) const {
  const Vec3d centre = (Vec3d(cluster.min) + Vec3d(cluster.max)) * 0.5;
  return dot(Vec3d(cluster.axis), eye_ - centre * eye_w_) < 0;
}

float ClusterView::highest_sample(const MeshCluster& cluster, const BoxPlace& at) const {
  const double edge = cluster.longest_edge;
  const double hw = viewport_.half_width, hh = viewport_.half_height;
  const double width = at.pixels.x1 - at.pixels.x0, height = at.pixels.y1 - at.pixels.y0;
  const double x = std::min(hw * steepest(0, at.x_ndc, at) * edge + 2 * at.x_error, width);
  const double y = std::min(hh * steepest(1, at.y_ndc, at) * edge + 2 * at.y_error, height);
  const double change = std::min(steepest(2, at.z_ndc, at) * edge + 2 * at.z_error, at.z_range);
  const double bound = at.highest + 0.05 * change * x * y + 0x1p-22 * at.z_ndc;
  // Rounded up; depths are clamped to at least 0.
  return static_cast<float>(std::max(bound + 0x1p-23 * std::abs(bound), 0.0) + kTiny);
}

}  // namespace rastrum::raster
