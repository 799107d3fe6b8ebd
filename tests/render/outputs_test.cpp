// SPDX-License-Identifier: BSD-3-Clause
// The images of the surface at a pixel (Targets, docs/outputs.md): against a float64 oracle, and
// with the same bits on every backend.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/colors.hpp"
#include "tests/support/every_way.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/projection.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::outputs_test {
namespace {

constexpr int kW = 72, kH = 56;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

RenderOptions options() {
  return RenderOptions({.width = kW, .height = kH}, {.threads = 1});
}

Frame draw(const SceneView& scene, const Camera& camera, const RenderOptions& o,
           unsigned kinds = kSurfaces) {
  return test::draw(o, scene, camera, kinds);
}

/// How many pixels were checked for what, so that a test that checks nothing fails.
struct Seen {
  int pixels = 0, faces = 0, smooth = 0, depths = 0;
};

void check_pixel(const Frame& s, const SceneView& scene, const Camera& camera,
                 const std::vector<ProjectedTriangle>& projected, int x, int y, Seen& seen) {
  const auto id = static_cast<std::size_t>(s.ids(x, y));
  std::size_t instance = 0, t = id;
  while (t >= scene.instances[instance].mesh()->triangle_count())
    t -= scene.instances[instance++].mesh()->triangle_count();
  ASSERT_EQ(s.instances(x, y), static_cast<std::int64_t>(instance));
  ASSERT_EQ(s.primitives(x, y), static_cast<std::int64_t>(t));
  const MeshView& mesh = *scene.instances[instance].mesh();
  const auto a = exact_weights(projected[id], kW, kH, x, y);
  const Real sum = a[0] + a[1] + a[2];
  // Snapping may cover a sample just outside of a clipped triangle, where weights are clamped.
  if (std::ranges::any_of(a, [&](Real v) { return !(v / sum >= 0); })) return;
  ++seen.pixels;
  ASSERT_NEAR(s.barycentrics(x, y).x, static_cast<double>(a[1] / sum), 1e-5);
  ASSERT_NEAR(s.barycentrics(x, y).y, static_cast<double>(a[2] / sum), 1e-5);

  const Mat4d& m = scene.instances[instance].object_to_world;
  Point3 corner[3], p;
  Real size = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    corner[c] = transformed(m, mesh.positions[mesh.vertex(3 * t + c)]);
    p = p + corner[c] * (a[c] / sum);
    size = std::max(size, length(corner[c]));
  }
  ASSERT_LE(length(widen(s.positions(x, y)) - p), 1e-5 * size);

  // Normals against the cross product in the world, turned to the eye.
  const Mat4d view = world_to_camera(camera);
  const auto axis = [&](int i) { return Point3{view.m[i][0], view.m[i][1], view.m[i][2]}; };
  // On the ray of the pixel's centre by the camera's angle. The snapped triangle may be a little
  // beside it.
  const Real half = std::tan(Real(camera.fov_rad) / 2), smaller = std::min(kW, kH);
  const Real across = (x + Real(0.5) - Real(kW) / 2) * 2 * half / smaller;
  const Real down = (y + Real(0.5) - Real(kH) / 2) * 2 * half / smaller;
  const Point3 to_eye = camera.orthographic ? axis(2) : axis(2) - axis(0) * across + axis(1) * down;
  const Vec3 nc = s.camera_normals(x, y);
  const Point3 normal = widen(s.normals(x, y));
  if (length(normal) > 0) {
    ASSERT_NEAR(static_cast<double>(length(normal)), 1, 1e-6);
    ASSERT_GE(dot(normal, to_eye) / length(to_eye), -1e-5);
    for (int i = 0; i < 3; ++i)
      ASSERT_NEAR((&nc.x)[i], static_cast<double>(dot(axis(i), normal)), 1e-6);
    const Point3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
    const Point3 face = cross(e1, e2);
    if (mesh.normals.values.empty() && length(face) > 1e-3 * length(e1) * length(e2)) {
      ++seen.faces;
      ASSERT_GE(std::abs(dot(normal, face)) / length(face), 1 - 1e-5);
    }
    if (!mesh.normals.values.empty()) ++seen.smooth;
  }

  // Along the axis, at the precision of a float32 depth: its plane is rounded once per piece.
  const Real z = -(dot(axis(2), p) + view.m[2][3]);
  ASSERT_EQ(s.view_depth(x, y), static_cast<float>(view_distance(camera, s.depth(x, y))));
  if (projected[id].fate != Fate::whole || !(s.depth(x, y) > 0) || camera.orthographic) return;
  const float nearest =
      std::max({projected[id].snapped.v[0].depth, projected[id].snapped.v[1].depth,
                projected[id].snapped.v[2].depth});
  if (!(s.depth(x, y) > 0.05F * nearest) || !std::isinf(camera.far_plane)) return;
  const auto& v = projected[id].snapped.v;
  Real longest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Real dx = v[c].x_fx8 - v[(c + 1) % 3].x_fx8, dy = v[c].y_fx8 - v[(c + 1) % 3].y_fx8;
    longest = std::max(longest, dx * dx + dy * dy);
  }
  // The slope of a sliver's plane depends on the last bits of its corners.
  if (std::abs(twice_area(projected[id].snapped)) < Real(0.05) * longest) return;
  ++seen.depths;
  ASSERT_NEAR(s.view_depth(x, y), static_cast<double>(z), 1e-4 * static_cast<double>(z));
  const Real distance = length(p - widen(camera.eye));
  ASSERT_NEAR(s.distance(x, y), static_cast<double>(distance),
              5e-3 * static_cast<double>(distance));
}

TEST(Outputs, AreWhatAnOracleSaysOfTheVisibleTriangle) {
  const int scenes = share_of(400, 100);
  Seen seen;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(scenes); ++seed) {
    const GeneratedScene g = generate(seed, kW, kH);
    SCOPED_TRACE(g.kind + " " + std::to_string(seed));
    const SceneView scene = g.view();
    const Frame s = draw(scene, g.camera, options());
    const auto projected = project(scene, g.camera, kW, kH);
    for (const auto& [x, y] : pixels(kW, kH)) {
      if (s.ids(x, y) >= 0) {
        check_pixel(s, scene, g.camera, projected, x, y, seen);
        if (HasFatalFailure()) FAIL() << "at " << x << ", " << y;
        continue;
      }
      ASSERT_EQ(s.instances(x, y), -1);
      ASSERT_EQ(s.primitives(x, y), -1);
      ASSERT_EQ(s.barycentrics(x, y), Vec2{});
      ASSERT_EQ(s.positions(x, y), Vec3{});
      ASSERT_EQ(s.normals(x, y), Vec3{});
      ASSERT_EQ(s.camera_normals(x, y), Vec3{});
      ASSERT_EQ(s.view_depth(x, y), kInfinity);
      ASSERT_EQ(s.distance(x, y), kInfinity);
      ASSERT_EQ(s.albedo(x, y), Vec4{});
    }
  }
  EXPECT_GT(seen.pixels, 125 * scenes);
  EXPECT_GT(seen.faces, 25 * scenes);
  EXPECT_GT(seen.smooth, 2 * scenes);
  EXPECT_GT(seen.depths, 12 * scenes);
}

// Layers and samples too: of the surface with the largest key, wherever its key came from.
TEST(Outputs, AreTheSameBitsWhateverDraws) {
  // Few scenes of each kind, with half of the four ways to draw.
  const auto seeds = static_cast<std::uint64_t>(share_of(24, kSceneKinds));
  const bool half = test_share() < 100;
  for (const int samples : {1, 4})
    for (const float opacity : {1.0F, 0.5F})
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        if (half && (seed % 2 == 0) != ((samples == 1) == (opacity == 1))) continue;
        const GeneratedScene g = generate(seed, kW, kH);
        RenderOptions base = options();
        base.samples = samples;
        base.opacity = opacity;
        SCOPED_TRACE(g.kind + " " + std::to_string(seed));
        EveryWay(base, {{.threads = 1},
                        {.threads = 2},
                        {.threads = 8},
                        {.memory_limit = 6 << 20, .threads = 1, .isa = available_isas().back()}})
            .same([&](const RenderOptions& o) { return draw(g.view(), g.camera, o); });
      }
}

/// Two triangles, the nearer one in the left half.
struct Two {
  std::vector<Vec3> near{{-2, -2, 1}, {0, -2, 1}, {-1, 4, 1}},
      far{{-4, -4, 0}, {4, -4, 0}, {0, 8, 0}};
  KeptInstances instances{MeshView{.positions = near}, MeshView{.positions = far}};
  Camera camera{.eye = {0, 0, 4}};
  [[nodiscard]] SceneView scene() const { return {.instances = instances}; }
};

// A shader that computes normals passes them to the image; without one they are computed
// separately.
TEST(Outputs, NormalsAreTheSameWhateverShades) {
  for (const int samples : {1, 4})
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
      const GeneratedScene g = generate(seed, kW, kH);
      RenderOptions o = options();
      o.samples = samples;
      const Frame alone = draw(g.view(), g.camera, o, kNormals | kCameraNormals);
      for (const Shader shader : {Shader::flat, Shader::lambert, Shader::phong, Shader::material})
        for (const float opacity : {1.0F, 0.5F}) {
          o.shader = shader;
          o.opacity = opacity;
          const Frame shaded = draw(g.view(), g.camera, o, kColor8 | kNormals | kCameraNormals);
          ASSERT_TRUE(same_images(alone, shaded, kNormals | kCameraNormals))
              << g.kind << " " << seed;
        }
    }
}

// Blocks with a lit mesh and a sphere: each shader finds its own normals.
TEST(Outputs, NormalsBesideSpheresAreTheSameWhateverShades) {
  Two two;
  const std::vector<Vec3> centres{{0.3F, 0.2F, 0.9F}, {-0.6F, -0.4F, 1.1F}};
  two.instances.add(SpheresView{.centers = centres, .radius = 0.5F});
  RenderOptions o = options();
  const Frame alone = draw(two.scene(), two.camera, o, kNormals);
  o.shader = Shader::phong;
  EXPECT_TRUE(same_images(alone, draw(two.scene(), two.camera, o, kColor8 | kNormals), kNormals));
  EXPECT_GT(std::ranges::count(alone.normals.pixels(), Vec3{0, 0, 1}), 100);
}

// With several samples, the largest key may belong to a triangle that misses the centre. Its normal
// must not extrapolate beyond its corners, however small it is.
TEST(Outputs, NormalsOfSeveralSamplesLieBetweenThoseOfTheCorners) {
  const Mesh ball = shapes::sphere(100, 200);  // triangles of a third of a pixel
  std::vector<Vec3> corners, of_corners;
  for (std::size_t i = 0; i < ball.indices.size(); ++i) {
    corners.push_back(ball.positions[ball.indices[i]]);
    of_corners.push_back(Vec3{i % 3 == 0 ? 1.0F : 0, i % 3 == 1 ? 1.0F : 0, i % 3 == 2 ? 1.0F : 0});
  }
  const OneInstance instance(MeshView{.positions = corners, .normals = {.values = of_corners}});
  RenderOptions o = options();
  o.samples = 4;
  const Frame f = draw(instance.view(), {.eye = {0, 0, 4}}, o, kNormals);
  int seen = 0;
  for (const Vec3 n : f.normals.pixels()) {
    if (n == Vec3{}) continue;
    ++seen;
    // Between the three axes or, turned to the viewer, between their opposites.
    const auto [least, most] = std::minmax({n.x, n.y, n.z});
    ASSERT_TRUE(least >= 0 || most <= 0) << n.x << ' ' << n.y << ' ' << n.z;
  }
  EXPECT_GT(seen, 500);
}

TEST(Outputs, NameInstancesAsTheirCallerDoes) {
  Two two;
  two.instances[1].id = -77;
  const Frame s = draw(two.scene(), two.camera, options());
  EXPECT_EQ(s.instances(kW / 4 + 4, kH / 2), 0);
  EXPECT_EQ(s.instances(3 * kW / 4, kH / 2), -77);
  EXPECT_EQ(s.primitives(3 * kW / 4, kH / 2), 0);
}

TEST(Outputs, OverAPictureKeepWhatTheyHoldWhereNothingReaches) {
  Two two;
  Frame s(kW, kH, kSurfaces);
  std::ranges::fill(s.depth.pixels(), 0.0F);
  for (const auto& [x, y] : pixels(kW / 2, kH)) s.depth(x, y) = 1;
  std::ranges::fill(s.ids.pixels(), std::int64_t{9});
  std::ranges::fill(s.positions.pixels(), Vec3{7, 8, 9});
  Painter(options()).render(two.scene(), two.camera, s.targets(), {.over = true});
  EXPECT_EQ(s.positions(kW / 4, kH / 2), (Vec3{7, 8, 9}));
  EXPECT_EQ(s.ids(kW / 4, kH / 2), 9);
  EXPECT_EQ(s.ids(3 * kW / 4, kH / 2), 1);
  EXPECT_NEAR(s.positions(3 * kW / 4, kH / 2).z, 0, 1e-6);
}

TEST(Outputs, InPassesAreThoseOfThePassThatIsNearest) {
  Two two;
  Frame s(kW, kH, kSurfaces), all = draw(two.scene(), two.camera, options());
  Image<std::uint64_t> keys(kW, kH);
  Painter painter(options());
  for (std::size_t pass = 0; pass < 2; ++pass) {
    Targets targets = s.targets();
    targets.keys = keys;
    painter.render({.instances = {&two.instances[pass], 1}}, two.camera, targets,
                   {.load = pass != 0, .first_id = pass});
  }
  EXPECT_TRUE(same_images(s, all, kIds | kPositions | kNormals));
}

/// A quad that fills the picture, with corner colours and a texture of one texel.
struct Painted {
  Mesh mesh;
  std::vector<Material> materials{1};
  std::vector<Texture> textures{1};
  KeptInstances instances;
  Camera camera{.eye = {0, 0, 3}};

  Painted() {
    mesh.positions = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.colors.values = {{0.5F, 1, 1, 1}, {0.5F, 1, 1, 1}, {0.5F, 1, 1, 1}, {0.5F, 1, 1, 1}};
    mesh.texcoords.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    textures[0].image = Image<Rgba8>(1, 1);
    textures[0].image(0, 0) = {255, 255, 0, 128};
    materials[0].base_color = {0.5F, 0.25F, 1, 0.5F};
    materials[0].base_color_texture = 0;
    materials[0].emissive = {3, 0, 0};
    instances.add(mesh.view());
  }
  [[nodiscard]] SceneView scene() const { return {instances, materials, textures}; }
};

TEST(Outputs, AlbedoIsTheBaseColourBeforeLightWhateverTheShader) {
  Painted p;
  for (const Shader shader : {Shader::material, Shader::phong, Shader::depth}) {
    RenderOptions o = options();
    o.shader = shader;
    const Frame s = draw(p.scene(), p.camera, o);
    const Vec4 got = s.albedo(kW / 2, kH / 2);
    EXPECT_NEAR(got.x, 0.5 * light_of(0.5), 1e-6);
    EXPECT_NEAR(got.y, 0.25, 1e-6);
    EXPECT_EQ(got.z, 0);
    EXPECT_NEAR(got.w, 0.5 * 128 / 255, 1e-6);
  }
  const OneInstance bare(MeshView{.positions = p.mesh.positions, .indices = p.mesh.indices});
  const Frame plain = draw(bare.view(), p.camera, options());
  EXPECT_EQ(plain.albedo(kW / 2, kH / 2), plain_material(false).base_color);
}

TEST(Outputs, LinearLightIsTheColourBeforeItsTransferAndChangesNoOther) {
  Painted p;
  for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::blend})
    for (const Isa isa : available_isas()) {
      p.materials[0].alpha_mode = mode;
      RenderOptions o = options();
      o.isa = isa;
      o.background = {0.2F, 0.4F, 0.6F, 1};
      o.shader = Shader::material;
      const Frame f = draw(p.scene(), p.camera, o, kColor8 | kColor | kLinear);
      EXPECT_TRUE(same_images(f, draw(p.scene(), p.camera, o, kColor8 | kColor), kColor8 | kColor));
      bool bright = false;
      for (const auto& [x, y] : pixels(kW, kH)) {
        const Vec4 l = f.linear(x, y), c = f.color(x, y);
        ASSERT_NEAR(display(double{l.x}), c.x, 1e-4);
        ASSERT_NEAR(display(double{l.y}), c.y, 1e-4);
        ASSERT_EQ(l.w, c.w);
        bright |= l.x > 1;
      }
      EXPECT_EQ(bright, mode == AlphaMode::opaque) << "the emission is not cut";
    }
}

/// Pictures larger than any cache are written past it, in lines that begin anywhere. The pixels
/// must equal the scalar form's, which writes normally, and nothing beside them may be written.
TEST(Outputs, LargePicturesAreTheSameWhereverTheyLie) {
  constexpr int kSide = 2560, kPitch = kSide + 5, kFirst = 3;
  constexpr Rgba8 kElse{7, 7, 7, 7};
  const Mesh mesh = shapes::sphere(5, 8);
  const OneInstance instance(mesh.view());
  const SceneView scene = instance.view();
  RenderOptions o = options();
  o.width = o.height = kSide;
  o.shader = Shader::phong;
  o.background = {0.1F, 0.3F, 0.2F, 0.5F};
  const auto picture = [&](Isa isa) {
    std::vector<Rgba8> pixels(static_cast<std::size_t>(kPitch) * kSide + kFirst, kElse);
    Targets targets{.color8 = {pixels.data() + kFirst, kSide, kSide, kPitch}};
    o.isa = isa;
    Painter(o).render(scene, fit_camera(scene, Camera{}.fov_rad, false), targets);
    return pixels;
  };
  const std::vector<Rgba8> expected = picture(Isa::scalar);
  EXPECT_EQ(expected[kFirst - 1], kElse);
  EXPECT_EQ(expected[kFirst + kSide], kElse);
  EXPECT_EQ(expected[kFirst].a, 128);
  EXPECT_EQ(expected[kFirst + std::size_t{kPitch} * (kSide / 2) + kSide / 2].a, 255);
  for (const Isa isa : available_isas()) EXPECT_TRUE(picture(isa) == expected) << name(isa);
}

TEST(Outputs, RefuseWhatTheyAreNotFor) {
  const Two two;
  Painter painter(options());
  Image<Vec3> small(kW, kH - 1), positions(kW, kH);
  Image<Vec4> linear(kW, kH);
  expect_refused("positions target is 72x55", Errc::invalid_argument,
                 [&] { painter.render(two.scene(), two.camera, {.positions = small}); });
  expect_refused("normals target: rows", Errc::invalid_argument, [&] {
    Targets t{.normals = positions};
    t.normals.stride = kW / 2;
    painter.render(two.scene(), two.camera, t);
  });
  expect_refused("'material'", Errc::unsupported,
                 [&] { painter.render(two.scene(), two.camera, {.linear = linear}); });
  RenderOptions in_place = options();
  in_place.in_place = true;
  if (Painter(in_place).options().device == Device::cuda)
    expect_refused("only the targets color8", Errc::unsupported, [&] {
      Painter(in_place).render(two.scene(), two.camera, {.positions = positions});
    });
  const Program program(
      [](std::uint32_t i) {
        return VertexOutput<Vec3>{{i == 1 ? 3.0F : -1.0F, i == 2 ? 3.0F : -1.0F, 0.5F, 1}, {}};
      },
      [](const Vec3&, const Fragment&) {
        return Vec4{1, 1, 1, 1};
      });
  const ProgramDraw own = program.draw(3);
  Renderer renderer(options());
  expect_refused("positions target needs a scene", Errc::unsupported, [&] {
    renderer.draw({&own, 1}, options(), {.positions = positions});
  });
  // Targets that need no scene are still drawn.
  Image<std::int64_t> instances(kW, kH), primitives(kW, kH);
  Image<Vec2> barycentrics(kW, kH);
  renderer.draw({&own, 1}, options(),
                {.instances = instances, .primitives = primitives, .barycentrics = barycentrics});
  EXPECT_EQ(instances(0, kH - 1), 0);
  EXPECT_EQ(primitives(0, kH - 1), 0);
  EXPECT_NEAR(barycentrics(0, kH - 1).x, 0.5 / kW / 2, 1e-5);
  // This camera's depths do not give distances.
  Camera tilted = two.camera;
  tilted.matrix = world_to_clip(two.camera, kW, kH);
  tilted.matrix->m[2][0] += 0.1;
  Image<float> distance(kW, kH);
  expect_refused("planes of equal depth", Errc::invalid_argument,
                 [&] { painter.render(two.scene(), tilted, {.distance = distance}); });
}

}  // namespace
}  // namespace rastrum::test::outputs_test
