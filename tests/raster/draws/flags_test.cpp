// SPDX-License-Identifier: BSD-3-Clause
// Flags by material: in a draw of mixed triangles each piece and each micro fragment has its own
// flags, with every rasterizer and however short the runs are.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/program.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/draws/vertices.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/render.hpp>

#include "tests/support/draws_of.hpp"
#include "tests/support/family.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::flags_test {
namespace {

constexpr int kWidth = 150, kHeight = 100;

/// Drops every fragment that it tests.
class DropsAll final : public raster::FragmentTest {
 public:
  std::uint64_t test(const raster::FrameGeometry&, const raster::Piece&, const raster::Block&,
                     const raster::ShadingPoints*) const noexcept override {
    return 0;
  }
};

/// Triangles from less than a pixel to a third of the picture; its edges cut some.
struct Mixed {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> face_materials;
  Mat4d to_clip;

  explicit Mixed(int longest_run) {
    Random random(static_cast<std::uint64_t>(longest_run));
    while (face_materials.size() < 3000) {
      const auto material = static_cast<std::uint32_t>(random.integer(0, 2));
      const int run = random.integer(1, longest_run);
      for (int i = 0; i < run; ++i) {
        face_materials.push_back(material);
        const double x = random.real(-10, kWidth + 10), y = random.real(-10, kHeight + 10);
        const double size = random.chance(0.05) ? 30 : random.real(0.5, 4);
        for (int c = 0; c < 3; ++c)
          positions.push_back(at_pixel(x + random.real(-size, size), y + random.real(-size, size),
                                       random.real(0.1, 0.9), kWidth, kHeight));
      }
    }
    to_clip = world_to_clip(pixel_camera(kWidth, kHeight), kWidth, kHeight);
  }
  [[nodiscard]] raster::Draw draw() const { return draw_of(positions, to_clip); }
};

const raster::FragmentShader kWhite([](const raster::FrameGeometry&, const Fragment&) {
  return Vec4{1, 1, 1, 1};
});

RenderOptions options(const TablePoint& point) {
  return RenderOptions({.width = kWidth, .height = kHeight}, {.threads = 2},
                       {.rasterizer = point.rasterizer, .visibility = point.visibility});
}

class FlagsByMaterial : public testing::TestWithParam<TablePoint> {};

TEST_P(FlagsByMaterial, ATestSeesItsMaterialsAlone) {
  const std::vector<std::uint32_t> flags{0, kTested, 0};
  for (const int longest_run : {1, 5, 700}) {
    const Mixed mixed(longest_run);
    // `rest` is the scene without material 1, whose triangles are moved out of sight.
    Mixed rest = mixed;
    for (std::size_t t = 0; t < rest.face_materials.size(); ++t)
      if (rest.face_materials[t] == 1)
        for (std::size_t c = 0; c < 3; ++c) rest.positions[t * 3 + c] = {-1000, -1000, 0};
    std::vector<raster::Draw> draws{rest.draw()};
    Painter renderer(options(GetParam()));
    const Frame expected = draw(renderer, draws, kWhite, nullptr);

    draws = {mixed.draw()};
    draws[0].face_materials = mixed.face_materials;
    draws[0].material_flags = flags;
    const DropsAll test;
    const Frame frame = draw(renderer, draws, kWhite, &test);
    const auto visible = [](std::int64_t id) { return id >= 0; };
    ASSERT_TRUE(std::ranges::any_of(expected.ids.pixels(), visible));
    ASSERT_TRUE(same_images(frame, expected, kVisible)) << longest_run;
  }
}

std::vector<TablePoint> points_and_reference() {
  std::vector<TablePoint> points = table_points();
  points.push_back({"reference", "atomic"});
  return points;
}

INSTANTIATE_TEST_SUITE_P(Points, FlagsByMaterial, testing::ValuesIn(points_and_reference()),
                         [](const auto& p) { return test_name(p.param); });

TEST(FlagsOfADraw, FaceMaterialsAreChecked) {
  const Mixed mixed(3);
  Painter renderer(options({"auto", "auto"}));
  std::vector<raster::Draw> draws{mixed.draw()};
  const std::vector<std::uint32_t> two_flags{0, 0}, three_flags{0, 0, 0};
  const auto draw_with = [&](std::span<const std::uint32_t> materials,
                             std::span<const std::uint32_t> flags) {
    draws[0].face_materials = materials;
    draws[0].material_flags = flags;
    (void)draw(renderer, draws, kWhite, nullptr);
  };
  const std::span<const std::uint32_t> all = mixed.face_materials;
  draw_with(all, three_flags);
  expect_refused("", [&] { draw_with(all, two_flags); });
  expect_refused("", [&] { draw_with(all.first(all.size() - 1), three_flags); });
}

TEST(Setup, FragmentsOfTranslucentTrianglesSayThatTheyAre) {
  const Mixed mixed(3);
  const raster::VertexStage source = raster::MatrixVertices(mixed.positions, mixed.to_clip);
  const raster::Viewport viewport = raster::Viewport::of(kWidth, kHeight);
  std::vector<raster::ProjectedVertex> vertices(mixed.positions.size());
  for (const Isa isa : available_isas()) {
    source.project(0, vertices.size(), viewport, isa, vertices.data());
    raster::SetupInput input;
    input.vertices = vertices.data();
    input.vertex_count = vertices.size();
    input.count = raster::kSetupBatch;
    input.view = {0, 0, kWidth, kHeight};
    input.bin_columns = (kWidth + raster::kBinSize - 1) / raster::kBinSize;
    input.micro = true;
    struct Made {
      std::vector<raster::Piece> pieces{raster::kSetupBatch};
      std::vector<raster::BinFragment> fragments{raster::kSetupFragments};
      raster::SetupOutput out;
    };
    std::vector<std::uint32_t> slow(raster::kSetupBatch);
    const auto set_up = [&](std::uint32_t flags) {
      Made made;
      input.flags = flags;
      made.out =
          raster::kernels(isa).setup(input, made.pieces.data(), made.fragments.data(), slow.data());
      return made;
    };
    const Made opaque = set_up(0), translucent = set_up(kTranslucent);
    ASSERT_EQ(opaque.out.fragments, translucent.out.fragments) << name(isa);
    ASSERT_EQ(opaque.out.pieces, translucent.out.pieces) << name(isa);
    EXPECT_EQ(opaque.out.fragments != 0, isa != Isa::scalar) << name(isa);
    for (std::size_t i = 0; i < opaque.out.pieces; ++i)
      ASSERT_EQ(translucent.pieces[i].flags, opaque.pieces[i].flags | kTranslucent);
    for (std::size_t i = 0; i < opaque.out.fragments; ++i) {
      const raster::BinFragment& a = opaque.fragments[i];
      const raster::BinFragment& b = translucent.fragments[i];
      ASSERT_LT(a.pixel, raster::kTranslucentFragment);
      ASSERT_EQ(b.pixel, a.pixel | raster::kTranslucentFragment);
      ASSERT_EQ(b.key, a.key);
      ASSERT_EQ(b.bin, a.bin);
    }
  }
}

}  // namespace
}  // namespace rastrum::test::flags_test
