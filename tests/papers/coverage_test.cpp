// SPDX-License-Identifier: BSD-3-Clause
// The coverages of paper 1 enumerate every covered sample once, in every tuning and order, with any
// number of threads and under a memory limit. Each does the work of its name: its counters equal
// counts made here from the pieces alone.
#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <papers/axes/order.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/papers/rows.hpp"
#include "tests/support/pieces.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::coverage_test {
namespace {

using family::BlockOrder, family::SmallPath;

/// Paper 1's sizes, a bin of four tiles, and the largest tile; 0: 32/8.
constexpr std::pair<int, int> kTileSizes[] = {{0, 0},   {16, 4},  {32, 4}, {64, 4},  {64, 8},
                                              {64, 16}, {128, 8}, {8, 4},  {128, 64}};
constexpr std::pair<int, int> kImageSizes[] = {{64, 64}, {37, 53}, {200, 130}, {1, 1}, {131, 20}};
constexpr int kThreads[] = {1, 2, 8};
constexpr int kSmall[] = {0, 1, 40, 100000};
constexpr BlockOrder kOrders[] = {BlockOrder::row_major, BlockOrder::morton};
constexpr SmallPath kPaths[] = {SmallPath::blocks, SmallPath::rows};

std::string title(const RenderOptions& o) {
  std::string s = o.rasterizer;
  for (const int n :
       {o.tuning.bin_px, o.tuning.tile_px, o.tuning.small_px, o.threads, o.width, o.height})
    s.append(" ").append(std::to_string(n));
  return s.append(o.tuning.order == BlockOrder::morton ? " morton" : " rows")
      .append(o.tuning.small_path == SmallPath::rows ? " by rows" : "");
}

struct Row {
  std::string name;
  bool has_tiles;
};
const Row kRows[] = {
    {"scanline", false}, {"pineda", true}, {"tiled", true}, {"hybrid", true}, {"grouped", false}};

class EverySample : public testing::TestWithParam<Row> {};

TEST_P(EverySample, IsEnumeratedOnce) {
  const Row& row = GetParam();
  int n = 0;
  for (const auto& [width, height] : kImageSizes) {
    Painter reference(reference_options(width, height));
    for (const auto& [bin_px, tile_px] : kTileSizes) {
      if (!row.has_tiles && bin_px != 0) continue;
      // The other choices cycle: 3, 4, 2 and 2 values and the scene have periods of 3, 4, 8 and 16.
      for (int i = 0; i < (row.has_tiles ? 16 : 48); ++i, ++n) {
        if (test_share() < 100 && n % 5 != 0) continue;
        const RenderOptions o = row_options(width, height, row.name, kThreads[n % 3],
                                            {.bin_px = bin_px,
                                             .tile_px = tile_px,
                                             .small_px = kSmall[i % 4],
                                             .order = kOrders[i / 4 % 2],
                                             .small_path = kPaths[i / 8 % 2]});
        SCOPED_TRACE(title(o) + ", scene " + std::to_string(n));
        const GeneratedScene g = generate(static_cast<std::uint64_t>(n), width, height);
        const Frame actual = draw(o, g.scene, g.camera);
        ASSERT_TRUE(same_frame(actual, draw(reference, g.view(), g.camera))) << g.kind;
        ASSERT_TRUE(counts_add_up(actual)) << g.kind;
      }
    }
  }
}

/// Triangles from less than a pixel to larger than the picture.
Scene triangles(int count, int width, int height, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const double x = random.real(-0.1 * width, 1.1 * width);
    const double y = random.real(-0.1 * height, 1.1 * height);
    const double size = random.chance(0.02) ? width : random.real(0.5, 20);
    for (int c = 0; c < 3; ++c)
      mesh.positions.push_back(at_pixel(x + random.real(-size, size), y + random.real(-size, size),
                                        random.real(0, 1), width, height));
  }
  return single(std::move(mesh));
}

// Bands, batches of triangles and turns of an expansion: each limit cuts differently.
TEST_P(EverySample, IsEnumeratedOnceUnderALimit) {
  constexpr int kWidth = 700, kHeight = 500;
  const Scene scene = triangles(share_of(20000, 4000), kWidth, kHeight, 7);
  const Camera camera = pixel_camera(kWidth, kHeight);
  const Frame expected = draw(reference_options(kWidth, kHeight), scene, camera);
  EXPECT_GT(expected.stats.triangles.drawn, scene.triangle_count() / 2);
  for (const std::uint64_t limit : {std::uint64_t{4} << 20, std::uint64_t{16} << 20})
    for (const auto& [bin_px, tile_px] : {std::pair{0, 0}, std::pair{128, 8}, std::pair{16, 4}}) {
      if (!GetParam().has_tiles && bin_px != 0) continue;
      RenderOptions o =
          row_options(kWidth, kHeight, GetParam().name, 8, {.bin_px = bin_px, .tile_px = tile_px});
      o.memory_limit = limit;
      SCOPED_TRACE(title(o) + ", " + std::to_string(limit));
      const Frame actual = draw(o, scene, camera);
      ASSERT_TRUE(same_frame(actual, expected));
      EXPECT_LE(actual.stats.peak_bytes, limit);
    }
}

INSTANTIATE_TEST_SUITE_P(Coverages, EverySample, testing::ValuesIn(kRows),
                         [](const auto& p) { return p.param.name; });

/// Whether the sample is on the inner side of edge i or on the edge, if the triangle owns it.
bool inside_edge(const SnappedTriangle& t, int i, int px, int py) {
  SnappedVertex a = t.v[i], b = t.v[(i + 1) % 3];
  if (twice_area(t) < 0) std::swap(a, b);
  const std::int64_t e = (b.x_fx8 - a.x_fx8) * (256 * py + 128 - a.y_fx8) -
                         (b.y_fx8 - a.y_fx8) * (256 * px + 128 - a.x_fx8);
  const bool top_left = b.y_fx8 < a.y_fx8 || (b.y_fx8 == a.y_fx8 && b.x_fx8 > a.x_fx8);
  return e > 0 || (e == 0 && top_left);
}

using Counts = std::map<std::string, std::uint64_t>;

void count_rows(const SnappedTriangle& t, const PixelBox& box, Counts& counts) {
  counts["rows"] += static_cast<std::uint64_t>(box.y1 - box.y0);
  for (int y = box.y0; y < box.y1; ++y) {
    std::set<int> blocks;
    for (int x = box.x0; x < box.x1; ++x)
      if (covers(t, x, y)) blocks.insert(x / 8);
    counts["runs"] += blocks.size();
  }
}

void count_tiles(const SnappedTriangle& t, const PixelBox& box, int bin_px, int tile_px,
                 Counts& counts) {
  using Cell = std::pair<int, int>;
  std::set<Cell> bins;
  std::map<Cell, std::tuple<bool, bool, bool>> tiles;  // which edges have a sample inside
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x) {
      bins.insert({x / bin_px, y / bin_px});
      auto& [e0, e1, e2] = tiles[{x / tile_px, y / tile_px}];
      e0 = e0 || inside_edge(t, 0, x, y);
      e1 = e1 || inside_edge(t, 1, x, y);
      e2 = e2 || inside_edge(t, 2, x, y);
    }
  counts["bins"] += bins.size();
  counts["tile pairs"] +=
      static_cast<std::uint64_t>(std::ranges::count_if(tiles, [](const auto& tile) {
        return tile.second == std::tuple{true, true, true};
      }));
}

/// The counts that the listing of that name must make with these pieces.
Counts expected_counts(const std::string& name, const PieceList& pieces, const RenderOptions& o) {
  Counts counts;
  const int bin_px = o.tuning.bin_px == 0 ? 32 : o.tuning.bin_px;
  const int tile_px = o.tuning.tile_px == 0 ? 8 : o.tuning.tile_px;
  const int small_px = o.tuning.small_px == 0 ? 128 : o.tuning.small_px;
  for (const SnappedTriangle& t : pieces.triangles) {
    const PixelBox box = box_of(t, o.width, o.height);
    if (box.empty()) continue;
    const bool parted = name == "pineda" || name == "hybrid";
    const bool small = parted && box.area() <= small_px;
    if (parted) ++counts[small ? "small" : "large"];
    if (name == "scanline" || (small && o.tuning.small_path == SmallPath::rows && name == "hybrid"))
      count_rows(t, box, counts);
    else if (!small)
      count_tiles(t, box, bin_px, tile_px, counts);
  }
  return counts;
}

class CountersOf : public testing::TestWithParam<Row> {};

TEST_P(CountersOf, AreTheWorkOfTheListing) {
  const Row& row = GetParam();
  constexpr int kWidth = 203, kHeight = 150;
  Counts seen;
  int n = 0;
  for (const auto& [bin_px, tile_px] : kTileSizes) {
    if (!row.has_tiles && bin_px != 0) continue;
    for (const int small_px : kSmall)
      for (const SmallPath path : kPaths) {
        const RenderOptions o = row_options(kWidth, kHeight, row.name, kThreads[n % 3],
                                            {.bin_px = bin_px,
                                             .tile_px = tile_px,
                                             .small_px = small_px,
                                             .order = kOrders[n % 2],
                                             .small_path = path});
        const auto seed = static_cast<std::uint64_t>(n++);
        if (test_share() < 100 && seed % 5 != 0) continue;
        SCOPED_TRACE(title(o) + ", scene " + std::to_string(seed));
        const GeneratedScene g = generate(seed, kWidth, kHeight);
        const Frame frame = draw(o, g.scene, g.camera);
        const Counts expected =
            expected_counts(row.name, pieces_of(g.view(), g.camera, kWidth, kHeight), o);
        for (const auto& [name, value] : frame.stats.counters) {
          const auto found = expected.find(name);
          EXPECT_EQ(value, found == expected.end() ? 0 : found->second) << name;
        }
        for (const auto& [name, value] : expected) {
          seen[name] += value;
          const auto named = std::ranges::find(frame.stats.counters, name,
                                               &std::pair<std::string, std::uint64_t>::first);
          EXPECT_NE(named, frame.stats.counters.end()) << name;
        }
      }
  }
  for (const auto& [name, value] : seen)
    EXPECT_GT(value, static_cast<std::uint64_t>(share_of(100))) << name;
}

INSTANTIATE_TEST_SUITE_P(Coverages, CountersOf,
                         testing::ValuesIn(std::begin(kRows), std::end(kRows) - 1),
                         [](const auto& p) { return p.param.name; });

TEST(Tilings, OthersAreRefusedWithWhatThereIs) {
  for (const Row& row : kRows) {
    if (!row.has_tiles) continue;
    for (const auto& [bin_px, tile_px] : {std::pair{8, 8},
                                          {64, 2},
                                          {48, 8},
                                          {0, 5},
                                          {-32, 8},
                                          {32, -8},
                                          {256, 16},
                                          {128, 4},
                                          {8, 0}}) {
      const RenderOptions o =
          row_options(64, 64, row.name, 1, {.bin_px = bin_px, .tile_px = tile_px});
      SCOPED_TRACE(title(o));
      const std::string said = refusal_of([&] { const Painter painter(o); });
      EXPECT_TRUE(holds(said, "tiles from 4 px, bins of 2 to 16 tiles across and up to 128 px"));
      EXPECT_TRUE(holds(said, row.name));
    }
  }
}

TEST(Order, MortonIsTheInterleavedOneWithoutWhatLiesOutside) {
  for (const auto& [columns, rows] :
       {std::pair{1, 1}, {8, 8}, {7, 3}, {1, 19}, {33, 2}, {20, 20}, {5, 64}}) {
    std::vector<std::tuple<unsigned, int, int>> cells;  // code, column, row
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        unsigned code = 0;
        for (unsigned b = 0; b < 8; ++b)
          code |= (static_cast<unsigned>(x) >> b & 1U) << (2 * b) |
                  (static_cast<unsigned>(y) >> b & 1U) << (2 * b + 1);
        cells.emplace_back(code, x, y);
      }
    std::ranges::sort(cells);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const family::Cell cell = family::cell_at(BlockOrder::morton, i, columns, rows);
      EXPECT_EQ(std::pair(cell.column, cell.row),
                std::pair(std::get<1>(cells[i]), std::get<2>(cells[i])))
          << i << " of " << columns << " x " << rows;
      const family::Cell plain = family::cell_at(BlockOrder::row_major, i, columns, rows);
      EXPECT_EQ(static_cast<std::size_t>(plain.row * columns + plain.column), i);
    }
  }
}

std::uint64_t tiled_bytes(const char* spec, int size, float smaller) {
  const Scene scene = single(shapes::from_spec(spec));
  const SceneBinding binding(scene);
  Camera camera = fit_camera(binding.view(), 1.0472F, true);
  camera.orthographic_height *= smaller;
  RenderOptions o = row_options(size, size, "tiled", 2);
  o.shader = Shader::depth;
  Image<float> depth(size, size);
  const FrameStats stats = Painter(o).render(binding.view(), camera, {.depth = depth});
  EXPECT_GT(stats.pixels_covered, 500000U);
  return stats.peak_bytes;
}

// Paper 1, table 2: 9.4 MB for the Bunny of 4,968 triangles at 1024².
TEST(Tiled, ScratchStaysBelowThePapersForABunny) {
  const std::uint64_t bytes = tiled_bytes("sphere?rings=51&segments=50", 1024, 1);  // 5,000
  RecordProperty("bytes", std::to_string(bytes));
  EXPECT_LT(bytes, 9'000'000U);
}

TEST(Tiled, ScratchGrowsWithTrianglesAndNotWithPixels) {
  // The same triangles at the same size in pixels, in 16 times as many pixels.
  const std::uint64_t small = tiled_bytes("sphere?rings=51&segments=50", 1024, 1);
  const std::uint64_t large = tiled_bytes("sphere?rings=51&segments=50", 4096, 4);
  EXPECT_LT(large, small + small / 4) << small;
  // 16 times as many triangles on the same pixels.
  const std::uint64_t many = tiled_bytes("sphere?rings=201&segments=200", 1024, 1);  // 80,000
  EXPECT_GT(many, 2 * small);
  EXPECT_LT(many, 16 * small);
}

}  // namespace
}  // namespace rastrum::test::coverage_test
