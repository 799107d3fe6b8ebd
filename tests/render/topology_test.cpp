// SPDX-License-Identifier: BSD-3-Clause
// Draws of points, lines and triangles in any mix, with widths, sizes, depth biases and windings:
// serial equals the brute-force oracle, and every point of the table equals serial.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/program.hpp>
#include <rastrum/render.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/family.hpp"
#include "tests/support/pieces.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::topology_test {
namespace {

/// The test's description of a draw.
struct Plan {
  Topology topology = Topology::triangles;
  std::vector<std::uint32_t> indices;
  float line_width = 1, point_size = 1, bias = 0, bias_slope = 0;
  Cull cull = Cull::none;
  Winding winding = Winding::counter_clockwise;
};

struct Mix {
  std::vector<Vec4> clip;
  std::vector<Plan> plans;
};

/// A vertex that appears at (x, y) px, at distance w from the eye.
Vec4 vertex_at(double x, double y, double w, double depth, int width, int height) {
  const double ndc_x = 2 * x / width - 1, ndc_y = 1 - 2 * y / height;
  return {static_cast<float>(ndc_x * w), static_cast<float>(ndc_y * w),
          static_cast<float>(depth * w), static_cast<float>(w)};
}

Mix random_mix(std::uint64_t seed, int width, int height) {
  Random r(seed);
  Mix mix;
  const bool orthographic = r.chance(0.5), nasty = r.chance(0.5);
  for (int i = r.integer(6, 40); i > 0; --i) {
    const double step = r.chance(0.5) ? 0.5 : 1.0 / 256;
    const double x = std::floor(r.real(-8, width + 8) / step) * step;
    const double y = std::floor(r.real(-8, height + 8) / step) * step;
    const double w = orthographic ? 1 : r.real(0.1, 4);
    Vec4 v = vertex_at(x, y, w, r.integer(-1, 8) / 8.0, width, height);
    if (nasty && r.chance(0.1)) v.w = -v.w;        // behind the eye
    if (nasty && r.chance(0.1)) v.z = v.w + 0.5F;  // before the near plane
    if (nasty && r.chance(0.1)) v.x *= 1e5F;       // beyond the guard band
    if (nasty && r.chance(0.05)) v.y = std::numeric_limits<float>::quiet_NaN();
    mix.clip.push_back(v);
  }
  for (int d = r.integer(1, 5); d > 0; --d) {
    Plan plan;
    constexpr Topology kTopologies[] = {Topology::points, Topology::lines, Topology::triangles};
    plan.topology = kTopologies[r.integer(0, 2)];
    const int primitives = r.integer(0, 12);
    for (int i = primitives * static_cast<int>(plan.topology); i > 0; --i)
      plan.indices.push_back(
          static_cast<std::uint32_t>(r.integer(0, static_cast<int>(mix.clip.size()) - 1)));
    plan.line_width = static_cast<float>(r.chance(0.5) ? 1 : r.real(0.1, 12));
    plan.point_size = static_cast<float>(r.chance(0.5) ? r.integer(1, 9) : r.real(0.1, 20));
    if (r.chance(0.3)) plan.bias = r.real32(-0.3, 0.3);
    if (r.chance(0.3)) plan.bias_slope = static_cast<float>(r.integer(-2, 2));
    plan.cull = static_cast<Cull>(r.integer(0, 2));
    plan.winding = static_cast<Winding>(r.integer(0, 2));
    mix.plans.push_back(plan);
  }
  return mix;
}

struct Expected {
  std::vector<SnappedPrimitive> pieces;
  std::uint64_t input = 0, dropped = 0;
};

bool keeps(const Plan& plan, bool counter_clockwise) {
  if (plan.winding == Winding::either || plan.cull == Cull::none) return true;
  const bool front = counter_clockwise == (plan.winding == Winding::counter_clockwise);
  return front == (plan.cull == Cull::back);
}

/// Whole primitives come from the tests' own projection, others from the library's clipper
/// (lines_test and clip_test test it).
Expected expected_of(const Mix& mix, int width, int height) {
  Expected out;
  std::int64_t id = -1;
  for (const Plan& plan : mix.plans) {
    const auto corners = static_cast<std::size_t>(plan.topology);
    for (std::size_t first = 0; first < plan.indices.size(); first += corners) {
      ++out.input;
      ++id;
      ProjectedTriangle p;
      bool whole = true, finite = true;
      for (std::size_t c = 0; c < corners; ++c) {
        const Vec4 v = mix.clip[plan.indices[first + c]];
        finite = finite && std::isfinite(v.y);
        p.clip[c] = {v.x, v.y, v.z, v.w};
        p.has_position[c] = snap(p.clip[c], width, height, p.snapped.v[c]);
        whole = whole && p.has_position[c];
      }
      if (!finite) {
        ++out.dropped;
        continue;
      }
      const auto add = [&](auto shape) {
        shape.id = id;
        out.pieces.push_back({shape, plan.bias, plan.bias_slope});
      };
      if (plan.topology == Topology::points) {
        const double size = std::max(plan.point_size, 1.0F);
        if (const auto at = point_of(corner_of(p, 0), width, height))
          add(SnappedPoint{*at, std::llrint(size * 256)});
      } else if (plan.topology == Topology::lines) {
        const int line_width = std::max(static_cast<int>(std::lrint(plan.line_width)), 1);
        if (const auto v = line_of(corner_of(p, 0), corner_of(p, 1), width, height))
          add(SnappedLine{{(*v)[0], (*v)[1]}, line_width});
      } else if (whole) {
        const std::int64_t area = twice_area(p.snapped);
        if (area != 0 && keeps(plan, area < 0)) add(p.snapped);
      } else {
        const double facing = facing_of(p);
        if (facing == 0 || !keeps(plan, facing > 0)) continue;
        for (const SnappedTriangle& t : fan_of(clip(p, width, height), facing > 0, id)) add(t);
      }
    }
  }
  return out;
}

template <class Shade>
auto program_of(const Mix& mix, Shade shade) {
  return Program(
      [&mix](std::uint32_t v) {
        return VertexOutput<Vec4>{mix.clip[v], mix.clip[v]};
      },
      shade);
}
auto program_of(const Mix& mix) {
  return program_of(mix, [](const Vec4& v, const Fragment& f) {
    return Vec4{v.x, f.depth, static_cast<float>(f.vertex[0]), f.front ? 1.0F : 0.5F};
  });
}

template <class Program>
std::vector<raster::Draw> draws_of(const Mix& mix, const Program& program) {
  std::vector<raster::Draw> draws;
  for (const Plan& plan : mix.plans) {
    raster::Draw& d =
        draws.emplace_back(program.draw(mix.clip.size(), plan.indices, plan.topology));
    d.primitive_count = plan.indices.size() / static_cast<std::size_t>(plan.topology);
    d.line_width = plan.line_width;
    d.point_size = plan.point_size;
    d.depth_bias = plan.bias;
    d.depth_bias_slope = plan.bias_slope;
    d.cull = plan.cull;
    d.winding = plan.winding;
  }
  return draws;
}

RenderOptions serial(int width, int height) {
  return RenderOptions({.width = width, .height = height}, {.device = Device::serial});
}

TEST(Topologies, MixesEqualTheOracle) {
  std::uint64_t clipped = 0, dropped = 0;
  std::map<std::size_t, std::uint64_t> visible;  // pixels by kind of primitive
  const int all = share_of(1000, 30);
  for (const auto& [width, height] : {std::pair{64, 64}, {37, 91}, {130, 70}}) {
    Painter renderer(serial(width, height));
    for (int i = 0; i < all / 3; ++i) {
      const auto seed = static_cast<std::uint64_t>(i + width * 100000);
      SCOPED_TRACE("mix " + std::to_string(seed));
      const Mix mix = random_mix(seed, width, height);
      const auto program = program_of(mix);
      std::vector<raster::Draw> draws = draws_of(mix, program);
      const Expected want = expected_of(mix, width, height);
      const OracleImage oracle = brute_force(width, height, want.pieces);
      const Frame frame = draw(renderer, draws, program, nullptr);
      ASSERT_TRUE(same_surfaces(frame, oracle));
      ASSERT_TRUE(counts_add_up(frame));
      ASSERT_EQ(frame.stats.triangles.input, want.input);
      ASSERT_EQ(frame.stats.triangles.dropped, want.dropped);
      clipped += frame.stats.triangles.clipped;
      dropped += want.dropped;
      for (const SnappedPrimitive& p : want.pieces) visible[p.shape.index()] += oracle.pixels_of(p);
    }
  }
  if (all >= 100) {
    EXPECT_GT(clipped, 20U);
    EXPECT_GT(dropped, 20U);
    for (std::size_t kind = 0; kind < 3; ++kind) EXPECT_GT(visible[kind], 1000U) << kind;
  }
}

/// Every point of the table, with any number of threads and every instruction set. In one case the
/// budget is so small that vertices are projected where they are read.
class TopologyTable : public testing::TestWithParam<TablePoint> {};

TEST_P(TopologyTable, MixesEqualSerial) {
  constexpr int kWidth = 130, kHeight = 91;
  Painter reference(serial(kWidth, kHeight));
  std::vector<Painter> renderers;
  for (const Isa isa : available_isas())
    for (const int threads : {1, 2, 8}) {
      const std::uint64_t limit = threads == 2 ? std::uint64_t{4} << 20 : 0;
      renderers.emplace_back(RenderOptions({.width = kWidth, .height = kHeight},
                                           {.memory_limit = limit, .threads = threads, .isa = isa},
                                           GetParam()));
    }
  const auto mixes = static_cast<std::uint64_t>(share_of(30, 6));
  for (std::uint64_t seed = 0; seed < mixes; ++seed) {
    Mix mix = random_mix(seed, kWidth, kHeight);
    // More vertices than fit into a quarter of the budget.
    mix.clip.resize(std::size_t{1} << 17, Vec4{0, 0, 0, 1});
    const auto program = program_of(mix);
    std::vector<raster::Draw> draws = draws_of(mix, program);
    const Frame expected = draw(reference, draws, program, nullptr);
    for (std::size_t k = seed % 3; k < renderers.size(); k += 3) {
      const Frame frame = draw(renderers[k], draws, program, nullptr);
      ASSERT_TRUE(same_frames(frame, expected))
          << "mix " << seed << ", " << name_of(renderers[k].options());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Points, TopologyTable, testing::ValuesIn(table_points()),
                         [](const auto& p) { return test_name(p.param); });

// Translucent points, lines and triangles among opaque ones. With several samples, points and lines
// cover all samples of their pixels.
TEST(Topologies, LayersOfMixesEqualSerial) {
  constexpr int kWidth = 61, kHeight = 47;
  const auto mixes = static_cast<std::uint64_t>(share_of(30, 6));
  for (const int samples : {1, 4}) {
    RenderOptions options = serial(kWidth, kHeight);
    options.samples = samples;
    Painter reference(options);
    options.device = Device::threads;
    std::vector<Painter> renderers;
    for (const char* const rasterizer : {"grouped", "tiled"})
      for (const Isa isa : {Isa::scalar, available_isas().back()}) {
        options.rasterizer = rasterizer;
        options.isa = isa;
        options.threads = isa == Isa::scalar ? 1 : 8;
        renderers.emplace_back(options);
      }
    std::uint64_t layers = 0;
    for (std::uint64_t seed = 0; seed < mixes; ++seed) {
      const Mix mix = random_mix(seed, kWidth, kHeight);
      const auto program = program_of(mix, [](const Vec4&, const Fragment& f) {
        return Vec4{0.25F, f.depth / 2, static_cast<float>(f.vertex[0] % 4) / 8, 0.5F};
      });
      std::vector<raster::Draw> draws = draws_of(mix, program);
      for (std::size_t d = seed % 2; d < draws.size(); d += 2) draws[d].flags = kTranslucent;
      const Frame expected = draw(reference, draws, program, nullptr);
      for (Painter& renderer : renderers) {
        const Frame frame = draw(renderer, draws, program, nullptr);
        ASSERT_TRUE(same_images(frame, expected))
            << "mix " << seed << ", " << renderer.options().rasterizer << ", " << samples;
        for (const auto& [counter, value] : frame.stats.counters)
          if (counter == "translucent fragments") layers += value;
      }
    }
    EXPECT_GT(layers, 1000U);
  }
}

TEST(Topologies, RefusesWidthsSizesAndBiasesOutOfRange) {
  const Program program(
      [](std::uint32_t) {
        return VertexOutput<float>{{0, 0, 0.5F, 1}, 0};
      },
      [](float, const Fragment&) { return Vec4{}; });
  for (const Device device : {Device::serial, Device::threads}) {
    RenderOptions options({.width = 16, .height = 16}, {.device = device});
    Painter renderer(options);
    const auto message = [&](float raster::Draw::*member, float value) {
      raster::Draw d = program.draw(1, {}, Topology::points);
      d.*member = value;
      return error_message_of([&] { (void)renderer.draw({&d, 1}, program, nullptr, {}); });
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float bad : {0.0F, -1.0F, 5000.0F, nan}) {
      EXPECT_NE(message(&raster::Draw::line_width, bad), "") << bad;
      EXPECT_NE(message(&raster::Draw::point_size, bad), "") << bad;
    }
    EXPECT_NE(message(&raster::Draw::depth_bias, nan), "");
    EXPECT_NE(message(&raster::Draw::depth_bias_slope, std::numeric_limits<float>::infinity()), "");
    EXPECT_EQ(message(&raster::Draw::line_width, 4096), "");
    // Lines report an index out of range too.
    const std::vector<std::uint32_t> indices{0, 1};
    raster::Draw d = program.draw(1, indices, Topology::lines);
    EXPECT_THROW((void)renderer.draw({&d, 1}, program, nullptr, {}), Error);
  }
}

}  // namespace
}  // namespace rastrum::test::topology_test
