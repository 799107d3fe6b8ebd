#include <rastrum/raster/frame/reference.hpp>

#include <algorithm>
#include <string>

#include <rastrum/core/error.hpp>
#include <rastrum/parallel/stop.hpp>
#include <rastrum/raster/assemble/assemble.hpp>
#include <rastrum/raster/cover/rules.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/frame/stopwatch.hpp>
#include <rastrum/raster/resolve/resolve.hpp>

namespace rastrum::raster {
namespace {

/// Keeps the maximum key of each covered sample. Blocks of one row, so that a fragment test sees
/// the same interface as everywhere.
void draw_piece(const FrameRequest& request, const FrameGeometry& frame, const Piece& piece,
                ImageView<std::uint64_t> keys, FrameStats& stats) {
  const Rect box = piece_bounds(piece, Rect{0, 0, request.width, request.height});
  for (int y = box.y0; y < box.y1; ++y) {
    const Span span = row_span(piece, y, box.x0, box.x1);
    for (int x = span.begin; x < span.end; ++x) {
      ++stats.fragments;
      if (!request.targets.overdraw.empty()) ++request.targets.overdraw(x, y);
      if ((piece.flags & kMayDrop) != 0) {
        const std::uint64_t bit = std::uint64_t{1}
                                  << (y % kBlockSize * kBlockSize + x % kBlockSize);
        const Block block{0, static_cast<std::uint16_t>(x / kBlockSize),
                          static_cast<std::uint16_t>(y / kBlockSize), bit};
        if (request.kept(frame, piece, block, nullptr) == 0) continue;
      }
      std::uint64_t& key = keys(x, y);
      key = std::max(key, make_key(depth_at(piece, x, y), piece.low));
    }
  }
}

}  // namespace

FrameStats render_reference(FrameRequest& request, MemoryAccount& memory) {
  Stopwatch watch;
  FrameStats stats;
  stats.rasterizer = "reference";
  stats.visibility = "atomic";
  const Targets& targets = request.targets;
  const Totals totals = number_draws(request.draws, targets.first_id, request.draw_noun);
  check_indices(request.draws, request.draw_noun);

  FrameGeometry frame{request.width, request.height, Viewport::of(request.width, request.height),
                      request.draws, nullptr};
  Buffer<ProjectedVertex> projected(memory);
  projected.reserve(totals.vertices);
  for (const Draw& draw : request.draws)
    draw.source.project(0, draw.vertex_count, frame.viewport, Isa::scalar,
                        projected.data() + draw.first_vertex);
  frame.projected = projected.data();
  watch.lap(stats, "project");

  const std::size_t pixels =
      static_cast<std::size_t>(request.width) * static_cast<std::size_t>(request.height);
  Buffer<std::uint64_t> buffer(memory);
  buffer.reserve(pixels);
  const ImageView<std::uint64_t> keys{buffer.data(), request.width, request.height, request.width};
  for (int y = 0; y < request.height; ++y) {
    if (targets.load)
      std::copy_n(targets.keys.row(y), request.width, keys.row(y));
    else
      std::fill_n(keys.row(y), request.width, std::uint64_t{0});
    if (!targets.overdraw.empty() && !targets.load)
      std::fill_n(targets.overdraw.row(y), request.width, 0U);
    if (!targets.errors.empty()) std::fill_n(targets.errors.row(y), request.width, std::uint8_t{0});
  }
  stats.triangles.input = totals.primitives;
  for (const Draw& draw : request.draws)
    for (std::uint64_t t = 0; t < draw.primitive_count; ++t) {
      parallel::throw_if_stopped();
      const Fate fate = assemble_primitive(frame, draw, t, [&](const Piece& piece) {
        draw_piece(request, frame, piece, keys, stats);
      });
      stats.triangles.dropped += fate == Fate::dropped;
      stats.triangles.culled += fate == Fate::culled;
      stats.triangles.clipped += fate == Fate::clipped;
    }
  stats.triangles.drawn = stats.triangles.input - stats.triangles.dropped - stats.triangles.culled;
  watch.lap(stats, "rasterize");

  ShaderScratch scratch;
  scratch.begin(request.shading.scratch_bytes());
  const Backdrop backdrop = backdrop_of(request);
  for (int y0 = 0; y0 < request.height; y0 += kBlockSize) {
    parallel::throw_if_stopped();
    for (int x0 = 0; x0 < request.width; x0 += kBlockSize) {
      alignas(64) std::uint64_t block[64] = {};
      for (int y = y0; y < std::min(y0 + kBlockSize, request.height); ++y)
        for (int x = x0; x < std::min(x0 + kBlockSize, request.width); ++x)
          block[(y - y0) * kBlockSize + (x - x0)] = keys(x, y);
      stats.pixels_covered += static_cast<std::uint64_t>(
          resolve_block(request, frame, backdrop, block, x0, y0, scratch.data()));
    }
  }
  watch.lap(stats, "shade");
  return stats;
}

}  // namespace rastrum::raster
