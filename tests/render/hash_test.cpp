// SPDX-License-Identifier: BSD-3-Clause
// Digests of pictures and of intermediate results that are the same on every machine
// (tests/golden/hashes.txt). `./dev check --full` runs this on AArch64 too.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/core/elementary.hpp>
#include <rastrum/digest.hpp>
#include <rastrum/environment.hpp>
#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/light.hpp>
#include <rastrum/program.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/shaded_scenes.hpp"
#include "tests/support/small_environment.hpp"
#include "tests/support/surface_scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::hash_test {
namespace {

/// Combines many digests into one.
class Sum {
 public:
  void add(const Digest& d) { bytes_.insert(bytes_.end(), d.bytes.begin(), d.bytes.end()); }
  template <class T>
  void add(const std::vector<T>& values) {
    add(digest(ImageView<const T>{values.data(), static_cast<int>(values.size()), 1}));
  }
  [[nodiscard]] Digest total() const {
    return digest(ImageView<const std::uint8_t>{bytes_.data(), static_cast<int>(bytes_.size()), 1});
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

void add(Sum& sum, const Frame& frame) {
  sum.add(digest(frame.color8));
  sum.add(digest(frame.color));
  sum.add(digest(frame.depth));
  sum.add(digest(frame.ids));
}

/// Compares with the golden digest on all instruction sets. With a smaller share (test_share.hpp)
/// on two, which differ from picture to picture of a test.
template <class Draw>
void expect_golden(const std::string& name, const Draw& draw) {
  const std::vector<Isa> isas = available_isas();
  const std::size_t some = test_share() < 100 ? 2 : isas.size();
  static std::size_t next = 0;
  for (std::size_t i = 0; i < std::min(some, isas.size()); ++i) {
    const Isa isa = isas[next++ % isas.size()];
    Sum sum;
    draw(isa, sum);
    ASSERT_TRUE(matches_golden(name, sum.total())) << rastrum::name(isa);
  }
}

/// Compares a scene's digests in these frames, 160 × 120, with the golden ones.
void expect_golden_frames(const std::string& name, const Scene& scene,
                          const std::vector<FrameOptions>& frames, unsigned kinds = kPicture) {
  const Fitted fitted(scene, 0.8F);
  expect_golden(name, [&](Isa isa, Sum& sum) {
    Renderer renderer({.threads = 2, .isa = isa});
    for (FrameOptions frame : frames) {
      frame.width = 160;
      frame.height = 120;
      const Frame picture = draw(renderer, fitted.view, fitted.camera, frame, kinds);
      add(sum, picture);
      if ((kinds & kScalars) != 0) sum.add(digest(picture.scalars));
    }
  });
}

/// "spheres" of "spheres?count=3".
std::string shape_of(const std::string& spec) {
  return spec.substr(0, spec.find('?'));
}

TEST(Hashes, Shapes) {
  const std::pair<const char*, Mesh> shapes[] = {
      {"teapot", shapes::teapot(6)},
      {"sphere", shapes::sphere(24, 48)},
      {"torus_knot", shapes::torus_knot()},
      {"boxes", shapes::boxes(3)},
      {"hairball", shapes::hairball(50, 16)},
      {"gyroid", shapes::gyroid(24)},
      {"soup", shapes::soup(500)},
  };
  for (const auto& [name, mesh] : shapes) {
    Sum sum;
    sum.add(mesh.positions);
    sum.add(mesh.normals.values);
    sum.add(mesh.indices);
    EXPECT_TRUE(matches_golden(std::string("shapes/") + name, sum.total()));
    expect_golden_frames(std::string("pictures/") + name, single(mesh),
                         {{.shader = Shader::id},
                          {.shader = Shader::depth},
                          {.shader = Shader::normal},
                          {.shader = Shader::phong}});
  }
}

/// Numbers by every map, over meshes and quadrics.
TEST(Hashes, Scalars) {
  for (const std::string_view map : color_map_names()) {
    Sum sum;
    for (const Vec4& c : color_map(map).colors) sum.add(std::vector<Vec4>{c});
    EXPECT_TRUE(matches_golden(std::string("color_maps/").append(map), sum.total()));
  }
  for (const std::string spec : {"gyroid?cells=24", "tube", "spheres"}) {
    Scene scene = shapes::scene_from_spec(spec);
    show_scalars(scene, "distance");
    ScalarMapping& m = scene.scalar_mappings.emplace_back();
    m.map = color_map("turbo");
    m.range = ScalarRange{0.25, 1.5};
    m.logarithmic = true;
    m.below = Vec4{1, 1, 1, 0.25F};
    m.isolines = {0.5, 1};
    expect_golden_frames(
        "scalars/" + shape_of(spec), scene,
        {{.shader = Shader::flat}, {.shader = Shader::phong}, {.shader = Shader::material}},
        kPicture | kScalars);
  }
}

/// Every kind of light, shadows, tone and samples, over each shader that is lit.
TEST(Hashes, Lights) {
  std::vector<Light> several = light_kit();
  several.push_back({.kind = HemisphereLight{{0, 1, 0.5F}, {0.1F, 0.05F, 0}}, .intensity = 0.2F});
  several.push_back({.kind = PointLight{{0.6, 1.6, 1.2}, 4}, .color = {1, 0.7F, 0.4F}});
  several.push_back({.kind = SpotLight{{2, 2, 2}, {-1, -1, -1}, 10, 0.2F, 0.5F}, .intensity = 6});
  std::vector<FrameOptions> frames;
  for (const Shader shader : {Shader::lambert, Shader::phong, Shader::material}) {
    frames.push_back({.shader = shader, .samples = 4, .lights = light_kit()});
    frames.push_back({.shader = shader, .lights = several, .shadows = true});
  }
  frames.back().tone = {Tone::aces, 0.5F};
  std::vector<FrameOptions> classic{
      {.shader = Shader::classic, .samples = 4, .lights = light_kit()}};
  several.push_back({.kind = PointLight{{-1, 1, 1}}, .classic = ClassicLight{{0.1F, 0, 0}}});
  classic.push_back({.shader = Shader::classic, .lights = several, .shadows = true});
  for (const std::string spec : {"torus_knot", "boxes?count=3", "spheres"}) {
    const Scene scene = shapes::scene_from_spec(spec);
    expect_golden_frames("lights/" + shape_of(spec), scene, frames);
    expect_golden_frames("classic/" + shape_of(spec), scene, classic);
  }
}

template <class Picture>
void expect_golden_environments(const std::string& folder, const Picture& picture) {
  const Environment of_sky(picture(BuiltinEnvironment::sky).view()),
      of_room(picture(BuiltinEnvironment::room).view());
  const Light sky{.kind = EnvironmentLight{of_sky}},
      room{.kind = EnvironmentLight{of_room, {1, 1, 0}, 0.7F}, .intensity = 0.5F};
  std::vector<FrameOptions> frames;
  for (const Shader shader : {Shader::phong, Shader::material})
    frames.push_back({.shader = shader, .lights = {sky, room}, .environment_behind = true});
  frames.back().tone = {Tone::neutral, -0.5F};
  for (const std::string spec : {"torus_knot", "spheres"})
    expect_golden_frames(folder + spec, shapes::scene_from_spec(spec), frames);
}

TEST(Hashes, Environments) {
  expect_golden_environments("small_environments/", small_environment);
}

TEST(Hashes, LargeEnvironments) {
  if (test_share() < 100) GTEST_SKIP() << kOnlyWhole;
  expect_golden_environments("environments/", builtin_environment);
}

std::vector<std::uint64_t> bits_of(const std::vector<double>& values) {
  std::vector<std::uint64_t> bits;
  for (const double v : values) bits.push_back(std::isnan(v) ? 0 : std::bit_cast<std::uint64_t>(v));
  return bits;
}

TEST(Hashes, ElementaryFunctions) {
  using namespace elementary;
  const std::pair<const char*, double (*)(double)> functions[] = {
      {"sin", sin},
      {"cos", cos},
      {"tan", tan},
      {"asin", asin},
      {"acos", acos},
      {"atan", atan},
      {"exp", exp},
      {"log", log},
      {"log2", log2},
      {"log10", log10},
      {"log1p", log1p},
      {"cbrt", cbrt},
      {"pow", [](double x) { return pow(std::abs(x), 2.4); }},
      {"atan2", [](double x) { return atan2(x, 1 - x * x); }}};
  for (const auto& [name, f] : functions) {
    Random random(3);
    std::vector<double> values;
    for (int i = 0; i < 10000; ++i) values.push_back(f(random.real(-1, 1)));
    for (int i = 0; i < 10000; ++i) {
      // One draw per statement, because the order of arguments is unspecified.
      const int exponent = random.integer(-60, 60);
      values.push_back(f(std::ldexp(random.real(-1, 1), exponent)));
    }
    Sum sum;
    sum.add(bits_of(values));
    EXPECT_TRUE(matches_golden(std::string("elementary/") + name, sum.total()));
  }
}

TEST(Hashes, CamerasAndRotations) {
  Random r(11);
  std::vector<double> values;
  const auto add = [&](const Mat4d& m) {
    for (const auto& row : m.m) values.insert(values.end(), std::begin(row), std::end(row));
  };
  const auto real = [&] { return r.real32(-2, 2); };
  const auto vector = [&] {
    const float x = real(), y = real();
    return Vec3{x, y, real()};
  };
  for (int i = 0; i < 500; ++i) {
    Camera camera{
        .eye = vector() + Vec3{0, 0, 9}, .target = vector(), .fov_rad = r.real32(0.01, 3)};
    add(world_to_clip(camera, 640, 480));
    const double angle = r.real(-9, 9);
    const Quaternion a = rotation_about(vector(), angle), b = rotation_about(vector(), 1);
    add(rotation(slerp(a, b, r.real(0, 1))));
  }
  Sum sum;
  sum.add(bits_of(values));
  EXPECT_TRUE(matches_golden("cameras", sum.total()));
}

// Every shader, with materials, layers, samples, clipping.
TEST(Hashes, ShadedScenes) {
  constexpr int kGroup = 50;
  for (int first = 0; first < 400; first += kGroup)
    expect_golden("shaded/" + std::to_string(first), [&](Isa isa, Sum& sum) {
      Renderer renderer({.threads = 2, .isa = isa});
      for (int seed = first; seed < first + kGroup; ++seed) {
        const ShadedScene s = generate_shaded(static_cast<std::uint64_t>(seed));
        add(sum, draw(renderer, s.view(), s.camera, s.frame));
      }
    });
}

TEST(Hashes, Transparency) {
  const std::pair<const char*, TransparencyOptions> methods[] = {
      {"filter", family::filtered(3)}, {"unsorted", {.method = Transparency::unsorted}},
      {"wboit", family::wboit()},      {"mboit4", family::mboit4()},
      {"mboit6", family::mboit6()},    {"mlab4", family::mlab4()}};
  for (const auto& method : methods)
    expect_golden(std::string("transparency/") + method.first, [&](Isa isa, Sum& sum) {
      Renderer renderer = family::make_renderer({.threads = 2, .isa = isa}, {});
      for (std::uint64_t seed = 0; seed < 25; ++seed) {
        ShadedScene s = generate_shaded(seed);
        s.frame.transparency = method.second;
        s.frame.opacity = 0.4F;
        s.frame.samples = 1;
        add(sum, draw(renderer, s.view(), s.camera, s.frame));
      }
    });
}

struct Tint {
  Vec3 color;
  Tint operator+(const Tint& o) const { return {color + o.color}; }
  Tint operator*(float s) const { return {color * s}; }
};

TEST(Hashes, PointsLinesAndTriangles) {
  Random r(17);
  std::vector<Vec4> clip;
  std::vector<Vec3> colors;
  for (int i = 0; i < 240; ++i) {
    const auto real = [&](double a, double b) { return r.real32(a, b); };
    const float w = real(0.1, 3), x = real(-1.3, 1.3), y = real(-1.3, 1.3);
    clip.push_back({x * w, y * w, real(-0.1, 1.1) * w, w});
    const float red = real(0, 1), green = real(0, 1);
    colors.push_back({red, green, real(0, 1)});
  }
  const Program program(
      [&](std::uint32_t i) {
        return VertexOutput<Tint>{clip[i], {colors[i]}};
      },
      [](const Tint& t, const Fragment& f) {
        const float alpha = f.draw == 1 ? 0.5F : 1.0F;
        return Vec4{t.color.x * alpha, t.color.y * alpha, t.color.z * alpha, alpha};
      });
  for (const Topology topology : {Topology::points, Topology::lines, Topology::triangles}) {
    const char* const names[] = {"points", "lines", "triangles"};
    expect_golden(std::string("program/") + names[static_cast<int>(topology) - 1],
                  [&](Isa isa, Sum& sum) {
                    Renderer renderer({.threads = 2, .isa = isa});
                    for (const int samples : {1, 4}) {
                      ProgramDraw draws[2] = {program.draw(clip.size()), program.draw(clip.size())};
                      for (ProgramDraw& d : draws) {
                        d.topology = topology;
                        d.primitive_count = clip.size() / static_cast<std::size_t>(topology);
                        d.line_width = 3;
                        d.point_size = 5.5F;
                        d.depth_bias = &d == draws ? 0 : 0.05F;
                      }
                      draws[1].flags = kTranslucent;
                      FrameOptions f{.width = 150,
                                     .height = 110,
                                     .background = {0.1F, 0.2F, 0.3F, 0.6F},
                                     .samples = samples};
                      Frame picture(f.width, f.height, kPicture);
                      renderer.draw(draws, f, picture.targets());
                      add(sum, picture);
                    }
                  });
  }
}

// --- Terrain ------------------------------------------------------------------------------------

terrain::HeightMap map() {
  Random r(23);
  terrain::HeightMap map{Image<float>(128, 96), Image<Rgba8>(64, 48)};
  const terrain::HeightFunction noise = terrain::named_function("noise");
  for (const auto& [x, y] : pixels(128, 96)) {
    const double u = x * 4, v = y * 4;
    noise(&u, &v, 1, &map.heights(x, y));
    if (r.chance(0.002)) map.heights(x, y) = NAN;
  }
  for (Rgba8& c : map.colors.pixels()) {
    const std::uint64_t bits = r.bits();
    c = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
         static_cast<std::uint8_t>(bits >> 16), 255};
  }
  return map;
}

void add(Sum& sum, const terrain::Terrain& terrain, terrain::TerrainOptions o, Isa isa,
         std::initializer_list<double> angles) {
  o.width = 120;
  o.height = 80;
  o.distance = 300;
  terrain::TerrainRenderer renderer({.threads = 2, .isa = isa});
  Image<Rgba8> color(o.width, o.height);
  Image<float> depth(o.width, o.height);
  terrain::TerrainCamera camera{.x = 60.25, .y = 70.75, .altitude = 130, .horizon_px = 30};
  for (const double angle : angles) {
    camera.angle_rad = angle;
    camera.roll_rad = o.classic ? 0 : angle / 8 - 0.2;
    renderer.render(terrain, camera, o, {.color8 = color, .depth = depth});
    sum.add(digest(color));
    sum.add(digest(depth));
  }
}

TEST(Hashes, TerrainViews) {
  using namespace terrain;
  std::vector<std::pair<std::string, TerrainOptions>> views(6);
  views[0] = {"plain", {}};
  views[1] = {"classic", {.classic = true}};
  views[2] = {"bilinear", {.fov_rad = 1.1, .filter = MapFilter::bilinear, .fog = {0.004, 20, {}}}};
  views[2].second.step = 0;
  views[3] = {"mip", {.dz = 0.05, .filter = MapFilter::mip, .tiling = Tiling::mirror}};
  views[4] = {"cylinder", {.fov_rad = 5, .projection = Projection::cylindrical}};
  views[5] = {"clamped", {.tiling = Tiling::clamp, .ground_clearance = 12}};
  const Terrain terrain(map());
  for (const auto& view : views)
    expect_golden("terrain/" + view.first, [&](Isa isa, Sum& sum) {
      add(sum, terrain, view.second, isa, {0.3, 2.5, 4.0});
    });
}

TEST(Hashes, TerrainLight) {
  using namespace terrain;
  const std::pair<const char*, terrain::Shadows> shadows[] = {
      {"none", terrain::Shadows::none},
      {"accumulated", terrain::Shadows::accumulated},
      {"sharp", terrain::Shadows::sharp},
      {"soft", terrain::Shadows::soft}};
  for (const auto& [name, kind] : shadows) {
    terrain::Light light;
    light.sun = {250, 25};
    light.shadows = kind;
    light.hill_shading = true;
    light.sun_radius_deg = 2;
    light.smooth = true;
    light.march.steps = 16;  // functions are marched for each visible sample
    expect_golden(std::string("light/") + name, [&](Isa isa, Sum& sum) {
      const HeightMap heights = map();
      sum.add(digest(lit_colors(heights, light, {.threads = 2, .isa = isa})));
      for (const FunctionInfo& f : named_functions())
        add(sum, function_terrain(named_function(f.name), f.low, f.high, light), {}, isa, {0.3});
    });
  }
}

TEST(Hashes, Formulas) {
  using namespace terrain;
  Sum sum;
  for (const char* formula :
       {"40*sin(x/30)*cos(y/50)+x^2/1000", "exp(-((x-500)/90)^2)*120+tan(y/900)",
        "x^1.7/300+ln(1+y^2)", "atan2(y-300,x-300)*20+sqrt(x^2+y^2)/9",
        "log10(9+x^2)+log2(2+y^2)+tanh(x/99)+cosh(y/400)",
        "x>300 && y<500 ? asin(sin(x)) : acos(cos(y))+atan(x)+sinh(x/999)"}) {
    HeightFunction f;
    try {
      f = expression_function(formula);
    } catch (const Error& e) {
      ASSERT_EQ(e.code(), Errc::unsupported) << e.what();
      GTEST_SKIP() << e.what();
    }
    std::vector<float> values;
    for (int i = 0; i < 5000; ++i) {
      const double x = i * 0.37, y = 1700 - i * 0.21;
      f(&x, &y, 1, &values.emplace_back());
    }
    sum.add(values);
  }
  EXPECT_TRUE(matches_golden("formulas", sum.total()));
}

// Spheres, cylinders, cones, tubes and discs, beside triangles and cut by planes.
TEST(Hashes, Surfaces) {
  constexpr Shader kShaders[] = {Shader::phong, Shader::material, Shader::normal, Shader::id};
  for (int kind = 0; kind < kSurfaceKinds; ++kind)
    expect_golden("surfaces/" + std::to_string(kind), [&](Isa isa, Sum& sum) {
      Renderer renderer({.threads = 2, .isa = isa});
      for (int i = 0; i < 8; ++i) {
        const auto seed = static_cast<std::uint64_t>(kind + i * kSurfaceKinds);
        SurfaceScene s = generate_surfaces(seed, 90, 70);
        if (i % 2 == 1) add_clip_planes(s, seed);
        FrameOptions f{.width = s.width,
                       .height = s.height,
                       .shader = kShaders[i % 4],
                       .opacity = i % 3 == 2 ? 0.5F : 1,
                       .samples = i == 5 ? 4 : 1,
                       .clip_planes = s.clip_planes};
        const Frame images = draw(renderer, s.view(), s.camera, f, kColor | kSurfaces);
        for_each_kind([&](unsigned image, const char*, auto member, auto) {
          if ((image & (kColor | kSurfaces)) != 0) sum.add(digest(images.*member));
        });
      }
    });
}

}  // namespace
}  // namespace rastrum::test::hash_test
