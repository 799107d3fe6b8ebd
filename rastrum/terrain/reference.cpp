// SPDX-License-Identifier: BSD-3-Clause
// The serial device: each column by itself, near to far, spans drawn as they are found. Source:
// Macke's program (paper 3, section 2.3).
#include <limits>
#include <vector>

#include <rastrum/stop.hpp>
#include <rastrum/terrain/classic.hpp>
#include <rastrum/terrain/methods.hpp>

namespace rastrum::terrain {
namespace {

void draw_span(const TerrainTargets& targets, int x, int from, int to, Rgba8 color, float depth) {
  for (int y = from; y < to; ++y) {
    if (!targets.color8.empty()) targets.color8(x, y) = color;
    if (!targets.depth.empty()) targets.depth(x, y) = depth;
  }
}

}  // namespace

Counts draw_reference(const Samples& samples, const TerrainTargets& targets) {
  const SetupView& setup = samples.setup;
  Counts counts;
  for (std::size_t column = 0; column < setup.ux.size(); ++column) {
    throw_if_stopped();
    const int x = static_cast<int>(column);
    int hidden = setup.height;  // rows from here on are drawn
    for (const Slice& slice : setup.slices) {
      if (hidden == 0) break;
      ++counts.samples;
      const int top = setup.first_row(samples.height(column, slice), slice);
      if (top >= hidden) continue;
      draw_span(targets, x, top, hidden, samples.color(column, slice), slice.z);
      hidden = top;
      ++counts.visible;
    }
    draw_span(targets, x, 0, hidden, setup.sky, std::numeric_limits<float>::infinity());
  }
  return counts;
}

Counts draw_classic_reference(const Terrain& terrain, const TerrainOptions& options,
                              const TerrainCamera& camera, const TerrainTargets& targets) {
  for (int x = 0; x < options.width; ++x)
    draw_span(targets, x, 0, options.height, options.sky, std::numeric_limits<float>::infinity());
  Counts counts;
  std::vector<int> hidden(static_cast<std::size_t>(options.width), options.height);
  for (const ClassicLine& line : classic_lines(options, camera)) {
    throw_if_stopped();
    double x = line.x, y = line.y;
    for (int i = 0; i < options.width; ++i, x += line.dx, y += line.dy) {
      int& below = hidden[static_cast<std::size_t>(i)];
      if (below == 0) continue;
      ++counts.samples;
      const double ground = terrain.height_at(x, y, options.tiling);
      const double row = (camera.altitude - ground) * line.rows + camera.horizon_px;
      if (!(row < below)) continue;
      const int top = row > 0 ? static_cast<int>(row) : 0;
      ++counts.visible;
      draw_span(targets, i, top, below, terrain.color_at(x, y, options.tiling),
                static_cast<float>(line.z));
      below = top;
    }
  }
  return counts;
}

}  // namespace rastrum::terrain
