// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/frame/driver.hpp>

#include <algorithm>
#include <atomic>
#include <string>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/raster/bin/tile_grid.hpp>
#include <rastrum/raster/cull/selection.hpp>
#include <rastrum/raster/draws/numbering.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/rules/quadric.hpp>
#include <rastrum/raster/setup/set_up.hpp>

namespace rastrum::raster {
namespace {

/// With fewer bytes for triangles or fragments at once, the pieces of work would be smaller than
/// the cost of a task.
constexpr std::uint64_t kLeastShare = std::uint64_t{1} << 19;

/// Bytes that each thread needs beside the shares of the plan: a tile's keys, colours and depths, a
/// bin's rows, a setup kernel's fragments with their runs, and a bin's keys of several samples.
std::uint64_t thread_bytes(int samples) {
  constexpr std::uint64_t kKeysOfASample = sizeof(std::uint64_t) * kBinSize * kBinSize;
  return (std::uint64_t{3} << 16) +
         (samples > 1 ? static_cast<std::uint64_t>(samples) * kKeysOfASample : 0);
}

/// 32 bits count the pieces of a batch, and the clipper makes fewer than 16 of a triangle.
constexpr std::uint64_t kLargestBatch = std::uint64_t{1} << 28;

/// A draw by clusters projects only vertices that are seen, but into memory for all. Draws with
/// more vertices (a GiB) keep none: shading projects again those that it needs.
constexpr std::size_t kMostSparse = std::size_t{1} << 26;

std::atomic<std::uint64_t> frames_of_all = 0;

[[noreturn]] void refuse_limit(std::uint64_t limit, const std::string& why) {
  throw Error(Errc::out_of_memory, std::string("a memory limit of ")
                                       .append(std::to_string(limit))
                                       .append(" bytes ")
                                       .append(why));
}

/// Gives draws their places among the projected vertices. Returns their number.
std::uint64_t place_projected(std::span<Draw> draws) {
  std::uint64_t vertices = 0;
  for (Draw& draw : draws) {
    draw.is_projected = false;
    if (!draw.visible || is_projected_in_setup(draw) ||
        (draw.clusters != nullptr && draw.vertex_count > kMostSparse)) {
      draw.first_vertex = kNotProjected;
      continue;
    }
    draw.first_vertex = vertices;
    vertices += draw.vertex_count;
  }
  return vertices;
}

bool has_round_points(const FrameRequest& request) {
  return std::ranges::any_of(request.draws, [](const Draw& d) { return d.is_round(); });
}

}  // namespace

Totals begin_frame(FrameRequest& request) {
  const Targets& targets = request.targets;
  const Totals totals = number_draws(request.draws, request.pass.first_id, request.names);
  for (int y = 0; y < request.height; ++y) {
    if (!targets.overdraw.empty() && !request.pass.load)
      std::fill_n(targets.overdraw.row(y), request.width, 0U);
    if (!targets.errors.empty()) std::fill_n(targets.errors.row(y), request.width, std::uint8_t{0});
  }
  return totals;
}

void end_frame(const Totals& totals, FrameStats& stats) {
  stats.triangles.input = totals.primitives;
  stats.triangles.drawn = totals.primitives - stats.triangles.dropped - stats.triangles.culled;
}

/// Bands of rows, and batches of triangles in each. Without a limit there is one of both.
struct FrameDriver::Split {
  bool project_first = true;  ///< else where triangles need them
  bool surface = true;        ///< a band has keys; else tiles keep their own
  int band_rows = 0;
  std::uint64_t batch = 0;  ///< triangles
  std::uint64_t fragment_bytes = 0;
  std::uint64_t expansion_bytes = 0;
  std::uint64_t view_bytes = 0;
};

FrameDriver::FrameDriver(std::unique_ptr<Method> method, std::uint64_t memory_limit,
                         MemoryAccount& memory, parallel::Threads* threads)
    : method_(std::move(method)),
      needs_(method_->needs()),
      memory_limit_(memory_limit),
      threads_(threads),
      shaders_([&memory] { return ShaderOfThread(memory); }),
      projected_(memory),
      keys_(memory),
      colors_(memory) {}

FrameDriver::~FrameDriver() = default;

FrameDriver::Split FrameDriver::split_work(const FrameRequest& request,
                                           const Totals& totals) const {
  const std::uint64_t triangles = totals.primitives;
  Split p;
  p.batch = std::clamp<std::uint64_t>(triangles, 1, kLargestBatch);
  if (needs_.whole_view) p.batch = std::max<std::uint64_t>(triangles, 1);
  p.surface = needs_.surface || p.batch < triangles;
  p.band_rows = request.height;
  if (memory_limit_ == 0) return p;

  const std::uint64_t row_of_pixels =
      static_cast<std::uint64_t>(block_columns({0, 0, request.width, 1})) * kBlockSize *
      static_cast<std::uint64_t>(needs_.surface_bytes);
  // A band is whole rows of bins.
  const std::uint64_t least_band = row_of_pixels * kBinSize;
  const auto threads =
      static_cast<std::uint64_t>(threads_ == nullptr ? 1 : threads_->concurrency());
  const std::uint64_t others = request.other_bytes + thread_bytes(request.samples) * threads;
  const std::uint64_t least = others + std::max(least_band, kLeastShare) + 3 * kLeastShare;
  if (memory_limit_ < least)
    refuse_limit(memory_limit_,
                 "is less than the " + std::to_string(least) + " that this frame needs at least");

  // A quarter each for projected vertices, triangles, the surface and fragments. An unused share
  // goes to no other, so that the plan of a frame does not jump.
  const std::uint64_t band_share = std::max((memory_limit_ - others) / 4, least_band);
  const std::uint64_t share = (memory_limit_ - others - band_share) / 3;
  p.project_first = totals.vertices <= share / sizeof(ProjectedVertex);
  p.fragment_bytes = share;
  if (needs_.whole_view) {
    p.view_bytes = share;
    if (!needs_.cuts_views)
      throw Error(Errc::out_of_memory,
                  std::string("'")
                      .append(needs_.rasterizer)
                      .append("' keeps all triangles of a frame with layers at once, whatever the "
                              "memory limit; 'grouped' heeds it"));
    return p;
  }
  // The size of what triangles are expanded to is known only during a draw. A part that does not
  // fit is drawn in turns, onto a surface.
  p.expansion_bytes = needs_.expands ? share / 2 : 0;
  std::uint64_t bytes = static_cast<std::uint64_t>(needs_.triangle_bytes);
  if (request.has_quadrics()) bytes += sizeof(Quadric) + sizeof(Piece);
  p.batch = std::min(p.batch, (share - p.expansion_bytes) / bytes);
  p.surface = p.surface || needs_.expands || p.batch < triangles;
  if (p.surface)
    p.band_rows = static_cast<int>(
        std::min(band_share / least_band * kBinSize, static_cast<std::uint64_t>(request.height)));
  return p;
}

void FrameDriver::project(FrameRun& frame) {
  frame.geometry.projected = frame.projected = projected_.data();
  for (Draw& draw : frame.request.draws)
    if (draw.visible && draw.first_vertex != kNotProjected && draw.clusters == nullptr)
      frame.project(draw);
}

void FrameDriver::draw_view(FrameRun& frame, std::uint64_t first, std::uint64_t last) {
  const Rect view = frame.view;
  frame.fits = true;
  method_->draw(frame, first, last);
  frame.first_band = frame.first_band && !frame.fits;
  if (frame.fits) return;
  const int columns = (view.x1 - view.x0 + kBinSize - 1) / kBinSize;
  const int rows = (view.y1 - view.y0 + kBinSize - 1) / kBinSize;
  if (columns == 1 && rows == 1)
    refuse_limit(memory_limit_, std::string("does not hold what touches the 64 x 64 pixels at (")
                                    .append(std::to_string(view.x0))
                                    .append(", ")
                                    .append(std::to_string(view.y0))
                                    .append("), which layers need at once"));
  Rect a = view, b = view;
  if (rows > 1)
    a.y1 = b.y0 = view.y0 + (rows + 1) / 2 * kBinSize;
  else
    a.x1 = b.x0 = view.x0 + (columns + 1) / 2 * kBinSize;
  for (const Rect& half : {a, b}) {
    frame.view = half;
    draw_view(frame, first, last);
  }
}

void FrameDriver::draw_band(FrameRun& frame, const Split& split, std::uint64_t triangles) {
  const Rect band = frame.view;
  const TileGrid tiles{band, kBinSize};
  const auto each_tile = [&](const auto& f) {
    frame.for_each_index(tiles.count(), [&](std::size_t t) {
      const Rect r = tiles.rect(t);
      f(r, frame.surface.part(r.x0 / kBlockSize, r.y0 / kBlockSize));
    });
  };
  if (split.surface) {
    const std::size_t blocks = block_count(band);
    keys_.reserve(blocks * 64);
    if (needs_.colors) colors_.reserve(blocks);
    frame.surface = {band.x0 / kBlockSize, band.y0 / kBlockSize, block_columns(band), keys_.data(),
                     needs_.colors ? colors_.data() : nullptr};
    each_tile([&](Rect r, const SurfaceView& s) { load_keys(frame.request, r, s); });
  }
  const std::uint64_t first_id = frame.request.pass.first_id;
  if (needs_.whole_view) {
    draw_view(frame, first_id, first_id + triangles);
    frame.view = band;
  } else {
    std::uint64_t drawn = 0;
    do {  // also without triangles: the background is drawn
      const std::uint64_t count = std::min(split.batch, triangles - drawn);
      method_->draw(frame, first_id + drawn, first_id + drawn + count);
      drawn += count;
    } while (drawn < triangles);
  }
  if (!split.surface) return;
  each_tile([&](Rect r, const SurfaceView& s) { frame.shade(s, r); });
  frame.watch.lap(frame.stats, "shade");
}

/// Projects all vertices, though few may be seen: projecting them where they are read costs more.
void FrameDriver::shade_blocks(FrameRun& frame, const KnownBlocks& known) {
  constexpr std::size_t kChunk = 32;
  frame.for_each_index((known.blocks.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    FrameRequest request = frame.request;
    void* const scratch = frame.shader_scratch();
    std::uint64_t covered = 0;
    alignas(64) std::uint64_t keys[64];
    const std::size_t end = std::min((chunk + 1) * kChunk, known.blocks.size());
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      const KnownBlock& block = known.blocks[i];
      for (int k = 0; k < 64; ++k)
        keys[k] = (block.mask >> k & 1) != 0 ? block.keys[k] - known.forward : 0;
      request.targets = known.targets(i);
      covered += static_cast<std::uint64_t>(
          resolve_block(request, frame.plan, frame.geometry, keys, block.x0, block.y0, scratch));
    }
    frame.pixels_covered.fetch_add(covered, std::memory_order_relaxed);
  });
  frame.watch.lap(frame.stats, "shade");
}

template <class F>
FrameStats FrameDriver::run(FrameRequest& request, const FramePlan& plan, bool by_clusters,
                            const F& work) {
  Stopwatch watch;
  FrameStats stats;
  stats.rasterizer = needs_.rasterizer;
  stats.visibility = needs_.visibility;
  stats.why = plan.why;
  stats.isa = choose_isa(request.isa);
  if (!needs_.quadrics && (request.has_quadrics() || has_round_points(request)))
    throw Error(Errc::unsupported,
                std::string("'")
                    .append(needs_.rasterizer)
                    .append("' draws triangles, square points and lines; round points, spheres, "
                            "cylinders, tubes and discs are the renderer's"));
  Totals totals = begin_frame(request);
  // Draws by clusters project later, only the clusters that are drawn.
  keep_clusters(request.draws, by_clusters);
  totals.vertices = place_projected(request.draws);
  const Split split = split_work(request, totals);
  FrameRun frame(
      {.request = request,
       .plan = plan,
       .geometry = {request.width, request.height, Viewport::of(request.width, request.height),
                    request.draws, nullptr, request.isa, ++frames_of_all},
       .kernel = kernels(request.isa),
       .threads = threads_,
       .stats = stats,
       .watch = watch},
      shaders_, ++frames_);
  if (split.project_first) {
    projected_.reserve(totals.vertices);
    project(frame);
    watch.lap(stats, "project");
  }
  frame.fragment_bytes = split.fragment_bytes;
  frame.expansion_bytes = split.expansion_bytes;
  frame.view_bytes = split.view_bytes;
  try {
    work(frame, split, totals.primitives);
  } catch (...) {
    method_->abandon();
    throw;
  }
  end_frame(totals, stats);
  stats.fragments = frame.fragments;
  stats.pixels_covered = frame.pixels_covered;
  for (const auto& [name, value] : frame.counters)
    stats.counters.emplace_back(std::string(name), value);
  return stats;
}

FrameStats FrameDriver::draw(FrameRequest& request, const FramePlan& plan) {
  const auto draw_bands = [&](FrameRun& frame, const Split& split, std::uint64_t triangles) {
    const Rect& all = plan.drawn;
    for (int y = all.y0; y < all.y1; y += split.band_rows) {
      frame.view = {all.x0, y, all.x1, std::min(y + split.band_rows, all.y1)};
      frame.first_band = y == all.y0;
      draw_band(frame, split, triangles);
    }
  };
  return run(request, plan, method_->takes_clusters(request), draw_bands);
}

FrameStats FrameDriver::shade(FrameRequest& request, const KnownBlocks& known) {
  request.pass.load = true;  // pixels without a surface stay as they are
  return run(request, plan(request), false,
             [&](FrameRun& frame, const Split&, std::uint64_t) { shade_blocks(frame, known); });
}

}  // namespace rastrum::raster
