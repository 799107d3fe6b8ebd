// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstring>
#include <variant>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/refused.hpp"

namespace rastrum::test::spec_test {
namespace {

bool same(const Mesh& a, const Mesh& b) {
  return a.indices == b.indices && a.positions.size() == b.positions.size() &&
         std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3)) ==
             0;
}

TEST(Spec, DefaultsAreThoseOfTheFunctions) {
  EXPECT_TRUE(same(shapes::from_spec("teapot"), shapes::teapot()));
  EXPECT_TRUE(same(shapes::from_spec("sphere"), shapes::sphere()));
  EXPECT_TRUE(same(shapes::from_spec("torus_knot"), shapes::torus_knot()));
  EXPECT_TRUE(same(shapes::from_spec("boxes"), shapes::boxes()));
  EXPECT_TRUE(same(shapes::from_spec("hairball"), shapes::hairball()));
  EXPECT_TRUE(same(shapes::from_spec("gyroid"), shapes::gyroid()));
  EXPECT_TRUE(same(shapes::from_spec("soup"), shapes::soup()));
}

TEST(Spec, ReadsEveryParameter) {
  EXPECT_TRUE(same(shapes::from_spec("teapot?n=3"), shapes::teapot(3)));
  EXPECT_TRUE(same(shapes::from_spec("sphere?segments=7&rings=5"), shapes::sphere(5, 7)));
  EXPECT_TRUE(same(shapes::from_spec("torus_knot?p=3&q=5&segments=90&sides=6&tube=0.125"),
                   shapes::torus_knot(3, 5, 90, 6, 0.125F)));
  EXPECT_TRUE(same(shapes::from_spec("boxes?count=2&fill=0.25"), shapes::boxes(2, 0.25F)));
  EXPECT_TRUE(same(shapes::from_spec("hairball?strands=9&segments=8&width=1e-2&seed=7"),
                   shapes::hairball(9, 8, 0.01F, 7)));
  EXPECT_TRUE(same(shapes::from_spec("gyroid?cells=9&periods=1.5"), shapes::gyroid(9, 1.5F)));
  EXPECT_TRUE(same(shapes::from_spec("soup?count=5&min_size=0.1&max_size=0.5&seed=123456789012"),
                   shapes::soup(5, 0.1F, 0.5F, 123456789012)));
}

TEST(Spec, CatalogueListsWhatFromSpecKnows) {
  const auto infos = shapes::catalogue();
  EXPECT_EQ(infos.size(), 11U);
  for (const shapes::ShapeInfo& info : infos) {
    EXPECT_FALSE(info.description.empty());
    // The listed parameters with their defaults are a valid specification.
    const Scene scene = shapes::scene_from_spec(info.name + "?" + info.parameters);
    const Scene plain = shapes::scene_from_spec(info.name);
    ASSERT_EQ(scene.instances.size(), 1U);
    EXPECT_GT(scene.primitive_count(), 0U);
    EXPECT_EQ(scene.primitive_count(), plain.primitive_count());
    if (!scene.meshes.empty()) {
      EXPECT_TRUE(same(shapes::from_spec(info.name), plain.meshes.front())) << info.name;
      EXPECT_TRUE(same(scene.meshes.front(), plain.meshes.front())) << info.name;
    }
  }
}

TEST(Spec, ShapesThatAreNoMeshesAreGeometries) {
  const Scene spheres = shapes::scene_from_spec("spheres?count=20&min_radius=0.1&max_radius=0.3");
  const auto& s = std::get<Spheres>(spheres.geometries.at(0));
  EXPECT_EQ(s.centers.size(), 20U);
  for (std::size_t i = 0; i < s.centers.size(); ++i) {
    EXPECT_GE(s.radii[i], 0.1F);
    EXPECT_LE(s.radii[i], 0.3F);
    for (const float x : {s.centers[i].x, s.centers[i].y, s.centers[i].z})
      EXPECT_LE(std::abs(x) + s.radii[i], 1.0001F);
  }
  const Scene tube = shapes::scene_from_spec("tube?p=3&q=5&segments=60&radius=0.125");
  const auto& t = std::get<Tubes>(tube.geometries.at(0));
  EXPECT_EQ(t.view().size(), 60U);
  EXPECT_EQ(t.positions.front(), t.positions.back());
  EXPECT_EQ(t.radius, 0.125F);
  EXPECT_EQ(std::get<Cylinders>(shapes::scene_from_spec("cylinders?count=3").geometries.at(0))
                .view()
                .size(),
            3U);
  EXPECT_EQ(
      std::get<Discs>(shapes::scene_from_spec("discs?count=4").geometries.at(0)).normals.size(),
      4U);
}

TEST(Spec, ErrorsNameWhatIsWrongAndWhatIsKnown) {
  const auto expect = [](const char* spec, std::initializer_list<const char*> parts) {
    for (const char* part : parts)
      expect_refused(part, [&] { static_cast<void>(shapes::from_spec(spec)); });
  };
  expect("spheres", {"'spheres' is no mesh"});
  expect("tube?p=2&q=4", {"tube: p and q must have no common divisor"});
  expect("spheres?max_radius=2", {"spheres: max_radius must lie in"});
  expect("", {"no shape ''", "teapot"});
  expect("teapod",
         {"teapod", "teapot", "sphere", "torus_knot", "boxes", "hairball", "gyroid", "soup"});
  expect("teapot?m=3", {"teapot", "'m'", "known are n"});
  expect("teapot?n", {"teapot", "n needs a value"});
  expect("teapot?n=", {"teapot", "n must be", "''"});
  expect("teapot?n=3x", {"n must be", "'3x'"});
  expect("teapot?n=99999999999", {"n must be", "'99999999999'"});
  expect("teapot?n=0", {"teapot: n must lie in [1,", "got 0"});
  expect("teapot?n=3&n=4", {"n is given twice"});
  expect("sphere?rings=1", {"sphere: rings"});
  expect("torus_knot?p=2&q=4", {"p and q", "2 and 4"});
  expect("boxes?fill=nan", {"boxes: fill", "nan"});
  expect("hairball?strands=100000000&segments=100", {"strands and segments", "32-bit"});
  expect("hairball?seed=-1", {"seed must be", "'-1'"});
  expect("soup?min_size=0.5&max_size=0.1", {"soup: min_size", "0.5"});
  expect("gyroid?periods=inf", {"gyroid: periods", "inf"});
}

}  // namespace
}  // namespace rastrum::test::spec_test
