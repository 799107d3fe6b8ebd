// The real meshes that tests draw, where the shared data is there.
#pragma once

#include <cctype>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

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

}  // namespace rastrum::test
