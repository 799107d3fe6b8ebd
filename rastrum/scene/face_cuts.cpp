// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/scene/face_cuts.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <rastrum/parallel/exec.hpp>

namespace rastrum {
namespace {

constexpr std::uint32_t kNobody = ~std::uint32_t{0};

/// How far (a sum of sines) a fan's triangles may turn back, because float32 corners are not quite
/// collinear.
constexpr double kStraight = 1e-6;

/// The sum of the fan's cross products, the same for any corner's fan: twice the face's area long.
Vec3d newell_normal(std::span<const Vec3d> corner) {
  Vec3d sum;
  for (std::size_t k = 2; k < corner.size(); ++k)
    sum = sum + cross(corner[k - 1] - corner[0], corner[k] - corner[0]);
  return sum;
}

/// The sine of the angle at corner a by which a triangle turns against `normal`; 0 if it does not.
double turned_back(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& normal) {
  const Vec3d u = b - a, v = c - a;
  const double along = dot(cross(u, v), normal);
  if (!(along < 0)) return 0;
  return -along / std::sqrt(dot(u, u) * dot(v, v) * dot(normal, normal));
}

/// Whether the face may be cut into its fan. Always, if its normal is zero or not finite.
bool is_fan(std::span<const Vec3d> corner, const Vec3d& normal) {
  double back = 0;
  for (std::size_t k = 2; k < corner.size(); ++k)
    back += turned_back(corner[0], corner[k - 1], corner[k], normal);
  return !(back > kStraight);
}

/// Rotates a triangle to begin with its least corner.
void add_ascending(std::vector<std::uint32_t>& triangles, std::array<std::uint32_t, 3> corner) {
  std::rotate(corner.begin(), std::min_element(corner.begin(), corner.end()), corner.end());
  triangles.insert(triangles.end(), corner.begin(), corner.end());
}

}  // namespace

bool is_cut_across(const Vec3d (&c)[4]) {
  const Vec3d normal = newell_normal(c);
  return !is_fan(c, normal) &&
         turned_back(c[3], c[0], c[1], normal) + turned_back(c[1], c[2], c[3], normal) <= kStraight;
}

std::span<const std::uint32_t> FaceCutter::cut(std::span<const Vec3d> corners) {
  triangles_.clear();
  const std::size_t n = corners.size();
  if (n == 4) {
    const Vec3d quad[4] = {corners[0], corners[1], corners[2], corners[3]};
    if (is_cut_across(quad)) triangles_ = {0, 1, 3, 1, 2, 3};
    return triangles_;
  }
  const Vec3d normal = newell_normal(corners);
  if (n < 4 || is_fan(corners, normal)) return triangles_;
  flatten(corners, normal);
  cut_ears(n);
  return triangles_;
}

void FaceCutter::flatten(std::span<const Vec3d> corners, const Vec3d& normal) {
  const Vec3d n = normal * (1 / length(normal));
  const double ax = std::abs(n.x), ay = std::abs(n.y), az = std::abs(n.z);
  const Vec3d least = ax <= ay && ax <= az ? Vec3d{1, 0, 0}
                      : ay <= az           ? Vec3d{0, 1, 0}
                                           : Vec3d{0, 0, 1};
  Vec3d u = cross(n, least);
  u = u * (1 / length(u));
  const Vec3d v = cross(n, u);
  x_.resize(corners.size());
  y_.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d p = corners[i] - corners[0];
    x_[i] = dot(p, u);
    y_[i] = dot(p, v);
  }
}

/// Twice the area, positive if a, b, c turn as the face does.
double FaceCutter::area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  return (x_[b] - x_[a]) * (y_[c] - y_[a]) - (x_[c] - x_[a]) * (y_[b] - y_[a]);
}

std::size_t FaceCutter::column(double x) const {
  return std::min(columns_ - 1, static_cast<std::size_t>((x - x0_) * per_unit_x_));
}
std::size_t FaceCutter::row(double y) const {
  return std::min(rows_ - 1, static_cast<std::size_t>((y - y0_) * per_unit_y_));
}

/// Makes a grid of about square cells, about as many as inward corners.
void FaceCutter::make_grid() {
  const auto [left, right] = std::minmax_element(x_.begin(), x_.end());
  const auto [bottom, top] = std::minmax_element(y_.begin(), y_.end());
  const double width = *right - *left, height = *top - *bottom;
  const auto count = static_cast<double>(std::count(inward_.begin(), inward_.end(), 1));
  columns_ = rows_ = 1;
  per_unit_x_ = per_unit_y_ = 0;
  if (count > 16 && width > 0 && height > 0) {
    const double side = std::sqrt(width * height / count);
    const auto cells = [&](double length) {
      return static_cast<std::size_t>(std::clamp(length / side, 1.0, count));
    };
    columns_ = cells(width);
    rows_ = cells(height);
    per_unit_x_ = static_cast<double>(columns_) / width;
    per_unit_y_ = static_cast<double>(rows_) / height;
  }
  x0_ = *left;
  y0_ = *bottom;
  cell_.assign((columns_ + 1) * rows_, kNobody);
  to_filled_.assign(cell_.size(), 0);
}

void FaceCutter::set_inward(std::uint32_t corner) {
  inward_[corner] = 1;
  if (in_grid_[corner] != 0) return;
  in_grid_[corner] = 1;
  std::uint32_t& first = cell_[row(y_[corner]) * (columns_ + 1) + column(x_[corner])];
  next_in_cell_[corner] = first;
  first = corner;
}

/// Whether `corner` lies in the ear (a, b, c), or on its border so that it forbids the cut.
bool FaceCutter::lies_in(std::uint32_t corner, std::uint32_t a, std::uint32_t b,
                         std::uint32_t c) const {
  if (corner == a || corner == b || corner == c) return false;
  if (area(a, b, corner) < 0 || area(b, c, corner) < 0 || area(c, a, corner) < 0) return false;
  const auto same = [&](std::uint32_t other) {
    return x_[corner] == x_[other] && y_[corner] == y_[other];
  };
  // Another corner at the place of a or c does no harm.
  if (same(a) || same(c)) return false;
  if (!same(b)) return true;
  // One at b does harm if one of its sides goes into the ear.
  const auto goes_in = [&](std::uint32_t to) { return area(a, b, to) > 0 && area(b, c, to) > 0; };
  return goes_in(before_[corner]) || goes_in(after_[corner]);
}

/// The next cell of a row, from `cell` on, that may contain a corner. An empty cell stays empty: no
/// corner becomes inward, unless the face crosses itself.
std::uint32_t* FaceCutter::filled(std::uint32_t* cell) {
  std::uint32_t* const skip = &to_filled_[static_cast<std::size_t>(cell - cell_.data())];
  std::uint32_t* at = cell;
  std::uint32_t* step = skip;
  while (*step != 0) {
    at += *step;
    step += *step;
  }
  for (std::uint32_t* s = skip; s != step;) {
    const std::uint32_t one = *s;
    *s = static_cast<std::uint32_t>(step - s);
    s += one;
  }
  return at;
}

/// The first and last column where a triangle meets a row, and one more on either side for
/// rounding.
std::pair<std::size_t, std::size_t> FaceCutter::columns_in(
    std::size_t row_number, const std::array<std::uint32_t, 3>& triangle) const {
  if (columns_ == 1) return {0, 0};
  const double low = y0_ + (static_cast<double>(row_number) - 0.5) / per_unit_y_;
  const double high = low + 2 / per_unit_y_;
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (std::size_t i = 0; i < 3; ++i) {
    std::uint32_t p = triangle[i], q = triangle[(i + 1) % 3];
    if (y_[p] > y_[q]) std::swap(p, q);
    if (y_[q] < low || y_[p] > high) continue;
    const double slope = y_[p] < y_[q] ? (x_[q] - x_[p]) / (y_[q] - y_[p]) : 0;
    const double from = y_[p] < low ? x_[p] + (low - y_[p]) * slope : x_[p];
    const double to = y_[q] > high ? x_[p] + (high - y_[p]) * slope : x_[q];
    left = std::min({left, from, to});
    right = std::max({right, from, to});
  }
  const std::size_t first = column(std::max(left, x0_)), last = column(std::max(right, x0_));
  return {first == 0 ? 0 : first - 1, std::min(columns_ - 1, last + 1)};
}

/// An inward corner in the ear of `b`; kNobody: none, so it may be cut off.
std::uint32_t FaceCutter::what_lies_in(std::uint32_t b) {
  const std::uint32_t a = before_[b], c = after_[b];
  const auto [bottom, top] = std::minmax({y_[a], y_[b], y_[c]});
  for (std::size_t j = row(bottom), top_row = row(top); j <= top_row; ++j) {
    const auto [left, right] = columns_in(j, {a, b, c});
    std::uint32_t* const begin = &cell_[j * (columns_ + 1)];
    const std::uint32_t* const last = begin + right;
    for (std::uint32_t* cell = filled(begin + left); cell <= last; cell = filled(cell)) {
      for (std::uint32_t* at = cell; *at != kNobody;) {
        const std::uint32_t corner = *at;
        if (inward_[corner] == 0) {  // no longer inward
          in_grid_[corner] = 0;
          *at = next_in_cell_[corner];
          continue;
        }
        if (lies_in(corner, a, b, c)) return corner;
        at = &next_in_cell_[corner];
      }
      if (*cell == kNobody)
        to_filled_[static_cast<std::size_t>(cell - cell_.data())] = 1;
      else
        ++cell;
    }
  }
  return kNobody;
}

/// Makes a triangle of a corner and its neighbours, and queues these behind all others, so that
/// corners take turns and triangles become less thin.
void FaceCutter::cut_off(std::uint32_t b) {
  const std::uint32_t a = before_[b], c = after_[b];
  add_ascending(triangles_, {a, b, c});
  after_[a] = c;
  before_[c] = a;
  const auto no_longer_inward = [&](std::uint32_t corner) {
    if (inward_[corner] == 0) return;
    inward_[corner] = 0;
    for (std::uint32_t w = first_waiting_[corner]; w != kNobody; w = waiting_[w].next)
      queue_.push_back(waiting_[w].entry);
    first_waiting_[corner] = kNobody;
  };
  ++stamp_[b];
  no_longer_inward(b);
  for (const std::uint32_t corner : {a, c}) {
    ++stamp_[corner];
    const double turn = area(before_[corner], corner, after_[corner]);
    if (turn > 0)
      no_longer_inward(corner);
    else
      set_inward(corner);
    if (turn >= 0) (turn > 0 ? queue_ : straight_).push_back({corner, stamp_[corner]});
  }
}

void FaceCutter::cut_ears(std::size_t n) {
  before_.resize(n);
  after_.resize(n);
  next_in_cell_.resize(n);
  stamp_.assign(n, 0);
  inward_.assign(n, 0);
  in_grid_.assign(n, 0);
  first_waiting_.assign(n, kNobody);
  waiting_.clear();
  queue_.clear();
  straight_.clear();
  const auto last = static_cast<std::uint32_t>(n - 1);
  for (std::uint32_t i = 0; i <= last; ++i) {
    before_[i] = i == 0 ? last : i - 1;
    after_[i] = i == last ? 0 : i + 1;
  }
  for (std::uint32_t i = 0; i <= last; ++i) {
    const double turn = area(before_[i], i, after_[i]);
    inward_[i] = turn > 0 ? 0 : 1;
    if (turn >= 0) (turn > 0 ? queue_ : straight_).push_back({i, 0});
  }
  make_grid();
  for (std::uint32_t i = 0; i <= last; ++i)
    if (inward_[i] != 0) set_inward(i);

  std::uint32_t some = 0;  // any corner that is left
  std::size_t asked = 0, left = n;
  const auto next_of = [&](std::vector<Entry>& queue, std::size_t& at) {
    for (; at < queue.size(); ++at)
      if (queue[at].stamp == stamp_[queue[at].corner]) return queue[at++].corner;
    return kNobody;
  };
  std::size_t straight = 0;
  while (left > 3) {
    std::uint32_t corner = next_of(queue_, asked);
    if (corner != kNobody) {
      if (const std::uint32_t in = what_lies_in(corner); in != kNobody) {
        waiting_.push_back({{corner, stamp_[corner]}, first_waiting_[in]});
        first_waiting_[in] = static_cast<std::uint32_t>(waiting_.size() - 1);
        continue;
      }
    } else {
      // No ears are left: the remaining corners are collinear, or the face crosses itself.
      corner = next_of(straight_, straight);
      for (std::size_t k = 0; corner == kNobody && k < left; ++k, some = after_[some])
        if (inward_[some] == 0) corner = some;
      if (corner == kNobody) break;
    }
    if (corner == some) some = after_[some];
    cut_off(corner);
    --left;
  }
  for (std::uint32_t b = after_[some], c = after_[b]; c != some; b = c, c = after_[c])
    add_ascending(triangles_, {some, b, c});
}

std::span<const Vec3d> corners_of(const MeshView& mesh, std::size_t begin, std::size_t end,
                                  std::vector<Vec3d>& to) {
  to.clear();
  for (std::size_t c = begin; c < end; ++c) {
    const std::uint32_t v = mesh.vertex(c);
    if (v >= mesh.positions.size()) return {};
    to.push_back(mesh.positions.wide(v));
  }
  return to;
}

FaceCuts::FaceCuts(const MeshView& mesh, parallel::Threads* threads) {
  constexpr std::size_t kGrain = 4096;
  struct Part {
    std::vector<std::size_t> faces, sizes;
    std::vector<std::uint32_t> triangles;
  };
  const std::size_t count = mesh.face_count();
  std::vector<Part> parts((count + kGrain - 1) / kGrain);
  const auto look = [&](std::size_t number) {
    Part& part = parts[number];
    FaceCutter cutter;
    std::vector<Vec3d> corners;
    for (std::size_t f = number * kGrain, end = std::min(f + kGrain, count); f < end; ++f) {
      const IndexView& offsets = mesh.faces.offsets;
      const std::size_t begin = offsets.empty() ? 0 : offsets.wide(f);
      const std::size_t n = (offsets.empty() ? mesh.corner_count() : offsets.wide(f + 1)) - begin;
      if (n < 4) continue;
      const std::span<const std::uint32_t> cut =
          cutter.cut(corners_of(mesh, begin, begin + n, corners));
      if (cut.empty()) continue;
      part.faces.push_back(f);
      part.sizes.push_back(cut.size());
      part.triangles.insert(part.triangles.end(), cut.begin(), cut.end());
    }
  };
  parallel::for_each_index(parts.size() > 1 ? threads : nullptr, parts.size(), look);
  std::size_t next = 0;
  for (const Part& part : parts) {
    faces_.insert(faces_.end(), part.faces.begin(), part.faces.end());
    triangles_.insert(triangles_.end(), part.triangles.begin(), part.triangles.end());
    for (const std::size_t size : part.sizes) {
      first_.push_back(next);
      next += size;
    }
  }
}

std::size_t FaceCuts::lower_bound(std::size_t face) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(faces_, face) - faces_.begin());
}

std::size_t FaceCuts::find(std::size_t face) const {
  const std::size_t i = lower_bound(face);
  return this->face(i) == face ? i : kNone;
}

MeshView with_cuts(const MeshView& mesh, std::list<FaceCuts>& cuts, parallel::Threads* threads) {
  MeshView cut = mesh;
  if (mesh.faces.kind == FaceKind::polygons && mesh.cuts == nullptr)
    cut.cuts = &cuts.emplace_back(mesh, threads);
  return cut;
}

}  // namespace rastrum
