// SPDX-License-Identifier: BSD-3-Clause
// The C interface's pictures have the bits of C++'s pictures of the same scene.
#include <cstring>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/render.hpp>
#include <rastrum/version.hpp>

#include "tests/c/handles.hpp"
#include "tests/support/array_layouts.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::c_pictures_test {
namespace {

constexpr int kW = 96, kH = 72;
constexpr unsigned kKinds = kPicture | kSurfaces | kScalars;
constexpr double kPlaced[16] = {0.8, 0.1,  0,   0.2,  -0.1, 0.7, 0.2, 0,
                                0,   -0.2, 0.9, -0.1, 0,    0,   0,   1};

/// Sets the camera of the tests in both languages.
void place(rastrum_camera* camera) {
  const double eye[3] = {1.5, 1, 3}, target[3] = {0, 0.1, 0}, up[3] = {0, 1, 0.1};
  expect_ok(rastrum_camera_look_at(camera, eye, target, up));
  expect_ok(rastrum_camera_set_perspective(camera, 0.9F));
  expect_ok(rastrum_camera_set_planes(camera, 0.5F, 20));
}
const Camera kCamera{.eye = {1.5, 1, 3},
                     .target = {0, 0.1, 0},
                     .up = {0, 1, 0.1},
                     .fov_rad = 0.9F,
                     .near_plane = 0.5F,
                     .far_plane = 20};

FrameOptions options() {
  return {.width = kW, .height = kH};
}

/// Compares C++'s picture of `instances` with `picture`'s.
void expect_same(const CPicture& picture, std::span<const InstanceView> instances,
                 const FrameOptions& o = options(), unsigned kinds = kKinds,
                 std::span<const ScalarMapping> mappings = {}) {
  place(picture.camera.get());
  const Frame expected = draw(RendererOptions{}, {instances, {}, {}, mappings}, kCamera, o, kinds);
  EXPECT_TRUE(same_images(picture.draw(kinds), expected, kinds));
  EXPECT_GT(expected.stats.pixels_covered, 50U);
}

std::vector<double> wide(const std::vector<Vec3>& vectors) {
  std::vector<double> numbers;
  for (const Vec3 v : vectors) numbers.insert(numbers.end(), {v.x + 1e-9, v.y, v.z});
  return numbers;
}

const Sheet& sheet() {
  static const Sheet made(9);
  return made;
}

TEST(CPictures, MeshesOfAnyLayout) {
  const Sheet& s = sheet();
  const std::vector<double> doubles = wide(s.positions);
  struct Vertex {
    Vec3 position;
    std::uint8_t rgb[3];
    std::int16_t normal[3];
  };
  std::vector<Vertex> vertices;
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    Vertex v{s.positions[i], {}, {1000, static_cast<std::int16_t>(i * 100), 30000}};
    std::memcpy(v.rgb, &s.colors8[4 * i], 3);
    vertices.push_back(v);
  }
  const std::vector<std::int64_t> long_indices(s.indices.begin(), s.indices.end());
  const std::vector<std::uint16_t> short_indices(s.indices.begin(), s.indices.end());
  constexpr std::ptrdiff_t kStride = sizeof(Vertex);
  const std::size_t n = vertices.size();

  {
    SCOPED_TRACE("packed");
    const CPicture p{kW, kH};
    size_t i = 9;
    expect_ok(
        rastrum_scene_add_mesh(p.scene.get(), array_of(s.positions), array_of(s.indices), &i));
    EXPECT_EQ(i, 0U);
    expect_same(p, KeptInstances{MeshView{.positions = s.positions, .indices = s.indices}});
    expect_ok(
        rastrum_instance_set_colors(p.scene.get(), i, array_of(s.colors8, 4), RASTRUM_PER_VERTEX));
    expect_ok(
        rastrum_instance_set_normals(p.scene.get(), i, array_of(s.normals), RASTRUM_PER_VERTEX));
    MeshView mesh{.positions = s.positions, .indices = s.indices, .normals = {s.normals}};
    mesh.colors.values = ArrayView<Vec4>::of(s.colors8.data(), n);
    expect_same(p, KeptInstances{mesh});
  }
  {
    SCOPED_TRACE("float64");
    const CPicture p{kW, kH};
    expect_ok(rastrum_scene_add_mesh(p.scene.get(), array_of(doubles, 3), array_of(long_indices),
                                     nullptr));
    expect_same(p, KeptInstances{MeshView{.positions = ArrayView<Vec3>::of(doubles.data(), n),
                                          .indices = long_indices}});
  }
  {
    SCOPED_TRACE("interleaved");
    const CPicture p{kW, kH};
    expect_ok(rastrum_scene_add_mesh(p.scene.get(),
                                     {&vertices[0].position, n, RASTRUM_FLOAT32, 0, kStride},
                                     array_of(short_indices), nullptr));
    expect_ok(rastrum_instance_set_normals(
        p.scene.get(), 0, {vertices[0].normal, n, RASTRUM_INT16, 3, kStride}, RASTRUM_PER_VERTEX));
    expect_ok(rastrum_instance_set_colors(
        p.scene.get(), 0, {vertices[0].rgb, n, RASTRUM_UINT8, 3, kStride}, RASTRUM_PER_VERTEX));
    MeshView mesh{.positions = ArrayView<Vec3>::of(&vertices[0].position.x, n, kStride),
                  .indices = short_indices};
    mesh.normals.values = ArrayView<Vec3>::of(vertices[0].normal, n, kStride);
    mesh.colors.values = ArrayView<Vec4>::rgb(vertices[0].rgb, n, kStride);
    expect_same(p, KeptInstances{mesh});
  }
  {
    SCOPED_TRACE("backwards, without indices");
    const CPicture p{kW, kH};
    const double* const last = &doubles[3 * (n - 1)];
    const std::size_t whole = n / 3 * 3;
    expect_ok(rastrum_scene_add_mesh(p.scene.get(), {last, whole, RASTRUM_FLOAT64, 3, -24}, kNone,
                                     nullptr));
    expect_same(p, KeptInstances{MeshView{.positions = ArrayView<Vec3>::of(last, whole, -24)}});
  }
}

TEST(CPictures, LooksOfInstances) {
  const Sheet& s = sheet();
  const CPicture p{kW, kH};
  rastrum_scene* const scene = p.scene.get();
  const float green[4] = {0.1F, 0.7F, 0.2F, 0.8F};
  size_t first = 0, second = 0, third = 0;
  expect_ok(rastrum_scene_add_mesh(scene, array_of(s.positions), array_of(s.indices), &first));
  expect_ok(rastrum_scene_add_copy(scene, first, &second));
  expect_ok(rastrum_instance_set_transform(scene, second, kPlaced));
  expect_ok(rastrum_instance_set_color(scene, second, green));
  expect_ok(rastrum_instance_set_opacity(scene, second, 0.5F));
  expect_ok(rastrum_instance_set_id(scene, second, 77));
  expect_ok(rastrum_scene_add_copy(scene, second, &third));
  expect_ok(rastrum_instance_set_color(scene, third, nullptr));
  expect_ok(rastrum_instance_set_normals(scene, third, array_of(s.normals), RASTRUM_PER_VERTEX));
  expect_ok(rastrum_instance_set_visible(scene, first, 0));

  const MeshView mesh{.positions = s.positions, .indices = s.indices};
  std::vector<InstanceView> instances(3, InstanceView{mesh});
  instances[1].object_to_world = matrix_from_rows(kPlaced);
  instances[1].color = Vec4{0.1F, 0.7F, 0.2F, 0.8F};
  instances[1].opacity = 0.5F;
  instances[1].id = 77;
  instances[2] = instances[1];
  instances[2].color.reset();
  MeshView smooth = mesh;  // a copy has attributes of its own
  smooth.normals.values = s.normals;
  instances[2].geometry = smooth;
  instances[0].visible = false;
  expect_same(p, instances);
}

TEST(CPictures, NumbersAsColours) {
  const Sheet& s = sheet();
  std::vector<float> heights;
  for (const Vec3 v : s.positions) heights.push_back(v.z);
  std::vector<std::int32_t> of_faces;
  for (int i = 0; i < static_cast<int>(s.indices.size() / 3); ++i) of_faces.push_back(i % 7);
  const CPicture p{kW, kH};
  rastrum_scene* const scene = p.scene.get();
  size_t hot = 9, listed = 9;
  expect_ok(rastrum_scene_add_color_map(scene, "viridis", &hot));
  expect_ok(rastrum_scene_add_color_map(scene, "#ff0000, #00ff00", &listed));
  EXPECT_EQ(hot, 0U);
  EXPECT_EQ(listed, 1U);
  expect_ok(rastrum_scene_set_color_range(scene, listed, -1, 5));
  for (size_t i = 0; i < 2; ++i)
    expect_ok(rastrum_scene_add_mesh(scene, array_of(s.positions), array_of(s.indices), nullptr));
  expect_ok(rastrum_instance_set_scalars(scene, 0, array_of(heights), RASTRUM_PER_VERTEX, hot));
  expect_ok(rastrum_instance_set_scalars(scene, 1, array_of(of_faces), RASTRUM_PER_FACE, listed));
  expect_ok(rastrum_instance_set_transform(scene, 1, kPlaced));

  std::vector<InstanceView> instances(2);
  const MeshView mesh{.positions = s.positions, .indices = s.indices, .scalars = {heights}};
  instances[0] = {mesh};
  MeshView by_face = mesh;
  by_face.scalars = {of_faces, Per::face};
  instances[1] = {by_face, matrix_from_rows(kPlaced)};
  instances[1].scalar_mapping = 1;
  const ScalarMapping mappings[2] = {
      {}, {.map = color_map_or_list("#ff0000, #00ff00"), .range = ScalarRange{-1, 5}}};
  expect_same(p, instances, options(), kKinds, mappings);
}

TEST(CPictures, OtherGeometries) {
  const std::vector<Vec3> at{{-0.8F, -0.5F, 0}, {-0.2F, 0.6F, 0.3F}, {0.3F, -0.3F, 0.5F},
                             {0.9F, 0.4F, 0},   {0.1F, 0.9F, -0.4F}, {-0.6F, 0.1F, 0.6F}};
  const std::vector<float> radii{0.1F, 0.2F, 0.05F, 0.15F, 0.1F, 0.12F};
  const std::vector<float> sizes{3, 9, 5, 7, 2, 6};
  const std::vector<float> colors{1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0, 0, 1, 1, 1, 0, 1};
  const std::vector<std::int32_t> pairs{0, 3, 1, 2}, runs{0, 2, 6}, polygons{0, 1, 2, 3, 4};
  const std::vector<std::int64_t> one_face{0, 5};
  const CPicture p{kW, kH};
  rastrum_scene* const scene = p.scene.get();
  expect_ok(rastrum_scene_add_points(scene, array_of(at), 6, nullptr));
  expect_ok(rastrum_instance_set_radii(scene, 0, array_of(sizes)));
  expect_ok(rastrum_instance_set_normals(scene, 0, array_of(at), RASTRUM_PER_VERTEX));
  expect_ok(rastrum_scene_add_lines(scene, array_of(at), array_of(pairs), 3, nullptr));
  expect_ok(rastrum_scene_add_lines(scene, array_of(at), kNone, 1, nullptr));
  expect_ok(rastrum_instance_set_offsets(scene, 2, array_of(runs)));
  expect_ok(rastrum_scene_add_spheres(scene, array_of(at), 0.1F, nullptr));
  expect_ok(rastrum_instance_set_radii(scene, 3, array_of(radii)));
  expect_ok(rastrum_instance_set_colors(scene, 3, array_of(colors, 3), RASTRUM_PER_VERTEX));
  expect_ok(rastrum_scene_add_cylinders(scene, array_of(at), array_of(pairs), 0.07F, nullptr));
  expect_ok(rastrum_scene_add_tubes(scene, array_of(at), 0.04F, nullptr));
  expect_ok(rastrum_instance_set_offsets(scene, 5, array_of(runs)));
  expect_ok(rastrum_scene_add_mesh(scene, array_of(at), array_of(polygons), nullptr));
  expect_ok(rastrum_instance_set_offsets(scene, 6, array_of(one_face)));

  const ArrayView<Vec4> rgb = ArrayView<Vec4>::rgb(colors.data(), at.size());
  expect_same(
      p,
      KeptInstances{
          PointsView{.positions = at, .normals = at, .sizes = sizes, .point_size = 6},
          LinesView{.positions = at, .indices = pairs, .line_width = 3},
          LinesView{.positions = at, .kind = LineKind::polylines, .offsets = runs},
          SpheresView{.centers = at, .radii = radii, .colors = rgb},
          CylindersView{.positions = at, .indices = pairs, .radius = 0.07F},
          TubesView{.positions = at, .offsets = runs, .radius = 0.04F},
          MeshView{.positions = at, .indices = polygons, .faces = {FaceKind::polygons, one_face}}});
}

TEST(CPictures, OptionsOfFrames) {
  const Sheet& s = sheet();
  const CPicture p{kW, kH};
  rastrum_frame* const frame = p.frame.get();
  const float background[4] = {0.2F, 0.3F, 0.4F, 1}, white[3] = {1, 0.9F, 0.8F};
  const double planes[8] = {1, 0, 0, 0.7, 0, 1, 0.5, 0.6}, down[3] = {-0.3, -1, -0.5};
  const double place_of_lamp[3] = {0.5, 0.2, 2};
  expect_ok(
      rastrum_scene_add_mesh(p.scene.get(), array_of(s.positions), array_of(s.indices), nullptr));
  expect_ok(rastrum_frame_set_shader(frame, "lambert"));
  expect_ok(rastrum_frame_set_background(frame, background));
  expect_ok(rastrum_frame_set_samples(frame, 4));
  expect_ok(rastrum_frame_set_opacity(frame, 0.7F));
  expect_ok(rastrum_frame_set_cull(frame, RASTRUM_CULL_FRONT));
  expect_ok(rastrum_frame_set_cull(frame, RASTRUM_CULL_NONE));
  expect_ok(rastrum_frame_set_clip_planes(frame, planes, 2));
  expect_ok(rastrum_frame_add_light(frame, RASTRUM_LIGHT_AMBIENT, nullptr, white, 0.2F, 0));
  expect_ok(rastrum_frame_add_light(frame, RASTRUM_LIGHT_DIRECTIONAL, down, white, 0.8F, 1));
  expect_ok(rastrum_frame_add_light(frame, RASTRUM_LIGHT_POINT, place_of_lamp, white, 0.5F, 0));
  expect_ok(rastrum_frame_set_shadows(frame, 1));
  expect_ok(rastrum_renderer_set_threads(p.renderer.get(), 1));
  expect_ok(rastrum_renderer_set_device(p.renderer.get(), "threads"));

  FrameOptions o = options();
  o.shader = Shader::lambert;
  o.background = {0.2F, 0.3F, 0.4F, 1};
  o.samples = 4;
  o.opacity = 0.7F;
  o.clip_planes = {{{1, 0, 0}, 0.7}, {{0, 1, 0.5}, 0.6}};
  const Vec3 rgb{1, 0.9F, 0.8F};
  o.lights = {{.kind = AmbientLight{}, .color = rgb, .intensity = 0.2F},
              {.kind = DirectionalLight{{-0.3F, -1, -0.5F}},
               .color = rgb,
               .intensity = 0.8F,
               .of_camera = true},
              {.kind = PointLight{.position = {0.5, 0.2, 2}}, .color = rgb, .intensity = 0.5F}};
  o.shadows = true;
  expect_same(p, KeptInstances{MeshView{.positions = s.positions, .indices = s.indices}}, o,
              kPicture);
}

TEST(CPictures, RowsBottomUpInAWiderPicture) {
  const Sheet& s = sheet();
  const CPicture p{kW, kH};
  place(p.camera.get());
  expect_ok(
      rastrum_scene_add_mesh(p.scene.get(), array_of(s.positions), array_of(s.indices), nullptr));
  const Frame straight = p.draw(kColor8);
  constexpr int kWide = kW + 5;
  std::vector<Rgba8> wider(static_cast<std::size_t>(kWide * kH));
  expect_ok(rastrum_frame_set_target(p.frame.get(), "color8", &wider[(kH - 1) * kWide],
                                     wider.size() * 4, -kWide * 4));
  expect_ok(p.render());
  for (int y = 0; y < kH; ++y)
    EXPECT_EQ(std::memcmp(&wider[static_cast<std::size_t>((kH - 1 - y) * kWide)],
                          &straight.color8(0, y), kW * 4),
              0)
        << y;
  char hex[65];
  expect_ok(rastrum_frame_digest(p.frame.get(), "color8", hex));
  EXPECT_EQ(hex, digest(straight.color8).hex());
}

/// Expects that a camera's matrix has the bits of C++'s.
void expect_same_camera(const CCamera& camera, const Camera& expected) {
  double got[16];
  expect_ok(rastrum_camera_get_matrix(camera.get(), kW, kH, got));
  const Mat4d m = world_to_clip(expected, kW, kH);
  EXPECT_EQ(std::memcmp(got, m.m, sizeof got), 0);
}

TEST(CPictures, Cameras) {
  const Sheet& s = sheet();
  const CCamera camera(rastrum_camera_new());
  expect_same_camera(camera, Camera{});
  place(camera.get());
  expect_same_camera(camera, kCamera);
  Camera parallel = kCamera;
  parallel.orthographic = true;
  parallel.orthographic_height = 3;
  expect_ok(rastrum_camera_set_orthographic(camera.get(), 3));
  expect_same_camera(camera, parallel);

  const double pose[16] = {1, 0, 0, 0.1, 0, -1, 0, 0.2, 0, 0, -1, 3, 0, 0, 0, 1};
  const double lens[6] = {80, 82, 47, 35, 0.5, 0};
  expect_ok(rastrum_camera_set_opencv(camera.get(), lens, pose, kW, kH, 0.1));
  const Intrinsics k{.fx = 80, .fy = 82, .cx = 47, .cy = 35, .skew = 0.5};
  const Camera seen = camera_from_opencv(k, matrix_from_rows(pose), kW, kH, 0.1);
  expect_same_camera(camera, seen);

  // Fitting keeps the matrix's direction, as in C++.
  Camera both = parallel;
  both.matrix = seen.matrix;
  const CScene scene(rastrum_scene_new());
  expect_ok(
      rastrum_scene_add_mesh(scene.get(), array_of(s.positions), array_of(s.indices), nullptr));
  const OneInstance instance(MeshView{.positions = s.positions, .indices = s.indices});
  expect_ok(rastrum_camera_fit(camera.get(), scene.get(), kW, kH));
  expect_same_camera(camera, fit_picture(instance.view(), both, kW, kH));

  const Mat4d m = world_to_clip(kCamera, kW, kH);
  expect_ok(rastrum_camera_set_matrix(camera.get(), &m.m[0][0], RASTRUM_DEPTH_REVERSED));
  expect_same_camera(camera, kCamera);
  expect_ok(rastrum_camera_set_matrix(camera.get(), &m.m[0][0], RASTRUM_DEPTH_OPENGL));
  expect_same_camera(camera, camera_from_matrix(m, ClipDepth::opengl));
}

TEST(CPictures, TargetsSayTheirNumbers) {
  const auto numbers = [](const char* name) {
    int type = -1, channels = -1;
    expect_ok(rastrum_target_type(name, &type, &channels));
    return std::pair(type, channels);
  };
  EXPECT_EQ(numbers("color8"), std::pair(+RASTRUM_UINT8, 4));
  EXPECT_EQ(numbers("color"), std::pair(+RASTRUM_FLOAT32, 4));
  EXPECT_EQ(numbers("normals"), std::pair(+RASTRUM_FLOAT32, 3));
  EXPECT_EQ(numbers("barycentrics"), std::pair(+RASTRUM_FLOAT32, 2));
  EXPECT_EQ(numbers("depth"), std::pair(+RASTRUM_FLOAT32, 1));
  EXPECT_EQ(numbers("ids"), std::pair(+RASTRUM_INT64, 1));
  EXPECT_EQ(numbers("ids32"), std::pair(+RASTRUM_INT32, 1));
  EXPECT_EQ(numbers("keys"), std::pair(+RASTRUM_UINT64, 1));
  EXPECT_EQ(numbers("overdraw"), std::pair(+RASTRUM_UINT32, 1));
  EXPECT_EQ(numbers("errors"), std::pair(+RASTRUM_UINT8, 1));
}

TEST(CPictures, TheVersionIsTheLibrarys) {
  EXPECT_EQ(rastrum_version(), version());
}

/// draw.c and draw.f90 print the digest of this picture.
TEST(CPictures, TheExamplesDrawTheSame) {
  const std::vector<Vec3> positions{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  const std::vector<std::uint32_t> triangles{0, 1, 3, 0, 2, 1, 0, 3, 2, 1, 2, 3};
  const std::vector<Vec4> colors{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 0, 1}};
  MeshView mesh{.positions = positions, .indices = triangles};
  mesh.colors.values = colors;
  const InstanceView instance{mesh};
  const SceneView scene{{&instance, 1}, {}, {}, {}};
  const Camera camera = fit_picture(scene, {.eye = {3, 2, 5}}, 320, 240);
  const Image<Rgba8> image =
      render(scene, camera, {.width = 320, .height = 240, .background = {1, 1, 1, 1}});
  EXPECT_EQ(digest(image).hex(), RASTRUM_DRAW_DIGEST);
}

}  // namespace
}  // namespace rastrum::test::c_pictures_test
