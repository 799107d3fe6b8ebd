// SPDX-License-Identifier: BSD-3-Clause
// Polygons, normals, colours and transforms.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/test_share.hpp"

namespace rastrum::test::scene_troubles {
namespace {

constexpr int kSize = 96;

struct Picture {
  Image<Rgba8> color{kSize, kSize};
  Image<std::int64_t> ids{kSize, kSize};
  Image<Vec4> albedo{kSize, kSize};
};

/// From +z; a pixel is `units` across, the middle of the picture is (cx, cy).
Picture picture(const SceneView& scene, Shader shader, double units = 0.125, double cx = 0,
                double cy = 0) {
  FrameOptions frame{.width = kSize, .height = kSize, .shader = shader};
  Camera camera{.eye = {cx, cy, 10}, .target = {cx, cy, 0}, .near_plane = 0.1F, .far_plane = 100};
  camera = orthographic_by_scale(camera, units, kSize, kSize);
  Picture p;
  Targets targets{.color8 = p.color.view(), .ids = p.ids.view(), .albedo = p.albedo.view()};
  (void)Renderer({.threads = 1}).render(scene, camera, frame, targets);
  // Plain C++ gives the same.
  Picture q;
  targets.color8 = q.color.view();
  (void)Renderer({.threads = 1, .isa = Isa::scalar}).render(scene, camera, frame, targets);
  EXPECT_TRUE(std::ranges::equal(p.color.pixels(), q.color.pixels()));
  return p;
}
Picture picture(const Scene& scene, Shader shader, double units = 0.125) {
  return picture(SceneBinding(scene).view(), shader, units);
}

Scene decoded(const std::string& text, std::string_view format) {
  return io::decode_scene(std::as_bytes(std::span(text)), format, "odd." + std::string(format));
}

// ---- polygons

using Ring = std::vector<std::array<double, 2>>;

/// An arrowhead, counter-clockwise, whose second corner points inwards: the fan of its first leaves
/// it. No pixel's centre lies on an edge.
const Ring kDart{{-2.03, -3.01}, {-0.47, 0.02}, {-2.51, 3.03}, {4.53, 0.04}};
const Ring kC{{-3.51, -3.52}, {3.53, -3.54}, {3.55, -1.56}, {-1.57, -1.51},
              {-1.53, 1.52},  {3.57, 1.54},  {3.51, 3.56},  {-3.55, 3.57}};

/// Even–odd, at the centre of a pixel of picture().
bool is_inside(const Ring& ring, int x, int y, double units = 0.125) {
  const double px = (x + 0.5 - kSize / 2) * units, py = (kSize / 2 - y - 0.5) * units;
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const auto [ax, ay] = ring[i];
    const auto [bx, by] = ring[j];
    if ((ay > py) != (by > py) && px < (bx - ax) * (py - ay) / (by - ay) + ax) inside = !inside;
  }
  return inside;
}

void expect_filled(const Picture& p, const Ring& ring, const std::string& what,
                   double units = 0.125) {
  int wrong = 0, seen = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const bool inside = is_inside(ring, x, y, units);
      wrong += (p.ids(x, y) >= 0) != inside;
      seen += inside;
      const auto triangles = static_cast<std::int64_t>(ring.size() - 2);
      if (p.ids(x, y) >= triangles) ++wrong;
    }
  EXPECT_GT(seen, 100) << what;
  EXPECT_EQ(wrong, 0) << what;
}

std::vector<Vec3> corners_of(const Ring& ring) {
  std::vector<Vec3> p;
  for (const auto& [x, y] : ring) p.push_back({static_cast<float>(x), static_cast<float>(y), 0});
  return p;
}

std::string xyz(const Ring& ring, const std::string& before) {
  std::string text;
  for (const auto& [x, y] : ring)
    text += before + std::to_string(x) + " " + std::to_string(y) + " 0\n";
  return text;
}

std::string numbers(std::size_t first, std::size_t n) {
  std::string text;
  for (std::size_t i = 0; i < n; ++i) text += " " + std::to_string(first + i);
  return text;
}

/// In every form that a polygon has.
void expect_filled_in_all_forms(const Ring& ring, const std::string& what) {
  const std::size_t n = ring.size();
  const std::string count = std::to_string(n);
  const std::string f = "f" + numbers(1, n) + "\n", later = "f" + numbers(2, n) + "\n";
  const std::string vertices =
      "element vertex " + count + "\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string corners = count + numbers(0, n) + "\n", ply = "ply\nformat ascii 1.0\n";
  const struct {
    const char* format;
    std::string text;
    const char* how;
  } kFiles[] = {
      {"obj", xyz(ring, "v ") + f, ""},
      {"obj", "v 9 9 9\n" + later + xyz(ring, "v "), ", whose positions follow"},
      {"off", "OFF\n" + count + " 1 0\n" + xyz(ring, "") + corners, ""},
      {"ply", ply + vertices + face + "end_header\n" + xyz(ring, "") + corners, ""},
      {"ply", ply + face + vertices + "end_header\n" + corners + xyz(ring, ""), ", faces first"}};
  for (const auto& [format, text, how] : kFiles)
    expect_filled(picture(decoded(text, format), Shader::flat), ring, what + " of " + format + how);
  const std::vector<Vec3> positions = corners_of(ring);
  MeshView mesh{.positions = positions};
  mesh.faces.kind = FaceKind::polygons;
  const InstanceView instance{mesh, Mat4d::identity()};
  expect_filled(picture({{&instance, 1}}, Shader::flat), ring, what + " of arrays");
  const PreparedMesh prepared(mesh);
  const InstanceView of_prepared{prepared.view()};
  expect_filled(picture({{&of_prepared, 1}}, Shader::phong), ring, what + ", prepared");
  if (n != 4) return;
  mesh.faces.kind = FaceKind::quads;
  const InstanceView quad{mesh, Mat4d::identity()};
  expect_filled(picture({{&quad, 1}}, Shader::flat), ring, what + " as a quad");
}

// Concave faces of OBJ, OFF, PLY and arrays, also before positions. Right: their inside is
// drawn, by n - 2 triangles (docs/inputs.md).
TEST(OddPolygons, DartsAndCs) {
  for (const auto& [ring, what] : {std::pair(kDart, "dart"), std::pair(kC, "C")})
    for (std::size_t turn = 0; turn < ring.size(); ++turn) {
      Ring turned = ring;
      std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(turn), turned.end());
      const std::string name = what + std::string(" from corner ") + std::to_string(turn);
      expect_filled_in_all_forms(turned, name);
      std::reverse(turned.begin(), turned.end());
      expect_filled_in_all_forms(turned, name + ", clockwise");
    }
}

// Corners between corners of a straight side, and twice. Right: the same picture as without
// them.
TEST(OddPolygons, CornersInARow) {
  Ring many;  // a C whose sides have corners between, some twice
  for (std::size_t i = 0; i < kC.size(); ++i) {
    const auto [ax, ay] = kC[i];
    const auto [bx, by] = kC[(i + 1) % kC.size()];
    for (int k = 0; k < 5; ++k) many.push_back({ax + (bx - ax) * k / 5, ay + (by - ay) * k / 5});
    if (i % 2 == 0) many.push_back(many.back());
  }
  expect_filled_in_all_forms(many, "C with corners in rows");
}

// A ring that goes to a hole and back the same way. Right: the hole stays empty.
TEST(OddPolygons, HolesByBridges) {
  // A square with a square hole, one ring that passes the bridge between them twice.
  const Ring keyhole{{-4.51, -4.52}, {4.53, -4.54}, {4.55, 4.56}, {-4.57, 4.51}, {-4.51, -4.52},
                     {-2.03, -2.01}, {-2.05, 2.07}, {2.01, 2.03}, {2.05, -2.07}, {-2.03, -2.01}};
  expect_filled_in_all_forms(keyhole, "hole");
}

double cross_z(Vec3 a, Vec3 b, Vec3 c) {
  return (double{b.x} - a.x) * (double{c.y} - a.y) - (double{c.x} - a.x) * (double{b.y} - a.y);
}

// Concave faces of 100,000 corners. Right: drawn, within a second or two.
TEST(OddPolygons, Huge) {
  // The comb is the worst case.
  const int teeth = share_of(50'000, 500), comb_teeth = share_of(5'000, 50);
  Ring comb;
  for (int i = 0; i < comb_teeth; ++i) {
    comb.push_back({-4.0 + 8.0 * i / comb_teeth, -4.01});
    comb.push_back({-4.0 + 8.0 * (i + 0.5) / comb_teeth, 4.02});
  }
  comb.push_back({4.03, -4.51});
  comb.push_back({-4.03, -4.52});
  std::reverse(comb.begin(), comb.end());
  Ring star, spiral;
  for (int i = 0; i < 2 * teeth; ++i) {
    const double angle = 6.283185307179586 * i / (2 * teeth), r = i % 2 == 0 ? 4.5 : 2.5;
    star.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  for (int i = 0; i < teeth; ++i) {
    const double angle = 37.7 * i / teeth, r = 0.5 + 4.0 * i / teeth;
    spiral.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  for (int i = teeth - 1; i >= 0; --i) {
    const double angle = 37.7 * i / teeth, r = 0.8 + 4.0 * i / teeth;
    spiral.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  std::reverse(spiral.begin(), spiral.end());
  for (const auto& [ring, what] :
       {std::pair(&comb, "comb"), std::pair(&star, "star"), std::pair(&spiral, "spiral")}) {
    const std::vector<Vec3> positions = corners_of(*ring);
    MeshView mesh{.positions = positions};
    mesh.faces.kind = FaceKind::polygons;
    const InstanceView instance{mesh, Mat4d::identity()};
    std::vector<std::uint32_t> corners(3 * mesh.triangle_count());
    mesh.read_triangles(0, mesh.triangle_count(), corners.data());
    double area = 0, drawn = 0;  // twice
    for (std::size_t i = 0; i < positions.size(); ++i)
      area += cross_z(positions[0], positions[i], positions[(i + 1) % positions.size()]);
    for (std::size_t t = 0; t < corners.size(); t += 3)
      drawn += std::abs(
          cross_z(positions[corners[t]], positions[corners[t + 1]], positions[corners[t + 2]]));
    EXPECT_NEAR(drawn, std::abs(area), 1e-9 * std::abs(area)) << what;
    // The same triangles one by one, as pictures ask for them; teeth are finer than pixels.
    const Picture p = picture({{&instance, 1}}, Shader::phong);
    if (ring != &spiral) continue;
    int wrong = 0;  // float32 and snapping move edges by parts of a pixel
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) wrong += (p.ids(x, y) >= 0) != is_inside(*ring, x, y);
    EXPECT_LT(wrong, 30);
  }
}

// ---- normals

/// Whether nearly all of a picture is as bright as one whose normals are as they should be.
void expect_lit_as(const Scene& scene, const Scene& sound, const std::string& what) {
  for (const Shader shader : {Shader::phong, Shader::lambert, Shader::material, Shader::normal}) {
    const Picture p = picture(scene, shader, 0.03), q = picture(sound, shader, 0.03);
    int other = 0, seen = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        if (q.ids(x, y) < 0) continue;
        ++seen;
        other += std::abs(p.color(x, y).r - q.color(x, y).r) > 30;
      }
    EXPECT_GT(seen, 1000) << what;
    EXPECT_LE(other, seen / 50) << what << ", shader " << name(shader);
  }
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Vertex normals that are zero or not finite. Right: such a corner has the normal of its face
// (docs/colours.md: unusable normals).
TEST(OddNormals, SayNothing) {
  Scene ball = shapes::scene_from_spec("sphere");
  Mesh& sound = ball.meshes.at(0);
  sound.normals = {};
  for (const Vec3& p : sound.positions) sound.normals.values.push_back(normalize(p));
  for (const bool turned : {false, true}) {
    if (turned)  // faces turn the other way than normals point
      for (std::size_t t = 0; t < sound.indices.size(); t += 3)
        std::swap(sound.indices[t], sound.indices[t + 1]);
    for (const auto& [bad, what] :
         {std::pair(Vec3{0, 0, 0}, "zero"), std::pair(Vec3{kNan, 0, 1}, "NaN")}) {
      Scene scene = ball;
      Mesh& mesh = scene.meshes[0];
      for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (i % 3 != 0) mesh.normals.values[i] = bad;
      expect_lit_as(scene, ball, std::string("some ") + what);
      // Values that corners name, as OBJ has them.
      mesh.normals.indices = mesh.indices;
      expect_lit_as(scene, ball, std::string("some of corners ") + what);
      if (turned) continue;  // without any usable normal, faces decide what is outside
      mesh.normals = {};
      mesh.normals.values.assign(mesh.positions.size(), bad);
      expect_lit_as(scene, ball, std::string("all ") + what);
    }
  }
}

// The same in OBJ and PLY. Right: such a corner has a computed normal, with one warning.
TEST(OddNormals, SayNothingInFiles) {
  const std::string square = "v -2 -2 0\nv 2 -2 0\nv 2 2 0\nv -2 2 0\nvn 0 0 0\nvn 0 0 1\n";
  const Scene sound = decoded(square + "f 1//2 2//2 3//2 4//2\n", "obj");
  const Scene scene = decoded(square + "f 1//1 2//2 3//1 4//1\n", "obj");
  expect_lit_as(scene, sound, "OBJ");
  EXPECT_EQ(sound.warnings.size(), 0U);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_NE(scene.warnings[0].find("the normals of 5 corners are zero"), std::string::npos)
      << scene.warnings[0];
  const Scene ply = decoded(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face 1\nproperty list "
      "uchar int vertex_indices\nend_header\n-2 -2 0 0 0 0\n2 -2 0 nan 0 0\n2 2 0 0 0 0\n"
      "-2 2 0 0 0 0\n4 0 1 2 3\n",
      "ply");
  expect_lit_as(ply, sound, "PLY");
  EXPECT_EQ(ply.warnings.size(), 1U);
}

// ---- colours

constexpr Vec4 kBrown{0x80 / 255.0F, 0x40 / 255.0F, 0x20 / 255.0F, 1};

/// A square with a display colour: of its vertices, its instance or both ways of a point.
Scene brown_square(bool of_instance) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  if (!of_instance) mesh.colors.values.assign(4, kBrown);
  scene.instances.emplace_back();
  if (of_instance) scene.instances[0].color = kBrown;
  return scene;
}
Scene brown_points() {
  Scene scene;
  Points& points = std::get<Points>(scene.geometries.emplace_back(Points{}));
  points.positions = {{0, 0, 0}};
  points.colors = {kBrown};
  points.point_size = 90;
  scene.instances.emplace_back().geometry = 0;
  return scene;
}
Scene brown_ball() {
  Scene scene;
  Spheres& ball = std::get<Spheres>(scene.geometries.emplace_back(Spheres{}));
  ball.centers = {{0, 0, 0}};
  ball.colors = {kBrown};
  ball.radius = 5;
  scene.instances.emplace_back().geometry = 0;
  return scene;
}
/// Far outside of the picture, and with a material.
Scene neighbour() {
  Scene scene = brown_square(true);
  scene.instances[0].color.reset();
  for (Vec3& p : scene.meshes[0].positions) p.x += 1000;
  scene.materials.emplace_back().name = "other";
  return scene;
}

// #804020 of vertices, instances, points, balls; a material beside. Right: the same display
// values; albedo is linear light (docs/colours.md).
TEST(OddColors, BesideMaterials) {
  for (const auto& [alone, what] :
       {std::pair(brown_square(false), "vertices"), std::pair(brown_square(true), "instance"),
        std::pair(brown_points(), "points"), std::pair(brown_ball(), "spheres")}) {
    Scene beside = alone;
    beside.append(neighbour());
    Scene behind = neighbour();
    behind.append(alone);
    for (const Shader shader : {Shader::flat, Shader::phong, Shader::material}) {
      const Picture a = picture(alone, shader);
      for (const Scene* scene : {&beside, &behind}) {
        const Picture b = picture(*scene, shader);
        const Rgba8 ca = a.color(48, 48), cb = b.color(48, 48);
        EXPECT_EQ(ca.r, cb.r) << what << ", " << name(shader);
        EXPECT_EQ(ca.g, cb.g) << what << ", " << name(shader);
        EXPECT_EQ(ca.b, cb.b) << what << ", " << name(shader);
        EXPECT_EQ(a.albedo(48, 48).x, b.albedo(48, 48).x) << what;
      }
      // 0x80 of a display is 0.2159 of its light.
      EXPECT_NEAR(a.albedo(48, 48).x, 0.2158605, 1e-6) << what;
      EXPECT_NEAR(a.albedo(48, 48).z, 0.0144438, 1e-6) << what;
      if (shader != Shader::flat) continue;
      EXPECT_EQ(a.color(48, 48).r, 0x80) << what;
      EXPECT_EQ(a.color(48, 48).g, 0x40) << what;
    }
  }
}

// A thing without a colour, beside one with a material. Right: it looks as it does alone
// (docs/colours.md: base colour).
TEST(OddColors, OfPlainThings) {
  Scene alone = brown_square(true);
  alone.instances[0].color.reset();
  Scene beside = alone;
  beside.append(neighbour());
  for (const Shader shader : {Shader::flat, Shader::material}) {
    const Picture a = picture(alone, shader), b = picture(beside, shader);
    EXPECT_EQ(a.color(48, 48).r, b.color(48, 48).r) << name(shader);
    EXPECT_EQ(a.color(48, 48).b, b.color(48, 48).b) << name(shader);
    EXPECT_EQ(a.albedo(48, 48).x, b.albedo(48, 48).x);
  }
}

}  // namespace

}  // namespace rastrum::test::scene_troubles
