#include <rastrum/terrain/shadow_sweep.hpp>

#include <algorithm>
#include <cmath>

namespace rastrum::terrain {
namespace {

/// Fractions and columns that are nearer than this are taken as both sides of the border: far above
/// what float64 rounds, and above the crossings that do not count (10⁻⁹ of 65,536 cells).
constexpr double kMargin = 1e-4;

/// Where y = f + s·x is in row r: x from `enter` to `leave`, without regard to columns.
struct Crossing {
  double enter, leave;
};
Crossing cross(double f, double s, int r) {
  const double a = (r - f) / s, b = (r + 1 - f) / s;
  return {std::min(a, b), std::max(a, b)};
}

SweepColumn plan_column(int column, double s, double tau) {
  SweepColumn c;
  const double x = column;
  const double phi = 0.5 - s * (x + 0.5);
  const double band = std::floor(phi);
  c.begin_row = static_cast<std::int32_t>(-band);
  c.part = std::min(static_cast<std::int32_t>((phi - band) * kSubBands), kSubBands - 1);
  c.begin = static_cast<float>((x + 0.5) * tau);
  c.row = static_cast<std::int32_t>(std::floor(s * x + std::min(s, 0.0) - kMargin));
  // Along an axis or a diagonal every ray runs in the same cells: from side to side of a row's
  // middle, or from corner to corner. Nothing is left between the bounds.
  if (s == 0 || std::abs(s) == 1) {
    const auto part = static_cast<std::size_t>(c.part);
    const std::int32_t row = s == 0 ? 0 : s > 0 ? column : -column - 1;
    c.row = row;
    c.count[part] = 1;
    c.entries[part][0] = {0, static_cast<float>(x * tau), static_cast<float>(x * tau)};
    return c;
  }
  for (int part = 0; part < kSubBands; ++part) {
    const double low = static_cast<double>(part) / kSubBands - kMargin;
    const double high = static_cast<double>(part + 1) / kSubBands + kMargin;
    auto& count = c.count[static_cast<std::size_t>(part)];
    for (int i = 0; i < 4; ++i) {
      const Crossing p = cross(low, s, c.row + i), q = cross(high, s, c.row + i);
      // Lines of the part enter the row between these, and leave it between those.
      const double first = std::max(std::min(p.enter, q.enter), x);
      const double last = std::max(std::max(p.enter, q.enter), x);
      const double first_out = std::min(std::min(p.leave, q.leave), x + 1);
      const double last_out = std::min(std::max(p.leave, q.leave), x + 1);
      const bool any = first <= x + 1 + kMargin && last_out >= x - kMargin;
      const bool all = last + kMargin < x + 1 && first_out > x + kMargin;
      if (!any) continue;
      c.entries[static_cast<std::size_t>(part)][static_cast<std::size_t>(count++)] = {
          i, static_cast<float>(std::max(first - kMargin, x) * tau),
          all ? static_cast<float>((last + (last > x ? kMargin : 0)) * tau)
              : std::numeric_limits<float>::infinity()};
    }
  }
  return c;
}

}  // namespace

Sweep plan_sweep(const ShadowCaster& map, const SunRay& ray, std::vector<RayStep> steps) {
  Sweep p;
  p.map = map;
  p.along_x = std::abs(ray.x) >= std::abs(ray.y);
  const double along = p.along_x ? ray.x : ray.y, across = p.along_x ? ray.y : ray.x;
  p.flipped = along < 0;
  p.columns = p.along_x ? map.heights.width : map.heights.height;
  p.rows = p.along_x ? map.heights.height : map.heights.width;
  const double s = across / std::abs(along), tau = ray.rise / std::abs(along);
  int reach = 0;
  for (std::size_t k = 0; k < steps.size(); ++k)
    for (const int ahead = std::abs(p.along_x ? steps[k].dx : steps[k].dy); reach <= ahead; ++reach)
      p.first_step.push_back(static_cast<std::uint32_t>(k));
  p.first_step.push_back(static_cast<std::uint32_t>(steps.size()));
  for (const RayStep& step : steps)
    p.along.push_back({std::abs(p.along_x ? step.dx : step.dy), p.along_x ? step.dy : step.dx,
                       static_cast<float>(step.climb)});
  p.steps = std::move(steps);
  const int all = p.columns + reach;
  p.column.reserve(static_cast<std::size_t>(all));
  for (int x = 0; x < all; ++x) p.column.push_back(plan_column(x, s, tau));
  p.cyclic = map.tiling == Tiling::repeat;
  if (p.cyclic) {
    p.bands = p.rows;
  } else {
    const int a = -p.column[0].begin_row;
    const int b = -p.column[static_cast<std::size_t>(p.columns - 1)].begin_row;
    p.first_band = std::min(a, b);
    p.bands = p.rows + std::abs(a - b);
  }
  const double largest = std::max(std::abs(static_cast<double>(map.highest)),
                                  std::abs(static_cast<double>(map.lowest)));
  p.slack = static_cast<float>((largest + (all + 1) * tau) * 0x1p-21);
  return p;
}

}  // namespace rastrum::terrain
