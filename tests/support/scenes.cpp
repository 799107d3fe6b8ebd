// SPDX-License-Identifier: BSD-3-Clause
// One function per kind, in the order of the table at the end. Sizes are in pixels, so that a seed
// is equally difficult for small and large images.
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <rastrum/core/elementary.hpp>

#include "tests/support/random.hpp"

namespace rastrum::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Corners {
  Vec3 a, b, c;
};

struct Maker {
  Random random;
  int width, height;
  Camera camera;
  Mesh mesh;

  std::uint32_t vertex(Vec3 p) {
    mesh.positions.push_back(p);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { add_triangle(mesh, a, b, c); }
  void triangle(const Corners& t) {
    const std::uint32_t a = vertex(t.a), b = vertex(t.b), c = vertex(t.c);
    triangle(a, b, c);
  }
  /// Its corners are successive results of corner().
  template <class F>
  void triangle_by(const F& corner) {
    triangle({corner(), corner(), corner()});
  }
  template <class F>
  void triangles(int n, const F& corner) {
    for (int i = 0; i < n; ++i) triangle_by(corner);
  }
  [[nodiscard]] Placer placer() const { return {camera, width, height}; }
  double x() { return random.real(-0.2 * width, 1.2 * width); }
  double y() { return random.real(-0.2 * height, 1.2 * height); }
  double larger() const { return std::max(width, height); }
};

Vec3 random_vector(Random& r, double size) {
  return {r.real32(-size, size), r.real32(-size, size), r.real32(-size, size)};
}

// Any camera: perspective or orthographic, near and far planes of every magnitude.
Camera random_camera(Random& r) {
  Camera c{.eye = random_vector(r, 5)};
  const Vec3 forward = normalize(random_vector(r, 1) + Vec3{0.1F, 0.05F, -0.02F});
  c.target = Vec3(c.eye) + forward * r.real32(0.5, 4);
  c.up = std::abs(forward.y) > 0.9F ? Vec3{1, 0, 0} : Vec3{0.1F, 1, 0};
  c.fov_rad = r.real32(0.4, 2.4);
  const double nears[] = {1e-4, 0.01, 0.05, 0.1};
  c.near_plane = static_cast<float>(nears[r.integer(0, 3)]);
  if (r.chance(0.4)) c.far_plane = r.real32(1, 20);
  if (r.chance(0.2)) {
    c.orthographic = true;
    c.orthographic_height = r.real32(0.5, 10);
    c.near_plane = r.real32(-1, 0.1);
    c.far_plane = r.real32(3, 50);
  }
  return c;
}

void use_pixel_camera(Maker& m) {
  m.camera = pixel_camera(m.width, m.height);
}

// `w` is used as the depth.
Vec3 pixel_point(const Maker& m, ScreenPoint p) {
  return at_pixel(p.x_px, p.y_px, p.w, m.width, m.height);
}

void soup(Maker& m) {
  const Placer p = m.placer();
  const int n = m.random.integer(1, 60);
  for (int i = 0; i < n; ++i) {
    const double x = m.x(), y = m.y(), size = elementary::exp(m.random.real(-1, 5));
    m.triangle_by([&] {
      return p.at(
          {x + m.random.real(-size, size), y + m.random.real(-size, size), m.random.real(0.1, 4)});
    });
  }
}

// A star-shaped polygon around a centre, cut into a fan; every inner edge is shared.
void fan(Maker& m) {
  const bool pixels = m.random.chance(0.5);
  if (pixels) use_pixel_camera(m);
  const Placer p = m.placer();
  const auto point = [&](double x, double y) {
    return pixels ? pixel_point(m, {x, y, m.random.real(0, 1)})
                  : p.at({x, y, m.random.real(0.1, 4)});
  };
  const double cx = m.random.real(0, m.width), cy = m.random.real(0, m.height);
  const int n = m.random.integer(3, 40);
  const double turn = m.random.real(0, 2 * kPi);
  const std::uint32_t centre = m.vertex(point(cx, cy));
  for (int i = 0; i < n; ++i) {
    const double angle = turn + 2 * kPi * i / n;
    const double r = m.random.real(0.1, 0.9) * m.larger();
    m.vertex(point(cx + r * elementary::cos(angle), cy + r * elementary::sin(angle)));
  }
  for (int i = 0; i < n; ++i) {
    const auto a = centre + 1 + static_cast<std::uint32_t>(i);
    const auto b = centre + 1 + static_cast<std::uint32_t>((i + 1) % n);
    m.triangle(centre, a, b);
  }
}

// A rotated grid of quads, each cut along a random diagonal.
void grid(Maker& m) {
  const Placer p = m.placer();
  const int n = m.random.integer(1, 8);
  const double turn = m.random.real(0, 2 * kPi), cell = m.random.real(0.5, m.larger() / 3);
  const double cx = m.random.real(0, m.width), cy = m.random.real(0, m.height);
  const bool flat = m.random.chance(0.3);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double u = (i - n / 2.0) * cell, v = (j - n / 2.0) * cell;
      m.vertex(p.at({cx + u * elementary::cos(turn) - v * elementary::sin(turn),
                     cy + u * elementary::sin(turn) + v * elementary::cos(turn),
                     flat ? 1.0 : m.random.real(0.1, 4)}));
    }
  }
  for_each_cell(n, n, 0, [&](auto a, auto b, auto c, auto d) {
    const bool first = m.random.chance(0.5);
    m.triangle(a, b, first ? d : c);
    m.triangle(first ? a : b, d, c);
  });
}

void slivers(Maker& m) {
  const Placer p = m.placer();
  const int n = m.random.integer(1, 80);
  for (int i = 0; i < n; ++i) {
    const double x0 = m.x(), y0 = m.y(), x1 = m.x(), y1 = m.y();
    const double thin = elementary::pow(10.0, m.random.real(-3, 0.3));
    m.triangle({p.at({x0, y0, m.random.real(0.1, 4)}), p.at({x1, y1, m.random.real(0.1, 4)}),
                p.at({x1 + thin, y1 + thin * m.random.real(-1, 1), m.random.real(0.1, 4)})});
  }
}

void sub_pixel(Maker& m) {
  const Placer p = m.placer();
  const int n = m.random.integer(20, 200);
  for (int i = 0; i < n; ++i) {
    const double x = m.random.real(0, m.width), y = m.random.real(0, m.height);
    const double size = elementary::exp(m.random.real(-6, 0.5)), w = m.random.real(0.1, 4);
    m.triangle_by([&] {
      return p.at({x + m.random.real(-size, size), y + m.random.real(-size, size), w});
    });
  }
}

// Far past the image on every side, some of it past the guard band.
void huge(Maker& m) {
  const Placer p = m.placer();
  const int n = m.random.integer(1, 20);
  for (int i = 0; i < n; ++i) {
    const double size = elementary::pow(10.0, m.random.real(2, 7));
    m.triangle_by([&] {
      return p.at({m.random.real(-size, size), m.random.real(-size, size), m.random.real(0.1, 4)});
    });
  }
}

struct CameraPoint {
  double x, y, z;
};

Vec3 from_camera(const Mat4d& world_to_camera, CameraPoint p) {
  // The inverse of a rigid motion: transposed rotation of the shifted point.
  const auto& v = world_to_camera.m;
  const double d[3] = {p.x - v[0][3], p.y - v[1][3], p.z - v[2][3]};
  const auto row = [&](int i) {
    return static_cast<float>(v[0][i] * d[0] + v[1][i] * d[1] + v[2][i] * d[2]);
  };
  return {row(0), row(1), row(2)};
}

// Corners on both sides of the near plane and of the eye, some exactly in the eye's plane.
void near_crossing(Maker& m) {
  const Mat4d view = world_to_camera(m.camera);
  const int n = m.random.integer(1, 30);
  const double near = m.camera.near_plane;
  const auto corner = [&] {
    const double depths[] = {0,
                             near,
                             near * 1.0000001,
                             near * m.random.real(0.5, 2),
                             m.random.real(-2, 2),
                             m.random.real(-2, 2)};
    const double z = -depths[m.random.integer(0, 5)];
    const double size = m.random.chance(0.3) ? 0.05 : 2;
    return from_camera(view, {m.random.real(-size, size), m.random.real(-size, size), z});
  };
  m.triangles(n, corner);
}

void behind(Maker& m) {
  const Mat4d view = world_to_camera(m.camera);
  const int n = m.random.integer(1, 20);
  for (int i = 0; i < n; ++i) {
    const bool all = m.random.chance(0.7);
    m.triangle_by([&] {
      return from_camera(
          view, {m.random.real(-2, 2), m.random.real(-2, 2), m.random.real(all ? 0.0 : -1.0, 5)});
    });
  }
}

void not_finite(Maker& m) {
  grid(m);
  soup(m);
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity()};
  for (Vec3& p : m.mesh.positions) {
    if (!m.random.chance(0.1)) continue;
    float* axis[] = {&p.x, &p.y, &p.z};
    *axis[m.random.integer(0, 2)] = bad[m.random.integer(0, 2)];
  }
}

// Repeated corners, points on a line, and triangles that only snapping flattens.
void degenerate(Maker& m) {
  use_pixel_camera(m);
  const int n = m.random.integer(3, 60);
  for (int i = 0; i < n; ++i) {
    const double x = m.x(), y = m.y(), dx = m.random.real(-20, 20), dy = m.random.real(-20, 20);
    const double z = m.random.real(0, 1), tiny = 1.0 / m.random.integer(200, 5000);
    const Vec3 a = pixel_point(m, {x, y, z});
    const Vec3 b = pixel_point(m, {x + dx, y + dy, z});
    switch (m.random.integer(0, 4)) {
      case 0:
        m.triangle({a, a, b});
        break;
      case 1:
        m.triangle({a, b, pixel_point(m, {x + 2 * dx, y + 2 * dy, z})});
        break;
      case 2:
        m.triangle({a, a, a});
        break;
      case 3:
        m.triangle({a, b, pixel_point(m, {x + dx + tiny, y + dy - tiny, z})});
        break;
      default:
        m.triangle({a, pixel_point(m, {x, y + dy, z}), pixel_point(m, {x + dx, y, z})});
        break;
    }
  }
}

void extreme(Maker& m) {
  // A wide view, so that such coordinates stay finite in the transform.
  m.camera = Camera{};
  m.camera.fov_rad = m.random.real32(0.8, 2.4);
  if (m.random.chance(0.5)) m.camera.far_plane = 100;
  const float limit = std::numeric_limits<float>::max() / 16;
  const auto coordinate = [&] {
    const double magnitude =
        elementary::pow(10.0, m.random.real(-3, elementary::log10(double{limit})));
    const float v = m.random.chance(0.2) ? limit : static_cast<float>(magnitude);
    return m.random.chance(0.5) ? v : -v;
  };
  m.triangles(m.random.integer(1, 30), [&] {
    const Vec3 v{coordinate(), coordinate(), coordinate()};
    return m.random.chance(0.4) ? random_vector(m.random, 2) : v;
  });
}

// Layers in one plane, and the same triangle again and again with its corners turned.
void equal_depth(Maker& m) {
  use_pixel_camera(m);
  const int n = m.random.integer(2, 50);
  const double levels[] = {0, 0.25, 0.5, 1};
  for (int i = 0; i < n; ++i) {
    const double z = levels[m.random.integer(0, 3)];
    const std::uint32_t a = m.vertex(pixel_point(m, {m.x(), m.y(), z}));
    const std::uint32_t b = m.vertex(pixel_point(m, {m.x(), m.y(), z}));
    const std::uint32_t c = m.vertex(pixel_point(m, {m.x(), m.y(), z}));
    m.triangle(a, b, c);
    if (m.random.chance(0.3)) m.triangle(b, c, a);
    if (m.random.chance(0.3)) m.triangle(c, b, a);
  }
}

// Corners on samples, pixel corners and n.8 positions: the edges run exactly through samples.
void on_samples(Maker& m) {
  use_pixel_camera(m);
  const int n = m.random.integer(1, 60);
  const double steps[] = {1, 0.5, 0.25, 1.0 / 256};
  const double step = steps[m.random.integer(0, 3)];
  m.triangles(n, [&] {
    return pixel_point(
        m, {std::round(m.x() / step) * step, std::round(m.y() / step) * step, m.random.real(0, 1)});
  });
}

// Beyond a finite far plane the depth stays 0 and is still drawn.
void beyond_far(Maker& m) {
  m.camera.orthographic = false;
  m.camera.near_plane = 0.1F;
  m.camera.far_plane = m.random.real32(0.2, 3);
  const Placer p = m.placer();
  m.triangles(m.random.integer(1, 60), [&] {
    return p.at({m.x(), m.y(), m.random.real(0.05, 8)});
  });
}

// A mesh without indices, in world space around the camera's target.
void unindexed(Maker& m) {
  const int n = m.random.integer(1, 66);
  for (int i = 0; i < n; ++i) {
    const Vec3 centre = Vec3(m.camera.target) + random_vector(m.random, 2);
    for (int c = 0; c < 3; ++c) m.mesh.positions.push_back(centre + random_vector(m.random, 1));
  }
}

// Steep depth: nearly edge-on triangles, where the plane's slope is largest.
void edge_on(Maker& m) {
  const Mat4d view = world_to_camera(m.camera);
  const int n = m.random.integer(1, 60);
  for (int i = 0; i < n; ++i) {
    const double x = m.random.real(-1, 1), y = m.random.real(-1, 1);
    const double lean = elementary::pow(10.0, m.random.real(-6, -1));
    m.triangle_by([&] {
      const double z = m.random.real(0.2, 6);
      return from_camera(
          view, {x * z + m.random.real(-lean, lean), y * z + m.random.real(-lean, lean), -z});
    });
  }
}

struct Kind {
  const char* name;
  void (*make)(Maker&);
};
constexpr std::array kKinds = {
    Kind{"soup", soup},
    Kind{"fan", fan},
    Kind{"grid", grid},
    Kind{"slivers", slivers},
    Kind{"sub_pixel", sub_pixel},
    Kind{"huge", huge},
    Kind{"near_crossing", near_crossing},
    Kind{"behind", behind},
    Kind{"not_finite", not_finite},
    Kind{"degenerate", degenerate},
    Kind{"extreme", extreme},
    Kind{"equal_depth", equal_depth},
    Kind{"on_samples", on_samples},
    Kind{"beyond_far", beyond_far},
    Kind{"unindexed", unindexed},
    Kind{"edge_on", edge_on},
};

// Sometimes normals and colours, indexed like the positions or by themselves.
void add_attributes(Maker& m) {
  Random& r = m.random;
  const auto fill = [&](auto& attribute, auto value) {
    if (!r.chance(0.5)) return;
    const bool own = r.chance(0.5) && !m.mesh.indices.empty();
    const std::size_t n = own ? 7 : m.mesh.positions.size();
    for (std::size_t i = 0; i < n; ++i) attribute.values.push_back(value());
    if (own)
      for (std::size_t i = 0; i < m.mesh.indices.size(); ++i)
        attribute.indices.push_back(static_cast<std::uint32_t>(r.integer(0, 6)));
  };
  fill(m.mesh.normals, [&] { return random_vector(r, 1); });
  fill(m.mesh.colors, [&] {
    const Vec3 c = random_vector(r, 0.5) + Vec3{0.5F, 0.5F, 0.5F};
    return Vec4{c.x, c.y, c.z, 1};
  });
}

Mat4d random_placement(Random& r) {
  // A rotation about a random axis, unequal scales (now and then a mirror image), a shift.
  const Vec3 a = normalize(random_vector(r, 1) + Vec3{0, 0.01F, 0});
  const double angle = r.real(0, 2 * kPi), s = elementary::sin(angle), c = elementary::cos(angle);
  const double u[3] = {a.x, a.y, a.z};
  const double k[3][3] = {{0, -u[2], u[1]}, {u[2], 0, -u[0]}, {-u[1], u[0], 0}};
  double scale[3];
  for (double& v : scale) v = r.real(0.3, 2) * (r.chance(0.2) ? -1 : 1);
  Mat4d m = Mat4d::identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      m.m[i][j] = ((i == j ? c : 0) + (1 - c) * u[i] * u[j] + s * k[i][j]) * scale[j];
    m.m[i][3] = r.real(-1, 1);
  }
  return m;
}

}  // namespace

const int kSceneKinds = static_cast<int>(kKinds.size());

GeneratedScene generate(std::uint64_t seed, int width, int height) {
  const Kind& kind = kKinds[seed % kKinds.size()];
  Maker m{Random(seed * 0x2545F4914F6CDD1DU + 1), width, height, {}, {}};
  m.camera = random_camera(m.random);
  kind.make(m);
  add_attributes(m);
  GeneratedScene out{kind.name, single(std::move(m.mesh)), m.camera};
  // Sometimes the mesh appears again elsewhere.
  if (out.scene.triangle_count() <= 60 && m.random.chance(0.3))
    for (int i = m.random.integer(1, 2); i > 0; --i)
      out.scene.instances.push_back({0, random_placement(m.random)});
  return out;
}

Placer::Placer(const Camera& camera, int width, int height)
    : camera_(camera),
      width_(width),
      height_(height),
      scale_(camera.orthographic
                 ? double{camera.orthographic_height} / std::min(width, height)
                 : 2 * elementary::tan(double{camera.fov_rad} / 2) / std::min(width, height)),
      world_to_camera_(world_to_camera(camera)) {}

Vec3 Placer::at(ScreenPoint p) const {
  const double unit = scale_ * (camera_.orthographic ? 1 : p.w);
  return from_camera(world_to_camera_,
                     {(p.x_px - width_ / 2) * unit, (height_ / 2 - p.y_px) * unit, -p.w});
}

Camera pixel_camera(int width, int height) {
  return Camera{.eye = {0, 0, 1},
                .target = {0, 0, 0},
                .orthographic = true,
                .orthographic_height = static_cast<float>(std::min(width, height)),
                .near_plane = 0,
                .far_plane = 1};
}

Vec3 at_pixel(double x_px, double y_px, double depth, int width, int height) {
  return {static_cast<float>(x_px - width / 2.0), static_cast<float>(height / 2.0 - y_px),
          static_cast<float>(depth)};
}

Mesh indexed(Mesh mesh) {
  if (mesh.indices.empty()) {
    mesh.indices.resize(mesh.positions.size() / 3 * 3);
    std::iota(mesh.indices.begin(), mesh.indices.end(), 0U);
  }
  return mesh;
}

Scene single(Mesh mesh) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({});
  return scene;
}

}  // namespace rastrum::test
