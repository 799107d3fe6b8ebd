// SPDX-License-Identifier: BSD-3-Clause
// Colours, float32 and 8 bits, have the same bits on every instruction set, for every number of
// threads and on the serial device: over generated scenes with everything that affects colours, and
// with colours by scalars on meshes, points, lines and quadrics.
#include <algorithm>
#include <deque>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/render.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/point_line_scenes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/shaded_scenes.hpp"
#include "tests/support/surface_scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::equal_colors_test {
namespace {

TEST(EqualColors, OnEveryInstructionSet) {
  EveryWay ways{{.threads = 1}, {.threads = 3, .isa = available_isas().back()}};
  const int scenes = share_of(1000, 60);
  std::uint64_t seen = 0;
  for (int seed = 0; seed < scenes && !HasFailure(); ++seed) {
    const ShadedScene s = generate_shaded(static_cast<std::uint64_t>(seed));
    SCOPED_TRACE(testing::Message()
                 << "scene " << seed << " (" << s.kind << ", " << name(s.frame.shader) << ", "
                 << s.frame.samples << " samples)");
    const Frame expected =
        ways.same([&](Renderer& renderer) { return draw(renderer, s.view(), s.camera, s.frame); });
    seen += static_cast<std::uint64_t>(
        std::ranges::count_if(expected.ids.pixels(), [](std::int64_t id) { return id >= 0; }));
  }
  // Scenes without visible pixels would compare nothing.
  EXPECT_GT(seen, static_cast<std::uint64_t>(scenes) * 100);
}

/// Numbers for any geometry; a few are NaN.
std::vector<double> numbers(std::uint64_t seed) {
  Random random(seed);
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i)
    values.push_back(random.chance(0.01) ? std::numeric_limits<double>::quiet_NaN()
                                         : random.real(0, 1));
  return values;
}

ScalarMapping mapping_of(std::uint64_t seed) {
  const char* const maps[] = {"viridis", "turbo", "tab10", "RdBu", "twilight"};
  ScalarMapping m{.map = color_map(maps[seed % 5])};
  if (seed % 2 == 0) m.range = ScalarRange{0.1, 0.9};
  m.logarithmic = seed % 4 == 0;
  if (seed % 3 == 0) m.steps = 7;
  if (seed % 5 == 0) m.isolines = {0.25, 0.5, 0.75};
  if (seed % 7 == 0) m.opacity = {{0.2, 0.1F}, {0.8, 1}};
  return m;
}

std::size_t count_of(const MeshView& mesh, Per per) {
  return per == Per::vertex   ? mesh.positions.size()
         : per == Per::corner ? mesh.corner_count()
         : per == Per::face   ? mesh.face_count()
                              : 1;
}
/// Points, lines and quadrics have one number per position or primitive.
template <class G>
std::size_t count_of(const G& geometry) {
  if constexpr (requires { geometry.positions; })
    return geometry.positions.size();
  else
    return geometry.centers.size();
}

/// Gives all instances numbers, and single ones by the seed. Returns the geometries that they now
/// refer to.
[[nodiscard]] std::deque<GeometryView> number(std::vector<InstanceView>& instances,
                                              const std::vector<double>& values,
                                              std::uint64_t seed) {
  Random random(seed);
  std::deque<GeometryView> geometries;
  for (InstanceView& instance : instances) {
    const int which = random.integer(0, 5);
    if (which == 0) instance.scalar = random.real(0, 1);
    if (which <= 1) continue;
    const Per per = static_cast<Per>(random.integer(0, 3));
    instance.geometry = instance.geometry.visit([&](auto g) -> const GeometryView& {
      const std::span<const double> all = values;
      if constexpr (requires { g.scalars.per; })
        g.scalars = {all.first(count_of(g, per)), per};
      else
        g.scalars = all.first(count_of(g));
      return geometries.emplace_back(g);
    });
  }
  return geometries;
}

class EqualScalars : public testing::Test {
 protected:
  void expect_equal(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                    std::uint64_t seed) {
    SCOPED_TRACE(testing::Message() << "scene " << seed << ", " << name(frame.shader));
    const Frame picture = ways_.same([&](Renderer& renderer) {
      return draw(renderer, scene, camera, frame, kColor | kVisible | kAlbedo | kScalars);
    });
    pictures_.push_back(digest(picture.color).hex() + digest(picture.scalars).hex());
  }
  /// `generate` makes a scene from a seed, width and height.
  template <class Generate>
  void expect_equal_scenes(const Generate& generate) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      auto s = generate(seed, 60, 44);
      const std::vector<double> values = numbers(seed);
      const auto geometries = number(s.instances, values, seed);
      const ScalarMapping mapping = mapping_of(seed);
      SceneView scene = s.view();
      scene.scalar_mappings = {&mapping, 1};
      expect_equal(scene, s.camera,
                   {.width = 60,
                    .height = 44,
                    .shader = seed % 3 == 0   ? Shader::material
                              : seed % 3 == 1 ? Shader::phong
                                              : Shader::classic,
                    .samples = seed % 4 == 3 ? 4 : 1},
                   seed);
    }
    expect_different(100);
  }
  /// Expects that not all pictures are empty.
  void expect_different(std::size_t at_least) {
    std::ranges::sort(pictures_);
    pictures_.erase(std::unique(pictures_.begin(), pictures_.end()), pictures_.end());
    EXPECT_GE(pictures_.size(), at_least);
  }

  EveryWay ways_{{.threads = 1},
                 {.threads = 8, .isa = available_isas().back()},
                 {.memory_limit = 6 << 20, .threads = 1, .isa = available_isas().back()}};
  std::vector<std::string> pictures_;
};

TEST_F(EqualScalars, OfMeshes) {
  const int scenes = share_of(300, 20);
  for (int i = 0; i < scenes; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const ShadedScene s = generate_shaded(seed);
    SceneView scene = s.view();
    std::vector<InstanceView> instances(scene.instances.begin(), scene.instances.end());
    const std::vector<double> values = numbers(seed);
    const auto geometries = number(instances, values, seed);
    const ScalarMapping mapping = mapping_of(seed);
    scene.instances = instances;
    scene.scalar_mappings = {&mapping, 1};
    expect_equal(scene, s.camera, s.frame, seed);
  }
  expect_different(static_cast<std::size_t>(scenes) / 2);
}

TEST_F(EqualScalars, OfPointsAndLines) {
  expect_equal_scenes(generate_points_and_lines);
}

TEST_F(EqualScalars, OfQuadrics) {
  expect_equal_scenes(generate_surfaces);
}

}  // namespace
}  // namespace rastrum::test::equal_colors_test
