// SPDX-License-Identifier: BSD-3-Clause
// Cameras of the C interface.
#include <rastrum/c/handles.hpp>

#include <algorithm>

#include <rastrum/camera.hpp>
#include <rastrum/fit.hpp>

namespace rastrum::c {

static_assert(RASTRUM_DEPTH_OPENGL == static_cast<int>(ClipDepth::opengl) &&
              RASTRUM_DEPTH_ZERO_TO_ONE == static_cast<int>(ClipDepth::zero_to_one) &&
              RASTRUM_DEPTH_REVERSED == static_cast<int>(ClipDepth::reversed));

namespace {

/// Changes a camera by f(camera), which may throw, and drops its matrix.
template <class F>
rastrum_status with_lens(rastrum_camera* camera, const F& f) noexcept {
  return guarded([&] {
    Camera changed = at(camera, "the camera").camera;
    changed.matrix.reset();
    f(changed);
    camera->camera = changed;
  });
}

}  // namespace

#pragma GCC visibility push( \
    default)  // as in rastrum.h, whose declarations are in another namespace
extern "C" {

rastrum_camera* rastrum_camera_new() {
  return made([] { return new rastrum_camera; });
}

void rastrum_camera_free(rastrum_camera* camera) {
  delete camera;
}

rastrum_status rastrum_camera_look_at(rastrum_camera* camera, const double eye[3],
                                      const double target[3], const double up[3]) {
  return with_lens(camera, [&](Camera& c) {
    c.eye = vec3(eye, "eye");
    c.target = vec3(target, "target");
    c.up = vec3(up, "up");
    (void)world_to_camera(c);  // refuses degenerate directions
  });
}

rastrum_status rastrum_camera_set_perspective(rastrum_camera* camera, float fov_rad) {
  return with_lens(camera, [&](Camera& c) {
    check_fov(fov_rad);
    c.fov_rad = fov_rad;
    c.orthographic = false;
  });
}

rastrum_status rastrum_camera_set_orthographic(rastrum_camera* camera, float height) {
  return with_lens(camera, [&](Camera& c) {
    c.orthographic_height = height;
    c.orthographic = true;
  });
}

rastrum_status rastrum_camera_set_planes(rastrum_camera* camera, float near_plane,
                                         float far_plane) {
  return with_lens(camera, [&](Camera& c) {
    c.near_plane = near_plane;
    c.far_plane = far_plane;
  });
}

rastrum_status rastrum_camera_fit(rastrum_camera* camera, const rastrum_scene* scene, int width,
                                  int height) {
  return guarded([&] {
    Camera& c = at(camera, "the camera").camera;
    c = fit_picture(at(scene, "the scene").view(), c, width, height);
  });
}

rastrum_status rastrum_camera_set_matrix(rastrum_camera* camera, const double world_to_clip[16],
                                         int depth) {
  return with_lens(camera, [&](Camera& c) {
    c.matrix = camera_from_matrix(matrix(world_to_clip, "world_to_clip"), to_enum<ClipDepth>(depth))
                   .matrix;
  });
}

rastrum_status rastrum_camera_set_opencv(rastrum_camera* camera, const double k[6],
                                         const double world_to_camera[16], int width, int height,
                                         double near_plane) {
  return with_lens(camera, [&](Camera& c) {
    (void)at(k, "k");
    const Intrinsics lens{k[0], k[1], k[2], k[3], k[4], k[5]};
    c.matrix = camera_from_opencv(lens, matrix(world_to_camera, "world_to_camera"), width, height,
                                  near_plane)
                   .matrix;
  });
}

rastrum_status rastrum_camera_get_matrix(const rastrum_camera* camera, int width, int height,
                                         double world_to_clip[16]) {
  return guarded([&] {
    const Mat4d m = rastrum::world_to_clip(at(camera, "the camera").camera, width, height);
    std::copy_n(&m.m[0][0], 16, &at(world_to_clip, "world_to_clip"));
  });
}

}  // extern "C"
#pragma GCC visibility pop
}  // namespace rastrum::c
