// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain/setup.hpp>

#include <algorithm>
#include <string>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/enum.hpp>
#include <rastrum/core/reject.hpp>

namespace rastrum::terrain {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMaxDistance = 8e6;
/// Up to here offsets from the camera are exact integers in float32.
constexpr double kMaxExtent = 0x1p23;
constexpr double kFarAway = 1e12;
/// Limits the slices of the narrowest view to 260,000.
constexpr double kLeastShare = 0x1p-14;

/// At distance 1, from the middle to the edge.
double half_width(const TerrainOptions& o) {
  return o.projection == Projection::planar ? elementary::tan(o.fov_rad / 2) : o.fov_rad / 2;
}

/// A step as a share of its distance: the height of a pixel there, but short enough that each row
/// below the horizon has a sample of flat ground. 0 if the options give steps of their own.
double step_share(const TerrainOptions& o) {
  const bool own = o.classic || o.step != 0 || o.filter != MapFilter::bilinear;
  return own ? 0 : std::max(1 / std::max<double>(scale_px(o), o.height), kLeastShare);
}

double first_step(const TerrainOptions& o) {
  return o.step == 0 ? 1 : o.step;
}

double distance_of(const TerrainOptions& o, double k) {
  return 1 + k * first_step(o) + o.dz * (k * (k + 1) / 2);
}

}  // namespace

double slice_count(const TerrainOptions& o) {
  if (o.distance <= 1) return 0;
  if (const double share = step_share(o); share > 0) {
    double n = 0;
    for (double z = 1; z < o.distance; z += z * share) ++n;
    return n;
  }
  // The root of distance_of(k) = distance, then corrected by the formula.
  const double b = first_step(o) + o.dz / 2, reach = o.distance - 1;
  double k = std::floor(2 * reach / (b + std::sqrt(b * b + 2 * o.dz * reach)));
  while (k > 0 && distance_of(o, k - 1) >= o.distance) --k;
  while (distance_of(o, k) < o.distance) ++k;
  return k;
}

void check(const TerrainOptions& o) {
  require(o.width >= 1 && o.height >= 1 && o.width <= kMaxImageSize && o.height <= kMaxImageSize,
          "terrain: the size ", o.width, "x", o.height, " is outside 1x1 to 32768x32768");
  check_enum(o.filter, MapFilter::mip, "terrain: the filter");
  check_enum(o.tiling, Tiling::none, "terrain: the tiling");
  check_enum(o.projection, Projection::cylindrical, "terrain: the projection");
  require(o.distance >= 0 && o.distance <= kMaxDistance,
          "terrain: the distance must lie between 0 and 8e6 cells");
  const bool planar = o.projection == Projection::planar;
  require(o.fov_rad > 0 && (planar ? o.fov_rad < kPi : o.fov_rad <= 2 * kPi),
          planar ? "terrain: a planar view must be wider than 0 and less than 180 degrees (the "
                   "cylindrical projection goes up to 360)"
                 : "terrain: a cylindrical view must be wider than 0 and at most 360 degrees");
  require(o.scale_px >= 0 && o.scale_px <= 1e7, "terrain: the scale must lie between 0 and 1e7");
  require(o.step >= 0 && o.step <= 1e7,
          "terrain: the step must lie between 0 (chosen by the filter) and 1e7");
  require(o.dz >= 0 && o.dz <= 1e7, "terrain: dz must lie between 0 and 1e7");
  require(o.fog.density >= 0 && std::isfinite(o.fog.density),
          "terrain: the fog's density must be a number, at least 0");
  require(o.fog.start >= 0 && std::isfinite(o.fog.start),
          "terrain: the fog must start at a distance of at least 0");
  require(!o.ground_clearance || std::isfinite(*o.ground_clearance),
          "terrain: the clearance above the ground must be a finite number");
  if (o.classic) {
    const TerrainOptions d;
    require(o.fov_rad == d.fov_rad && o.scale_px == d.scale_px && first_step(o) == d.step &&
                o.dz == d.dz && o.projection == d.projection && o.filter == d.filter &&
                !o.ground_clearance && o.tiling != Tiling::none,
            "terrain: the classic picture has its own field of view, scale, steps, projection, "
            "clearance and no filter, and its ground does not end (tiling none); leave them or the "
            "classic option out");
  } else {
    const double extent = std::max(1.0, half_width(o)) * o.distance;
    require(!(extent > kMaxExtent || slice_count(o) > kMaxSlices),
            "terrain: this distance with this field of view and step takes samples up to ", extent,
            " cells away in ", slice_count(o),
            " steps, and 2^23 and 2^24 are the limits; choose a smaller distance or larger steps");
  }
}

void check(const TerrainCamera& c) {
  for (const double v : {c.x, c.y, c.altitude, c.angle_rad, c.horizon_px, c.roll_rad})
    require(std::isfinite(v), "terrain: the camera holds a number that is not finite");
  require(std::abs(c.x) <= kFarAway && std::abs(c.y) <= kFarAway,
          "terrain: the camera is farther than 1e12 cells from the map's corner");
  require(std::abs(c.altitude) <= kFarAway, "terrain: the camera's altitude is beyond 1e12");
  require(std::abs(c.horizon_px) <= 1e6, "terrain: the horizon lies beyond 1e6 pixels");
  require(std::abs(c.angle_rad) <= 1e6 && std::abs(c.roll_rad) <= 1e6,
          "terrain: angles must lie within 1e6 radians");
}

double scale_px(const TerrainOptions& o) {
  if (o.classic) return 240;
  return o.scale_px > 0 ? o.scale_px : o.width / 2.0 / half_width(o);
}

Extent extent_of(const Terrain& terrain) {
  if (!terrain.is_map()) return {};
  return {terrain.heights()->width(), terrain.heights()->height(), terrain.highest()};
}

Setup set_up(const TerrainOptions& o, const TerrainCamera& camera, const Extent& terrain) {
  Setup s;
  s.height = o.height;
  s.sky = o.sky;
  s.fog = o.fog.color.value_or(o.sky);
  s.altitude = static_cast<float>(camera.altitude);
  s.horizon = static_cast<float>(camera.horizon_px + 0.5);

  const auto w = static_cast<std::size_t>(o.width);
  s.ux.resize(w);
  s.uy.resize(w);
  const double half = half_width(o);
  const auto [sin, cos] = elementary::sin_cos(camera.angle_rad);
  for (std::size_t i = 0; i < w; ++i) {
    double right = ((static_cast<double>(i) + 0.5) * 2 / o.width - 1) * half, ahead = 1;
    if (o.projection == Projection::cylindrical) {
      ahead = elementary::cos(right);
      right = elementary::sin(right);
    }
    s.ux[i] = static_cast<float>(cos * right - sin * ahead);
    s.uy[i] = static_cast<float>(-sin * right - cos * ahead);
  }

  s.camera_x = std::floor(camera.x);
  s.camera_y = std::floor(camera.y);
  s.fx = std::min(static_cast<float>(camera.x - s.camera_x), 1 - 0x1p-24F);
  s.fy = std::min(static_cast<float>(camera.y - s.camera_y), 1 - 0x1p-24F);
  if (terrain.width > 0) {
    const auto reduced = [&](double corner, int size) {
      const auto cell = static_cast<std::int64_t>(corner);
      const std::int64_t far = 1 << 30;  // beyond the edge with every offset
      if (o.tiling == Tiling::clamp || o.tiling == Tiling::none)
        return static_cast<int>(std::clamp(cell, -far, far));
      return static_cast<int>(
          tiled(cell, o.tiling == Tiling::mirror ? 2 * size : size, Tiling::repeat));
    };
    s.cell_x = reduced(s.camera_x, terrain.width);
    s.cell_y = reduced(s.camera_y, terrain.height);
  }

  const auto n = static_cast<std::size_t>(slice_count(o));
  const double scale = scale_px(o), spacing = 2 * half / o.width;
  const double share = step_share(o);
  double along = 1;  // the distance, if steps are a share of it
  s.slices.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    Slice& slice = s.slices[k];
    const double z = share > 0 ? along : distance_of(o, static_cast<double>(k));
    along += along * share;
    slice.z = static_cast<float>(z);
    slice.rows = static_cast<float>(scale / z);
    if (o.filter == MapFilter::mip) {
      const double step = first_step(o) + o.dz * static_cast<double>(k);
      slice.level = std::max(0, std::ilogb(std::max(step, z * spacing)));
    }
    if (o.fog.density > 0) {
      const double through = elementary::exp(-o.fog.density * std::max(0.0, z - o.fog.start));
      slice.clear = static_cast<std::uint32_t>(std::lround(256 * through));
    }
  }
  const float top = filtered_bound(terrain.highest);
  float lowest_row = std::numeric_limits<float>::infinity();
  for (std::size_t k = n; k-- > 0;) {
    const float row = (s.altitude - top) * s.slices[k].rows + s.horizon;
    lowest_row = row < lowest_row ? row : lowest_row;
    s.slices[k].lowest_row = std::isnan(row) ? -std::numeric_limits<float>::infinity() : lowest_row;
  }
  return s;
}

}  // namespace rastrum::terrain
