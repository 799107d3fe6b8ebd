// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/scene.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/scene/rig.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/matrices.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::scene_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.emplace_back();
  return scene;
}

TEST(Bounds, IgnoreUnusedAndNonFiniteVertices) {
  Mesh mesh{.positions = {{1, 2, 3},
                          {99, 0, 0},
                          {-4, 5, 6},
                          {kNan, 0, -50},
                          {7, -8, 9},
                          {0, kInfinity, 0},
                          {0, 0, -77}},
            .indices = {0, 2, 4, 3, 5, 0}};
  const Scene scene = scene_of(mesh);
  const Bounds b = bounds(SceneBinding(scene).view());
  EXPECT_EQ(b.min, (Vec3d{-4, -8, 3}));
  EXPECT_EQ(b.max, (Vec3d{7, 5, 9}));
  EXPECT_EQ(b.vertices_in_use, 3U);
}

TEST(Bounds, WithoutIndicesPositionsAreWholeTriangles) {
  Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  Scene scene = scene_of(mesh);
  const Bounds b = bounds(SceneBinding(scene).view());
  EXPECT_EQ(b.vertices_in_use, 3U);
  EXPECT_EQ(b.max, (Vec3d{1, 1, 0}));
  scene.meshes[0].positions.push_back({50, 50, 50});
  EXPECT_THROW((void)bounds(SceneBinding(scene).view()), Error);
}

TEST(Bounds, AreInWorldSpaceOverAllInstances) {
  Scene scene = scene_of(shapes::boxes(1, 1));
  scene.instances.push_back({0, Mat4d::identity()});
  // A quarter turn about z, doubled, and shifted along x.
  scene.instances[1].object_to_world = {{{0, -2, 0, 10}, {2, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  const Bounds b = bounds(SceneBinding(scene).view());
  EXPECT_EQ(b.min, (Vec3d{-0.5F, -1, -0.5F}));
  EXPECT_EQ(b.max, (Vec3d{11, 1, 0.5F}));
  EXPECT_EQ(b.vertices_in_use, 16U);
}

TEST(Bounds, RefuseIndicesOutOfRange) {
  Mesh mesh = shapes::boxes(1);
  mesh.indices[7] = 8;
  const Scene scene = scene_of(mesh);
  EXPECT_THROW(static_cast<void>(bounds(SceneBinding(scene).view())), Error);
}

TEST(Bounds, OfNothingHaveNoVertices) {
  const Scene scene;
  EXPECT_EQ(bounds(SceneBinding(scene).view()).vertices_in_use, 0U);
}

/// A second version of `--fit`'s definition.
void expect_fitted(const Camera& c, Vec3 centre, double r, double fov, bool orthographic) {
  const double distance = r / std::sin(fov / 2);
  const double tolerance = 1e-5 * (distance + static_cast<double>(length(centre)));
  expect_near(c.target, Vec3d(centre), tolerance);
  expect_near(c.eye, Vec3d(centre) + Vec3d{0, 0, distance}, tolerance);
  EXPECT_EQ(Vec3(c.up), (Vec3{0, 1, 0}));
  EXPECT_EQ(c.fov_rad, static_cast<float>(fov));
  EXPECT_EQ(c.orthographic, orthographic);
  EXPECT_NEAR(c.near_plane, std::max(distance - 1.001 * r, distance / 1000), 1e-5 * distance);
  if (orthographic) {
    EXPECT_NEAR(c.far_plane, distance + 1.001 * r, 1e-5 * distance);
    EXPECT_NEAR(c.orthographic_height, 2 * r, 1e-5 * r);
  } else {
    EXPECT_EQ(c.far_plane, kInfinity);
  }
  EXPECT_NO_THROW(static_cast<void>(world_to_clip(c, 640, 480)));
}

TEST(FitCamera, FollowsItsDefinition) {
  Mesh mesh;
  // The farthest vertex from the box's centre (2, 0, 1) is (6, 3, 1), 5 away; the last is unused.
  mesh.positions = {{6, 3, 1}, {-2, 0, 1}, {2, -3, 2}, {2, 0, 0}, {1000, 0, 0}};
  mesh.indices = {0, 1, 2, 0, 1, 3};
  const Scene scene = scene_of(mesh);
  const SceneBinding binding(scene);
  for (const double fov : {std::numbers::pi / 3, 0.5, 3.0}) {
    const auto rounded = static_cast<double>(static_cast<float>(fov));
    for (const bool orthographic : {false, true})
      expect_fitted(fit_camera(binding.view(), static_cast<float>(fov), orthographic), {2, 0, 1}, 5,
                    rounded, orthographic);
  }
}

TEST(FitCamera, RadiusZeroCountsAsOne) {
  Mesh point{.positions = {{5, 6, 7}, {5, 6, 7}, {5, 6, 7}}};
  const Scene scene = scene_of(point);
  const Scene nothing;
  const double fov = static_cast<double>(1.0F);
  for (const bool orthographic : {false, true}) {
    expect_fitted(fit_camera(SceneBinding(scene).view(), 1, orthographic), {5, 6, 7}, 1, fov,
                  orthographic);
    expect_fitted(fit_camera(SceneBinding(nothing).view(), 1, orthographic), {0, 0, 0}, 1, fov,
                  orthographic);
  }
}

TEST(FitCamera, RefusesFieldsOfViewThatAreNone) {
  const Scene scene = scene_of(shapes::boxes(1));
  const SceneBinding binding(scene);
  for (const float fov : {0.0F, -1.0F, 3.14159274F, 4.0F, kNan, kInfinity})
    for (const bool orthographic : {false, true}) {
      expect_refused("field of view",
                     [&] { static_cast<void>(fit_camera(binding.view(), fov, orthographic)); });
    }
}

TEST(FitCamera, SeesTheWholeScene) {
  const Scene scene = scene_of(shapes::teapot(8));
  const SceneBinding binding(scene);
  for (const bool orthographic : {false, true}) {
    const Camera c = fit_camera(binding.view(), 1, orthographic);
    const Mat4 m = static_cast<Mat4>(world_to_clip(c, 300, 200));
    for (const Vec3 p : scene.meshes[0].positions) {
      const Vec4 q = transform_point(m, p);
      EXPECT_LE(std::abs(q.x), q.w);
      EXPECT_LE(std::abs(q.y), q.w);
      EXPECT_GE(q.z, 0);
      EXPECT_LE(q.z, q.w);
    }
  }
}

TEST(VertexNormals, AreAreaWeighted) {
  // Two right triangles at vertex 0: one of area 2 in the xy plane, one of area 1/2 in the yz
  // plane.
  const std::vector<Vec3> positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0},
                                       {0, 1, 0}, {0, 0, 1}, {9, 9, 9}};
  const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 3, 4};
  const std::vector<Vec3> n = vertex_normals(positions, indices);
  ASSERT_EQ(n.size(), positions.size());
  expect_near(Vec3d(n[0]), Vec3d(normalize(Vec3{1, 0, 4})), 1e-6);
  EXPECT_EQ(n[1], (Vec3{0, 0, 1}));
  EXPECT_EQ(n[3], (Vec3{1, 0, 0}));
  EXPECT_EQ(n[5], (Vec3{0, 0, 0}));
}

TEST(VertexNormals, IgnoreNonFiniteTrianglesAndZeroArea) {
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {kNan, 0, 0}, {2, 0, 0}};
  const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 1, 3, 0, 1, 4};
  const std::vector<Vec3> n = vertex_normals(positions, indices);
  EXPECT_EQ(n[0], (Vec3{0, 0, 1}));
  EXPECT_EQ(n[1], (Vec3{0, 0, 1}));
  EXPECT_EQ(n[3], (Vec3{0, 0, 0}));
  EXPECT_EQ(n[4], (Vec3{0, 0, 0}));
}

TEST(VertexNormals, WithoutIndicesPositionsAreInOrder) {
  std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {5, 6, 5}, {5, 5, 6}};
  const std::vector<Vec3> n = vertex_normals(positions, {});
  ASSERT_EQ(n.size(), positions.size());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(n[i], (Vec3{0, 0, 1}));
  for (std::size_t i = 3; i < 6; ++i) EXPECT_EQ(n[i], (Vec3{1, 0, 0}));
  positions.push_back({7, 7, 7});  // the begin of a third triangle
  EXPECT_THROW((void)vertex_normals(positions, {}), Error);
}

TEST(VertexNormals, RefuseIndicesOutOfRange) {
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (const std::uint32_t far : {3U, 4'000'000'000U}) {
    const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 2, far};
    EXPECT_EQ(
        refusal_of([&] { static_cast<void>(vertex_normals(positions, indices)); }),
        "mesh: corner 2 of triangle 1 is vertex " + std::to_string(far) + ", but there are only 3");
  }
}

TEST(VertexNormals, OfASpherePointOutward) {
  const Mesh mesh = shapes::sphere(40, 80);
  const std::vector<Vec3> n = vertex_normals(mesh.positions, mesh.indices);
  for (std::size_t i = 0; i < n.size(); ++i) EXPECT_GT(dot(n[i], mesh.positions[i]), 0.999F);
}

/// A scene of two meshes, `materials` materials and `textures` textures, whose values all contain
/// `mark`.
Scene marked_scene(float mark, std::size_t materials, std::size_t textures) {
  Scene s;
  for (int i = 0; i < 2; ++i) s.meshes.push_back(shapes::boxes(1));
  s.meshes[0].name = std::to_string(mark);
  s.instances = {{1, Mat4d::identity()}, {0, Mat4d::identity()}, {1, Mat4d::identity()}};
  s.materials.resize(materials);
  for (Material& m : s.materials) m.roughness = mark;
  s.textures.resize(textures);
  if (materials > 0 && textures > 0)
    s.materials.back().emissive_texture = static_cast<std::int32_t>(textures) - 1;
  if (materials > 0) {
    s.meshes[1].material = static_cast<std::uint32_t>(materials) - 1;
    s.meshes[0].face_materials.assign(12, static_cast<std::uint32_t>(materials) - 1);
  }
  s.warnings = {std::to_string(mark)};
  s.cameras.resize(1);
  return s;
}

TEST(Scene, AnInstanceOfNoMeshIsRefused) {
  Scene scene = scene_of(shapes::boxes(1));
  scene.instances.push_back({7, Mat4d::identity()});
  EXPECT_THROW(static_cast<void>(scene.triangle_count()), Error);
  EXPECT_EQ(refusal_of([&] { const SceneBinding binding(scene); }),
            "scene: an instance is of mesh 7, but there are only 1");
}

TEST(SceneAppend, ShiftsIndices) {
  Scene a = marked_scene(0.25F, 2, 3);
  a.append(marked_scene(0.5F, 3, 2));
  ASSERT_EQ(a.meshes.size(), 4U);
  ASSERT_EQ(a.materials.size(), 5U);
  ASSERT_EQ(a.textures.size(), 5U);
  EXPECT_EQ(a.cameras.size(), 2U);
  EXPECT_EQ(a.warnings.size(), 2U);
  const std::uint32_t expected[] = {1, 0, 1, 3, 2, 3};
  ASSERT_EQ(a.instances.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(a.instances[i].mesh, expected[i]);
  EXPECT_EQ(a.meshes[1].material, 1U);
  EXPECT_EQ(a.meshes[2].material, 2U);
  EXPECT_EQ(a.meshes[3].material, 4U);
  EXPECT_EQ(a.meshes[2].face_materials, std::vector<std::uint32_t>(12, 4));
  EXPECT_EQ(a.materials[1].emissive_texture, 2);
  EXPECT_EQ(a.materials[4].emissive_texture, 4);
  EXPECT_EQ(a.materials[2].emissive_texture, kNoTexture);
  EXPECT_EQ(a.triangle_count(), 72U);
}

TEST(SceneBinding, GivesInstancesTheirLook) {
  Scene scene = scene_of(shapes::boxes(1));
  Instance& own = scene.instances.emplace_back();
  own.object_to_world.m[0][3] = 3;
  own.opacity = 0.25F;
  own.color = Vec4{1, 0.5F, 0.25F, 0.75F};
  own.material = 4;
  own.visible = false;
  own.winding = Winding::either;
  own.id = -7;
  own.clip_planes = {{{0, 1, 0}, 0.5}};
  const SceneBinding binding(scene);
  const InstanceView& plain = binding.view().instances[0];
  const InstanceView& view = binding.view().instances[1];
  EXPECT_EQ(view.object_to_world.m[0][3], 3);
  EXPECT_EQ(view.opacity, 0.25F);
  EXPECT_EQ(view.color, own.color);
  EXPECT_EQ(view.material, 4U);
  EXPECT_FALSE(view.visible);
  EXPECT_EQ(view.winding, Winding::either);
  EXPECT_EQ(view.id, -7);
  ASSERT_EQ(view.clip_planes.size(), 1U);
  EXPECT_EQ(view.clip_planes[0].offset, 0.5);
  EXPECT_EQ(plain.opacity, 1.0F);
  EXPECT_FALSE(plain.color || plain.material || plain.id);
  EXPECT_TRUE(plain.visible);
}

TEST(SceneAppend, ShiftsTheMaterialsOfInstances) {
  Scene a = marked_scene(0.25F, 2, 3), b = marked_scene(0.5F, 3, 2);
  b.instances[1].material = 1;
  b.instances[1].opacity = 0.5F;
  a.append(std::move(b));
  EXPECT_EQ(a.instances[4].material, 3U);
  EXPECT_EQ(a.instances[4].opacity, 0.5F);
  EXPECT_FALSE(a.instances[3].material);
}

// Without materials an instance's colour shows directly. Appending must not darken it by a plain
// material, and the material that an instance names does not exist.
TEST(SceneAppend, ColoursOfInstancesWithoutMaterialsStay) {
  Scene a = marked_scene(0.25F, 0, 0);
  a.instances[0].color = Vec4{0, 1, 0, 0.5F};
  a.instances[1].material = 9;
  a.append(marked_scene(0.5F, 2, 1));
  ASSERT_TRUE(a.instances[0].material);
  const Material& seen = a.materials[*a.instances[0].material];
  EXPECT_EQ(seen.base_color, (Vec4{1, 1, 1, 1}));
  EXPECT_EQ(seen.alpha_mode, AlphaMode::blend);
  EXPECT_FALSE(a.instances[1].material);
}

TEST(SceneAppend, FilesWithoutMaterialsLookAsTheyDid) {
  // First without, then with materials: the first file's meshes must not get the second's
  // materials.
  Scene a = marked_scene(0.25F, 0, 0);
  a.append(marked_scene(0.5F, 2, 1));
  ASSERT_EQ(a.materials.size(), 3U);
  EXPECT_EQ(a.meshes[0].material, 0U);
  EXPECT_EQ(a.materials[0].roughness, Material{}.roughness);
  EXPECT_EQ(a.materials[a.meshes[3].material].roughness, 0.5F);

  Scene b = marked_scene(0.5F, 2, 1);
  b.append(marked_scene(0.25F, 0, 0));
  ASSERT_EQ(b.materials.size(), 3U);
  EXPECT_EQ(b.materials[b.meshes[2].material].roughness, Material{}.roughness);

  Scene c = marked_scene(0.25F, 0, 0);
  c.append(marked_scene(0.5F, 0, 0));
  EXPECT_TRUE(c.materials.empty());

  // Meshes of a file keep their own colours; the others get the plain shaders' colour.
  Scene d = marked_scene(0.25F, 0, 0);
  d.meshes[1].colors.values.assign(d.meshes[1].positions.size(), {0, 1, 0, 0.5F});
  d.append(marked_scene(0.5F, 1, 0));
  ASSERT_EQ(d.materials.size(), 3U);
  const Material& plain = d.materials[d.meshes[0].material];
  const Material& colored = d.materials[d.meshes[1].material];
  EXPECT_EQ(plain.alpha_mode, AlphaMode::opaque);
  EXPECT_TRUE(plain.double_sided);
  EXPECT_LT(plain.base_color.z, plain.base_color.x);
  EXPECT_EQ(colored.base_color.x, 1.0F);
  EXPECT_EQ(colored.alpha_mode, AlphaMode::blend);
}

TEST(Cameras, OfMatricesLieAtNumbersOfFloat32) {
  const auto expect_float32 = [](const Vec3d& v) { EXPECT_EQ(v, Vec3d(Vec3(v))); };
  Mat4d m = Mat4d::identity();
  for (int i = 0; i < 3; ++i) m.m[i][3] = 0.1 + i * 0.3;
  Camera camera;
  look_from(camera, m);
  expect_float32(camera.eye);
  expect_float32(camera.target);
}

}  // namespace
}  // namespace rastrum::test::scene_test
