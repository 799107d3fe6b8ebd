// SPDX-License-Identifier: BSD-3-Clause
// The real files of the shared data folder, with the triangle counts of its README.
#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/io/files.hpp"
#include "tests/support/directories.hpp"

namespace rastrum::test::real_files_test {
namespace {

struct RealFile {
  const char* path;
  std::uint64_t triangles;
};

void PrintTo(const RealFile& f, std::ostream* out) {
  *out << f.path;
}

class RealFiles : public testing::TestWithParam<RealFile> {};

TEST_P(RealFiles, HaveTheirTriangles) {
  const auto file = shared_dir() / "data" / GetParam().path;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const Scene scene = io::read_scene(file);
  EXPECT_EQ(scene.triangle_count(), GetParam().triangles);
  for (const Mesh& m : scene.meshes) {
    for (const std::uint32_t i : m.indices) ASSERT_LT(i, m.positions.size());
    for (const std::uint32_t i : m.face_materials) ASSERT_LT(i, scene.materials.size());
    if (!m.normals.empty() && m.normals.indices.empty()) {
      EXPECT_EQ(m.normals.values.size(), m.positions.size());
    }
    for (const auto* indices : {&m.normals.indices, &m.texcoords.indices}) {
      if (indices->empty()) continue;
      EXPECT_EQ(indices->size(), m.indices.size());
    }
  }
  for (const std::string& w : scene.warnings) RecordProperty("warning", w);
}

INSTANTIATE_TEST_SUITE_P(
    Data, RealFiles,
    testing::Values(
        RealFile{"small/teapot.obj", 6320}, RealFile{"small/suzanne.obj", 968},
        RealFile{"small/cow.obj", 5804}, RealFile{"small/rocker-arm.obj", 20088},
        RealFile{"small/stanford-bunny.obj", 69451},
        RealFile{"small/spot/spot_triangulated.obj", 5856},
        RealFile{"small/spot/spot_quadrangulated.obj", 5856},
        RealFile{"small/42400-IDGH.stl", 11036}, RealFile{"big/dragon_348k.ply", 348503},
        RealFile{"big/brain_iso126_1033k.ply", 1033112}, RealFile{"sponza/sponza.obj", 279163},
        RealFile{"depth/2CylinderEngine.glb", 121496}, RealFile{"alpha/smallpine/scene.gltf", 1650},
        RealFile{"alpha/AlphaBlendModeTest.glb", 61}, RealFile{"gltf/BoxTextured.glb", 12},
        RealFile{"gltf/TextureSettingsTest.glb", 72},
        RealFile{"gltf/BoxInterleaved/BoxInterleaved.gltf", 12},
        RealFile{"gltf/SimpleSparseAccessor/SimpleSparseAccessor.gltf", 12},
        RealFile{"depth/ratboy_mohawk_ribbons_138k.ply", 138136}),
    [](const testing::TestParamInfo<RealFile>& file) {
      std::string name = std::filesystem::path(file.param.path).stem().string();
      std::replace_if(
          name.begin(), name.end(),
          [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
      return name;
    });

}  // namespace
}  // namespace rastrum::test::real_files_test
