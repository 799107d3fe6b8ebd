// Pieces that a device makes, with the device's code on the CPU.
#include <cstdint>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/raster/cuda/pieces.cuh>
#include <rastrum/raster/resolve.hpp>

#include "tests/support/scenes.hpp"

namespace rastrum::test {
namespace {

// For who wants pieces as an array, from arrays that are on the device already.
TEST(CudaPieces, AreTheHostsInOrderOfSubmission) {
  constexpr int kWidth = 200, kHeight = 120;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const GeneratedScene g = generate(seed, kWidth, kHeight);
    const SceneBinding binding(g.scene);
    const Mat4d to_clip = world_to_clip(g.camera, kWidth, kHeight);
    std::vector<raster::TransformSource> sources;
    sources.reserve(binding.view().instances.size());
    std::vector<raster::Draw> draws;
    std::vector<raster::DeviceDraw> device_draws;
    parallel::Cuda exec;
    for (const InstanceView& instance : binding.view().instances) {
      const Mat4d matrix = to_clip * instance.object_to_world;
      raster::Draw& d = draws.emplace_back();
      d.source = &sources.emplace_back(instance.mesh.positions, matrix);
      d.vertex_count = instance.mesh.positions.size();
      d.indices = instance.mesh.indices;
      d.primitive_count = instance.mesh.triangle_count();
      device_draws.push_back({d, {instance.mesh.positions, matrix, {}, {}}});
    }
    const auto total = raster::number_draws(draws).primitives;
    raster::FrameGeometry frame{kWidth, kHeight, raster::Viewport::of(kWidth, kHeight), draws};
    for (const bool project_first : {true, false}) {
      const raster::DeviceScene<parallel::Cuda> scene(exec, device_draws, kWidth, kHeight, 0,
                                                      project_first);
      ASSERT_EQ(scene.primitives(), total);
      const raster::SampleOffset at{37, -90};
      std::vector<raster::Piece> expected;
      raster::Outcomes sum;
      for (const raster::Draw& d : draws)
        for (std::uint64_t p = 0; p < d.primitive_count; ++p) {
          raster::Outcome o;
          o.fate = raster::assemble_primitive(
              frame, d, p, [&](const raster::Piece& piece) { expected.push_back(piece); }, 3, at);
          sum = raster::AddOutcomes{}(sum, raster::Outcomes(o));
        }
      const auto made = raster::make_pieces(exec, scene, 0, total, 3, at);
      ASSERT_EQ(made.pieces.size(), expected.size());
      EXPECT_EQ(made.sum.culled, sum.culled);
      EXPECT_EQ(made.sum.clipped, sum.clipped);
      EXPECT_EQ(made.sum.dropped, sum.dropped);
      if (!expected.empty()) {
        EXPECT_EQ(std::memcmp(made.pieces.data(), expected.data(),
                              expected.size() * sizeof(raster::Piece)),
                  0);
      }
    }
  }
}

}  // namespace
}  // namespace rastrum::test
