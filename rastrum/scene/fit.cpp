// SPDX-License-Identifier: BSD-3-Clause
// Works in camera axes around the centre of the scene's box: x to the right, y up, z back towards
// the eye. A frustum's side of slope t first touches the vertex with the largest x + t z, so its
// eye needs x_e + t z_e at least as large. Two such sides leave a wedge of eyes, whose tip is the
// nearest (as in viewers' "zoom to fit"; Blender's Frame Selected).
#include <rastrum/fit.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>
#include <rastrum/scene/vertices_in_use.hpp>

namespace rastrum {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The least distance from the eye to the nearest vertex, in r.
constexpr double kNearest = 1 / 20.0;
constexpr double kNearPlane = 0.99, kPlaneMargin = 0.01;

/// A point in one plane of the camera: across the view and back from the centre.
struct Flat {
  double across = 0, back = 0;
};

/// The points that the two planes of slope t touch first.
struct Touched {
  Flat high, low;
  double most = -kInfinity, least = -kInfinity;  ///< of across + t back, and of −across + t back

  void add(double across, double back, double t) {
    const Flat p{across, back};
    merge({p, p, across + t * back, -across + t * back});
  }
  /// Among equals the first stays, as in add.
  void merge(const Touched& later) {
    if (later.most > most) {
      most = later.most;
      high = later.high;
    }
    if (later.least > least) {
      least = later.least;
      low = later.low;
    }
  }
  [[nodiscard]] bool empty() const { return most == -kInfinity; }
  /// Joins the points of all ranks; among equals the first stays.
  void gather(FitRanks* ranks) {
    if (ranks == nullptr) return;
    const double own[] = {most, high.across, high.back, least, low.across, low.back};
    const std::vector<double> all = ranks->gather(own);
    *this = {};
    for (std::size_t r = 0; r < all.size(); r += 6)
      merge({{all[r + 1], all[r + 2]}, {all[r + 4], all[r + 5]}, all[r], all[r + 3]});
  }
  /// The tip of the wedge between the planes.
  [[nodiscard]] double tip_across() const { return (most - least) / 2; }
  [[nodiscard]] double tip_back(double t) const { return (most + least) / (2 * t); }
};

/// The scene in camera axes, still or swept about an axis through the origin.
class Outline {
 public:
  Outline(const VerticesInUse& vertices, const Mat4d& to_camera, Vec3d centre, bool turns, Vec3d up,
          FitRanks* ranks)
      : vertices_(vertices), to_camera_(to_camera), centre_(centre), turns_(turns), ranks_(ranks) {
    const Vec3d a = turned(up);
    const double l = length(a);
    axis_y_ = a.y / l;  // its x is 0, because up defines the camera's x
    axis_z_ = a.z / l;
  }

  [[nodiscard]] double axis_y() const { return axis_y_; }
  [[nodiscard]] double axis_z() const { return axis_z_; }
  [[nodiscard]] Vec3d to_world(Vec3d p) const {
    const auto& m = to_camera_.m;
    return {centre_.x + (m[0][0] * p.x + m[1][0] * p.y + m[2][0] * p.z),
            centre_.y + (m[0][1] * p.x + m[1][1] * p.y + m[2][1] * p.z),
            centre_.z + (m[0][2] * p.x + m[1][2] * p.y + m[2][2] * p.z)};
  }
  [[nodiscard]] double back_of(Vec3d world) const { return turned(world - centre_).z; }

  [[nodiscard]] Touched horizontal(double t) const { return touched<0>(t); }
  [[nodiscard]] Touched vertical(double t) const { return touched<1>(t); }
  /// The nearest and the farthest, back from the centre; 0 without vertices.
  struct Depths {
    double nearest = -kInfinity, farthest = kInfinity;
    void add(double back) { merge({back, back}); }
    void merge(const Depths& d) {
      nearest = std::max(nearest, d.nearest);
      farthest = std::min(farthest, d.farthest);
    }
  };
  [[nodiscard]] Depths depths() const {
    Depths d;
    own_work(ranks_, [&] { d = vertices_.reduce(DepthsOfVertices{this, {}}).depths; });
    if (ranks_ != nullptr) {
      const double own[] = {d.nearest, d.farthest};
      const std::vector<double> all = ranks_->gather(own);
      for (std::size_t r = 0; r < all.size(); r += 2) d.merge({all[r], all[r + 1]});
    }
    return d.nearest < d.farthest ? Depths{0, 0} : d;
  }

 private:
  [[nodiscard]] Vec3d turned(Vec3d d) const { return turned_by(to_camera_, d); }
  /// An upper bound of ± `across` + t `back` in a box; `axis`: 0 across, 1 up, 2 none.
  [[nodiscard]] double most(const VerticesInUse::WorldBox& box, int axis, double sign,
                            double t) const {
    if (turns_) return kInfinity;
    double middle = 0, half = 0;
    const auto add = [&](int i, double centre, double extent, double origin) {
      const double a = axis == 2 ? 0 : to_camera_.m[axis][i], b = to_camera_.m[2][i];
      const double slope = sign * a + t * b;
      middle += slope * (centre - origin);
      half += std::abs(slope) * extent;
      half += VerticesInUse::WorldBox::kMargin * (std::abs(a) + std::abs(t * b)) *
              (std::abs(centre) + extent + std::abs(origin));
    };
    add(0, box.centre.x, box.half.x, centre_.x);
    add(1, box.centre.y, box.half.y, centre_.y);
    add(2, box.centre.z, box.half.z, centre_.z);
    return middle + half;
  }

  /// The points that two planes touch, for VerticesInUse::reduce.
  template <int axis>
  struct TouchedVertices {
    const Outline* outline;
    double t;
    Touched touched;

    void add(const Vec3d& world) {
      const Vec3d p = outline->turned(world - outline->centre_);
      if (!outline->turns_) return touched.add(axis == 0 ? p.x : p.y, p.z, t);
      const Circle c = outline->circle(p);
      const double y = outline->axis_y_, z = outline->axis_z_;
      if constexpr (axis == 0) {
        // A vertex goes round a circle of radius ρ: ρ (cos θ, axis_y sin θ) across and back.
        const double k = 1 / std::sqrt(1 + t * t * y * y);
        const double back = c.along * z + c.radius * y * y * t * k;
        touched.add(c.radius * k, back, t);
        touched.add(-c.radius * k, back, t);
      } else {
        // The view axis and the axis of turning span this plane, so the circle is a line in it.
        for (const double r : {c.radius, -c.radius})
          touched.add(c.along * y - r * z, c.along * z + r * y, t);
      }
    }
    void merge(const TouchedVertices& later) { touched.merge(later.touched); }
    [[nodiscard]] std::array<double, 2> values() const { return {touched.most, touched.least}; }
    [[nodiscard]] std::array<double, 2> bounds(const VerticesInUse::WorldBox& box) const {
      return {outline->most(box, axis, 1, t), outline->most(box, axis, -1, t)};
    }
  };
  template <int axis>
  [[nodiscard]] Touched touched(double t) const {
    Touched touched;
    own_work(ranks_, [&] {
      touched = vertices_.reduce(TouchedVertices<axis>{this, t, {}}).touched;
    });
    touched.gather(ranks_);
    return touched;
  }

  struct DepthsOfVertices {
    const Outline* outline;
    Depths depths;

    void add(const Vec3d& world) {
      const Vec3d p = outline->turned(world - outline->centre_);
      if (!outline->turns_) return depths.add(p.z);
      const Circle c = outline->circle(p);
      depths.add(c.along * outline->axis_z_ + c.radius * outline->axis_y_);
      depths.add(c.along * outline->axis_z_ - c.radius * outline->axis_y_);
    }
    void merge(const DepthsOfVertices& later) { depths.merge(later.depths); }
    [[nodiscard]] std::array<double, 2> values() const {
      return {depths.nearest, -depths.farthest};
    }
    [[nodiscard]] std::array<double, 2> bounds(const VerticesInUse::WorldBox& box) const {
      return {outline->most(box, 2, 1, 1), outline->most(box, 2, 1, -1)};
    }
  };

  /// A vertex's circle: its place along the axis of turning, and its radius.
  struct Circle {
    double along, radius;
  };
  [[nodiscard]] Circle circle(const Vec3d& p) const {
    const double along = p.y * axis_y_ + p.z * axis_z_;
    const double off = p.z * axis_y_ - p.y * axis_z_;
    return {along, std::sqrt(p.x * p.x + off * off)};
  }

  const VerticesInUse& vertices_;
  Mat4d to_camera_;
  Vec3d centre_;
  bool turns_;
  FitRanks* ranks_;
  double axis_y_ = 1, axis_z_ = 0;
};

/// Where the eye, `back` from the centre, has equal margins on both sides: the tip of the wedge
/// with the least slope t whose tip is no farther back. Newton's method from t = 0 never goes too
/// far, and ends once it has the two vertices that count.
template <class Touch>
double middle(const Touch& touch, double back, double t_picture, const Touched& in_picture) {
  constexpr int kMost = 16;
  double t = 0;
  Touched touched = touch(t);
  for (int i = 0; i < kMost; ++i) {
    const double next = (touched.high.across - touched.low.across) /
                        (2 * back - touched.high.back - touched.low.back);
    if (!(next > t)) break;
    t = next;
    touched = touch(t);
  }
  const double lower = in_picture.most - t_picture * back;
  const double upper = t_picture * back - in_picture.least;
  return lower <= upper ? std::clamp(touched.tip_across(), lower, upper) : in_picture.tip_across();
}

/// The box, or that of the origin if it is empty.
Box3d or_origin(const Box3d& box) {
  return box.empty() ? Box3d{{}, {}} : box;
}

}  // namespace

Camera fit_picture(const SceneView& scene, const Camera& view, int width, int height,
                   const FitOptions& options) {
  const FloatScope floats;
  const auto [fill, turns, ranks] = options;
  if (width < 1 || height < 1)
    throw Error(Errc::invalid_argument, "fit: the picture must have at least a pixel");
  if (!(fill > 0 && fill <= 1))
    throw Error(Errc::invalid_argument, "fit: the share that is filled must be in (0, 1]");
  if (!view.orthographic) check_fov(view.fov_rad);
  std::optional<VerticesInUse> vertices;
  const auto [low, high] = or_origin(extent_of(scene, ranks, vertices));
  const Vec3d half{(high.x - low.x) / 2, (high.y - low.y) / 2, (high.z - low.z) / 2};
  double r = length(half);
  if (!(r > 0)) r = 1;
  const Mat4d to_camera = world_to_camera(view);
  Camera camera = view;
  if (view.matrix) camera.up = {to_camera.m[1][0], to_camera.m[1][1], to_camera.m[1][2]};
  camera.matrix.reset();
  const Outline outline(*vertices, to_camera, {low.x + half.x, low.y + half.y, low.z + half.z},
                        turns, camera.up, ranks);
  const Outline::Depths depths = outline.depths();
  const double smaller = std::min(width, height);
  const double aspect_x = width / smaller, aspect_y = height / smaller;

  Vec3d eye;
  double ortho_height = 0;
  if (view.orthographic) {
    const Touched x = outline.horizontal(0), y = outline.vertical(0);
    if (!x.empty()) {
      eye = {x.tip_across(), y.tip_across(), 0};
      ortho_height = std::max((x.most + x.least) / aspect_x, (y.most + y.least) / aspect_y);
    }
    ortho_height = ortho_height > 0 ? ortho_height / fill : 2 * r;
    eye.z = depths.nearest + r;
  } else {
    const double t = elementary::tan(double{view.fov_rad} / 2) * fill;
    const double t_x = t * aspect_x, t_y = t * aspect_y;
    const Touched x = outline.horizontal(t_x), y = outline.vertical(t_y);
    eye.z = depths.nearest + kNearest * r;
    if (!x.empty()) {
      eye.z = std::max({eye.z, x.tip_back(t_x), y.tip_back(t_y)});
      eye.x = middle([&](double s) { return outline.horizontal(s); }, eye.z, t_x, x);
      eye.y = middle([&](double s) { return outline.vertical(s); }, eye.z, t_y, y);
    }
  }
  if (turns) eye.x = 0;  // the same, but for rounding

  camera.eye = outline.to_world(eye);
  // Where the view axis meets the axis of turning: as far as the centre if they are perpendicular.
  const double target_back = turns ? eye.y * outline.axis_z() / outline.axis_y() : 0;
  camera.target = outline.to_world({eye.x, eye.y, target_back});
  const double back = outline.back_of(camera.eye);
  if (view.orthographic) {
    camera.orthographic_height = static_cast<float>(ortho_height);
    camera.near_plane = static_cast<float>(back - depths.nearest - kPlaneMargin * r);
    camera.far_plane = static_cast<float>(back - depths.farthest + kPlaneMargin * r);
  } else {
    camera.near_plane =
        static_cast<float>(std::max(kNearPlane * (back - depths.nearest), kNearest * r / 100));
    camera.far_plane = std::numeric_limits<float>::infinity();
  }
  return camera;
}

BoundingSphere bounding_sphere(const SceneView& scene, FitRanks* ranks) {
  const FloatScope floats;
  std::optional<VerticesInUse> vertices;
  const auto [low, high] = or_origin(extent_of(scene, ranks, vertices));
  const Vec3d centre = {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
  double r = 0;
  own_work(ranks, [&] { r = vertices->reduce(ReachOfVertices{centre}).reach; });
  if (ranks != nullptr) r = std::ranges::max(ranks->gather(std::span(&r, 1)));
  return {centre, r == 0 ? 1 : r};
}

double nearest_plane(Vec3d eye, double to_target, const BoundingSphere& scene) {
  const FloatScope floats;
  return std::min(std::max(length(eye - scene.centre), scene.radius) / 1000, to_target / 100);
}

void place_planes(Camera& camera, const BoundingSphere& scene) {
  const FloatScope floats;
  if (camera.matrix) return;
  const double d = length(camera.eye - scene.centre), r = scene.radius;
  const double least = nearest_plane(camera.eye, length(camera.eye - camera.target), scene);
  camera.near_plane = static_cast<float>(std::max(d - 1.001 * r, least));
  if (camera.orthographic) camera.far_plane = static_cast<float>(d + 1.001 * r);
}

}  // namespace rastrum
