// SPDX-License-Identifier: BSD-3-Clause
// Arrays of any kind are drawn without a copy. A mesh gives the same picture, bit for bit, for all
// types and strides of its arrays and all kinds of faces. float64 positions stay exact far from the
// origin. Errors of arrays name instance, array and element. allocations_test.cpp tests the memory.
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <stop_token>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>
#include <rastrum/stop.hpp>

#include "tests/support/array_layouts.hpp"
#include "tests/support/every_way.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::arrays_test {
namespace {

constexpr int kW = 150, kH = 110;

Frame draw(Renderer& renderer, const SceneView& scene, const Camera& camera, FrameOptions look) {
  look.width = kW;
  look.height = kH;
  return test::draw(renderer, scene, camera, look);
}

std::size_t ids_that_differ(const Frame& a, const Frame& b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.ids.pixels().size(); ++i)
    n += a.ids.pixels()[i] != b.ids.pixels()[i];
  return n;
}

Camera camera_of_sheet() {
  return Camera{.eye = {0.3, -0.8, 1.9}, .target = {0, 0.05, 0}};
}

std::vector<Material> two_materials() {
  std::vector<Material> m(2);
  m[0].roughness = 0.4F;
  m[0].double_sided = true;
  m[1].base_color = {0.9F, 0.6F, 0.5F, 0.6F};
  m[1].alpha_mode = AlphaMode::blend;
  m[1].double_sided = true;
  return m;
}

struct Look {
  const char* name;
  FrameOptions frame;
  bool materials = false;
};

std::vector<Look> looks() {
  return {{"phong", {.shader = Shader::phong}},
          {"material", {.shader = Shader::material}, true},
          {"normal, 4 samples", {.shader = Shader::normal, .samples = 4}},
          {"wireframe", {.shader = Shader::wireframe}},
          {"layers", {.shader = Shader::lambert, .opacity = 0.6F}}};
}

std::vector<RendererOptions> renderers() {
  return {{.threads = 2},
          {.memory_limit = 3U << 20, .threads = 2},  // projects where vertices are read
          {.device = Device::serial}};
}

TEST(Arrays, EveryLayoutHasThePictureOfThePackedOne) {
  const Sheet sheet(23);
  const std::vector<Material> materials = two_materials();
  const Camera camera = camera_of_sheet();
  for (const RendererOptions& by : renderers()) {
    Renderer renderer(by);
    for (const Look& look : looks()) {
      const auto picture = [&](const MeshView& mesh) {
        const OneInstance instance(mesh);
        SceneView scene = instance.view();
        if (look.materials) scene.materials = materials;
        return draw(renderer, scene, camera, look.frame);
      };
      const Frame packed = picture(sheet.view());
      ASSERT_GT(packed.stats.pixels_covered, 2000U);
      for (const Layout& layout : layouts()) {
        Memory memory;
        const Frame other = picture(layout.view(sheet, memory));
        EXPECT_TRUE(same_images(packed, other))
            << layout.name << ", " << look.name << ", limit " << by.memory_limit;
        EXPECT_EQ(packed.stats.triangles.drawn, other.stats.triangles.drawn) << layout.name;
      }
    }
  }
}

/// The triangles of a mesh one by one, from place() and read_triangles().
TEST(Arrays, FacesAreTrianglesInTheirOrder) {
  const std::vector<Vec3> positions(40);
  MeshView mesh{.positions = positions};
  const auto triangles = [&] {
    std::vector<std::vector<std::uint32_t>> all;
    for (std::size_t first = 0; first < mesh.triangle_count(); first += first < 8 ? 1 : 97) {
      const std::size_t n = mesh.triangle_count() - first;
      std::vector<std::uint32_t> run(3 * n);
      mesh.read_triangles(first, n, run.data());
      for (std::size_t t = 0; t < n; ++t) {
        const TrianglePlace place = mesh.place(first + t);
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_EQ(mesh.vertex(place.corner[c]), run[3 * t + c]) << first << " " << t << " " << c;
        if (first == 0) {
          std::vector<std::uint32_t>& face = all.emplace_back(
              run.begin() + 3 * static_cast<int>(t), run.begin() + 3 * static_cast<int>(t) + 3);
          face.push_back(static_cast<std::uint32_t>(place.face));
        }
      }
    }
    return all;
  };
  using Triangles = std::vector<std::vector<std::uint32_t>>;
  const std::vector<std::int64_t> offsets{2, 5, 7, 11, 13};
  mesh.faces = {FaceKind::polygons, offsets};
  EXPECT_EQ(triangles(), (Triangles{{2, 3, 4, 0}, {7, 8, 9, 2}, {7, 9, 10, 2}}));
  mesh.faces.kind = FaceKind::strips;
  EXPECT_EQ(triangles(), (Triangles{{2, 3, 4, 0}, {7, 8, 9, 2}, {9, 8, 10, 2}}));
  const std::vector<std::uint16_t> corners{9, 8, 7, 6, 5};
  mesh.indices = corners;
  mesh.faces = {FaceKind::strips, {}};
  EXPECT_EQ(triangles(), (Triangles{{9, 8, 7, 0}, {7, 8, 6, 0}, {7, 6, 5, 0}}));
  mesh.faces = {FaceKind::polygons, {}};
  EXPECT_EQ(triangles(), (Triangles{{9, 8, 7, 0}, {9, 7, 6, 0}, {9, 6, 5, 0}}));
  mesh.faces = {FaceKind::quads, {}};
  EXPECT_EQ(triangles(), (Triangles{{9, 8, 7, 0}, {9, 7, 6, 0}}));
  mesh.indices = {};
  // One fan, larger than what is read at a time.
  const std::vector<Vec3> many(1000);
  mesh.positions = many;
  mesh.faces = {FaceKind::polygons, {}};
  EXPECT_EQ(triangles().back(), (std::vector<std::uint32_t>{0, 998, 999, 0}));
  mesh.faces = {FaceKind::strips, {}};
  EXPECT_EQ(triangles().back(), (std::vector<std::uint32_t>{998, 997 + 0, 999, 0}));
  mesh.positions = {};
  EXPECT_EQ(mesh.triangle_count(), 0U);
}

TEST(Arrays, NumbersAreWhatGltfMakesOfThem) {
  const std::uint8_t u8[] = {0, 51, 255, 1};
  EXPECT_EQ(ArrayView<Vec4>::of(u8, 1)[0], (Vec4{0, 51 / 255.0F, 1, 1 / 255.0F}));
  EXPECT_EQ(ArrayView<Vec4>::rgb(u8, 1)[0], (Vec4{0, 51 / 255.0F, 1, 1}));
  const std::int8_t i8[] = {-128, -127, 127};
  EXPECT_EQ(ArrayView<Vec3>::of(i8, 1)[0], (Vec3{-1, -1, 1}));
  const std::uint16_t u16[] = {65535, 13107};
  EXPECT_EQ(ArrayView<Vec2>::of(u16, 1)[0], (Vec2{1, 0.2F}));
  const std::int16_t i16[] = {-32768};
  EXPECT_EQ(ArrayView<float>::of(i16, 1)[0], -1.0F);
  const double f64[] = {1e300, 0.1, -0.0};
  EXPECT_EQ(ArrayView<Vec3>::of(f64, 1).wide(0), (Vec3d{1e300, 0.1, 0}));
  EXPECT_EQ(ArrayView<Vec3>::of(f64, 1)[0].x, std::numeric_limits<float>::infinity());
  const std::int64_t i64[] = {-1, 7, std::int64_t{1} << 32, 0xFFFFFFFE};
  const IndexView indices(i64);
  EXPECT_EQ(indices[0], kNoIndex);
  EXPECT_EQ(indices[1], 7U);
  EXPECT_EQ(indices[2], kNoIndex);
  EXPECT_EQ(indices[3], 0xFFFFFFFEU);
  EXPECT_EQ(indices.text(0), "-1");
  // One value for all.
  const float up[] = {0, 0, 1};
  const ArrayView<Vec3> normals = ArrayView<Vec3>::of(up, 1000, 0);
  EXPECT_EQ(normals[999], (Vec3{0, 0, 1}));
}

// Types of other libraries.

/// Like CUDA's float3.
struct Plain {
  float x, y, z;
};
struct Color {
  float r, g, b;
};
struct Inner {
  std::array<double, 3> v;
};
struct Triangle {
  int a, b, c;
};
/// Like glm::vec3.
class Unions {
 public:
  Unions() {}
  Unions(float x_, float y_, float z_) : x(x_), y(y_), z(z_) {}
  union {
    float x, r;
  };
  union {
    float y, g;
  };
  union {
    float z, b;
  };
};
/// Like Eigen::Vector3d, which has its own copy constructors.
class Indexed {
 public:
  Indexed(double a, double b, double c) : v_{a, b, c} {}
  Indexed(const Indexed& other) : v_{other[0], other[1], other[2]} {}
  Indexed& operator=(const Indexed&) = delete;
  double& operator[](std::ptrdiff_t i) { return v_[i]; }
  const double& operator[](std::ptrdiff_t i) const { return v_[i]; }

 private:
  double v_[3];
};
// Three numbers in size, but not a vector.
struct ColoredPoint {
  float x, y;
  std::uint32_t rgb;
};
struct Row {
  const double& operator[](std::size_t i) const { return data[i]; }
  const double* data;
  std::size_t size, stride;
};
class Closed {
  [[maybe_unused]] float v_[3];
};

template <class View, class... From>
constexpr bool kTakesAll = (std::is_convertible_v<From, View> && ...);
template <class View, class... From>
constexpr bool kTakesNone = !(std::is_constructible_v<View, From> || ...);
template <class T>
using List = std::vector<T>&;

using Positions = ArrayView<Vec3>;
static_assert(kTakesAll<Positions, List<Vec3>, const std::vector<Vec3>&, List<Vec3d>, List<float>,
                        List<double>, List<std::array<float, 3>>, List<Plain>, List<Color>,
                        List<Inner>, List<Unions>, List<Indexed>, float (&)[5][3],
                        const double (&)[5][3], const std::array<Vec3, 2>&, std::span<Vec3>,
                        std::span<const Vec3, 3>, std::span<const float>>);
static_assert(kTakesNone<Positions, List<ColoredPoint>, List<Row>, List<Closed>, List<Triangle>,
                         List<std::vector<double>>, List<int>, List<Vec2>, List<Vec4>,
                         List<std::array<float, 4>>, float (&)[5][2], List<std::span<double>>>);
static_assert(kTakesAll<ArrayView<Vec2>, List<Vec2>, List<float>, List<std::array<double, 2>>>);
static_assert(kTakesNone<ArrayView<Vec2>, List<std::span<float, 2>>, List<Vec3>>);
static_assert(kTakesAll<ArrayView<Vec4>, List<Vec4>, List<double>, float (&)[2][4]>);
static_assert(kTakesAll<ArrayView<float>, List<float>, List<double>>);
static_assert(kTakesAll<IndexView, List<int>, List<std::size_t>, List<Triangle>,
                        List<std::array<std::int64_t, 2>>, const std::uint16_t (&)[5][4]>);
static_assert(kTakesNone<IndexView, List<float>, List<Plain>, List<bool>, List<std::vector<int>>>);
static_assert(kTakesAll<ScalarView, List<float>, List<char>, std::span<const long>>);
static_assert(kTakesNone<ScalarView, List<Vec3>, IndexView&, Positions&>);
// Temporaries.
static_assert(kTakesNone<Positions, std::vector<Vec3>, const std::vector<Vec3>, std::vector<float>,
                         std::vector<Plain>, std::array<Vec3, 2>>);
static_assert(kTakesNone<IndexView, std::vector<int>, std::vector<Triangle>, std::array<int, 3>>);
static_assert(kTakesNone<ScalarView, std::vector<float>, const std::vector<double>>);
static_assert(kTakesNone<StopScope, std::stop_token> && !kTakesNone<StopScope, std::stop_token&>);

TEST(Arrays, TypesTellTheirNumbers) {
  const std::vector<float> flat{1, 2, 3, 4, 5, 6};
  const std::vector<double> wide{1, 2, 3, 4, 5, 6.1};
  const std::vector<Unions> unions{{1, 2, 3}, {4, 5, 6}};
  const std::vector<Indexed> indexed{{1, 2, 3}, {4, 5, 6.1}};
  const Plain plain[]{{1, 2, 3}, {4, 5, 6}};
  const double rows[2][3]{{1, 2, 3}, {4, 5, 6.1}};
  for (const Positions& v : {Positions(flat), Positions(unions), Positions(plain)}) {
    ASSERT_EQ(v.size(), 2U);
    EXPECT_TRUE(v.is_packed());
    EXPECT_EQ(v[1], (Vec3{4, 5, 6}));
  }
  for (const Positions& v : {Positions(wide), Positions(indexed), Positions(rows)}) {
    ASSERT_EQ(v.size(), 2U);
    EXPECT_TRUE(v.is_wide());
    EXPECT_EQ(v.wide(1), (Vec3d{4, 5, 6.1}));
  }
  EXPECT_EQ(ArrayView<Vec2>(flat).size(), 3U);
  EXPECT_EQ(ArrayView<Vec2>(wide)[2], (Vec2{5, 6.1F}));
  EXPECT_EQ(ArrayView<float>(wide)[5], 6.1F);
  EXPECT_TRUE(Positions(std::span<const float>()).empty());
  expect_refused(
      "6 numbers do not make up whole values, which have 4 each; colours without alpha are "
      "ArrayView::rgb",
      [&] { (void)ArrayView<Vec4>(flat); });
  expect_refused("5 numbers do not make up whole values, which have 3 each",
                 [&] { (void)Positions(std::span(wide).first(5)); });

  const std::vector<std::array<std::uint32_t, 3>> triples{{0, 1, 2}, {3, 4, 5}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
  const std::int8_t edges[3][2]{{0, 1}, {2, 3}, {4, 5}};
  EXPECT_TRUE(IndexView(triples).is_packed());
  for (const IndexView& v : {IndexView(triples), IndexView(triangles), IndexView(edges)}) {
    ASSERT_EQ(v.size(), 6U);
    for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(v[i], i);
  }
}

/// A city of boxes on a plane, with a camera among them.
struct City {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;

  City() {
    for (int i = 0; i < 400; ++i) {
      const float x = static_cast<float>(i % 20) * 25, y = static_cast<float>(i / 20) * 25;
      const float high = 8 + static_cast<float>(i * 37 % 50);
      const auto first = static_cast<std::uint32_t>(positions.size());
      for (int c = 0; c < 8; ++c)
        positions.push_back({x + static_cast<float>(c % 2) * 12.3F,
                             y + static_cast<float>(c / 2 % 2) * 14.7F,
                             static_cast<float>(c / 4) * high});
      for (const std::uint32_t c :
           {0U, 2U, 1U, 1U, 2U, 3U, 4U, 5U, 6U, 5U, 7U, 6U, 0U, 1U, 4U, 1U, 5U, 4U,
            2U, 6U, 3U, 3U, 6U, 7U, 0U, 4U, 2U, 2U, 4U, 6U, 1U, 3U, 5U, 3U, 7U, 5U})
        indices.push_back(first + c);
    }
  }
  [[nodiscard]] std::vector<Vec3d> at(Vec3d origin) const {
    std::vector<Vec3d> moved;
    for (const Vec3& p : positions) moved.push_back(Vec3d(p) + origin);
    return moved;
  }
};

Camera in_the_city(Vec3d origin) {
  return Camera{.eye = Vec3d{-40, -60, 55} + origin,
                .target = Vec3d{250, 240, 0} + origin,
                .up = {0, 0, 1},
                .near_plane = 1};
}

TEST(Arrays, ACityInUtmCoordinatesStandsStill) {
  const City city;
  const Vec3d utm{5e6, 4e5, 100};
  const std::vector<Vec3d> near = city.at({}), far = city.at(utm);
  std::vector<Vec3> far32;
  for (const Vec3d& p : far) far32.push_back(Vec3(p));
  Renderer renderer({.threads = 2});
  const auto picture = [&](const ArrayView<Vec3>& positions, Vec3d origin) {
    const OneInstance mesh(MeshView{.positions = positions, .indices = city.indices});
    return draw(renderer, mesh.view(), in_the_city(origin), {});
  };
  const Frame home = picture(city.positions, {});
  ASSERT_GT(home.stats.pixels_covered, kW * kH / 4U);
  // float64 positions at the origin and 5000 km away are rounded once each. So a vertex may snap to
  // the neighbouring 256th of a pixel, and a few pixels may show another triangle.
  EXPECT_LE(ids_that_differ(home, picture(far, utm)), 12U);
  EXPECT_LE(ids_that_differ(home, picture(near, {})), 12U);
  // float32 rounds the positions to half metres.
  EXPECT_GT(ids_that_differ(home, picture(far32, utm)), 300U);
}

TEST(Arrays, Float64HasTheSameBitsEverywhere) {
  const City city;
  const Vec3d utm{5e6, 4e5, 100};
  const std::vector<Vec3d> positions = city.at(utm);
  MeshView mesh{.positions = positions, .indices = city.indices};
  Memory memory;
  MeshView strided = mesh;
  strided.positions = memory.view<Vec3>(&positions[0].x, positions.size(), 40, 1);
  // Some vertices are behind the eye, for the clipper; some are huge or not finite.
  std::vector<Vec3d> nasty = positions;
  nasty[3] = {1e200, 4e5, 100};
  nasty[11].x = std::numeric_limits<double>::quiet_NaN();
  nasty[21].y = std::numeric_limits<double>::infinity();
  MeshView bad = mesh;
  bad.positions = nasty;
  Camera close = in_the_city(utm);
  close.eye = Vec3d{120, 118, 4} + utm;
  for (const Camera& camera : {in_the_city(utm), close})
    for (const MeshView* const m : {&mesh, &strided, &bad}) {
      const OneInstance instance(*m);
      for (const Look& look : looks()) {
        if (look.materials) continue;
        SCOPED_TRACE(look.name);
        const Frame reference =
            EveryWay{{.threads = 2}, {.memory_limit = 3U << 20, .threads = 2}}.same(
                [&](Renderer& by) { return draw(by, instance.view(), camera, look.frame); });
        EXPECT_EQ(reference.stats.triangles.dropped > 0, m == &bad);
      }
    }
}

TEST(Arrays, WhatCannotBeReadIsRefused) {
  const Sheet sheet(4);
  const std::vector<std::int32_t> negative{0, 1, 2, 3, -4, 5};
  const std::vector<std::int64_t> huge{0, 1, 2, 3, std::int64_t{1} << 32, 5};
  const std::vector<std::uint64_t> largest{0, 1, std::numeric_limits<std::uint64_t>::max()};
  const std::vector<std::uint32_t> none{0, 1, 0xFFFFFFFF};
  const std::vector<std::uint8_t> beyond{0, 25, 1};
  const std::vector<std::int64_t> falling{0, 4, 3, 8}, from_behind{-4, 4, 8}, too_far{0, 4, 9999},
      lonely{0, 3, 4, 7};
  const std::vector<Vec3> three(3);
  const auto faces = [](FaceKind kind, const std::vector<std::int64_t>& offsets) {
    return [=, &offsets](MeshView& m) { m.faces = {kind, offsets}; };
  };
  const auto normals = [&](Per per) {
    return [&, per](MeshView& m) { m.normals = {three, {}, per}; };
  };
  const std::pair<const char*, std::function<void(MeshView&)>> all[] = {
      {"instance 1: indices[4]: index -4 is out of range, there are 25 vertices",
       [&](MeshView& m) { m.indices = negative; }},
      {"indices[4]: index 4294967296 is out of range", [&](MeshView& m) { m.indices = huge; }},
      {"indices[2]: index 18446744073709551615 is out", [&](MeshView& m) { m.indices = largest; }},
      {"indices[2]: index 4294967295 is out of range", [&](MeshView& m) { m.indices = none; }},
      {"indices[1]: index 25 is out of range", [&](MeshView& m) { m.indices = beyond; }},
      {"instance 1: faces.offsets: face 1 has the corners 4 to 3 of 96",
       faces(FaceKind::polygons, falling)},
      {"face 0 has the corners -4 to 4", faces(FaceKind::polygons, from_behind)},
      {"face 1 has the corners 4 to 9999 of 96", faces(FaceKind::strips, too_far)},
      {"face 1 has the corners 3 to 4 of 96; it must have two or more",
       faces(FaceKind::polygons, lonely)},
      {"triangles and quads have no faces.offsets", faces(FaceKind::quads, falling)},
      {"faces.kind is 200", [&](MeshView& m) { m.faces.kind = static_cast<FaceKind>(200); }},
      {"normals are fewer (3) than positions (25)", [&](MeshView& m) { m.normals.values = three; }},
      {"normals are fewer (3) than corners (96)", normals(Per::corner)},
      {"normals are fewer (3) than faces (32)", normals(Per::face)},
      {"normals.per is 200", normals(static_cast<Per>(200))},
      {"colors.indices are fewer (6) than corners (96)",
       [&](MeshView& m) { m.colors.indices = negative; }},
      {"has 4294967296 positions", [&](MeshView& m) {
         m.positions = ArrayView<Vec3>::of(&three[0].x, std::size_t{1} << 32, 0);
       }}};
  for (const RendererOptions& by : renderers()) {
    Renderer renderer(by);
    for (const auto& [part, change] : all) {
      MeshView mesh = sheet.view();
      change(mesh);
      const KeptInstances instances{sheet.view(), mesh};
      expect_refused(
          part, [&] { (void)draw(renderer, {.instances = instances}, camera_of_sheet(), {}); });
    }
  }
}

TEST(Arrays, BuffersThatAreTooSmallAreRefused) {
  const std::vector<std::byte> buffer(100);
  const auto refused = [&](const ArrayLayout& l) {
    return error_message_of([&] { (void)ArrayView<Vec3>::in(buffer, l); });
  };
  using enum NumberType;
  const std::size_t most = std::numeric_limits<std::size_t>::max();
  EXPECT_EQ(refused({float32, 3, 8, 4, 12}), "");
  EXPECT_EQ(refused({float32, 3, 5, 88, -22}), "");
  EXPECT_EQ(refused({float64, 3, most, 76, 0}), "");
  EXPECT_EQ(refused({float64, 3, 0, most, 24}), "");
  EXPECT_EQ(refused({int16, 3, 16, 4, 6}), "");
  for (const ArrayLayout& l :
       std::vector<ArrayLayout>{{float32, 3, 9, 0, 12},
                                {float32, 3, 1, 89, 12},
                                {float32, 3, 2, 11, -12},
                                {float64, 3, 5, 0, 24},
                                {float32, 3, most, 0, 1},
                                {float32, 3, 2, 0, std::numeric_limits<std::ptrdiff_t>::min()},
                                {float32, 3, 2, 0, std::numeric_limits<std::ptrdiff_t>::max()},
                                {float32, 3, 1, most, 12}})
    EXPECT_TRUE(holds(refused(l), "reach beyond a buffer of 100 bytes"));
  EXPECT_TRUE(holds(refused({float32, 4, 1, 0, 16}), "3 channels, not 4"));
  EXPECT_TRUE(holds(refused({int64, 3, 1, 0, 24}), "float32, float64"));
  EXPECT_THROW((void)IndexView::in(buffer, {float32, 1, 1, 0, 4}), Error);
  EXPECT_THROW((void)IndexView::in(buffer, {int32, 1, 26, 0, 4}), Error);
  EXPECT_EQ(IndexView::in(buffer, {int32, 1, 25, 0, 4}).size(), 25U);
}

}  // namespace
}  // namespace rastrum::test::arrays_test
