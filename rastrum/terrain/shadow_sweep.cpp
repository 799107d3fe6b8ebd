// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain/shadow_sweep.hpp>

#include <algorithm>
#include <cmath>

namespace rastrum::terrain {
namespace {

/// Nearer to a border than this counts on both sides of it: far above the rounding of float64 and
/// the corners that count as one crossing (10⁻⁹ of 65,536 cells).
constexpr double kMargin = 1e-4;

/// Error in units of two heights (each half a unit and less than a tenth) and of a ray's begin,
/// rounded down: below and above the begin's sum.
constexpr int kBelow = 3, kAbove = 1;

std::int64_t floor_of(double v) {
  return static_cast<std::int64_t>(std::floor(v));
}

struct Rays {
  double s, tau;   ///< rows and units per column
  double columns;  ///< per row, with the sign of s
  bool alike;      ///< along an axis or a diagonal
};

SweepColumn plan_column(int column, const Rays& rays) {
  const double x = column;
  const double phi = 0.5 - rays.s * (x + 0.5);
  const double band = std::floor(phi);
  SweepColumn c;
  c.begin_row = static_cast<std::int32_t>(-band);
  c.part = std::min(static_cast<std::int32_t>((phi - band) * kSubBands), kSubBands - 1);
  c.begin = floor_of((x + 0.5) * rays.tau);
  return c;
}

/// The cells of column x that rays of a part enter, row by row.
template <class Add>
void each_entry(int column, int part, const Rays& rays, const Add& add) {
  const double x = column, s = rays.s;
  const double low = static_cast<double>(part) / kSubBands - kMargin;
  const double high = static_cast<double>(part + 1) / kSubBands + kMargin;
  const auto row = static_cast<std::int32_t>(std::floor(s * x + std::min(s, 0.0) - kMargin));
  // The lines that enter and leave a row first, and last. y = f + s·x is in row r from (r + in −
  // f)/s to (r + out − f)/s.
  const double early = s > 0 ? high : low, late = s > 0 ? low : high;
  const int in = s > 0 ? 0 : 1, out = 1 - in;
  for (int i = 0; i < 4; ++i) {
    const double r = row + i;
    const double first = std::max((r + in - early) * rays.columns, x);
    const double last = std::max((r + in - late) * rays.columns, x);
    const double first_out = std::min((r + out - early) * rays.columns, x + 1);
    const double last_out = std::min((r + out - late) * rays.columns, x + 1);
    if (!(first <= x + 1 + kMargin && last_out >= x - kMargin)) continue;
    const bool all = last + kMargin < x + 1 && first_out > x + kMargin;
    add(row + i, floor_of(std::max(first - kMargin, x) * rays.tau), all,
        floor_of((last + (last > x ? kMargin : 0)) * rays.tau) + 1);
  }
}

void plan_part(Sweep& p, SweepBlock& block, int x0, int part, const Rays& rays) {
  using Kind = SweepStep::Kind;
  const auto add = [&](Kind kind, int c, std::int32_t row, std::int64_t upper, std::int64_t lower) {
    block.low = std::min(block.low, row);
    block.high = std::max(block.high, row);
    p.steps.push_back({kind, static_cast<std::uint8_t>(c), row,
                       static_cast<std::int16_t>(upper - block.frame),
                       static_cast<std::int16_t>(lower - block.frame)});
  };
  for (int c = kSweepBlock - 1; c >= 0; --c) {
    const int x = x0 + c;
    const SweepColumn& column = p.column[static_cast<std::size_t>(x)];
    if (x < p.columns && column.part == part)
      add(Kind::cells_begin, c, column.begin_row, column.begin + kBelow, column.begin - kAbove);
    if (!rays.alike) {
      each_entry(x, part, rays,
                 [&](std::int32_t row, std::int64_t upper, bool all, std::int64_t lower) {
                   add(all ? Kind::all_enter : Kind::may_enter, c, row, upper, all ? lower : upper);
                 });
    } else if (column.part == part) {
      // Every ray runs in the same cells: from side to side, or from corner to corner.
      const std::int32_t row = rays.s == 0 ? 0 : rays.s > 0 ? x : -x - 1;
      const double at = x * rays.tau;
      add(Kind::all_enter, c, row, floor_of(at), static_cast<std::int64_t>(std::ceil(at)));
    }
  }
}

/// The finest units that fit 16 bits: a height less the climb on a block and on the half column
/// before a ray's begin, and a ray's climb on two blocks. `tau`: cells per column.
SweepUnits units_of(const ShadowCaster& map, double tau) {
  const double relief = map.relief();
  const double units = std::min(65500 / (1 + (kSweepBlock + 0.5) * tau / relief),
                                32700 / ((2 * kSweepBlock + 1) * tau / relief));
  SweepUnits u;
  u.lowest = map.lowest;
  u.scale = static_cast<float>(units / relief);
  const double most = (kSweepBlock + 0.5) * tau * static_cast<double>(u.scale) + 8;
  u.zero = static_cast<std::int16_t>(SweepUnits::least + static_cast<int>(most));
  return u;
}

}  // namespace

Sweep plan_sweep(const ShadowCaster& map, const HeightTiles& tiles, const SunRay& ray,
                 std::vector<RayStep> steps) {
  Sweep p;
  p.map = map;
  p.along_x = std::abs(ray.x) >= std::abs(ray.y);
  const double along = p.along_x ? ray.x : ray.y, across = p.along_x ? ray.y : ray.x;
  p.flipped = along < 0;
  p.columns = p.along_x ? map.heights.width : map.heights.height;
  p.rows = p.along_x ? map.heights.height : map.heights.width;
  p.units = units_of(map, ray.rise / std::abs(along));
  const auto scale = static_cast<double>(p.units.scale);
  const double s = across / std::abs(along);
  const Rays rays{s, ray.rise / std::abs(along) * scale, 1 / s, s == 0 || std::abs(s) == 1};
  int reach = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const int ahead = std::abs(p.along_x ? steps[k].dx : steps[k].dy);
    for (; reach <= ahead; ++reach) p.first_step.push_back(static_cast<std::uint32_t>(k));
    if (ahead < 2 * kSweepBlock)
      p.near.push_back({ahead, p.along_x ? steps[k].dy : steps[k].dx,
                        static_cast<std::int32_t>(steps[k].climb * scale)});
  }
  p.first_step.push_back(static_cast<std::uint32_t>(steps.size()));
  p.ray = std::move(steps);

  p.cyclic = map.tiling == Tiling::repeat;
  if (p.cyclic) {
    p.bands = p.rows;
  } else {
    const int a = -plan_column(0, rays).begin_row;
    const int b = -plan_column(p.columns - 1, rays).begin_row;
    p.first_band = std::min(a, b);
    p.bands = p.rows + std::abs(a - b);
  }
  p.reach = reach_of(map, tiles,
                     {p.along_x, p.flipped, p.columns, p.rows, s, ray.rise / std::abs(along),
                      p.first_band, p.bands},
                     kSweepBlock, (p.columns + reach + kSweepBlock - 1) / kSweepBlock);
  const int blocks = *std::ranges::max_element(p.reach);
  p.column.reserve(static_cast<std::size_t>(blocks) * kSweepBlock);
  for (int x = 0; x < blocks * kSweepBlock; ++x) p.column.push_back(plan_column(x, rays));
  p.blocks.resize(static_cast<std::size_t>(blocks));
  p.steps.reserve(p.column.size() * 2 * kSubBands + p.column.size());
  for (int b = 0; b < blocks; ++b) {
    SweepBlock& block = p.blocks[static_cast<std::size_t>(b)];
    const int x0 = b * kSweepBlock;
    block.frame = floor_of(x0 * rays.tau);
    block.low = block.high = p.column[static_cast<std::size_t>(x0)].begin_row;
    for (int part = 0; part < kSubBands; ++part) {
      block.first[static_cast<std::size_t>(part)] = static_cast<std::uint32_t>(p.steps.size());
      plan_part(p, block, x0, part, rays);
    }
    block.first[kSubBands] = static_cast<std::uint32_t>(p.steps.size());
  }
  return p;
}

}  // namespace rastrum::terrain
