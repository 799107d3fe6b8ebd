// SPDX-License-Identifier: BSD-3-Clause
// The real meshes of the tests, if the shared data is there, and their cameras.
#pragma once

#include <cctype>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/scene.hpp>

namespace rastrum::test {

inline constexpr const char* kRealMeshes[] = {
    "small/teapot.obj",
    "small/suzanne.obj",
    "small/cow.obj",
    "small/rocker-arm.obj",
    "small/stanford-bunny.obj",
    "small/spot/spot_quadrangulated.obj",
    "small/42400-IDGH.stl",
    "big/dragon_348k.ply",
    "big/brain_iso126_1033k.ply",
    "sponza/sponza.obj",
    "alpha/smallpine/scene.gltf",
    "depth/2CylinderEngine.glb",
    "depth/ratboy_mohawk_ribbons_138k.ply",
    "gltf/BoxInterleaved/BoxInterleaved.gltf",
};

inline std::string name_of_file(const testing::TestParamInfo<const char*>& p) {
  std::string name = std::filesystem::path(p.param).stem().string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

/// Stands inside the bounding box and looks at a corner of it.
inline Camera close_camera(const SceneView& scene) {
  const Bounds b = bounds(scene);
  const Vec3 low(b.min), size = Vec3(b.max) - low;
  Camera c = fit_camera(scene, 1.2F, false);
  c.eye = low + size * Vec3{0.45F, 0.55F, 0.6F};
  c.target = low + size * Vec3{0.1F, 0.2F, 0.0F};
  c.near_plane = 1e-4F * length(size);
  return c;
}

}  // namespace rastrum::test
