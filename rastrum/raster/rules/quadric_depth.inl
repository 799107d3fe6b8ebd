// SPDX-License-Identifier: BSD-3-Clause
// Where the ray of a sample meets a quadric. One body with a fixed order of float64 operations
// serves one sample (quadric.hpp) and lanes (kernels/wide_lanes-inl.hpp), so the bits are the same.

/// Constant along a row of samples.
struct QuadricRow {
  struct Part {
    double b, d, dx;
    double limit[3];
  } part[3];

  RASTRUM_LANES QuadricRow(const Quadric& q, double dy) {
    std::uint32_t k = 0;
    do {
      const QuadricPart& p = q.part[k];
      part[k].b = p.b + p.by * dy;
      part[k].d = p.d + dy * (p.dy + p.dyy * dy);
      part[k].dx = p.dx + p.dxy * dy;
      if (q.is_plain) return;
      for (std::uint32_t i = 0; i < p.limit_count; ++i)
        part[k].limit[i] = p.limits[i].at + p.limits[i].y * dy;
    } while (++k < q.part_count);
  }
};

/// Where a ray enters a part and where it leaves it.
struct Roots {
  W enters, leaves;
  WideMask real;
};
RASTRUM_LANES W discriminant_of(const QuadricPart& p, const QuadricRow::Part& row, W dx) {
  return wide(row.d) + dx * (wide(row.dx) + wide(p.dxx) * dx);
}
RASTRUM_LANES Roots roots_of(const QuadricPart& p, const QuadricRow::Part& row, W dx) {
  const W d = discriminant_of(p, row, dx);
  const W b = wide(row.b) + wide(p.bx) * dx;
  const WideMask real = at_most(wide(0), d);
  const W root = square_root(choose(real, d, wide(0)));
  const W a = wide(p.inverse_a);
  return {(root - b) * a, (wide(0) - root - b) * a, real};
}

/// From the farthest to the nearest depth.
struct DepthInterval {
  W least, most;
};
RASTRUM_LANES DepthInterval between_limits(const QuadricPart& p, const QuadricRow::Part& row,
                                           W dx) {
  constexpr double kAll = std::numeric_limits<double>::max();
  DepthInterval i{wide(-kAll), wide(kAll)};
  for (std::uint32_t k = 0; k < p.limit_count; ++k) {
    const W at = wide(row.limit[k]) + wide(p.limits[k].x) * dx;
    if (p.limits[k].is_least)
      i.least = greater(i.least, at);
    else
      i.most = lesser(i.most, at);
  }
  return i;
}

/// The part's interval on a ray: one, since the part is convex.
struct Inside {
  DepthInterval e;
  WideMask any;
};
RASTRUM_LANES Inside inside_part(const QuadricPart& p, const QuadricRow::Part& row, W dx) {
  const Roots r = roots_of(p, row, dx);
  const DepthInterval limits = between_limits(p, row, dx);
  if (p.inverse_a > 0) {
    const DepthInterval e{greater(limits.least, r.leaves), lesser(limits.most, r.enters)};
    return {e, both(r.real, at_most(e.least, e.most))};
  }
  // The eye is inside the quadric or a cone's other half. All is inside except between the roots,
  // and the limits leave one of the two sides.
  const W near_least = greater(limits.least, r.leaves), far_most = lesser(limits.most, r.enters);
  const WideMask is_near = at_most(near_least, limits.most);
  const WideMask is_far = at_most(limits.least, far_most);
  const DepthInterval e{choose(r.real, choose(is_near, near_least, limits.least), limits.least),
                        choose(r.real, choose(is_near, limits.most, far_most), limits.most)};
  return {e, both(either(is_near, is_far), at_most(e.least, e.most))};
}

struct Surface {
  W e;
  WideMask covered;
};
RASTRUM_LANES Surface surface_at(const Quadric& q, const QuadricRow& row, bool away, W dx) {
  if (q.is_plain) {
    const Roots r = roots_of(q.part[0], row.part[0], dx);
    return {away ? r.leaves : r.enters, r.real};
  }
  if (q.is_open) {
    const Roots r = roots_of(q.part[0], row.part[0], dx);
    const DepthInterval limits = between_limits(q.part[0], row.part[0], dx);
    const W e = away ? r.leaves : r.enters;
    return {e, both(both(r.real, at_most(e, wide(q.nearest))),
                    both(at_most(limits.least, e), at_most(e, limits.most)))};
  }
  Inside all = inside_part(q.part[0], row.part[0], dx);
  for (std::uint32_t k = 1; k < q.part_count; ++k) {
    const Inside i = inside_part(q.part[k], row.part[k], dx);
    const WideMask two = both(i.any, all.any);
    all.e.least =
        choose(two, lesser(all.e.least, i.e.least), choose(i.any, i.e.least, all.e.least));
    all.e.most = choose(two, greater(all.e.most, i.e.most), choose(i.any, i.e.most, all.e.most));
    all.any = either(all.any, i.any);
  }
  const W e = away ? all.e.least : all.e.most;
  return {e, both(all.any, at_most(e, wide(q.nearest)))};
}
