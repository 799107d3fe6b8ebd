// SPDX-License-Identifier: BSD-3-Clause
// The fast path, without paper 3's scans (its chapter 7 asks for that). Each column keeps a
// running minimum, the row from which it is drawn down. A sample above that row leaves a mark, its
// colour, in the first row it shows. Blocks of 64 columns walk their slices near to far in vectors
// of columns, until every column is full or the map's highest peak would stay hidden. Then each row
// is written once: a pixel's mark, or what is above it.
#include <algorithm>

#include <rastrum/stop.hpp>
#include <rastrum/terrain/blocks.hpp>
#include <rastrum/terrain/fan.hpp>
#include <rastrum/terrain/methods.hpp>

namespace rastrum::terrain {
namespace {

/// Slices that are skipped together. On a busy machine groups of 4, 8 and 16 differed within the
/// noise; blocks of 64 columns were no slower than of 32.
constexpr std::size_t kGroup = 8;

/// The walk over a terrain of functions: one call for a slice's heights, one for the colours of its
/// visible samples.
struct SurfaceWalk {
  const Samples& samples;
  alignas(64) double x[kBlockColumns], y[kBlockColumns];

  void place(const Slice& slice, const ColumnBlock& block, std::size_t i, std::size_t column) {
    const SetupView& s = samples.setup;
    x[i] = s.camera_x + static_cast<double>(s.fx + slice.z * block.ux[column]);
    y[i] = s.camera_y + static_cast<double>(s.fy + slice.z * block.uy[column]);
  }
  void heights(const Slice& slice, std::size_t n, ColumnBlock& block) {
    for (std::size_t i = 0; i < n; ++i) place(slice, block, i, i);
    samples.terrain.surface().heights(x, y, n, block.heights);
  }
  void colors(const Slice& slice, const ColumnBlock& block, std::size_t n, Rgba8* out) {
    for (std::size_t i = 0; i < n; ++i)
      place(slice, block, i, static_cast<std::size_t>(block.mark[i]) % kBlockColumns);
    samples.terrain.surface().colors(x, y, n, out);
    for (std::size_t i = 0; i < n; ++i) out[i] = faded(out[i], samples.setup.fog, slice.clear);
  }
};

Counts walk(const Samples& samples, const Kernels& kernels, std::size_t first, std::size_t n,
            BlockMarks& marks) {
  const SetupView& setup = samples.setup;
  const bool is_map = samples.terrain.is_map();
  const bool direct = is_map && samples.map.colors_match();
  ColumnBlock block;
  std::copy_n(setup.ux.data() + first, n, block.ux);
  std::copy_n(setup.uy.data() + first, n, block.uy);
  block.restart(n, setup.height);
  SurfaceWalk surface{samples, {}, {}};
  Counts counts;
  const Fan fan(setup, first, n);
  const CeilingView ceiling = is_map ? samples.ceiling->view() : CeilingView{};
  for (std::size_t k = 0; k < setup.slices.size(); ++k) {
    const Slice& slice = setup.slices[k];
    if (block.deepest <= slice.lowest_row) break;
    // The marks made so far are still written; the loop over the blocks reports the stop.
    if (k % kGroup == 0 && stop_requested()) break;
    if (is_map && k % kGroup == 0) {
      const std::size_t last = std::min(k + kGroup, setup.slices.size()) - 1;
      if (block.deepest <= fan.lowest_row(samples, ceiling, slice, setup.slices[last])) {
        k = last;
        continue;
      }
    }
    counts.samples += n;
    if (is_map)
      kernels.heights(samples, slice, n, block);
    else
      surface.heights(slice, n, block);
    const std::size_t visible =
        kernels.occlude(setup.altitude, slice.rows, setup.horizon, n, block);
    if (visible == 0) continue;
    counts.visible += visible;
    marks.put_depth(block, visible, slice.z);
    if (direct && slice.clear == 256) {
      const int level = samples.map.height_level(slice.level);
      marks.put_cells(block, visible, samples.map.colors(level).data);
      continue;
    }
    Rgba8 colors[kBlockColumns];
    if (is_map)
      kernels.colors(samples, slice, visible, block, colors);
    else
      surface.colors(slice, block, visible, colors);
    marks.put_colors(block, visible, colors);
  }
  return counts;
}

}  // namespace

Counts draw_fast(parallel::Threads& exec, Isa isa, BlockPool& pool, const Samples& samples,
                 const TerrainTargets& targets) {
  const Blocks blocks(static_cast<int>(samples.setup.ux.size()), targets);
  return draw_blocks(exec, isa, pool, samples.setup.sky, targets, blocks, samples.setup.height,
                     [&](const Kernels& kernels, std::size_t b, BlockMarks& marks) {
                       return walk(samples, kernels, blocks.first(b), blocks.size(b), marks);
                     });
}

}  // namespace rastrum::terrain
