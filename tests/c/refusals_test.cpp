// SPDX-License-Identifier: BSD-3-Clause
// Failures of the C interface: a status and a message for the thread, and nothing changes.
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/c/handles.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::c_refusals_test {
namespace {

void expect_refused(rastrum_status got, const std::string& part,
                    rastrum_status expected = RASTRUM_INVALID_ARGUMENT) {
  EXPECT_EQ(got, expected);
  EXPECT_TRUE(holds(rastrum_error_text(), part));
}

CPicture square() {
  CPicture p{16, 16};
  expect_ok(
      rastrum_scene_add_mesh(p.scene.get(), array_of(kSquare), array_of(kTwoTriangles), nullptr));
  return p;
}

TEST(CRefusals, Null) {
  const CPicture p = square();
  const double m[16] = {};
  const float rgba[4] = {};
  char digest[65];
  std::vector<Rgba8> pixels(256);
  expect_ok(rastrum_frame_set_target(p.frame.get(), "color8", pixels.data(), 1024, 0));
  rastrum_scene* const s = p.scene.get();
  rastrum_camera* const c = p.camera.get();
  rastrum_frame* const f = p.frame.get();
  rastrum_renderer* const r = p.renderer.get();
  expect_refused(rastrum_scene_add_mesh(nullptr, kNone, kNone, nullptr), "the scene is null");
  expect_refused(rastrum_scene_add_copy(nullptr, 0, nullptr), "the scene is null");
  expect_refused(rastrum_scene_add_color_map(s, nullptr, nullptr), "colour map is null");
  expect_refused(rastrum_scene_add_color_map(nullptr, "hot", nullptr), "the scene is null");
  expect_refused(rastrum_instance_set_transform(s, 0, nullptr), "the matrix is null");
  expect_refused(rastrum_instance_set_visible(nullptr, 0, 1), "the scene is null");
  expect_refused(rastrum_camera_look_at(c, nullptr, m, m), "eye is null");
  expect_refused(rastrum_camera_fit(c, nullptr, 4, 4), "the scene is null");
  expect_refused(rastrum_camera_set_matrix(c, nullptr, 0), "world_to_clip is null");
  expect_refused(rastrum_camera_set_opencv(c, nullptr, m, 4, 4, 1), "k is null");
  expect_refused(rastrum_camera_set_planes(nullptr, 1, 2), "the camera is null");
  expect_refused(rastrum_camera_get_matrix(c, 4, 4, nullptr), "world_to_clip is null");
  expect_refused(rastrum_frame_set_shader(f, nullptr), "the name of the shader is null");
  expect_refused(rastrum_frame_set_background(nullptr, rgba), "the frame is null");
  expect_refused(rastrum_frame_set_background(f, nullptr), "rgba is null");
  expect_refused(rastrum_frame_set_clip_planes(f, nullptr, 1), "the clip planes are null");
  expect_refused(rastrum_frame_add_light(f, RASTRUM_LIGHT_POINT, nullptr, rgba, 1, 0),
                 "the place of a light is null");
  expect_refused(rastrum_frame_set_target(f, nullptr, pixels.data(), 1024, 0),
                 "the name of the target is null");
  expect_refused(rastrum_frame_set_target(f, "color8", nullptr, 1024, 0), "is null, but has 1024");
  expect_refused(rastrum_frame_digest(f, "color8", nullptr), "digest is null");
  expect_refused(rastrum_frame_digest(f, "depth", digest), "the frame has no depth target");
  expect_refused(rastrum_target_type("depth", nullptr, nullptr), "type is null");
  expect_refused(rastrum_frame_set_stopped(nullptr, 1), "the frame is null");
  expect_refused(rastrum_renderer_set_threads(nullptr, 1), "the renderer is null");
  expect_refused(rastrum_renderer_set_device(r, nullptr), "the name of the device is null");
  expect_refused(rastrum_render(nullptr, s, c, f), "the renderer is null");
  expect_refused(rastrum_render(r, nullptr, c, f), "the scene is null");
  expect_refused(rastrum_render(r, s, nullptr, f), "the camera is null");
  expect_refused(rastrum_render(r, s, c, nullptr), "the frame is null");
  expect_ok(p.render());
  rastrum_scene_free(nullptr);
  rastrum_camera_free(nullptr);
  rastrum_frame_free(nullptr);
  rastrum_renderer_free(nullptr);
}

TEST(CRefusals, Names) {
  const CPicture p = square();
  expect_refused(rastrum_frame_set_shader(p.frame.get(), "phnog"), "no shader is called 'phnog'");
  expect_refused(rastrum_frame_set_target(p.frame.get(), "colour", nullptr, 0, 0),
                 "no target is called 'colour'; there are color8, color, view_depth",
                 RASTRUM_NOT_FOUND);
  expect_refused(rastrum_scene_add_color_map(p.scene.get(), "viridsi", nullptr),
                 "did you mean 'viridis'?", RASTRUM_NOT_FOUND);
  expect_refused(rastrum_renderer_set_device(p.renderer.get(), "gpu"),
                 "no device is called 'gpu'; there are serial, threads, cuda, auto");
}

TEST(CRefusals, Arrays) {
  const CPicture p = square();
  rastrum_scene* const scene = p.scene.get();
  const rastrum_array indices = array_of(kTwoTriangles);
  const auto refused = [&](rastrum_array positions, const std::string& part) {
    expect_refused(rastrum_scene_add_mesh(scene, positions, indices, nullptr), part);
  };
  const void* const at = kSquare.data();
  refused({nullptr, 4, RASTRUM_FLOAT32, 3, 0}, "4 values at a null pointer");
  refused({at, 4, 99, 3, 0}, "array: its type is");
  refused({at, 4, 256, 3, 0}, "array: its type is");
  refused({at, 4, -1, 3, 0}, "array: its type is");
  refused({at, 4, RASTRUM_INT32, 3, 0}, "float32, float64 or normalized integers");
  refused({at, 4, RASTRUM_FLOAT32, 2, 0}, "values have 3 channels, not 2");
  refused({at, SIZE_MAX / 2, RASTRUM_FLOAT32, 3, 0}, "do not fit into memory");
  refused({at, 3, RASTRUM_FLOAT32, 3, PTRDIFF_MIN}, "do not fit into memory");
  expect_refused(rastrum_scene_add_mesh(scene, array_of(kSquare), array_of(kSquare), nullptr),
                 "indices have one channel, not 3");
  expect_refused(rastrum_instance_set_color(scene, 1, nullptr),
                 "there is no instance 1: the scene has 1");
  expect_refused(rastrum_instance_set_normals(scene, 0, array_of(kSquare), RASTRUM_PER_MESH + 1),
                 "per is");
  expect_refused(rastrum_instance_set_radii(scene, 0, kNone), "instance 0: its kind of geometry");
  expect_refused(rastrum_instance_set_scalars(scene, 0, kNone, RASTRUM_PER_VERTEX, 0),
                 "there is no colour map 0: the scene has 0");
  expect_ok(rastrum_scene_add_spheres(scene, array_of(kSquare), 1, nullptr));
  expect_refused(rastrum_instance_set_colors(scene, 1, kNone, RASTRUM_PER_FACE), "only meshes");
  expect_refused(rastrum_instance_set_offsets(scene, 1, kNone), "instance 1: its kind of geometry");
  expect_ok(p.render());

  const std::vector<std::int32_t> wrong{0, 1, 4};
  size_t number = 0;
  expect_ok(rastrum_scene_add_mesh(scene, array_of(kSquare), array_of(wrong), &number));
  EXPECT_EQ(number, 2U);
  std::vector<float> depth(256);
  expect_ok(rastrum_frame_set_target(p.frame.get(), "depth", depth.data(), 1024, 0));
  expect_refused(p.render(), "instance 2: indices[2]: index 4 is out of range");
}

TEST(CRefusals, Frames) {
  EXPECT_EQ(rastrum_frame_new(0, 5), nullptr);
  EXPECT_TRUE(holds(rastrum_error_text(), "image size 0x5"));
  EXPECT_EQ(rastrum_error_status(), RASTRUM_INVALID_ARGUMENT);
  const CPicture p = square();
  rastrum_frame* const frame = p.frame.get();
  const float nan4[4] = {NAN, 0, 0, 0};
  expect_refused(rastrum_frame_set_samples(frame, 3), "samples must be 1, 4, 8 or 16");
  expect_refused(rastrum_frame_set_opacity(frame, 2), "opacity must lie in [0, 1]");
  expect_refused(rastrum_frame_set_background(frame, nan4), "finite");
  expect_refused(rastrum_frame_set_cull(frame, 3), "cull is");
  expect_refused(rastrum_frame_set_cull(frame, 256), "cull is");
  expect_refused(rastrum_frame_add_light(frame, 7, nullptr, nan4, 1, 0), "number 7");
  expect_refused(rastrum_frame_add_light(frame, RASTRUM_LIGHT_AMBIENT, nullptr, nan4, 1, 0),
                 "light 0");
  const std::vector<double> planes(36, 1);
  expect_refused(rastrum_frame_set_clip_planes(frame, planes.data(), 9), "9 clip planes");
  expect_ok(p.render());
}

TEST(CRefusals, MemoryOfTargets) {
  const CPicture p = square();
  std::vector<Vec4> memory(16 * 16 + 1);
  const auto set = [&](const char* name, std::size_t offset, std::size_t bytes,
                       std::ptrdiff_t stride) {
    return rastrum_frame_set_target(p.frame.get(), name,
                                    reinterpret_cast<char*>(memory.data()) + offset, bytes, stride);
  };
  expect_refused(
      set("color", 0, 1024, 0),
      "the color target of 16 x 16 pixels takes 4096 bytes, not 1024: each pixel has 16");
  expect_refused(set("color8", 0, 4096, 0), "takes 1024 bytes, not 4096");
  expect_refused(set("color8", 0, 1024, 68), "takes 1084 bytes, not 1024");
  expect_refused(set("color8", 0, 1024, 6), "its rows must begin where a pixel of 4 bytes can");
  expect_refused(set("depth", 2, 1024, 0), "its rows must begin");
  expect_refused(set("depth", 0, 1024, 60), "overlap");
  expect_refused(set("depth", 0, 1024, PTRDIFF_MAX - 3), "takes");
  expect_ok(set("color8", 0, 1084, 68));
  expect_ok(set("color8", 0, 1024, -64));
  expect_ok(set("color8", 0, 1024, 0));
  expect_ok(set("depth", 512, 1024, 0));
  expect_refused(p.render(), "the targets color8 and depth overlap in memory");
}

TEST(CRefusals, CamerasStayAsTheyWere) {
  const CCamera camera(rastrum_camera_new());
  const double zero[3] = {}, flat[16] = {}, lens[6] = {};
  const auto matrix = [&] {
    std::vector<double> m(16);
    expect_ok(rastrum_camera_get_matrix(camera.get(), 16, 16, m.data()));
    return m;
  };
  const std::vector<double> before = matrix();
  expect_refused(rastrum_camera_look_at(camera.get(), zero, zero, zero), "camera");
  expect_refused(rastrum_camera_set_perspective(camera.get(), 4), "field of view");
  expect_refused(rastrum_camera_set_matrix(camera.get(), flat, RASTRUM_DEPTH_OPENGL), "singular");
  expect_refused(rastrum_camera_set_matrix(camera.get(), before.data(), 3), "clip space");
  expect_refused(rastrum_camera_set_opencv(camera.get(), lens, flat, 16, 16, 1), "fx and fy");
  EXPECT_EQ(matrix(), before);
  expect_ok(rastrum_camera_set_planes(camera.get(), 2, 1));
  double m[16];
  EXPECT_EQ(rastrum_camera_get_matrix(camera.get(), 16, 16, m), RASTRUM_INVALID_ARGUMENT);
}

TEST(CRefusals, OtherKinds) {
  const CPicture p = square();
  std::vector<Vec4> linear(256);
  expect_ok(rastrum_frame_set_target(p.frame.get(), "linear", linear.data(), 4096, 0));
  expect_refused(p.render(), "the linear target needs the shader 'material'", RASTRUM_UNSUPPORTED);
  expect_ok(rastrum_frame_set_target(p.frame.get(), "linear", nullptr, 0, 0));
  expect_ok(p.render());
  expect_ok(rastrum_frame_set_stopped(p.frame.get(), 1));
  expect_refused(p.render(), "stopped", RASTRUM_STOPPED);
  expect_ok(rastrum_frame_set_stopped(p.frame.get(), 0));
  expect_ok(p.render());
  expect_ok(rastrum_renderer_set_memory_limit(p.renderer.get(), 16));
  expect_refused(p.render(), "16", RASTRUM_OUT_OF_MEMORY);
  expect_ok(rastrum_renderer_set_memory_limit(p.renderer.get(), 0));
  expect_ok(p.render());
  expect_refused(rastrum_renderer_set_threads(p.renderer.get(), -1), "threads");
  expect_ok(p.render());
}

TEST(CRefusals, EachThreadHasItsSentence) {
  const CPicture p = square();
  (void)rastrum_frame_set_samples(p.frame.get(), 3);
  const std::string here = rastrum_error_text();
  std::thread([&] {
    EXPECT_STREQ(rastrum_error_text(), "");
    EXPECT_EQ(rastrum_error_status(), RASTRUM_OK);
    expect_refused(rastrum_frame_set_shader(p.frame.get(), "none"), "no shader is called 'none'");
  }).join();
  EXPECT_EQ(rastrum_error_text(), here);
  EXPECT_TRUE(holds(here, "samples"));
  expect_ok(p.render());
  EXPECT_EQ(rastrum_error_text(), here);
}

}  // namespace
}  // namespace rastrum::test::c_refusals_test
