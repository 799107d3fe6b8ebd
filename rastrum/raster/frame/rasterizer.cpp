#include <rastrum/raster/frame/rasterizer.hpp>

#include <algorithm>
#include <string>

#include <rastrum/core/error.hpp>
#include <rastrum/raster/resolve/resolve.hpp>

namespace rastrum::raster {
namespace {

constexpr std::size_t kProjectGrain = 4096;

/// Below this many bytes for triangles or fragments at once the pieces of the work would be smaller
/// than what a task costs.
constexpr std::uint64_t kLeastShare = std::uint64_t{1} << 19;

/// A thread's own, beside what is dealt out: a tile's keys, colours and depths.
constexpr std::uint64_t kThreadBytes = std::uint64_t{1} << 17;

/// Pieces of a batch are counted in 32 bits, and the clipper makes fewer than 16 of a triangle.
constexpr std::uint64_t kLargestBatch = std::uint64_t{1} << 28;

}  // namespace

/// How the work is cut: bands of rows, and in each band batches of triangles. Without a limit there
/// is one of both.
struct Rasterizer::Plan {
  bool project_first = true;  ///< else vertices are projected where triangles need them
  bool surface = true;        ///< keys for a band, else tiles keep their own
  int band_rows = 0;
  std::uint64_t batch = 0;  ///< triangles
  std::uint64_t fragment_bytes = 0;
  std::uint64_t expansion_bytes = 0;
  std::uint64_t view_bytes = 0;
};

Rasterizer::Rasterizer(const CoverageRow& coverage, const Visibility& visibility,
                       const Tuning& tuning, std::uint64_t memory_limit, MemoryAccount& memory,
                       parallel::Threads& threads)
    : row_(coverage),
      visibility_(visibility),
      memory_limit_(memory_limit),
      threads_(threads),
      coverage_(coverage.make(tuning, memory)),
      scratch_(memory, threads),
      projected_(memory),
      keys_(memory),
      colors_(memory) {}

Rasterizer::~Rasterizer() = default;

Rasterizer::Plan Rasterizer::plan(const FrameRequest& request, std::uint64_t triangles,
                                  std::size_t vertices) const {
  Plan p;
  p.batch = std::clamp<std::uint64_t>(triangles, 1, kLargestBatch);
  if (visibility_.keeps_layers) p.batch = std::max<std::uint64_t>(triangles, 1);
  p.surface = !row_.owns_tiles || p.batch < triangles;
  p.band_rows = request.height;
  if (memory_limit_ == 0) return p;

  const std::uint64_t row_of_pixels =
      static_cast<std::uint64_t>(block_columns({0, 0, request.width, 1})) * kBlockSize *
      static_cast<std::uint64_t>(visibility_.surface_bytes);
  // The least band is a row of bins, so that a band never cuts one.
  const std::uint64_t least_band = row_of_pixels * kBinSize;
  const std::uint64_t others =
      request.texture_bytes + kThreadBytes * static_cast<std::uint64_t>(threads_.concurrency());
  const std::uint64_t least = others + std::max(least_band, kLeastShare) + 3 * kLeastShare;
  if (memory_limit_ < least)
    throw Error(Errc::out_of_memory, std::string("a memory limit of ")
                                         .append(std::to_string(memory_limit_))
                                         .append(" bytes is less than the ")
                                         .append(std::to_string(least))
                                         .append(" that this frame needs at least"));

  // A quarter each for projected vertices, triangles, the surface and fragments; what one does not
  // need is not given to another, so that the plan of a frame does not jump.
  const std::uint64_t band_share = std::max((memory_limit_ - others) / 4, least_band);
  const std::uint64_t share = (memory_limit_ - others - band_share) / 3;
  p.project_first = vertices <= share / sizeof(ProjectedVertex);
  if (visibility_.keeps_layers) {
    // Tiles keep their own keys; the view is cut until its pieces fit.
    p.fragment_bytes = share;
    p.view_bytes = share;
    if (!row_.cuts_views)
      throw Error(Errc::out_of_memory,
                  std::string("'").append(row_.name).append(
                      "' keeps all triangles of a frame with layers at once, whatever the "
                      "memory limit; 'grouped' heeds it"));
    return p;
  }
  // What triangles are expanded to is known in the middle of a draw only, and what does not fit
  // then is drawn in turns, onto a surface.
  p.expansion_bytes = row_.expands ? share / 2 : 0;
  p.batch = std::min(p.batch,
                     (share - p.expansion_bytes) / static_cast<std::uint64_t>(row_.triangle_bytes));
  p.fragment_bytes = share;
  p.surface = p.surface || row_.expands || p.batch < triangles;
  if (p.surface)
    p.band_rows = static_cast<int>(
        std::min(band_share / least_band * kBinSize, static_cast<std::uint64_t>(request.height)));
  return p;
}

void Rasterizer::project(FrameRequest& request, FrameGeometry& frame) {
  for (const Draw& draw : request.draws)
    parallel::for_each_index(
        threads_, (draw.vertex_count + kProjectGrain - 1) / kProjectGrain, [&](std::size_t i) {
          const std::size_t begin = i * kProjectGrain;
          const std::size_t end = std::min(begin + kProjectGrain, draw.vertex_count);
          draw.source.project(begin, end, frame.viewport, request.isa,
                              projected_.data() + draw.first_vertex + begin);
        });
  frame.projected = projected_.data();
}

/// Draws the view, in halves where it does not fit.
void Rasterizer::draw_view(Frame& frame, std::uint64_t first, std::uint64_t last) {
  const Rect view = frame.view;
  coverage_->draw(frame, first, last);
  frame.first_band = frame.first_band && !frame.fits;
  if (frame.fits) return;
  const int columns = (view.x1 - view.x0 + kBinSize - 1) / kBinSize;
  const int rows = (view.y1 - view.y0 + kBinSize - 1) / kBinSize;
  if (columns == 1 && rows == 1)
    throw Error(Errc::out_of_memory,
                std::string("a memory limit of ")
                    .append(std::to_string(memory_limit_))
                    .append(" bytes does not hold what touches the 64 x 64 pixels at (")
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

void Rasterizer::draw_band(Frame& frame, const Plan& plan, std::uint64_t triangles) {
  const Rect band = frame.view;
  const TileGrid tiles{band, kBinSize, frame.request.tuning.order};
  if (plan.surface) {
    const std::size_t blocks = block_count(band);
    keys_.reserve(blocks * 64);
    if (visibility_.shades) colors_.reserve(blocks);
    frame.surface = {band.x0 / kBlockSize, band.y0 / kBlockSize, block_columns(band), keys_.data(),
                     visibility_.shades ? colors_.data() : nullptr};
    parallel::for_each_index(threads_, tiles.count(), [&](std::size_t t) {
      const Rect r = tiles.rect(tiles.tile_at(t));
      load_keys(frame.request.targets, r, frame.surface.part(r.x0 / kBlockSize, r.y0 / kBlockSize));
    });
  }
  const std::uint64_t first_id = frame.request.targets.first_id;
  if (visibility_.keeps_layers) return draw_view(frame, first_id, first_id + triangles);
  std::uint64_t drawn = 0;
  do {  // once without triangles too: the background is drawn
    const std::uint64_t count = std::min(plan.batch, triangles - drawn);
    coverage_->draw(frame, first_id + drawn, first_id + drawn + count);
    drawn += count;
  } while (drawn < triangles);
  if (!plan.surface) return;
  parallel::for_each_index(threads_, tiles.count(), [&](std::size_t t) {
    const Rect r = tiles.rect(tiles.tile_at(t));
    frame.shade(frame.surface.part(r.x0 / kBlockSize, r.y0 / kBlockSize), r,
                scratch_.workers.local());
  });
  frame.watch.lap(frame.stats, "shade");
}

FrameStats Rasterizer::render(FrameRequest& request) {
  Stopwatch watch;
  FrameStats stats;
  stats.rasterizer = row_.name;
  stats.visibility = visibility_.name;
  stats.isa = request.isa;
  const Totals totals = number_draws(request.draws, request.targets.first_id, request.draw_noun);
  const Plan cut = plan(request, totals.primitives, totals.vertices);

  FrameGeometry geometry{request.width, request.height, Viewport::of(request.width, request.height),
                         request.draws, nullptr,        request.isa};
  if (cut.project_first) {
    projected_.reserve(totals.vertices);
    project(request, geometry);
    watch.lap(stats, "project");
  }
  if (!request.targets.overdraw.empty() && !request.targets.load)
    for (int y = 0; y < request.height; ++y)
      std::fill_n(request.targets.overdraw.row(y), request.width, 0U);
  if (!request.targets.errors.empty())
    for (int y = 0; y < request.height; ++y)
      std::fill_n(request.targets.errors.row(y), request.width, std::uint8_t{0});

  Frame frame(request, geometry, visibility_, scratch_, stats, watch);
  frame.fragment_bytes = cut.fragment_bytes;
  frame.expansion_bytes = cut.expansion_bytes;
  frame.view_bytes = cut.view_bytes;
  try {
    for (int y = 0; y < request.height; y += cut.band_rows) {
      frame.view = {0, y, request.width, std::min(y + cut.band_rows, request.height)};
      frame.first_band = y == 0;
      draw_band(frame, cut, totals.primitives);
    }
  } catch (...) {
    // Regions have counted for a frame that will not be; nothing of it is to be in the next one's.
    scratch_.shared.reset();
    scratch_.workers.for_each([](Worker& worker) { worker.region.reset(); });
    throw;
  }
  stats.triangles.input = totals.primitives;
  stats.triangles.drawn = totals.primitives - stats.triangles.dropped - stats.triangles.culled;
  stats.fragments = frame.fragments;
  stats.pixels_covered = frame.pixels_covered;
  for (const auto& [name, value] : frame.counters)
    stats.counters.emplace_back(std::string(name), value);
  return stats;
}

}  // namespace rastrum::raster
