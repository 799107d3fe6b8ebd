#include <rastrum/raster/setup/make_quadric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rastrum::raster {
namespace {

/// A row of the matrix to clip space.
struct Row {
  Vec3d v;
  double w = 0;

  Row(const Mat4d& m, int i) : v{m.m[i][0], m.m[i][1], m.m[i][2]}, w(m.m[i][3]) {}
  [[nodiscard]] double at(Vec3d p) const { return dot(v, p) + w; }
};

struct Range {
  double least, most;

  [[nodiscard]] Range with(Range o) const {
    return {std::min(least, o.least), std::max(most, o.most)};
  }
};

/// A ball in front of the eye, or across it.
struct Ball {
  Vec3d centre;
  double radius;

  /// Whether all of it is where w > 0.
  [[nodiscard]] bool is_ahead(const Row& w) const {
    return w.at(centre) > radius * length(w.v) * (1 + 1e-9);
  }
  /// The range of row / w over it: where a plane row − X w = 0 touches it, a quadratic in X whose
  /// discriminant is written so that nothing cancels. Requires is_ahead.
  [[nodiscard]] Range range(const Row& row, const Row& w) const {
    const double n = row.at(centre), d = w.at(centre);
    const double r2 = radius * radius;
    const Vec3d c = cross(row.v, w.v);
    const Vec3d m = row.v * d - w.v * n;
    const double root = radius * std::sqrt(std::max(dot(m, m) - r2 * dot(c, c), 0.0));
    const double middle = n * d - r2 * dot(row.v, w.v);
    const double scale = 1 / (d * d - r2 * dot(w.v, w.v));
    return {(middle - root) * scale, (middle + root) * scale};
  }
};

/// Linear over the rays of a picture: o + x · dx + y · dy + depth · e.
struct Linear {
  double o, x, y, depth;
};
Linear operator+(const Linear& a, const Linear& b) {
  return {a.o + b.o, a.x + b.x, a.y + b.y, a.depth + b.depth};
}
Linear operator*(const Linear& a, double s) {
  return {a.o * s, a.x * s, a.y * s, a.depth * s};
}
Linear negated(const Linear& a) {
  return {-a.o, -a.x, -a.y, -a.depth};
}
Linear w_of(const RayFrame& f) {
  return {f.o.w, f.x.w, f.y.w, f.depth.w};
}

/// The same of vectors.
struct LinearVector {
  Vec3d o, x, y, depth;

  [[nodiscard]] Linear along(Vec3d axis) const {
    return {dot(o, axis), dot(x, axis), dot(y, axis), dot(depth, axis)};
  }
  [[nodiscard]] LinearVector without(Vec3d axis) const {
    const auto rest = [&](Vec3d v) { return v - axis * dot(v, axis); };
    return {rest(o), rest(x), rest(y), rest(depth)};
  }
  [[nodiscard]] LinearVector scaled(double s) const { return {o * s, x * s, y * s, depth * s}; }
};
/// Relative to a point: homogeneous, so that it is times w.
LinearVector from(const RayFrame& f, Vec3d p) {
  const auto minus = [&](const RayFrame::Point& h) { return h.v - p * h.w; };
  return {minus(f.o), minus(f.x), minus(f.y), minus(f.depth)};
}

/// A quadratic form |s|² − ρ² of rays, about 1 in size. `reach`: of depths over the primitive.
/// With A = |s_e|² − ρ_e² and B_i = s_e · s_i − ρ_e ρ_i, D_ij = B_i B_j − A C_ij is
/// (ρ_e s_i − ρ_i s_e) · (ρ_e s_j − ρ_j s_e) − (s_e × s_i) · (s_e × s_j), where nothing cancels.
void set_form(const LinearVector& s, const Linear& rho, double reach, QuadricPart& part) {
  const Vec3d v[3] = {s.o, s.x, s.y};
  const double r[3] = {rho.o, rho.x, rho.y};
  const double re = rho.depth;
  double b[3], d[3][3];
  Vec3d m[3], k[3];
  for (int i = 0; i < 3; ++i) {
    b[i] = dot(s.depth, v[i]) - re * r[i];
    m[i] = v[i] * re - s.depth * r[i];
    k[i] = cross(s.depth, v[i]);
  }
  double a = dot(s.depth, s.depth) - re * re;
  // The eye on the surface, or rays along the axis: just inside is as good, and has two roots.
  const double least = 1e-10 / (reach * reach);
  const bool is_flat = !(std::abs(a) > least);
  if (is_flat) a = -least;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      d[i][j] = is_flat ? b[i] * b[j] - a * (dot(v[i], v[j]) - r[i] * r[j])
                        : dot(m[i], m[j]) - dot(k[i], k[j]);
  part.b = b[0];
  part.bx = b[1];
  part.by = b[2];
  part.d = d[0][0];
  part.dx = 2 * d[0][1];
  part.dy = 2 * d[0][2];
  part.dxx = d[1][1];
  part.dxy = 2 * d[1][2];
  part.dyy = d[2][2];
  part.inverse_a = 1 / a;
}

/// Where g ≥ 0. A plane that holds the rays is turned a little. Returns whether it was not.
bool add_limit(Linear g, double reach, QuadricPart& part) {
  const double least = 1e-12 * std::max(std::abs(g.o), 1e-3) / reach;
  const bool crosses = std::abs(g.depth) >= least;
  if (!crosses) g.depth = g.depth < 0 ? -least : least;
  const double scale = -1 / g.depth;
  part.limits[part.limit_count++] = {g.o * scale, g.x * scale, g.y * scale, g.depth > 0};
  return crosses;
}

bool is_finite(const Quadric& q) {
  double sum = q.depth0;
  for (std::uint32_t k = 0; k < q.part_count; ++k) {
    const QuadricPart& p = q.part[k];
    sum += p.b + p.bx + p.by + p.d + p.dx + p.dy + p.dxx + p.dxy + p.dyy + p.inverse_a;
    for (std::uint32_t i = 0; i < p.limit_count; ++i)
      sum += p.limits[i].at + p.limits[i].x + p.limits[i].y;
  }
  return std::isfinite(sum);
}

/// Makes the parts of one quadric.
class PartMaker {
 public:
  PartMaker(const RayFrame& frame, double reach, bool asks_eye, Quadric& quadric)
      : frame_(frame), reach_(reach), asks_eye_(asks_eye), quadric_(quadric) {}

  QuadricPart& add_ball(const Ball& ball) {
    QuadricPart& part = next();
    set_form(from(frame_, ball.centre).scaled(1 / ball.radius), w_of(frame_), reach_, part);
    // The eye's other side.
    if (asks_eye_) add_limit(w_of(frame_), reach_, part);
    return part;
  }
  /// Returns whether it is not seen edge-on.
  bool add_disc(const Ball& ball, Vec3d normal) {
    QuadricPart& part = add_ball(ball);
    const Linear g = from(frame_, ball.centre).along(normal) * (1 / ball.radius);
    const bool is_seen = add_limit(g, reach_, part);
    // Its exact negative, so that both are at one depth.
    part.limits[part.limit_count] = part.limits[part.limit_count - 1];
    part.limits[part.limit_count].is_least = !part.limits[part.limit_count].is_least;
    ++part.limit_count;
    return is_seen;
  }
  /// Between p0 and p1, where the radii are r0 and r1. What lies between its ends lies where w > 0.
  void add_cone(Vec3d p0, Vec3d p1, double r0, double r1) {
    QuadricPart& part = next();
    const Vec3d middle = (p0 + p1) * 0.5;
    const double half = length(p1 - p0) * 0.5;
    const Vec3d axis = (p1 - p0) * (0.5 / half);
    const LinearVector v = from(frame_, middle);
    const Linear h = v.along(axis), w = w_of(frame_);
    const double scale = 1 / std::max(r0, r1);
    const Linear rho = w * ((r0 + r1) * 0.5) + h * ((r1 - r0) * 0.5 / half);
    set_form(v.without(axis).scaled(scale), rho * scale, reach_, part);
    const Linear g = h * (1 / half);
    add_limit(w + g, reach_, part);
    add_limit(w + negated(g), reach_, part);
  }

 private:
  QuadricPart& next() {
    QuadricPart& part = quadric_.part[quadric_.part_count++];
    part.limit_count = 0;
    return part;
  }

  const RayFrame& frame_;
  double reach_;
  bool asks_eye_;
  Quadric& quadric_;
};

std::int32_t to_fx8(double px, double plus) {
  return static_cast<std::int32_t>(std::floor(px * kSubpixels + plus));
}

}  // namespace

bool make_quadric(const QuadricStage& stage, const QuadricShape& shape, Viewport viewport,
                  Quadric& q, QuadricPlace& place, RayFrame* wanted) {
  if (stage.clip_to_object() == nullptr) return false;
  const Mat4d& to_clip = stage.object_to_clip();
  const Row x(to_clip, 0), y(to_clip, 1), z(to_clip, 2), w(to_clip, 3);
  const double hw = viewport.half_width, hh = viewport.half_height;
  const bool has_two = shape.kind != QuadricKind::sphere && shape.kind != QuadricKind::disc;
  const Ball balls[2] = {{shape.p0, shape.r0}, {shape.p1, shape.r1}};
  const std::span<const Ball> ends(balls, has_two ? 2 : 1);

  // Against the near plane: z − w > 0 lies before it.
  Row before = z;
  before.v = z.v - w.v;
  before.w = z.w - w.w;
  bool is_ahead = true, is_hidden = true;
  place.asks_near = false;
  for (const Ball& ball : ends) {
    const double reach = ball.radius * length(before.v), at = before.at(ball.centre);
    is_hidden &= at > reach;
    place.asks_near |= !(at < -reach * (1 + 1e-9));
    is_ahead &= ball.is_ahead(w);
  }
  if (is_hidden) return false;

  // A box and depths that hold it: those of the balls about its ends.
  Range across{0, 2 * hw}, down{0, 2 * hh}, depths{0, 1};
  if (is_ahead) {
    Range nx{}, ny{}, nd{};
    for (const Ball& ball : ends) {
      const Range bx = ball.range(x, w), by = ball.range(y, w), bd = ball.range(z, w);
      const bool first = &ball == ends.data();
      nx = first ? bx : nx.with(bx);
      ny = first ? by : ny.with(by);
      nd = first ? bd : nd.with(bd);
    }
    across = {std::max(across.least, (nx.least + 1) * hw),
              std::min(across.most, (nx.most + 1) * hw)};
    down = {std::max(down.least, (1 - ny.most) * hh), std::min(down.most, (1 - ny.least) * hh)};
    depths = nd;
  }
  if (!(across.least <= across.most && down.least <= down.most)) return false;
  place.x[1] = to_fx8(across.least, -1);
  place.x[2] = to_fx8(across.most, 2);
  place.y[1] = to_fx8(down.least, -1);
  place.y[2] = to_fx8(down.most, 2);

  // All is told about the pixel and the depth of its middle, or where that is out of sight about
  // another place of its box.
  const Vec3d middle = has_two ? (shape.p0 + shape.p1) * 0.5 : shape.p0;
  double px = (across.least + across.most) * 0.5, py = (down.least + down.most) * 0.5;
  q.depth0 = is_ahead ? (depths.least + depths.most) * 0.5 : 1;
  if (is_ahead) {
    const double inverse_w = 1 / w.at(middle);
    px = std::clamp((x.at(middle) * inverse_w + 1) * hw, across.least, across.most);
    py = std::clamp((1 - y.at(middle) * inverse_w) * hh, down.least, down.most);
    q.depth0 = z.at(middle) * inverse_w;
  }
  place.x[0] = to_fx8(px, 0.5);
  place.y[0] = to_fx8(py, 0.5);
  q.nearest = 1 - q.depth0;
  const double reach = is_ahead ? std::max(depths.most - depths.least, 1e-30) : 1;
  const double margin = 1e-6 * depths.most;
  q.lowest = static_cast<float>(std::clamp(depths.least - margin, 0.0, 1.0));
  q.highest = static_cast<float>(std::clamp(depths.most + margin, 0.0, 1.0));

  RayFrame frame;
  {
    const auto& m = stage.clip_to_object()->m;
    const auto column = [&](int i) {
      return RayFrame::Point{{m[0][i], m[1][i], m[2][i]}, m[3][i]};
    };
    const auto times = [](const RayFrame::Point& p, double s) {
      return RayFrame::Point{p.v * s, p.w * s};
    };
    const auto plus = [](const RayFrame::Point& a, const RayFrame::Point& b) {
      return RayFrame::Point{a.v + b.v, a.w + b.w};
    };
    constexpr double kPx = 1.0 / kSubpixels;
    frame.o = plus(plus(times(column(0), place.x[0] * kPx / hw - 1),
                        times(column(1), 1 - place.y[0] * kPx / hh)),
                   plus(times(column(2), q.depth0), column(3)));
    const double scale = 1 / frame.o.w;
    frame.o = times(frame.o, scale);
    frame.x = times(column(0), scale / hw);
    frame.y = times(column(1), -scale / hh);
    frame.depth = times(column(2), scale);
  }
  if (wanted != nullptr) *wanted = frame;

  q.part_count = 0;
  q.is_open = shape.kind == QuadricKind::open_cone;
  PartMaker parts(frame, reach, !is_ahead, q);
  switch (shape.kind) {
    case QuadricKind::sphere:
      parts.add_ball(balls[0]);
      break;
    case QuadricKind::disc:
      if (!parts.add_disc(balls[0], shape.p1)) return false;
      place.front = q.part[0].limits[q.part[0].limit_count - 2].is_least;
      break;
    case QuadricKind::cone:
    case QuadricKind::open_cone:
      parts.add_cone(shape.p0, shape.p1, shape.r0, shape.r1);
      break;
    case QuadricKind::hull: {
      for (const Ball& ball : ends)
        if (ball.radius > 0) parts.add_ball(ball);
      // The cone that touches both balls, between the circles where it does.
      const Vec3d between = shape.p1 - shape.p0;
      const double distance = length(between);
      const Vec3d axis = between * (1 / distance);
      const double sine = (shape.r0 - shape.r1) / distance;
      const double cosine = std::sqrt((1 - sine) * (1 + sine));
      parts.add_cone(shape.p0 + axis * (shape.r0 * sine), shape.p1 + axis * (shape.r1 * sine),
                     shape.r0 * cosine, shape.r1 * cosine);
      break;
    }
  }
  q.is_plain =
      shape.kind == QuadricKind::sphere && is_ahead && !place.asks_near && q.part[0].inverse_a > 0;
  return is_finite(q);
}

}  // namespace rastrum::raster
