// SPDX-License-Identifier: BSD-3-Clause
// Triangles that share an edge cover each sample on it exactly once: in fans, in rotated grids with
// |w| from 0.1 to 4, and where the near plane and the guard band cut them (dEQP `fill_rules`,
// piglit `triangle-rasterization-overdraw`).
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/device_test.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::shared_edges_test {
namespace {

class SharedEdges : public DeviceTest {};

using Index = std::uint32_t;

/// The cells of (n + 1)² positions, each cut from its first or its second corner.
template <class F>
void add_cells(Mesh& mesh, int n, const F& from_the_first) {
  for_each_cell(n, n, 0, [&](Index a, Index b, Index c, Index d) {
    const bool first = from_the_first();
    add_triangle(mesh, a, b, first ? d : c);
    add_triangle(mesh, first ? a : b, d, c);
  });
}

struct Point {
  double x, y;
};

// Distance of p from the segment a b.
double distance(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, l2 = dx * dx + dy * dy;
  const double t = l2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / l2, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

// Every sample inside of the outline is drawn once, every sample outside never. Samples within a
// corner's rounding may be either, but never drawn twice.
void expect_covered_once(const Frame& f, const std::vector<Point>& outline) {
  for (const auto& [x, y] : pixels(f.overdraw.width(), f.overdraw.height())) {
    const Point p{x + 0.5, y + 0.5};
    double nearest = 1e9;
    bool inside = false;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Point a = outline[i], b = outline[(i + 1) % outline.size()];
      nearest = std::min(nearest, distance(p, a, b));
      if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
        inside = !inside;
    }
    const std::uint32_t n = f.overdraw(x, y);
    if (nearest < 0.01) {
      EXPECT_LE(n, 1U) << x << "," << y;
    } else {
      EXPECT_EQ(n, inside ? 1U : 0U) << x << "," << y;
    }
  }
}

// A place in the image; in perspective at a random |w| from 0.1 to 4.
struct Screen {
  Random& random;
  int width, height;
  bool perspective;
  Camera camera;

  Screen(Random& r, int w, int h)
      : random(r), width(w), height(h), perspective(r.chance(0.7)), camera(pixel_camera(w, h)) {
    if (!perspective) return;
    camera = Camera{};
    camera.eye = {0, 0, 0};
    camera.target = {0, 0, -1};
    camera.fov_rad = r.real32(0.5, 2.0);
  }
  Vec3 at(Point p) {
    if (!perspective) return at_pixel(p.x, p.y, random.real(0, 1), width, height);
    return Placer(camera, width, height).at({p.x, p.y, random.real(0.1, 4)});
  }
};

TEST_P(SharedEdges, FansCoverThemOnce) {
  constexpr int kW = 61, kH = 70;
  Painter renderer(options(kW, kH));
  for (std::uint64_t seed = 0; seed < 200 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random r(seed);
    Screen screen(r, kW, kH);
    const Point centre{r.real(5, kW - 5), r.real(5, kH - 5)};
    const int n = r.integer(3, 30);
    const double turn = r.real(0, 7);
    Mesh mesh;
    mesh.positions.push_back(screen.at(centre));
    std::vector<Point> outline;
    for (int i = 0; i < n; ++i) {
      const double angle = turn + 2 * 3.14159265358979 * i / n, radius = r.real(3, 60);
      outline.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
      mesh.positions.push_back(screen.at(outline.back()));
      const auto a = static_cast<Index>(i + 1), b = static_cast<Index>((i + 1) % n + 1);
      add_triangle(mesh, 0, a, b);
    }
    const Scene scene = single(std::move(mesh));
    expect_covered_once(draw(renderer, SceneBinding(scene).view(), screen.camera), outline);
  }
}

TEST_P(SharedEdges, RotatedGridsCoverThemOnce) {
  constexpr int kW = 72, kH = 67;
  Painter renderer(options(kW, kH));
  for (std::uint64_t seed = 0; seed < 200 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random r(seed);
    Screen screen(r, kW, kH);
    const int n = r.integer(1, 12);
    const double turn = r.real(0, 7), cell = r.real(0.7, 90.0 / n);
    const Point centre{r.real(5, kW - 5), r.real(5, kH - 5)};
    const auto node = [&](double i, double j) {
      const double u = (i - n / 2.0) * cell, v = (j - n / 2.0) * cell;
      return Point{centre.x + u * std::cos(turn) - v * std::sin(turn),
                   centre.y + u * std::sin(turn) + v * std::cos(turn)};
    };
    Mesh mesh;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) mesh.positions.push_back(screen.at(node(i, j)));
    add_cells(mesh, n, [&] { return r.chance(0.5); });
    const Scene scene = single(std::move(mesh));
    expect_covered_once(draw(renderer, SceneBinding(scene).view(), screen.camera),
                        {node(0, 0), node(n, 0), node(n, n), node(0, n)});
  }
}

// A floor seen from above, whose cells cross the near plane, pass behind the eye and leave the
// guard band. The reference is the ray through each sample.
TEST_P(SharedEdges, ClippedFloorsCoverThemOnce) {
  constexpr int kW = 66, kH = 59;
  Painter renderer(options(kW, kH));
  std::uint64_t clipped = 0, fragments = 0;
  for (std::uint64_t seed = 0; seed < 300 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random r(seed);
    Camera camera{.eye = {0, r.real32(0.3, 1), 0}};
    camera.target = Vec3(camera.eye) + Vec3{r.real32(-0.4, 0.4), r.real32(-1.5, -0.2), -1};
    camera.near_plane = r.real32(0.05, 0.8);
    camera.fov_rad = r.real32(0.5, 2.2);
    const int n = 6;
    const double turn = r.real(0, 7);
    const double cell = r.chance(0.5) ? r.real(0.2, 1) : r.real(1, 8);
    Mesh mesh;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const auto inner = [&](int k) { return k > 0 && k < n ? r.real(-0.2, 0.2) : 0.0; };
        const double u = (i - n / 2.0 + inner(i)) * cell, v = (j - n / 2.0 + inner(j)) * cell;
        mesh.positions.push_back({static_cast<float>(u * std::cos(turn) - v * std::sin(turn)), 0,
                                  static_cast<float>(u * std::sin(turn) + v * std::cos(turn))});
      }
    add_cells(mesh, n, [] { return true; });
    const Scene scene = single(std::move(mesh));
    const Frame f = draw(renderer, SceneBinding(scene).view(), camera);
    clipped += f.stats.triangles.clipped;
    fragments += f.stats.fragments;

    const Mat4d view = world_to_camera(camera);
    const auto on_floor = [&](double x, double y) {
      const double s = 2 * std::tan(double{camera.fov_rad} / 2) / std::min(kW, kH);
      const double d[3] = {(x - kW / 2.0) * s, (kH / 2.0 - y) * s, -1};
      double ray[3];
      for (int i = 0; i < 3; ++i)
        ray[i] = view.m[0][i] * d[0] + view.m[1][i] * d[1] + view.m[2][i] * d[2];
      const double t = -camera.eye.y / ray[1];  // also the distance along −z
      if (!(t > double{camera.near_plane})) return false;
      const double px = t * ray[0], pz = t * ray[2];
      const double u = px * std::cos(turn) + pz * std::sin(turn);
      const double v = -px * std::sin(turn) + pz * std::cos(turn);
      return std::max(std::abs(u), std::abs(v)) < n / 2.0 * cell;
    };
    for (const auto& [x, y] : pixels(kW, kH)) {
      // Corners far outside of the image are rounded to float32 px, so edges may move a little.
      constexpr double kNear = 0.03;
      int inside = 0;
      for (const double dx : {-kNear, kNear})
        for (const double dy : {-kNear, kNear}) inside += on_floor(x + 0.5 + dx, y + 0.5 + dy);
      const std::uint32_t drawn = f.overdraw(x, y);
      EXPECT_LE(drawn, 1U) << x << "," << y;
      if (inside == 0 || inside == 4) {
        EXPECT_EQ(drawn, inside == 4 ? 1U : 0U) << x << "," << y;
      }
    }
  }
  EXPECT_GT(clipped, 1000U);
  EXPECT_GT(fragments, 100000U);
}

INSTANTIATE_TEST_SUITE_P(Devices, SharedEdges, testing::Values(Device::serial, Device::threads),
                         device_name);

}  // namespace
}  // namespace rastrum::test::shared_edges_test
