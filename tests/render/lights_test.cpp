// SPDX-License-Identifier: BSD-3-Clause
// A frame's own lights: against their formulas in float64 on a sphere, against the equivalent fixed
// light, and with the same bits on every backend.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/environment.hpp>
#include <rastrum/light.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/surfaces.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/light_oracle.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::lights_test {
namespace {

using namespace light_oracle;

constexpr int kSize = 96;

/// A ball of radius 1 around the origin; a quadric, so its normals are exact.
struct Ball {
  std::vector<Vec3> centre{{0, 0, 0}};
  KeptInstances instances{SpheresView{.centers = centre, .radius = 1}};
  std::vector<Material> materials;

  Ball() = default;
  Ball(const Ball&) = delete;  // the views refer to this object
  Ball& operator=(const Ball&) = delete;
  [[nodiscard]] SceneView view() const { return {instances, materials, {}, {}}; }
};

Camera camera(bool orthographic) {
  Camera c{.eye = {1.5, 1, 3},
           .orthographic = orthographic,
           .orthographic_height = 2.5F,
           .near_plane = 0.5F};
  if (orthographic) c.far_plane = 20;
  return c;
}

Image<Vec4> draw(const SceneView& scene, const Camera& seen_by, FrameOptions frame,
                 const RendererOptions& options = {.threads = 1}) {
  frame.width = frame.height = kSize;
  Image<Vec4> color(kSize, kSize);
  Renderer(options).render(scene, seen_by, frame, {.color = color});
  return color;
}

/// Expects the same light where both see the ball.
void expect_near(const Image<Vec4>& a, const Image<Vec4>& b) {
  int seen = 0;
  for (const auto& [x, y] : pixels(kSize, kSize)) {
    if (a(x, y).w == 0 || b(x, y).w == 0) continue;
    ++seen;
    ASSERT_NEAR(a(x, y).x, b(x, y).x, 1.0 / 255) << x << ", " << y;
  }
  EXPECT_GT(seen, 1500);
}

FrameOptions lit_by(std::vector<Light> lights, Shader shader) {
  return FrameOptions{.shader = shader, .lights = std::move(lights)};
}

/// An environment of three polynomials of degree 2 with factors for its bands 1 and 2. Factors of 1
/// give the light itself, a surface's factors what it gathers or mirrors.
Vec3d sky(Vec3d w, double first = 1, double second = 1) {
  return {0.5 + first * (0.3 * w.y - 0.1 * w.x), 0.5 + second * 0.7 * w.x * w.z,
          0.4 + first * 0.1 * w.z + second * 0.4 * (w.y * w.y - 1.0 / 3)};
}
Environment made_sky() {
  constexpr int kRows = 64;
  Image<Vec3> picture(2 * kRows, kRows);
  for (const auto& [x, y] : pixels(2 * kRows, kRows)) {
    const double across = std::numbers::pi * ((x + 0.5) / kRows - 1),
                 down = std::numbers::pi * (y + 0.5) / kRows;
    picture(x, y) = Vec3(sky(
        {std::sin(down) * std::sin(across), std::cos(down), -std::sin(down) * std::cos(across)}));
  }
  return Environment(picture.view());
}
const Environment& sky_picture() {
  static const Environment once = made_sky();
  return once;
}
/// The factors of bands 1 and 2 for facets of a roughness seen from above. Facets turn the light by
/// twice their own angle; GGX's density and the light's cosine are the weights.
std::pair<double, double> mirrored_bands(double roughness) {
  const double alpha2 = std::pow(roughness, 4);
  double sum = 0, first = 0, second = 0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double facet = (i + 0.5) / kSteps * std::numbers::pi / 4, c = std::cos(facet);
    const double lobe = c * c * (alpha2 - 1) + 1, light = std::cos(2 * facet);
    const double share = c * std::sin(facet) / (lobe * lobe) * light;
    sum += share;
    first += share * light;
    second += share * (3 * light * light - 1) / 2;
  }
  return {first / sum, second / sum};
}

/// The same light in world coordinates, if it moves with the camera.
Light in_world(Light l, const Camera& c) {
  if (!l.of_camera) return l;
  const Mat4d m = world_to_camera(c);
  const auto turned = [&](Vec3d v) {
    return Vec3d{m.m[0][0] * v.x + m.m[1][0] * v.y + m.m[2][0] * v.z,
                 m.m[0][1] * v.x + m.m[1][1] * v.y + m.m[2][1] * v.z,
                 m.m[0][2] * v.x + m.m[1][2] * v.y + m.m[2][2] * v.z};
  };
  if (auto* const d = std::get_if<DirectionalLight>(&l.kind))
    d->direction = Vec3(turned(wide(d->direction)));
  if (auto* const h = std::get_if<HemisphereLight>(&l.kind)) h->up = Vec3(turned(wide(h->up)));
  if (auto* const p = std::get_if<PointLight>(&l.kind)) p->position = turned(p->position) + c.eye;
  if (auto* const s = std::get_if<SpotLight>(&l.kind)) {
    s->position = turned(s->position) + c.eye;
    s->direction = Vec3(turned(wide(s->direction)));
  }
  return l;
}

/// light_oracle::around; for the environment, what a direction gathers or what a surface of a
/// roughness mirrors from there.
std::optional<Vec3d> all_around(const Light& l, Vec3d d, std::optional<double> roughness = {}) {
  if (!std::holds_alternative<EnvironmentLight>(l.kind)) return around(l, d);
  const auto [first, second] = roughness ? mirrored_bands(*roughness) : std::pair{2.0 / 3, 1.0 / 4};
  return times(wide(l.color) * l.intensity, sky(d, first, second));
}

/// The colour by `lambert`, or by `phong` if `shines`.
Vec3d expected_display(const std::vector<Light>& lights, bool shines, Vec3d p, Vec3d n, Vec3d v) {
  const Vec3d base{0.8, 0.7, 0.6};
  Vec3d sum;
  for (const Light& l : lights) {
    if (const auto from_around = all_around(l, n)) {
      sum = sum + times(base, *from_around);
      continue;
    }
    const Arrived in = arrived(l, p);
    const double n_l = dot(n, in.to_light);
    if (n_l <= 0) continue;
    sum = sum + times(base, in.radiance) * n_l;
    const double n_h = std::max(dot(n, unit(v + in.to_light)), 0.0);
    if (shines) sum = sum + in.radiance * (0.375 * std::pow(n_h, 32));
  }
  return sum;
}

/// The colour by `classic` without a texture.
Vec3d expected_classic(const std::vector<Light>& lights, const Material& m, Vec3d p, Vec3d n,
                       Vec3d v) {
  const auto shown = [](Vec3d c) { return Vec3d{display(c.x), display(c.y), display(c.z)}; };
  const Vec3d base = shown(wide({m.base_color.x, m.base_color.y, m.base_color.z}));
  Vec3d sum = base * m.classic.emission;
  for (const Light& l : lights) {
    Light of_display = l;
    of_display.color = Vec3(shown(wide(l.color)));
    if (auto* const h = std::get_if<HemisphereLight>(&of_display.kind))
      h->below = Vec3(shown(wide(h->below)));
    if (const auto from_around = around(of_display, n)) {
      sum = sum + times(base, *from_around);
      continue;
    }
    Arrived in = arrived(of_display, p);
    Vec3d ambient, diffuse = in.radiance, specular = in.radiance;
    if (l.classic) {
      const auto* const point = std::get_if<PointLight>(&l.kind);
      const auto* const spot = std::get_if<SpotLight>(&l.kind);
      double share = 1;
      if (point != nullptr || spot != nullptr) {
        const double d = length((point != nullptr ? point->position : spot->position) - p);
        const Vec3 a = l.classic->attenuation;
        share = 1 / (a.x + a.y * d + a.z * d * d);
      }
      if (spot != nullptr) {
        const double cosine = -dot(unit(wide(spot->direction)), in.to_light);
        share *= cosine >= std::cos(spot->outer_rad) ? std::pow(cosine, l.classic->exponent) : 0;
      }
      ambient = wide(l.classic->ambient) * share;
      diffuse = wide(l.classic->diffuse) * share;
      specular = wide(l.classic->specular) * share;
    }
    const double n_l = dot(n, in.to_light);
    sum = sum + times(base, ambient + diffuse * std::max(n_l, 0.0));
    const double n_h = std::max(dot(n, unit(v + in.to_light)), 0.0);
    if (n_l > 0)
      sum = sum + specular * (m.classic.specular * std::pow(n_h, 128 * m.classic.shininess));
  }
  const auto limited = [](double c) { return std::min(c, 1.0); };
  return {limited(sum.x), limited(sum.y), limited(sum.z)};
}

/// The colour of a material without textures, in linear light.
Vec3d expected_linear(const std::vector<Light>& lights, const Material& m, Vec3d p, Vec3d n,
                      Vec3d v) {
  const Vec3d base = wide({m.base_color.x, m.base_color.y, m.base_color.z});
  const Vec3d one{1, 1, 1};
  const Vec3d f0 = one * (0.04 * (1 - m.metallic)) + base * m.metallic;
  const Vec3d diffuse = base * (1 - m.metallic);
  const double alpha = static_cast<double>(m.roughness) * m.roughness, alpha2 = alpha * alpha;
  const double nv = std::max(dot(n, v), 1e-4);
  Vec3d sum;
  for (const Light& l : lights) {
    if (const auto of_n = all_around(l, n)) {
      const Vec3d of_r = *all_around(l, n * (2 * dot(n, v)) - v, m.roughness);
      const auto rise = [&](double c) { return std::max(1 - m.roughness - c, 0.0); };
      const Vec3d f =
          f0 + Vec3d{rise(f0.x), rise(f0.y), rise(f0.z)} * std::pow(std::max(1 - nv, 0.0), 5);
      sum = sum + times(diffuse, *of_n) + times(f, of_r);
      continue;
    }
    const Arrived in = arrived(l, p);
    const double nl = dot(n, in.to_light);
    if (nl <= 0) continue;
    const Vec3d h = unit(v + in.to_light);
    const double nh = std::max(dot(n, h), 0.0), vh = std::max(dot(v, h), 0.0);
    const double lobe = nh * nh * (alpha2 - 1) + 1;
    const double specular =
        alpha2 / (lobe * lobe) * 0.5 / (2 * nl * nv * (1 - alpha) + (nl + nv) * alpha);
    const Vec3d f = f0 + (one - f0) * std::pow(1 - vh, 5);
    sum = sum + times(times(diffuse, one - f) + f * specular, in.radiance) * nl;
  }
  return sum;
}

/// Calls f(x, y, place, direction to the viewer) for pixels whose centres see the ball.
template <class F>
void each_pixel(const Camera& c, F&& f) {
  const Mat4d to_camera = world_to_camera(c);
  const auto axis = [&](int i) {
    return Vec3d{to_camera.m[i][0], to_camera.m[i][1], to_camera.m[i][2]};
  };
  const Vec3d right = axis(0), up = axis(1), ahead = axis(2) * -1;
  const double half =
      c.orthographic ? c.orthographic_height / 2.0 : std::tan(static_cast<double>(c.fov_rad) / 2);
  for (const auto& [x, y] : pixels(kSize, kSize)) {
    const double a = ((x + 0.5) * 2 / kSize - 1) * half, b = (1 - (y + 0.5) * 2 / kSize) * half;
    const Vec3d across = right * a + up * b;
    const Vec3d from = c.orthographic ? c.eye + across : c.eye;
    const Vec3d d = unit(c.orthographic ? ahead : ahead + across);
    const double along = -dot(from, d), miss = dot(from, from) - along * along;
    if (miss < 1) f(x, y, from + d * (along - std::sqrt(1 - miss)), d * -1);
  }
}

Light classic_light(decltype(Light::kind) kind, const ClassicLight& classic) {
  Light l = light(kind, 7, {0.1F, 0.2F, 0.3F});  // which do not count
  l.classic = classic;
  return l;
}

/// Lights of every kind but environments, for Shader::classic.
std::vector<std::vector<Light>> sets_of_classic_lights() {
  const SpotLight spot{{1, 1.5, 2}, {-1, -1.4F, -1.6F}, 4, 0.1F, 0.4F};
  std::vector<std::vector<Light>> sets{
      {light(AmbientLight{}, 0.4F, {1, 0.5F, 0.25F})},
      {light(HemisphereLight{{1, 2, -1}, {0.3F, 0.1F, 0}}, 0.7F, {0.4F, 0.6F, 1})},
      {light(DirectionalLight{{-3, -2, -1}}, 0.9F, {1, 0.9F, 0.8F})},
      {light(PointLight{{-0.5, 1, 2}, 2.2F}, 2, {0.5F, 1, 0.5F})},
      {light(spot, 3)},
      {classic_light(DirectionalLight{{-3, -2, -1}},
                     {{0.1F, 0.2F, 0.3F}, {0.4F, 0.5F, 0.6F}, {0.9F, 0.8F, 0.7F}})},
      {classic_light(PointLight{{0.8, 1.2, 1.1}, 0.5F},
                     {{0.2F, 0.1F, 0.1F}, {1, 1, 1}, {0.5F, 0.5F, 1}, {0.2F, 0.5F, 0.25F}})},
      {classic_light(spot, {.diffuse = {2, 1, 1}, .attenuation = {0, 0, 0.5F}, .exponent = 10.5F})},
      {classic_light(spot, {})},
      {headlight(0.8F)}};
  Light of_camera = classic_light(SpotLight{{1, 1, 0}, {-0.2F, -0.3F, -1}}, {.exponent = 3});
  of_camera.of_camera = true;
  sets.push_back({of_camera});
  std::vector<Light> all = all_dimmed(sets);
  for (Light& l : all)
    if (l.classic) l.classic->diffuse = l.classic->diffuse * 0.3F;
  sets.push_back(all);
  return sets;
}

/// Lights of every kind, alone and together.
std::vector<std::vector<Light>> sets_of_lights() {
  std::vector<std::vector<Light>> sets{
      {light(AmbientLight{}, 0.4F, {1, 0.5F, 0.25F})},
      {light(HemisphereLight{{1, 2, -1}, {0.3F, 0.1F, 0}}, 0.7F, {0.4F, 0.6F, 1})},
      {light(DirectionalLight{{-3, -2, -1}}, 0.9F, {1, 0.9F, 0.8F})},
      {light(PointLight{{0.8, 1.2, 1.1}}, 0.6F)},
      {light(PointLight{{-0.5, 1, 2}, 2.2F}, 2, {0.5F, 1, 0.5F})},
      {light(SpotLight{{1, 1.5, 2}, {-1, -1.4F, -1.6F}}, 3)},
      {light(SpotLight{{1, 1.5, 2}, {-1, -1.4F, -1.6F}, 4, 0.2F, 0.3F}, 3, {1, 0, 0.5F})},
      {headlight(0.8F)},
      light_kit()};
  for (Light l : {light(HemisphereLight{{1, 2, -1}, {0.3F, 0.1F, 0}}, 0.7F),
                  light(PointLight{{-0.8, 1, -2}}, 1.5F),
                  light(SpotLight{{1, 1, 0}, {-0.2F, -0.3F, -1}}, 5)}) {
    l.of_camera = true;
    sets.push_back({l});
  }
  Light all_around = light(EnvironmentLight{sky_picture()}, 0.9F, {1, 0.9F, 0.8F});
  sets.push_back({all_around});
  sets.push_back(all_dimmed(sets));
  return sets;
}

TEST(Lights, AreTheirFormulasOnASphere) {
  Ball ball;
  Material matt, metal;
  matt.base_color = {0.7F, 0.5F, 0.3F, 1};
  matt.metallic = 0.2F;
  matt.roughness = 0.6F;
  for (const bool orthographic : {false, true})
    for (const std::vector<Light>& lights : sets_of_lights())
      for (const Shader shader : {Shader::lambert, Shader::phong, Shader::material}) {
        const bool is_material = shader == Shader::material;
        ball.materials.clear();
        if (is_material) ball.materials.push_back(matt);
        const Camera seen_by = camera(orthographic);
        std::vector<Light> placed_lights;
        for (const Light& l : lights) placed_lights.push_back(in_world(l, seen_by));
        const Image<Vec4> color = draw(ball.view(), seen_by, lit_by(lights, shader));
        double worst = 0;
        int seen = 0;
        each_pixel(seen_by, [&](int x, int y, Vec3d p, Vec3d v) {
          const Vec4 c = color(x, y);
          if (c.w == 0) return;  // rounding may end the ball here
          ++seen;
          Vec3d e = is_material ? expected_linear(placed_lights, matt, p, p, v)
                                : expected_display(placed_lights, shader == Shader::phong, p, p, v);
          if (is_material) e = {display(e.x), display(e.y), display(e.z)};
          worst = std::max({worst, std::abs(c.x - e.x), std::abs(c.y - e.y), std::abs(c.z - e.z)});
        });
        EXPECT_GT(seen, 1500);
        EXPECT_LE(worst, 1.0 / 255) << name(shader) << ", " << lights.size() << " lights of kind "
                                    << lights.front().kind.index();
      }
}

TEST(Lights, AreOpenGlsFormulaOnASphere) {
  Ball ball;
  const std::vector<ClassicMaterial> looks{{}, {0.8F, 1, 0.1F}, {1, 0, 0}, {0.3F, 0.03F, 0}};
  for (const bool orthographic : {false, true})
    for (const std::vector<Light>& lights : sets_of_classic_lights())
      for (const ClassicMaterial& look : looks) {
        Material m;
        m.base_color = {0.7F, 0.5F, 0.3F, 1};
        m.classic = look;
        ball.materials = {m};
        const Camera seen_by = camera(orthographic);
        std::vector<Light> placed_lights;
        for (const Light& l : lights) placed_lights.push_back(in_world(l, seen_by));
        const Image<Vec4> color = draw(ball.view(), seen_by, lit_by(lights, Shader::classic));
        int seen = 0, at_edges = 0;
        each_pixel(seen_by, [&](int x, int y, Vec3d p, Vec3d v) {
          const Vec4 c = color(x, y);
          if (c.w == 0) return;  // rounding may end the ball here
          ++seen;
          const Vec3d e = expected_classic(placed_lights, m, p, p, v);
          const double off =
              std::max({std::abs(c.x - e.x), std::abs(c.y - e.y), std::abs(c.z - e.z)});
          // Rounding may move the edge of a cone, and that of the lit half where light is mirrored.
          at_edges += off > 1.0 / 255 ? 1 : 0;
        });
        EXPECT_GT(seen, 1500);
        EXPECT_LE(at_edges, seen / 500)
            << lights.size() << " lights of kind " << lights.front().kind.index() << ", shininess "
            << look.shininess;
      }
}

TEST(Lights, WithoutAnyClassicHasAHeadlight) {
  Ball ball;
  ball.materials.resize(1);
  EXPECT_EQ(digest(draw(ball.view(), camera(false), lit_by({}, Shader::classic))),
            digest(draw(ball.view(), camera(false), lit_by({headlight()}, Shader::classic))));
}

TEST(Lights, OfClassicAreCutBeforeTheTexture) {
  // Two texels across, bright enough light for more than white, and a material's own colour.
  Texture texture;
  texture.image = {2, 1};
  texture.image(0, 0) = {128, 64, 255, 255};
  texture.image(1, 0) = {0, 200, 10, 255};
  texture.mag = texture.min = TextureFilter::nearest;
  texture.mipmaps = false;
  Material m;
  m.base_color = {1, 1, 0.5F, 1};
  m.base_color_texture = 0;
  m.classic.specular = 0;
  Mesh wall;
  wall.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  wall.indices = {0, 1, 2, 0, 2, 3};
  wall.texcoords.values = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  const KeptInstances instances{wall.view()};
  const std::vector<Material> materials{m};
  const std::vector<Texture> textures{texture};
  const Camera ahead{
      .eye = {0, 0, 3}, .orthographic = true, .orthographic_height = 2, .far_plane = 9};
  const auto lit = [&](float intensity) {
    return draw({instances, materials, textures, {}}, ahead,
                lit_by({light(AmbientLight{}, intensity)}, Shader::classic));
  };
  const double blue = display(0.5);
  for (const float intensity : {0.5F, 3.0F}) {
    const Image<Vec4> color = lit(intensity);
    const auto cut = [&](double base) { return std::min(1.0, base * intensity); };
    EXPECT_NEAR(color(10, 50).x, cut(1) * 128 / 255, 1e-4);
    EXPECT_NEAR(color(10, 50).y, cut(1) * 64 / 255, 1e-4);
    EXPECT_NEAR(color(10, 50).z, cut(blue), 1e-4);
    EXPECT_NEAR(color(80, 50).y, cut(1) * 200 / 255, 1e-4);
  }
}

TEST(Lights, OfClassicAreInRange) {
  Ball ball;
  ball.materials.resize(1);
  const auto refuses = [&](const Light& l, const char* part) {
    expect_refused(part,
                   [&] { (void)draw(ball.view(), camera(false), lit_by({l}, Shader::classic)); });
  };
  refuses(classic_light(PointLight{}, {.ambient = {-1, 0, 0}}),
          "light 0: its classic colours must lie in [0, 1e12]");
  refuses(classic_light(PointLight{}, {.attenuation = {0, 0, 0}}),
          "three numbers in [0, 1e12] of which one is not 0");
  refuses(classic_light(SpotLight{}, {.exponent = 129}), "its exponent must lie in [0, 128]");
  refuses(classic_light(AmbientLight{}, {}),
          "its classic part is for directional lights, points and spots");
  refuses(light(EnvironmentLight{sky_picture()}), "the shader classic has no environments");
  ball.materials[0].classic.shininess = 1.5F;
  refuses(headlight(), "material 0: specular and emission");
}

TEST(Lights, SayTheFixedLightOfPhong) {
  Ball ball;
  const auto fixed = draw(ball.view(), camera(false), lit_by({}, Shader::phong));
  const auto said =
      draw(ball.view(), camera(false),
           lit_by({light(AmbientLight{}, 0.1F), light(DirectionalLight{{-0.4F, -0.6F, -1}}, 0.8F)},
                  Shader::phong));
  expect_near(fixed, said);
}

/// Meshes, a ball, points with and without normals, and translucent things.
struct Mixture {
  Mesh knot = shapes::torus_knot(2, 3, 60, 8);
  std::vector<Vec3> places, normals;
  KeptInstances instances;

  Mixture() {
    for (int i = 0; i < 40; ++i) {
      const auto t = static_cast<float>(i);
      places.push_back({1.3F * std::cos(t), 0.04F * t - 0.8F, 1.3F * std::sin(t)});
      normals.push_back({std::cos(t), 0.3F, std::sin(t)});
    }
    instances.add(knot.view());
    instances.add(SpheresView{.centers = places, .radius = 0.2F}).opacity = 0.6F;
    instances.add(PointsView{.positions = places, .normals = normals, .point_size = 9},
                  translation({0.3, 0, 0}));
  }
  [[nodiscard]] SceneView scene() const { return {instances, {}, {}, {}}; }
};

TEST(Lights, AreTheSameBitsForAllThatDraws) {
  const Mixture mixture;
  std::vector<Light> lights = sets_of_lights().back();
  const std::vector<Light> kit = light_kit();
  lights.insert(lights.end(), kit.begin(), kit.end());
  for (const bool orthographic : {false, true})
    for (const Shader shader : {Shader::lambert, Shader::phong, Shader::material, Shader::classic})
      for (const int samples : {1, 4}) {
        FrameOptions frame =
            lit_by(shader == Shader::classic ? sets_of_classic_lights().back() : lights, shader);
        frame.samples = samples;
        const Camera seen_by = camera(orthographic);
        SCOPED_TRACE(testing::Message() << name(shader) << ", " << samples << " samples");
        const Digest first = EveryWay().same([&](const RendererOptions& by) {
          return digest(draw(mixture.scene(), seen_by, frame, by));
        });
        frame.lights.clear();
        EXPECT_FALSE(first == digest(draw(mixture.scene(), seen_by, frame)));
      }
}

TEST(Lights, OfTheCameraMoveWithIt) {
  const Ball ball;
  Camera one = camera(false), other = one;
  other.eye = {-3.2, 0.4, -1.1};
  const double scale = length(one.eye) / length(other.eye);
  other.eye = other.eye * scale;
  std::vector<Light> lights = light_kit();
  lights.push_back(light(SpotLight{{0.5, 0.5, -1}, {0, 0, -1}}, 4));
  lights.back().of_camera = true;
  const auto a = draw(ball.view(), one, lit_by(lights, Shader::phong));
  const auto b = draw(ball.view(), other, lit_by(lights, Shader::phong));
  expect_near(a, b);
}

TEST(Lights, ArePlacedByAMatrixCameraToo) {
  const Ball ball;
  const Camera lens = camera(false);
  const Camera matrix = camera_from_matrix(world_to_clip(lens, kSize, kSize), ClipDepth::reversed);
  const std::vector<Light> lights = sets_of_lights().back();
  const auto a = draw(ball.view(), lens, lit_by(lights, Shader::phong));
  const auto b = draw(ball.view(), matrix, lit_by(lights, Shader::phong));
  expect_near(a, b);
}

TEST(Lights, ThatCannotBeMeantAreRefused) {
  const Ball ball;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const auto refused = [&](const char* part, const Light& bad) {
    expect_refused(part, [&] {
      static_cast<void>(
          draw(ball.view(), camera(false), lit_by({light(AmbientLight{}), bad}, Shader::phong)));
    });
  };
  for (const float bad : {-1.0F, kNan, kInf}) {
    refused("light 1: its intensity", light(AmbientLight{}, bad));
    refused("light 1: its colour", light(AmbientLight{}, 1, {1, bad, 1}));
    refused("light 1: its colour below", light(HemisphereLight{{0, 1, 0}, {bad, 0, 0}}));
  }
  for (const Vec3 bad : {Vec3{0, 0, 0}, Vec3{0, kNan, 1}, Vec3{kInf, 0, 0}}) {
    refused("light 1: its direction", light(DirectionalLight{bad}));
    refused("light 1: its direction", light(SpotLight{{}, bad}));
    refused("light 1: its up", light(HemisphereLight{bad}));
  }
  refused("light 1: its position", light(PointLight{{kNan, 0, 0}}));
  refused("light 1: its position", light(SpotLight{{0, kInf, 0}}));
  for (const float bad : {0.0F, -2.0F, kNan}) {
    refused("light 1: its range", light(PointLight{{}, bad}));
    refused("light 1: its range", light(SpotLight{{}, {0, 0, -1}, bad}));
  }
  for (const auto& [inner, outer] :
       {std::pair{0.5F, 0.4F}, {0.5F, 0.5F}, {-0.1F, 0.5F}, {0.0F, 1.6F}, {kNan, 0.5F}})
    refused("light 1: its cone", light(SpotLight{{}, {0, 0, -1}, kInf, inner, outer}));
  expect_refused("257 lights", [&] {
    static_cast<void>(
        draw(ball.view(), camera(false), lit_by(std::vector<Light>(257), Shader::phong)));
  });
}

/// A ball over a floor.
struct BallOnFloor : Ball {
  Mesh floor{.positions = {{-3, -1.5F, -3}, {-3, -1.5F, 3}, {3, -1.5F, 3}, {3, -1.5F, -3}},
             .indices = {0, 1, 2, 0, 2, 3}};
  BallOnFloor() { instances.add(floor.view()); }
};

/// The distance of the line from p to the light from the ball's centre; large if the ball is behind
/// p.
double miss(const Light& l, Vec3d p) {
  const Arrived in = arrived(l, p);
  const double along = -dot(p, in.to_light);
  return along < 0 ? 9 : std::sqrt(std::max(dot(p, p) - along * along, 0.0));
}

TEST(Lights, CastShadowsAlongTheirRays) {
  const BallOnFloor scene;
  Camera seen_by = camera(false);
  seen_by.eye = {0.5, 2.5, 6};
  for (const Shader shader : {Shader::lambert, Shader::phong, Shader::material}) {
    int hidden = 0;
    for (const Light& l :
         {light(DirectionalLight{{-1, -1.2F, -0.4F}}, 0.8F),
          light(DirectionalLight{{-1, -0.6F, 0.1F}}, 0.8F),
          light(DirectionalLight{{-1, -0.15F, 0.1F}}, 0.8F),  // nearly along the floor
          light(SpotLight{{1.5, 3, 1}, {-1.5F, -3, -1}}, 9)}) {
      FrameOptions frame = lit_by({light(AmbientLight{}, 0.2F), l}, shader);
      const auto open = draw(scene.view(), seen_by, frame);
      frame.lights.pop_back();
      const auto dark = draw(scene.view(), seen_by, frame);
      frame.shadows = true;
      frame.shadow_size = 2048;
      frame.lights.push_back(l);
      frame.width = frame.height = kSize;
      const Frame f = test::draw({.threads = 1}, scene.view(), seen_by, frame,
                                 kColor | kInstances | kPositions);
      EXPECT_EQ(f.stats.stages.front().name, "shadows");
      int lit = 0;
      for (const auto& [x, y] : pixels(kSize, kSize)) {
        if (f.instances(x, y) != 1) continue;
        // Three texels are about 0.02 wide, and their filter reaches as far again.
        const double passes = miss(l, wide(f.positions(x, y)));
        if (passes > 1.06) {
          ++lit;
          ASSERT_EQ(f.color(x, y), open(x, y)) << name(shader) << " " << x << ", " << y;
        } else if (passes < 0.94) {
          ++hidden;
          ASSERT_EQ(f.color(x, y), dark(x, y)) << name(shader) << " " << x << ", " << y;
        }
      }
      EXPECT_GT(lit, 500);
    }
    EXPECT_GT(hidden, 100);
  }
}

TEST(Lights, CastTheSameShadowsWhateverDraws) {
  const Mixture mixture;
  std::vector<Light> lights = light_kit();
  lights.push_back(light(SpotLight{{1.5, 2, 2.5}, {-1, -1.4F, -1.6F}}, 3));
  for (const Shader shader : {Shader::phong, Shader::material, Shader::classic}) {
    FrameOptions frame = lit_by(lights, shader);
    frame.shadows = true;
    SCOPED_TRACE(name(shader));
    EveryWay{{.threads = 2}}.same([&](const RendererOptions& by) {
      return digest(draw(mixture.scene(), camera(false), frame, by));
    });
  }
}

TEST(Lights, OnlyThoseThatCastShadowsDo) {
  BallOnFloor scene;
  Camera seen_by = camera(false);
  seen_by.eye = {0.5, 2.5, 6};
  const Light sun = light(DirectionalLight{{-1, -1.2F, -0.4F}}, 0.8F);
  for (const Shader shader : {Shader::phong, Shader::material}) {
    FrameOptions frame = lit_by({sun}, shader);
    const auto of = [&] { return digest(draw(scene.view(), seen_by, frame)); };
    const Digest open = of();
    frame.shadows = true;
    const Digest shadowed = of();
    EXPECT_FALSE(shadowed == open);
    frame.lights[0].casts_shadows = false;
    EXPECT_EQ(of(), open);
    frame.lights[0].casts_shadows = true;
    scene.instances[1].casts_shadows = false;  // the floor, which has nothing below it
    EXPECT_EQ(of(), shadowed);
    scene.instances[0].casts_shadows = false;
    EXPECT_EQ(of(), open);
    for (InstanceView& i : scene.instances) i.casts_shadows = true;
  }
}

TEST(Lights, LeaveOtherShadersAlone) {
  const Mixture mixture;
  for (const Shader shader : {Shader::flat, Shader::normal, Shader::id, Shader::depth})
    EXPECT_EQ(digest(draw(mixture.scene(), camera(false), lit_by({}, shader))),
              digest(draw(mixture.scene(), camera(false), lit_by(light_kit(), shader))))
        << name(shader);
}

}  // namespace
}  // namespace rastrum::test::lights_test
