// SPDX-License-Identifier: BSD-3-Clause
// Pictures drawn in pieces, because the visible triangles do not fit at once: bands of rows, bins,
// and rectangles of pixels in one bin.
#include <cstdint>

#include <gtest/gtest.h>

#include <rastrum/environment.hpp>
#include <rastrum/error.hpp>

#include "tests/out_of_core/large_files.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::out_of_core_pieces_test {
namespace {

TEST(OutOfCore, BandsChangeNoBit) {
  const TempFolder folder;
  const Mesh mesh = shuffled_ball();
  const auto file = folder.write("a.ply", ply_of(mesh, {.comment = "x"}));
  for (const int samples : {1, 4})
    for (const float opacity : {1.0F, 0.3F}) {
      FrameOptions frame = frame_of(70, 120, Shader::phong, opacity);
      frame.samples = samples;
      OutOfCoreOptions options{.chunk_triangles = 400, .prepare = crease, .neighbours = true};
      options.band_triangles = opacity < 1 ? 1800 : 800;
      const OutOfCoreStats stats = expect_same(file, outside(), frame, options, "bands");
      EXPECT_GT(stats.bands, 1U);
    }
}

TEST(OutOfCore, PiecesOfBinsChangeNoBit) {
  const TempFolder folder;
  const Mesh mesh = shuffled_ball();
  const auto ply = folder.write("a.ply", ply_of(mesh));
  const auto glb = folder.write(
      "a.glb", glb_of(mesh, false, R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1]}})"));
  Image<Vec3> sky(16, 8);
  for (int i = 0; i < 16 * 8; ++i)
    sky(i % 16, i / 16) = {0.1F * static_cast<float>(i % 16), 0.5F, 1};
  Light around{.kind = EnvironmentLight{Environment(sky.view())}};
  for (const int samples : {1, 4})
    for (const float opacity : {1.0F, 0.3F})
      for (const int rows : {0, 64}) {
        FrameOptions frame = frame_of(150, 90, Shader::phong, opacity);
        frame.samples = samples;
        OutOfCoreOptions options{.chunk_triangles = 1500, .band_triangles = 120, .rows = rows};
        EXPECT_GT(expect_same(ply, outside(), frame, options, "pieces").bands, 12U);
        frame.shader = Shader::material;
        frame.tone = {.tone = Tone::aces, .exposure_stops = 0.5F};
        expect_same(glb, outside(), frame, options, "pieces with a tone");
        if (rows != 0) continue;
        frame.lights = {around};
        frame.environment_behind = true;
        expect_same(glb, outside(), frame, options, "pieces before surroundings");
      }
}

/// Small triangles in random order within a box of this side.
Mesh heap_of(std::uint32_t triangles, Vec3 at, double side) {
  Mesh mesh;
  Random random(9);
  const auto within = [&](double most) {
    const double x = random.real(0, most);
    const double y = random.real(0, most);
    const double z = random.real(0, most);
    return Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
  };
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const Vec3 center = at + within(side * 0.8);
    for (std::uint32_t c = 0; c < 3; ++c) {
      mesh.indices.push_back(3 * t + c);
      mesh.positions.push_back(center + within(side * 0.2));
    }
  }
  return mesh;
}

TEST(OutOfCore, LayersOfOneBinThatDoNotFitAtOnce) {
  const TempFolder folder;
  const Mesh mesh = heap_of(90'000, {0.2F, 0.2F, 0}, 0.6);
  const OutOfCoreOptions options{.memory_limit = std::uint64_t{28} << 20};
  const FrameOptions frame = frame_of(160, 120, Shader::flat, 0.3F);
  for (const auto& file :
       {folder.write("a.ply", ply_of(mesh)), folder.write("a.stl", stl_of(mesh))})
    EXPECT_GT(expect_same(file, outside(), frame, options, file.string()).bands, 1U);
}

TEST(OutOfCore, LayersOfOnePixelThatDoNotFitAreRefusedBeforeAnythingIsDrawn) {
  const TempFolder folder;
  Mesh mesh = heap_of(2'000, {-0.6F, -0.3F, 0}, 0.4);
  // All of them cover the same few pixels.
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {{0.5, 0.5, 0}, {0.6F, 0.5, 0}, {0.5, 0.6F, 0}});
  for (int i = 0; i < 150'000; ++i)
    mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
  const auto file = folder.write("a.ply", ply_of(mesh));
  const FrameOptions frame = frame_of(120, 90, Shader::flat, 0.3F);
  Image<Rgba8> image(120, 90);
  int pieces = 0;
  OutOfCoreOptions options{.memory_limit = std::uint64_t{26} << 20};
  options.progress = [&](std::string_view what, std::uint64_t, std::uint64_t) {
    pieces += what == "drawing what is seen";
  };
  const auto draw = [&] {
    (void)OutOfCoreFile(file).render(outside(), frame, {.color8 = image}, options);
  };
  expect_refused("a memory limit of 27262976 bytes is too little, about 325362720 are needed",
                 Errc::out_of_memory, draw);
  EXPECT_LE(pieces, 2);  // it tries the whole picture and that pixel
  options.memory_limit = 325'362'720;
  draw();
}

TEST(OutOfCore, RowsAtOnceChangeNoBit) {
  const TempFolder folder;
  const Mesh mesh = shuffled_ball();
  const auto ply = folder.write("a.ply", ply_of(mesh, {.comment = "x"}));
  const auto glb = folder.write(
      "a.glb", glb_of(mesh, false, R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1]}})"));
  for (const int rows : {64, 128, 1024})
    for (const int samples : {1, 4})
      for (const float opacity : {1.0F, 0.3F}) {
        FrameOptions frame = frame_of(70, 200, Shader::phong, opacity);
        frame.samples = samples;
        expect_same(ply, outside(), frame, {.chunk_triangles = 400, .rows = rows}, "rows");
        // With 128 rows a band has more visible triangles than may be drawn at once.
        expect_same(ply, outside(), frame,
                    {.chunk_triangles = 400,
                     .band_triangles = rows == 128 ? 3000U : 0U,
                     .prepare = crease,
                     .neighbours = true,
                     .rows = rows},
                    "rows of several parts");
        frame.shader = Shader::material;
        frame.tone = {.tone = Tone::aces, .exposure_stops = 0.5F};
        expect_same(glb, outside(), frame, {.rows = rows}, "rows with a tone");
      }
  const OutOfCoreFile large(ply);
  const AllTargets targets(70, 64, false);
  FrameOptions frame = frame_of(70, 200);
  EXPECT_THROW((void)large.render(outside(), frame, targets.targets(), {.rows = 63}), Error);
  expect_refused("give take_rows", Errc::invalid_argument,
                 [&] { (void)large.render(outside(), frame, targets.targets(), {.rows = 64}); });
  frame.shader = Shader::depth;
  EXPECT_THROW((void)large.render(outside(), frame, targets.targets(), {.rows = 64}), Error);
}

}  // namespace
}  // namespace rastrum::test::out_of_core_pieces_test
