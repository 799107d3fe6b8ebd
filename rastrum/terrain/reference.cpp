// The serial device: each column by itself, near to far, spans drawn as they are found. Written for
// plainness; source: Macke's program (paper 3, section 2.3) with the samples of setup.hpp.
#include <cmath>
#include <limits>

#include <rastrum/stop.hpp>
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
    parallel::throw_if_stopped();
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

}  // namespace rastrum::terrain
