// SPDX-License-Identifier: BSD-3-Clause
// Paper 2's rasterizer: its masks against their definition, both schedules against the reference,
// and its counters and the load of its simulated workers against counts made here.
#include <papers/paper2/binned.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <papers/paper2/tile_mask.hpp>
#include <papers/table/row.hpp>
#include <rastrum/error.hpp>
#include <rastrum/raster/frame/driver.hpp>
#include <rastrum/raster/frame/reference.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/raster/rules/points_and_lines.hpp>
#include <rastrum/render.hpp>

#include "tests/papers/rows.hpp"
#include "tests/support/draws_of.hpp"
#include "tests/support/isa.hpp"
#include "tests/support/pieces.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::binned_test {
namespace {

using family::Schedule;

constexpr std::array kSchedules{Schedule::two_stage, Schedule::persistent};
constexpr std::array<std::pair<int, int>, 5> kSizes{
    {{64, 8}, {32, 8}, {64, 16}, {128, 8}, {128, 16}}};

RenderOptions binned(int width, int height, Schedule schedule, int threads) {
  return row_options(width, height, "binned", threads, {.schedule = schedule});
}

const family::CoverageRow& binned_row() {
  return *std::ranges::find(family::coverages(), std::string_view("binned"),
                            &family::CoverageRow::name);
}

std::string title(const RenderOptions& o) {
  return std::string(o.tuning.schedule == Schedule::persistent ? "persistent" : "two-stage")
      .append(", ")
      .append(std::to_string(o.threads))
      .append(" threads, bins of ")
      .append(std::to_string(o.tuning.bin_px));
}

/// Random triangles of at least `least` and at most `most` px, anywhere inside of the picture.
Scene sized_triangles(int count, double least, double most, int width, int height,
                      std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  while (mesh.positions.size() < static_cast<std::size_t>(count) * 3) {
    double x[3], y[3];
    for (int i = 0; i < 3; ++i) {
      x[i] = random.real(0, width);
      y[i] = random.real(0, height);
    }
    const double area = std::abs((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])) / 2;
    if (area < least || area > most) continue;
    for (int i = 0; i < 3; ++i)
      mesh.positions.push_back(at_pixel(x[i], y[i], random.real(0, 1), width, height));
  }
  return single(std::move(mesh));
}

// Expected counters, computed from the pieces by the oracle.

struct Expected {
  std::uint64_t pieces = 0, small = 0, large = 0, bins = 0, tile_pairs = 0, blocks = 0;
  std::vector<std::uint64_t> tiles_of_bin;
};

Expected expected_of(const PieceList& pieces, int width, int height, int large_px = 4000,
                     int bin_px = 64, int tile_px = 8) {
  Expected e;
  const int columns = (width + bin_px - 1) / bin_px;
  e.tiles_of_bin.resize(static_cast<std::size_t>(columns * ((height + bin_px - 1) / bin_px)));
  for (const SnappedTriangle& t : pieces.triangles) {
    const PixelBox box = box_of(t, width, height);
    if (box.empty()) continue;
    ++e.pieces;
    const auto cells = [&](int size) {
      return static_cast<std::uint64_t>(((box.x1 - 1) / size - box.x0 / size + 1) *
                                        ((box.y1 - 1) / size - box.y0 / size + 1));
    };
    if ((box.x1 - box.x0) * (box.y1 - box.y0) < large_px) {
      ++e.small;
      e.blocks += cells(8);
      continue;
    }
    ++e.large;
    e.bins += cells(bin_px);
    for (int ty = box.y0 / tile_px * tile_px; ty < box.y1; ty += tile_px)
      for (int tx = box.x0 / tile_px * tile_px; tx < box.x1; tx += tile_px) {
        bool any = false;
        for (int y = ty; y < std::min(ty + tile_px, height) && !any; ++y)
          for (int x = tx; x < std::min(tx + tile_px, width) && !any; ++x) any = covers(t, x, y);
        if (!any) continue;
        ++e.tile_pairs;
        ++e.tiles_of_bin[static_cast<std::size_t>(ty / bin_px * columns + tx / bin_px)];
      }
  }
  return e;
}

void expect_counters(const FrameStats& stats, const Expected& e) {
  EXPECT_EQ(counter(stats, "batches"), (e.pieces + 31) / 32);
  EXPECT_EQ(counter(stats, "small"), e.small);
  EXPECT_EQ(counter(stats, "large"), e.large);
  EXPECT_EQ(counter(stats, "bins"), e.bins);
  EXPECT_EQ(counter(stats, "tile pairs"), e.tile_pairs);
  EXPECT_EQ(counter(stats, "work of 64 workers"), e.tile_pairs + e.blocks);
}

/// Expects this picture and work from both schedules with each number of threads.
void expect_by_both(const Scene& scene, const Camera& camera, const Frame& expected,
                    const Expected& work, std::initializer_list<int> thread_counts,
                    std::uint64_t most_bytes = ~std::uint64_t{0}) {
  for (const Schedule schedule : kSchedules)
    for (const int threads : thread_counts) {
      const RenderOptions options =
          binned(expected.ids.width(), expected.ids.height(), schedule, threads);
      SCOPED_TRACE(title(options));
      const Frame frame = draw(options, scene, camera);
      EXPECT_TRUE(same_frame(frame, expected));
      expect_counters(frame.stats, work);
      EXPECT_LT(frame.stats.peak_bytes, most_bytes);
    }
}

// A bin's mask has a tile if and only if a sample of the tile is covered.

raster::ProjectedVertex vertex(int x_fx8, int y_fx8) {
  raster::ProjectedVertex v;
  v.x_fx8 = x_fx8;
  v.y_fx8 = y_fx8;
  v.depth = 0.5F;
  return v;
}

/// The tiles that cover_tiles finds; expects each once, ascending.
std::vector<bool> covered_tiles(family::BinSizes sizes, const raster::Piece& piece,
                                raster::Rect bin) {
  std::vector<bool> tiles(static_cast<std::size_t>(sizes.tiles_per_bin()));
  int last = -1;
  family::cover_tiles(sizes, piece, bin, [&](int tile) {
    EXPECT_GT(tile, last);
    last = tile;
    tiles.at(static_cast<std::size_t>(tile)) = true;
  });
  return tiles;
}

void expect_exact_masks(family::BinSizes sizes, std::uint64_t seed, int count) {
  const int bin_px = sizes.bin_px();
  Random random(seed);
  std::uint64_t covered = 0, empty = 0;
  for (int i = 0; i < count; ++i) {
    // A bin anywhere, whole or cut by the view, and corners near it, far from it, or in a line.
    raster::Rect bin;
    bin.x0 = random.integer(0, 20) * bin_px;
    bin.y0 = random.integer(0, 20) * bin_px;
    bin.x1 = bin.x0 + (random.chance(0.7) ? bin_px : random.integer(1, bin_px));
    bin.y1 = bin.y0 + (random.chance(0.7) ? bin_px : random.integer(1, bin_px));
    const bool far = random.chance(0.3), grid = random.chance(0.3), sliver = random.chance(0.3);
    SnappedTriangle t;
    for (SnappedVertex& v : t.v) {
      const int reach = far ? 30000 : bin_px;
      v.x_fx8 = (bin.x0 + random.integer(-reach, reach + bin_px)) * 256 + random.integer(0, 255);
      v.y_fx8 = (bin.y0 + random.integer(-reach, reach + bin_px)) * 256 + random.integer(0, 255);
      if (grid) {
        v.x_fx8 = v.x_fx8 / 256 * 256 + 128;
        v.y_fx8 = v.y_fx8 / 256 * 256 + 128;
      }
    }
    if (sliver) {
      t.v[2] = t.v[1];
      t.v[2].x_fx8 += random.integer(-300, 300);
      t.v[2].y_fx8 += random.integer(-300, 300);
    }
    raster::Piece piece;
    const auto corner = [&](int k) {
      return vertex(static_cast<int>(t.v[k].x_fx8), static_cast<int>(t.v[k].y_fx8));
    };
    if (raster::make_piece(corner(0), corner(1), corner(2), 0, 0, Cull::none, bin, piece) ==
        raster::SetupResult::culled)
      continue;
    const std::vector<bool> found = covered_tiles(sizes, piece, bin);
    for (std::size_t tile = 0; tile < found.size(); ++tile) {
      const raster::Rect r = family::tile_of_bin(sizes, bin, static_cast<int>(tile));
      bool any = false;
      for (int y = r.y0; y < std::min(r.y1, bin.y1) && !any; ++y)
        for (int x = r.x0; x < std::min(r.x1, bin.x1) && !any; ++x) any = covers(t, x, y);
      ASSERT_EQ(found[tile], any) << "triangle " << i << ", tile " << tile;
      ++(any ? covered : empty);
    }
  }
  EXPECT_GT(covered, 100U);
  EXPECT_GT(empty, 100U);
}

TEST(TileMask, HoldsExactlyTheTilesWithACoveredSample) {
  const int count = share_of(5000);
  expect_exact_masks({6, 3}, 1, count);
  expect_exact_masks({5, 3}, 2, count);
  expect_exact_masks({6, 4}, 3, count);
  expect_exact_masks({7, 3}, 4, count / 4);
  expect_exact_masks({7, 4}, 5, count / 4);
}

TEST(TileMask, OfLinesAndPoints) {
  constexpr family::BinSizes kSizesOfBin{6, 3};
  Random random(11);
  std::array<std::uint64_t, 2> covered{};
  for (int i = 0; i < 2000; ++i) {
    const raster::Rect bin{640, 1280, 640 + random.integer(1, 64), 1280 + random.integer(1, 64)};
    const auto corner = [&] {
      const int x = random.integer(500 * 256, 900 * 256);
      return vertex(x, random.integer(1100 * 256, 1500 * 256));
    };
    const raster::ProjectedVertex a = corner(), b = corner();
    raster::Piece piece;
    const bool is_line = random.chance(0.5);
    const auto size = random.integer(1, 30);
    const raster::SetupResult result =
        is_line ? raster::make_line(a, b, 0, 0, static_cast<std::uint32_t>(size), bin, piece)
                : raster::make_point(a, 0, 0, size * 700, bin, piece);
    if (result == raster::SetupResult::culled) continue;
    const std::vector<bool> found = covered_tiles(kSizesOfBin, piece, bin);
    for (std::size_t tile = 0; tile < found.size(); ++tile) {
      const raster::Rect r = family::tile_of_bin(kSizesOfBin, bin, static_cast<int>(tile));
      bool any = false;
      for (int y = r.y0; y < std::min(r.y1, bin.y1); ++y) {
        const raster::Span span = raster::row_span(piece, y, r.x0, std::min(r.x1, bin.x1));
        any = any || span.begin < span.end;
      }
      ASSERT_EQ(found[tile], any) << i << ", tile " << tile;
      covered[is_line] += any;
    }
  }
  EXPECT_GT(covered[0], 100U);
  EXPECT_GT(covered[1], 100U);
}

TEST(TileMask, HalfLineIsItsDefinition) {
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const int n = random.integer(1, 16);
    const std::int64_t step = random.integer(-9, 9), base = random.integer(-60, 60);
    const raster::Span span = family::half_line(base, step, n);
    for (int t = 0; t < n; ++t)
      ASSERT_EQ(t >= span.begin && t < span.end, base + step * t >= 0)
          << base << " + " << step << " · " << t;
  }
}

// Every kind of scene, by both schedules: each covered sample once, and the work as counted here.

struct Case {
  Schedule schedule;
  int threads, bin_px, tile_px, large_px;
};

TEST(Binned, EnumeratesEachCoveredSampleOnceAndCountsItsWork) {
  constexpr int kWidth = 200, kHeight = 150;
  std::vector<Case> cases;
  for (const Schedule schedule : kSchedules)
    for (const int threads : {1, 2, 8}) {
      const auto& [bin_px, tile_px] = kSizes[cases.size() % kSizes.size()];
      cases.push_back({schedule, threads, 64, 8, 4000});
      cases.push_back({schedule, threads, 64, 8, 500});
      cases.push_back({schedule, threads, bin_px, tile_px, 1});
    }
  for (const auto& [bin_px, tile_px] : kSizes)
    for (const Schedule schedule : kSchedules) cases.push_back({schedule, 2, bin_px, tile_px, 100});
  std::vector<Painter> renderers;
  for (const Case& c : cases) {
    renderers.emplace_back(row_options(kWidth, kHeight, "binned", c.threads,
                                       {.bin_px = c.bin_px,
                                        .tile_px = c.tile_px,
                                        .large_px = c.large_px,
                                        .schedule = c.schedule}));
  }
  Painter reference(reference_options(kWidth, kHeight));

  const int scenes = share_of(100, kSceneKinds);
  std::map<std::string, Expected> seen;
  for (int seed = 0; seed < scenes; ++seed) {
    const GeneratedScene g = generate(static_cast<std::uint64_t>(seed), kWidth, kHeight);
    SCOPED_TRACE("scene " + std::to_string(seed) + " (" + g.kind + ")");
    const Frame expected = draw(reference, g.view(), g.camera);
    const PieceList pieces = pieces_of(g.view(), g.camera, kWidth, kHeight);
    std::map<std::tuple<int, int, int>, Expected> work;
    for (std::size_t k = 0; k < cases.size(); ++k) {
      const Case& c = cases[k];
      SCOPED_TRACE(title(renderers[k].options()));
      const Frame frame = draw(renderers[k], g.view(), g.camera);
      ASSERT_TRUE(same_frame(frame, expected));
      ASSERT_TRUE(counts_add_up(frame));
      const auto [entry, is_new] = work.try_emplace({c.large_px, c.bin_px, c.tile_px});
      if (is_new)
        entry->second = expected_of(pieces, kWidth, kHeight, c.large_px, c.bin_px, c.tile_px);
      expect_counters(frame.stats, entry->second);
      seen[g.kind].small += entry->second.small;
      seen[g.kind].large += entry->second.large;
    }
    if (HasFailure()) return;
  }
  // These include the kinds that the paper's reference code loses.
  for (const char* kind : {"near_crossing", "huge", "extreme"})
    EXPECT_GT(seen[kind].large, 0U) << kind;
}

TEST(Binned, DrawsWhatCrossesTheNearPlaneAndTheGuardBand) {
  constexpr int kWidth = 640, kHeight = 480;
  const Camera camera{.eye = {0, 0, 0}, .target = {0, 0, -1}, .near_plane = 0.1F};
  // A floor and a wall that begin behind the eye, and a triangle beyond the guard band.
  Mesh mesh;
  mesh.positions = {{-50, -1, 20},      {50, -1, 20},      {0, -1, -200},
                    {2, -40, 3},        {2, 40, 3},        {2, 0, -90},
                    {-9e5F, -8e5F, -3}, {9e5F, -7e5F, -3}, {1e4F, 9e5F, -3}};
  const Scene scene = single(std::move(mesh));
  const SceneBinding binding(scene);
  const Frame expected = draw(reference_options(kWidth, kHeight), scene, camera);
  EXPECT_EQ(expected.stats.triangles.clipped, 3U);
  EXPECT_EQ(expected.stats.pixels_covered, std::uint64_t{kWidth} * kHeight);
  const PieceList pieces = pieces_of(binding.view(), camera, kWidth, kHeight);
  const Expected work = expected_of(pieces, kWidth, kHeight);
  EXPECT_GE(work.large, 3U);
  expect_by_both(scene, camera, expected, work, {1, 2, 8});
}

TEST(Binned, QueuesGrow) {
  constexpr int kSize = 512;
  // Slivers whose boxes touch at least four bins; together they far exceed a round.
  const int count = share_of(100000);
  Random random(3);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const double x = random.real(0, kSize - 80), y = random.real(0, kSize - 80);
    for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {70.0, 66.0}, {69.0, 68.0}})
      mesh.positions.push_back(at_pixel(x + dx, y + dy, random.real(0, 1), kSize, kSize));
  }
  const Scene scene = single(std::move(mesh));
  const SceneBinding binding(scene);
  const Camera camera = pixel_camera(kSize, kSize);
  const Frame expected = draw(reference_options(kSize, kSize), scene, camera);
  const Expected work = expected_of(pieces_of(binding.view(), camera, kSize, kSize), kSize, kSize);
  EXPECT_EQ(work.large, static_cast<std::uint64_t>(count));
  EXPECT_GE(work.bins, 4U * static_cast<std::uint64_t>(count));
  // Entries take at most 48 bytes and do not exist all at once. The rest are pieces (twice),
  // vertices and keys.
  expect_by_both(scene, camera, expected, work, {1, 8},
                 static_cast<std::uint64_t>(count) * (2 * 48 + 3 * 16) * 3 / 2 + kSize * kSize * 8 +
                     (std::uint64_t{12} << 20));
}

TEST(Binned, DrawsInRoundsWhereMemoryIsShort) {
  if (test_share() < 100) GTEST_SKIP() << kOnlyWhole;
  constexpr int kSize = 512;
  constexpr std::uint64_t kLimit = std::uint64_t{24} << 20;
  const Scene scene = sized_triangles(3000, 30000, 80000, kSize, kSize, 4);
  const Camera camera = pixel_camera(kSize, kSize);
  const Frame expected = draw(reference_options(kSize, kSize), scene, camera);
  for (const Schedule schedule : kSchedules) {
    RenderOptions options = binned(kSize, kSize, schedule, 8);
    options.tuning.bin_px = 32;
    SCOPED_TRACE(title(options));
    const Frame all_at_once = draw(options, scene, camera);
    options.memory_limit = kLimit;
    const Frame frame = draw(options, scene, camera);
    EXPECT_TRUE(same_surfaces(frame, expected));
    EXPECT_LE(frame.stats.peak_bytes, kLimit);
    for (const char* name : {"small", "large", "bins", "tile pairs", "work of 64 workers"})
      EXPECT_EQ(counter(frame.stats, name), counter(all_at_once.stats, name)) << name;
    const auto stage = schedule == Schedule::persistent ? "draw" : "rasterize bins";
    const auto rounds = [&](const Frame& f) {
      return std::ranges::count(f.stats.stages, stage, &StageTime::name);
    };
    EXPECT_EQ(rounds(all_at_once), 1);
    EXPECT_GT(rounds(frame), 1);
  }
}

// How evenly 64 workers would share the tiles.

TEST(Binned, TwoStagesLoadAllWorkersAlike) {
  if (test_share() < 100) GTEST_SKIP() << kOnlyWhole;
  constexpr int kWidth = 1920, kHeight = 1080;
  const Camera camera = pixel_camera(kWidth, kHeight);
  struct Row {
    int count;
    double least, most;
  };
  for (const Row& row :
       {Row{8, 4000, 40000}, {40, 4000, 40000}, {400, 4000, 40000}, {40, 40000, 1e6}})
    for (const std::uint64_t seed : {std::uint64_t{1}, std::uint64_t{2}}) {
      SCOPED_TRACE(std::to_string(row.count) + " of at least " + std::to_string(row.least) +
                   " px, seed " + std::to_string(seed));
      const Scene scene = sized_triangles(row.count, row.least, row.most, kWidth, kHeight, seed);
      const SceneBinding binding(scene);
      const Expected work =
          expected_of(pieces_of(binding.view(), camera, kWidth, kHeight), kWidth, kHeight);
      ASSERT_EQ(work.large, static_cast<std::uint64_t>(row.count));
      std::array<std::uint64_t, 64> of_owner{};
      for (std::size_t bin = 0; bin < work.tiles_of_bin.size(); ++bin)
        of_owner[bin % 64] += work.tiles_of_bin[bin];
      std::array<double, 2> ratio{};
      for (const Schedule schedule : kSchedules) {
        const Frame frame = draw(binned(kWidth, kHeight, schedule, 2), scene, camera);
        expect_counters(frame.stats, work);
        const std::uint64_t most = counter(frame.stats, "most loaded of 64 workers");
        if (schedule == Schedule::persistent) {
          EXPECT_EQ(most, *std::max_element(of_owner.begin(), of_owner.end()));
        }
        ratio[schedule == Schedule::persistent] =
            static_cast<double>(most) * 64 / static_cast<double>(work.tile_pairs);
      }
      EXPECT_GE(ratio[0], 1.0);
      EXPECT_LE(ratio[0], 1.1);
      std::string what = std::to_string(row.count);
      what.append(row.most > 40000 ? "_very_large_" : "_large_").append(std::to_string(seed));
      RecordProperty(what + "_two_stage", std::to_string(ratio[0]));
      RecordProperty(what + "_persistent", std::to_string(ratio[1]));
    }
}

// A visibility that needs several passes over parts: each chunk must have the same blocks in the
// same order, whatever the threads do.

using Seen = std::vector<std::tuple<std::uint32_t, int, int, std::uint64_t>>;

class Again final : public family::Region {
 public:
  void begin(const family::RegionContext&, const raster::SurfaceView&, raster::Rect,
             std::size_t chunks) override {
    first_.assign(chunks, {});
    again_.assign(chunks, {});
    passes_ = 0;
  }
  std::optional<Pass> next() override {
    const std::size_t n = first_.size();
    switch (passes_++) {
      case 0:
        return Pass{0, n};
      case 1:
        return Pass{0, n / 3};
      case 2:
        return Pass{n / 3, n};
      default:
        for (const Seen& s : first_) blocks_seen += s.size();
        EXPECT_EQ(first_, again_);
        return std::nullopt;
    }
  }
  void blocks(std::size_t chunk, const raster::Piece*,
              std::span<const raster::Block> blocks) override {
    Seen& seen = (passes_ == 1 ? first_ : again_)[chunk];
    for (const raster::Block& b : blocks) seen.emplace_back(b.piece, b.bx, b.by, b.mask);
  }

  static inline std::size_t blocks_seen = 0;

 private:
  std::vector<Seen> first_, again_;
  int passes_ = 0;
};

TEST(Binned, EveryPassSeesTheSameChunks) {
  constexpr int kSize = 512;
  family::Visibility again;
  again.name = "again";
  again.make = [](family::Sharing, MemoryAccount&) -> std::unique_ptr<family::Region> {
    return std::make_unique<Again>();
  };
  Scene scene = sized_triangles(300, 4000, 40000, kSize, kSize, 5);
  const Scene small = sized_triangles(700, 4, 300, kSize, kSize, 6);
  Mesh& mesh = scene.meshes.front();
  // Large and small ones alternate in the batches.
  std::vector<Vec3> mixed;
  for (std::size_t i = 0; i < 1000; ++i) {
    const auto& from = i % 10 < 3 ? mesh.positions : small.meshes.front().positions;
    const std::size_t t = i % 10 < 3 ? i / 10 * 3 + i % 10 : i / 10 * 7 + i % 10 - 3;
    mixed.insert(mixed.end(), from.begin() + static_cast<std::ptrdiff_t>(t * 3),
                 from.begin() + static_cast<std::ptrdiff_t>(t * 3 + 3));
  }
  mesh.positions = std::move(mixed);
  raster::Draw draw =
      draw_of(mesh.positions, world_to_clip(pixel_camera(kSize, kSize), kSize, kSize));
  for (const Schedule schedule : kSchedules)
    for (const int threads : {1, 8})
      for (const std::uint64_t limit : {std::uint64_t{0}, std::uint64_t{4} << 20}) {
        MemoryAccount memory;
        parallel::Threads exec(threads, &memory);
        family::Tuning tuning;
        tuning.schedule = schedule;
        raster::FrameDriver rasterizer(family::make_row(binned_row(), again, tuning, true, memory),
                                       limit, memory, &exec);
        raster::FrameRequest request;
        request.width = request.height = kSize;
        request.draws = {&draw, 1};
        for (int frame = 0; frame < 2; ++frame) {  // the second reuses scratch
          Again::blocks_seen = 0;
          const FrameStats stats = rasterizer.draw(request, rasterizer.plan(request));
          EXPECT_GT(counter(stats, "large"), 0U);
          EXPECT_GT(counter(stats, "small"), 0U);
          EXPECT_GT(Again::blocks_seen, 10000U);
        }
      }
}

// Tested here, because the façade refuses it earlier.
TEST(FrameDriver, RefusesInstructionSetsThatAreNotThere) {
  MemoryAccount memory;
  parallel::Threads exec(1, &memory);
  raster::FrameDriver driver(
      family::make_row(binned_row(), family::visibilities().front(), {}, true, memory), 0, memory,
      &exec);
  raster::FrameRequest request;
  request.width = request.height = 8;
  request.isa = missing_isa();
  EXPECT_THROW(static_cast<void>(driver.draw(request, driver.plan(request))), Error);
  request.isa = available_isas().back();
  EXPECT_EQ(driver.draw(request, driver.plan(request)).isa, request.isa);
}

TEST(Binned, SendsLinesAndPointsThroughItsQueues) {
  constexpr int kSize = 300;
  Random random(13);
  std::vector<Vec3> positions;
  for (int i = 0; i < 400; ++i) {
    const double x = random.real(0, kSize), y = random.real(0, kSize);
    positions.push_back(at_pixel(x, y, random.real(0, 1), kSize, kSize));
  }
  std::array<raster::Draw, 2> draws;
  draws.fill(draw_of(positions, world_to_clip(pixel_camera(kSize, kSize), kSize, kSize)));
  draws[0].topology = Topology::lines;
  draws[0].primitive_count = positions.size() / 2;
  draws[0].line_width = 5;
  draws[1].topology = Topology::points;
  draws[1].primitive_count = positions.size();
  draws[1].point_size = 12.5F;
  const auto request_for = [&](Frame& p) {
    raster::FrameRequest request;
    request.width = request.height = kSize;
    request.draws = draws;
    request.targets = p.targets();
    return request;
  };
  MemoryAccount memory;
  Frame expected(kSize, kSize, kIds | kOverdraw);
  raster::FrameRequest plain = request_for(expected);
  raster::FrameDriver reference(raster::make_reference(), 0, memory, nullptr);
  const FrameStats stats = reference.draw(plain, reference.plan(plain));
  EXPECT_GT(stats.fragments, 100000U);
  for (const Schedule schedule : kSchedules) {
    parallel::Threads exec(2, &memory);
    family::Tuning tuning;
    tuning.schedule = schedule;
    tuning.large_px = 1;
    raster::FrameDriver rasterizer(
        family::make_row(binned_row(), family::visibilities().front(), tuning, true, memory), 0,
        memory, &exec);
    Frame actual(kSize, kSize, kIds | kOverdraw);
    raster::FrameRequest request = request_for(actual);
    const FrameStats s = rasterizer.draw(request, rasterizer.plan(request));
    EXPECT_TRUE(same_images(actual, expected));
    EXPECT_EQ(counter(s, "small"), 0U);
    EXPECT_GT(counter(s, "large"), 500U);
  }
}

TEST(Binned, RefusesATuningThatItDoesNotTake) {
  const auto painter = [](int bin_px, int tile_px, int large_px) {
    return [=] {
      const Painter made(row_options(64, 64, "binned", 1,
                                     {.bin_px = bin_px, .tile_px = tile_px, .large_px = large_px}));
    };
  };
  expect_refused("tiles from 8 px, bins of 2 to 16 tiles", painter(48, 8, 0));
  expect_refused("", painter(64, 4, 0));
  expect_refused("", painter(0, 64, 0));
  expect_refused("", painter(0, 0, -1));
  painter(0, 32, 0)();
  painter(0, 0, 0)();
  for (const auto& [bin_px, tile_px] : kSizes) painter(bin_px, tile_px, 1)();
}

}  // namespace
}  // namespace rastrum::test::binned_test
