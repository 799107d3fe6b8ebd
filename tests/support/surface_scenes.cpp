// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/surface_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <rastrum/core/elementary.hpp>

#include "tests/support/random.hpp"

namespace rastrum::test {
namespace surface_scenes {

enum Kind {
  kMixed,       ///< beside each other and crossing
  kNear,        ///< the near plane cuts them, or the eye is inside
  kBehind,      ///< also behind the eye
  kTiny,        ///< about a pixel
  kHuge,        ///< larger than the picture
  kDegenerate,  ///< radii of 0, no length, NaN, infinity, negative radii
  kFar,         ///< far from the origin
  kAffine,      ///< under any affine matrix
  kOrthographic,
  kFinite,  ///< a far plane
  kAlong,   ///< seen along their axes
  kKinds
};
constexpr const char* kNames[] = {"mixed", "near",   "behind",       "tiny",   "huge", "degenerate",
                                  "far",   "affine", "orthographic", "finite", "along"};

class Maker {
 public:
  Maker(std::uint64_t seed, int width, int height)
      : kind_(static_cast<Kind>(seed % kKinds)), random_(seed) {
    s_.kind = kNames[kind_];
    s_.width = width;
    s_.height = height;
  }

  SurfaceScene make() {
    make_camera();
    const int n = random_.integer(2, 5);
    for (int i = 0; i < n; ++i) add_instance();
    return std::move(s_);
  }

 private:
  double real(double a, double b) { return random_.real(a, b); }

  void make_camera() {
    Camera& c = s_.camera;
    // On the world's axes, so that the oracle knows them exactly.
    origin_ = kind_ == kFar ? Vec3{1048576, -524288, 2097152} : Vec3{0, 0, 0};
    c.eye = origin_;
    c.target = origin_ + Vec3{0, 0, -1};
    c.near_plane = 0.5F;
    c.orthographic = kind_ == kOrthographic || (kind_ == kAlong && random_.chance(0.5));
    if (c.orthographic) c.orthographic_height = 8;
    if (c.orthographic || kind_ == kFinite) c.far_plane = 24;
    OracleCamera& o = s_.eye;
    o.eye = widen(origin_);
    o.right = {1, 0, 0};
    o.up = {0, 1, 0};
    o.back = {0, 0, 1};
    o.orthographic = c.orthographic;
    const int side = std::min(s_.width, s_.height);
    o.px_scale =
        c.orthographic ? Real(8) / side : 2 * std::tan(static_cast<Real>(c.fov_rad) / 2) / side;
    o.near_plane = static_cast<Real>(c.near_plane);
    o.far_plane = std::isinf(c.far_plane) ? 0 : static_cast<Real>(c.far_plane);
    o.width = s_.width;
    o.height = s_.height;
  }

  /// A place that is probably visible, in object space.
  Vec3 place() {
    double z = real(-14, -2);
    if (kind_ == kNear) z = real(-2.5, 0.3);
    if (kind_ == kBehind) z = real(-8, 8);
    if (kind_ == kFinite) z = real(-30, -2);
    const double across = s_.camera.orthographic ? 4 : std::max(0.8, -0.55 * z);
    // Multiples of 1/64, so that nothing is rounded far from the origin.
    const auto eighths = [](double v) { return static_cast<float>(std::round(v * 64) / 64); };
    return origin_ +
           Vec3{eighths(real(-across, across)), eighths(real(-across, across)), eighths(z)};
  }
  float radius() {
    if (kind_ == kTiny) return random_.real32(0.01, 0.2);
    if (kind_ == kHuge) return static_cast<float>(elementary::exp(real(1, 7)));
    return random_.real32(0.2, 2.5);
  }
  Vec3 other_end(Vec3 p, double size) {
    if (kind_ == kAlong) return p + Vec3{0, 0, static_cast<float>(-std::round(size * 64) / 64)};
    const auto step = [&] { return static_cast<float>(std::round(real(-size, size) * 64) / 64); };
    const float x = step(), y = step(), z = step();
    return p + Vec3{x, y, z};
  }
  float odd_number() {
    constexpr float kInf = std::numeric_limits<float>::infinity();
    const float numbers[] = {std::numeric_limits<float>::quiet_NaN(), kInf, -kInf, -1};
    return numbers[random_.integer(0, 3)];
  }

  SurfacePrimitive& add(SurfaceKind kind, Vec3 p0, Vec3 p1, Real r0, Real r1) {
    const auto column = [&](int i) {
      const auto& m = matrix_.m;
      return Point3{m[0][i], m[1][i], m[2][i]};
    };
    return s_.primitives.emplace_back(SurfacePrimitive{.kind = kind,
                                                       .p0 = widen(p0),
                                                       .p1 = widen(p1),
                                                       .r0 = r0,
                                                       .r1 = r1,
                                                       .columns = {column(0), column(1), column(2)},
                                                       .origin = column(3),
                                                       .id = next_id_++,
                                                       .instance = s_.instances.size()});
  }
  static bool is_fine(Vec3 p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  }
  /// Adds a primitive that only the renderer sees.
  void skip(bool is_dropped) {
    ++next_id_;
    s_.dropped += is_dropped;
  }

  void add_instance() {
    matrix_ = Mat4d::identity();
    if (kind_ == kAffine) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) matrix_.m[i][j] = (i == j ? 1.0 : 0.0) + real(-0.6, 0.6);
      matrix_.m[0][3] = real(-1, 1);
      matrix_.m[2][3] = real(-4, 0);
    }
    // Far from the origin, float32 vertices are inexact.
    s_.instances.add(geometry(random_.integer(0, kind_ == kFar ? 4 : 5)), matrix_);
  }
  GeometryView geometry(int which) {
    if (which == 0) return spheres();
    if (which <= 2) return cylinders(which == 1);
    if (which == 3) return tubes();
    if (which == 4) return discs();
    return triangle();
  }

  SpheresView spheres() {
    auto& centers = s_.positions.emplace_back();
    auto& radii = s_.radii.emplace_back();
    const int n = random_.integer(1, 3);
    for (int i = 0; i < n; ++i) {
      Vec3 p = place();
      float r = radius();
      if (kind_ == kDegenerate && random_.chance(0.5)) {
        if (random_.chance(0.3))
          r = 0;
        else if (random_.chance(0.5))
          r = odd_number();
        else
          p.y = std::numeric_limits<float>::quiet_NaN();
      }
      centers.push_back(p);
      radii.push_back(r);
      if (is_fine(p) && r > 0 && std::isfinite(r))
        add(SurfaceKind::sphere, p, {}, r, r);
      else
        skip(!(r == 0 && is_fine(p)));
    }
    return {centers, radii};
  }

  CylindersView cylinders(bool caps) {
    auto& positions = s_.positions.emplace_back();
    auto& radii = s_.radii.emplace_back();
    auto& indices = s_.indices.emplace_back();
    const int n = random_.integer(1, 2);
    for (int i = 0; i < n; ++i) {
      const Vec3 p = place();
      Vec3 q = other_end(p, kind_ == kTiny ? 0.4 : 4);
      float r0 = radius(), r1 = random_.chance(0.4) ? r0 : random_.chance(0.3) ? 0 : radius();
      bool dropped = false;
      if (kind_ == kDegenerate && random_.chance(0.5)) {
        dropped = !random_.chance(0.4);
        if (dropped)
          r1 = odd_number();
        else
          q = p;
      }
      // Backwards, through indices.
      const auto at = static_cast<std::uint32_t>(positions.size());
      indices.insert(indices.end(), {at + 1, at});
      positions.insert(positions.end(), {q, p});
      radii.insert(radii.end(), {r1, r0});
      if (!dropped && q != p)
        add(caps ? SurfaceKind::closed_cone : SurfaceKind::open_cone, p, q, r0, r1);
      else
        skip(dropped);
    }
    return {positions, indices, radii, 1, {}, caps};
  }

  TubesView tubes() {
    auto& positions = s_.positions.emplace_back();
    auto& radii = s_.radii.emplace_back();
    auto& offsets = s_.indices.emplace_back();
    offsets.push_back(0);
    const int lines = random_.integer(1, 2);
    for (int line = 0; line < lines; ++line) {
      const int n = random_.integer(1, 3);
      Vec3 last = place();
      float last_radius = radius();
      positions.push_back(last);
      radii.push_back(last_radius);
      for (int i = 1; i < n; ++i) {
        const Vec3 p = kind_ == kDegenerate && random_.chance(0.3)
                           ? last
                           : other_end(last, kind_ == kTiny ? 0.4 : 3);
        const float r = random_.chance(0.5) ? last_radius : radius();
        add(SurfaceKind::tube, last, p, last_radius, r);
        positions.push_back(p);
        radii.push_back(r);
        last = p;
        last_radius = r;
      }
      offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    return {positions, offsets, radii};
  }

  DiscsView discs() {
    auto& centers = s_.positions.emplace_back();
    auto& normals = s_.positions.emplace_back();
    auto& radii = s_.radii.emplace_back();
    Vec3 n{random_.real32(-1, 1), random_.real32(-1, 1), random_.real32(-1, 1)};
    if (kind_ == kAlong) n = {0, 1, 0};  // edge-on in an orthographic view
    const bool none = kind_ == kDegenerate && random_.chance(0.4);
    if (none) n = {};
    centers.push_back(place());
    normals.push_back(n);
    radii.push_back(radius());
    if (none)
      skip(false);
    else
      add(SurfaceKind::disc, centers[0], n, radii[0], radii[0]);
    return {centers, normals, radii};
  }

  MeshView triangle() {
    auto& p = s_.positions.emplace_back();
    // Neither steep nor thin, because its corners are snapped.
    p.push_back(place());
    const double x = real(0.5, 4), y = real(-4, 4), turned = real(0.5, 1.5);
    for (const auto& [u, v] : {std::pair{x, y}, std::pair{-y * turned, x * turned}})
      p.push_back(p[0] +
                  Vec3{static_cast<float>(u), static_cast<float>(v), random_.real32(-0.2, 0.2)});
    SurfacePrimitive& t = add(SurfaceKind::triangle, p[0], p[1], 1, 1);
    t.p2 = widen(p[2]);
    return MeshView{.positions = p};
  }

  Kind kind_;
  Random random_;
  SurfaceScene s_;
  Vec3 origin_;
  Mat4d matrix_;
  std::int64_t next_id_ = 0;
};

/// A plane through a place near a primitive.
ClipPlane plane_near(const SurfacePrimitive& p, bool in_world, Random& random) {
  const auto real = [&](double a, double b) { return random.real(a, b); };
  const Vec3d n{real(-1, 1), real(-1, 1), real(-1, 1)};
  const Point3 middle = in_world ? p.to_world(p.p0) : p.p0;
  Vec3d at{static_cast<double>(middle.x), static_cast<double>(middle.y),
           static_cast<double>(middle.z)};
  const double r = static_cast<double>(std::max(p.r0, p.r1));
  at = at + Vec3d{real(-r, r), real(-r, r), real(-r, r)};
  return {n, -dot(n, at)};
}

OraclePlane oracle_plane(const ClipPlane& p, bool in_object_space) {
  return {widen(p.normal), p.offset, in_object_space};
}

}  // namespace surface_scenes

const int kSurfaceKinds = surface_scenes::kKinds;

SurfaceScene generate_surfaces(std::uint64_t seed, int width, int height) {
  return surface_scenes::Maker(seed, width, height).make();
}

void add_clip_planes(SurfaceScene& s, std::uint64_t seed) {
  using namespace surface_scenes;
  if (s.primitives.empty()) return;
  Random random(seed + 77);
  const auto some = [&]() -> const SurfacePrimitive& {
    return s.primitives[static_cast<std::size_t>(
        random.integer(0, static_cast<int>(s.primitives.size()) - 1))];
  };
  for (int n = random.integer(0, 2); n > 0; --n)
    s.clip_planes.push_back(plane_near(some(), true, random));
  for (std::size_t i = 0; i < s.instances.size(); i += 2) {
    const auto own = std::ranges::find(s.primitives, i, &SurfacePrimitive::instance);
    if (own == s.primitives.end()) continue;
    std::vector<ClipPlane>& planes = s.own_planes.emplace_back();
    for (int n = random.integer(1, 2); n > 0; --n)
      planes.push_back(plane_near(*own, false, random));
    s.instances[i].clip_planes = planes;
  }
  for (SurfacePrimitive& p : s.primitives) {
    for (const ClipPlane& c : s.clip_planes) p.planes.push_back(oracle_plane(c, false));
    for (const ClipPlane& c : s.instances[p.instance].clip_planes)
      p.planes.push_back(oracle_plane(c, true));
  }
}

}  // namespace rastrum::test
