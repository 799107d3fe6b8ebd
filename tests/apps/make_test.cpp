// SPDX-License-Identifier: BSD-3-Clause
// `rastrum make` writes the shape in order, at its place.
#include <rastrum/io.hpp>
#include <rastrum/shapes.hpp>

#include "flatten.hpp"
#include "program.hpp"

namespace rastrum::test::make_test {
namespace {

using Make = Program;

TEST_F(Make, WritesTheShape) {
  must("make torus_knot?segments=20,sides=5 -o k.ply");
  const Scene read = io::read_scene(path("k.ply"));
  const Mesh expected = shapes::torus_knot(2, 3, 20, 5);
  ASSERT_EQ(read.meshes.size(), 1U);
  EXPECT_EQ(read.meshes[0].positions, expected.positions);
  EXPECT_EQ(read.meshes[0].indices, expected.indices);
  EXPECT_EQ(read.meshes[0].normals.values, expected.normals.values);
}

TEST_F(Make, EveryShapeOfTheCatalogueIsListedInHelp) {
  const std::string help = run("make --help").out;
  for (const shapes::ShapeInfo& shape : shapes::catalogue()) {
    EXPECT_TRUE(holds(help, "\n  " + shape.name)) << shape.name;
    EXPECT_TRUE(holds(help, shape.description)) << shape.name;
  }
}

TEST_F(Make, SubdividesAFile) {
  write("q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  must("make q.obj --subdivide 2 -o q.ply");
  const Scene read = io::read_scene(path("q.ply"));
  EXPECT_EQ(read.meshes[0].triangle_count(), 32U);
  EXPECT_EQ(read.meshes[0].positions.size(), 25U) << "shared edges share their vertices";
}

TEST_F(Make, PlacesTheShape) {
  must("make boxes?count=1,x=5,scale=2 -o b.ply");
  const Scene read = io::read_scene(path("b.ply"));
  const Bounds placed = bounds(SceneBinding(read).view());
  const Scene plain = scene_of(shapes::boxes(1));
  const Bounds b = bounds(SceneBinding(plain).view());
  EXPECT_EQ(Vec3(placed.min), Vec3(b.min * 2 + Vec3d{5, 0, 0}));
  EXPECT_EQ(Vec3(placed.max), Vec3(b.max * 2 + Vec3d{5, 0, 0}));
}

TEST_F(Make, RefusesWhatItCannotDo) {
  for (const char* line : {"make cube -o c.ply", "make sphere", "make sphere -o s.obj",
                           "make sphere --subdivide -1 -o s.ply", "make spheres -o s.ply"})
    EXPECT_EQ(run(line).status, 2) << line;
  EXPECT_EQ(run("make gone.obj -o s.ply").status, 1);
  EXPECT_TRUE(files().empty());
}

TEST(Flatten, InstancesInOrderWithTheirMatrices) {
  Scene scene = scene_of(shapes::sphere(3, 4));
  scene.meshes[0].texcoords = {};  // numbered apart from the positions, because of the seam
  Mat4d m = Mat4d::identity();
  m.m[0][0] = 2;  // a stretch tilts normals
  m.m[0][3] = 10;
  scene.instances.push_back({0, m});
  const Mesh& sphere = scene.meshes[0];
  const std::size_t vertices = sphere.positions.size();
  const cli::Flattened flat = cli::flatten(scene);
  ASSERT_EQ(flat.mesh.positions.size(), 2 * vertices);
  ASSERT_EQ(flat.mesh.triangle_count(), 2 * sphere.triangle_count());
  EXPECT_TRUE(flat.warnings.empty());
  for (std::size_t i = 0; i < sphere.indices.size(); ++i) {
    EXPECT_EQ(flat.mesh.indices[i], sphere.indices[i]);
    EXPECT_EQ(flat.mesh.indices[sphere.indices.size() + i], sphere.indices[i] + vertices);
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    const Vec3 p = sphere.positions[i], n = sphere.normals.values[i];
    EXPECT_EQ(flat.mesh.positions[i], p);
    EXPECT_EQ(flat.mesh.normals.values[i], n);
    EXPECT_EQ(flat.mesh.positions[vertices + i], (Vec3{2 * p.x + 10, p.y, p.z}));
    const Vec3 leaning = normalize(Vec3{n.x / 2, n.y, n.z});
    EXPECT_NEAR(length(flat.mesh.normals.values[vertices + i] - leaning), 0, 1e-6);
  }
}

TEST(Flatten, SaysWhatPlyCannotHold) {
  Scene scene = scene_of(shapes::sphere(3, 4));
  scene.meshes[0].texcoords = {};
  Scene other = scene_of(shapes::boxes(1));
  other.meshes[0].normals = {};
  other.meshes[0].texcoords = {};
  scene.append(other);
  scene.materials.emplace_back();
  const cli::Flattened flat = cli::flatten(scene);
  EXPECT_TRUE(flat.mesh.normals.empty());
  ASSERT_EQ(flat.warnings.size(), 2U);
  EXPECT_EQ(flat.warnings[0].find("the normals are left out"), 0U);
  EXPECT_EQ(flat.warnings[1].find("the materials are left out"), 0U);
}

TEST(Flatten, AttributesNumberedApartAreLeftOutAndSaid) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2};
  mesh.normals.values = {{0, 0, 1}};
  mesh.normals.indices = {0, 0, 0};
  scene.instances.emplace_back();
  const cli::Flattened flat = cli::flatten(scene);
  EXPECT_TRUE(flat.mesh.normals.empty());
  ASSERT_EQ(flat.warnings.size(), 1U);
  EXPECT_EQ(flat.warnings[0].find("the normals are left out"), 0U);
}

}  // namespace
}  // namespace rastrum::test::make_test
