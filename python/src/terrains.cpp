// SPDX-License-Identifier: BSD-3-Clause
// Height maps that are lit once and drawn from any place.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <rastrum/annotate.hpp>
#include <rastrum/color_map.hpp>
#include <rastrum/io.hpp>
#include <rastrum/light.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "annotations.hpp"
#include "bindings.hpp"

namespace rastrum::python {
namespace {

using terrain::TerrainCamera;
using terrain::TerrainOptions;
using Rgb = std::array<std::uint8_t, 3>;

constexpr double kRadians = std::numbers::pi / 180;
constexpr std::size_t kMostCells = 1U << 20U;  // along a side

/// A copy of a C-contiguous array.
template <class T>
Image<T> image(const Array& array, const char* what) {
  if (array.shape(0) == 0 || array.shape(1) == 0 || array.shape(0) > kMostCells ||
      array.shape(1) > kMostCells)
    throw Error(Errc::invalid_argument, std::string(what) + ": has " +
                                            std::to_string(array.shape(1)) + " x " +
                                            std::to_string(array.shape(0)) + " cells");
  Image<T> made(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
  std::memcpy(made.pixels().data(), array.data(), made.pixels().size() * sizeof(T));
  return made;
}

struct LitTerrain {
  terrain::Terrain map;
  terrain::Sun sun;
  terrain::MapFilter filter;
  terrain::Tiling tiling;
  int width, height;
  double low, high;
  GroundLights ground;  ///< without lights the sun's
  /// The heights if lights move with the camera, so that each picture is lit anew; else empty.
  terrain::HeightMap unlit{};
  ScalarMapping mapping{};
  std::optional<ScalarColors> numbers{};  ///< none: heights are not shown as numbers
  double cells_a_unit = 1;                ///< the height of one given unit
  int threads = 0;

  [[nodiscard]] GroundNumbers meaning() const {
    return {cells_a_unit, &mapping, numbers ? &*numbers : nullptr};
  }
  [[nodiscard]] terrain::ShadowOptions by() const { return {tiling, Device::threads, threads, {}}; }
};

/// Heights become cells by `cells_a_unit`. Lit by the sun, or by `lights` if there are any.
LitTerrain lit_map(terrain::HeightMap map, double cells_a_unit, const std::array<double, 2>& sun,
                   const std::string& shadows, double ambient, double sun_radius_deg,
                   const std::string& filter, const std::string& tiling, int threads,
                   const std::vector<Light>& lights, const std::string& tone, double exposure,
                   const std::optional<ScalarMapping>& mapping) {
  terrain::Light light;
  light.sun = {sun[0], sun[1]};
  if (!std::isfinite(sun[0]) || !std::isfinite(sun[1]) || sun[1] > 90)
    throw Error(Errc::invalid_argument,
                "sun: azimuth and elevation must be finite, the elevation at most 90 degrees");
  light.shadows =
      named<terrain::Shadows>("shadows", shadows, {"none", "accumulated", "sharp", "soft"});
  light.hill_shading = map.colors.empty();
  light.ambient = static_cast<float>(ambient);
  light.sun_radius_deg = sun_radius_deg;
  const auto filtered = named<terrain::MapFilter>("filter", filter, {"none", "bilinear", "mip"});
  const auto tiles =
      named<terrain::Tiling>("tiling", tiling, {"repeat", "mirror", "clamp", "none"});
  light.smooth = filtered == terrain::MapFilter::bilinear;

  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (float& h : map.heights.pixels()) {
    if (!std::isfinite(h)) {
      h = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    low = std::min(low, static_cast<double>(h));
    high = std::max(high, static_cast<double>(h));
  }
  if (!(low <= high)) throw Error(Errc::invalid_argument, "heights: none of them is a number");
  const int width = map.heights.width(), height = map.heights.height();
  std::optional<ScalarColors> numbers;
  if (mapping) {
    if (!mapping->isolines.empty() || !mapping->opacity.empty())
      throw Error(Errc::invalid_argument,
                  "cmap: isolines and opacities are drawn on meshes only; on a terrain steps show "
                  "where a height is");
    std::vector<double> all;
    all.reserve(map.heights.pixels().size());
    for (const float h : map.heights.pixels()) all.push_back(static_cast<double>(h) / cells_a_unit);
    numbers.emplace(*mapping, finite_range(all, mapping->logarithmic));
    map.colors = terrain::colors_of_heights(map.heights.view(), *numbers, cells_a_unit,
                                            light.smooth ? 0 : 1, tiles, threads);
  }
  const terrain::ShadowOptions by{tiles, Device::threads, threads, {}};
  GroundLights ground{.lights = lights,
                      .shadows = light.shadows,
                      .sun_radius_deg = sun_radius_deg,
                      .tone = {named<Tone>("tone", tone, {"none", "reinhard", "aces", "neutral"}),
                               static_cast<float>(exposure)},
                      .smooth = light.smooth};
  terrain::HeightMap unlit;
  if (!lights.empty()) {
    if (std::ranges::any_of(lights, &Light::of_camera)) unlit = {map.heights, map.colors};
    map.colors = lit_colors(map, ground, by);
  } else if (light.hill_shading || light.shadows != terrain::Shadows::none) {
    map.colors = terrain::lit_colors(map, light, by);
  }
  return {terrain::Terrain(std::move(map)),
          light.sun,
          filtered,
          tiles,
          width,
          height,
          low,
          high,
          std::move(ground),
          std::move(unlit),
          mapping.value_or(ScalarMapping{}),
          std::move(numbers),
          cells_a_unit,
          threads};
}

terrain::Terrain seen_from(const LitTerrain& t, TerrainCamera camera, const TerrainOptions& o) {
  if (t.unlit.heights.empty()) return t.map;
  if (o.ground_clearance)
    camera = terrain::above_ground(t.map, camera, *o.ground_clearance, o.tiling);
  GroundLights ground = t.ground;
  ground.camera = camera;
  return t.map.with_colors(lit_colors(t.unlit, ground, t.by()));
}

/// Scales heights to cells. Returns how many cells a unit is high.
double in_cells(Image<float>& heights, double scale) {
  const auto factor = static_cast<float>(scale);
  if (!(std::isfinite(factor) && factor != 0))
    throw Error(Errc::invalid_argument, "height_scale: must be a finite number other than 0");
  for (float& h : heights.pixels()) h *= factor;
  return static_cast<double>(factor);
}

LitTerrain lit(const Array& heights, const std::optional<Array>& colors,
               const std::optional<double>& scale, const std::array<double, 2>& sun,
               const std::string& shadows, double ambient, double sun_radius_deg,
               const std::string& filter, const std::string& tiling, int threads,
               const std::vector<Light>& lights, const std::string& tone, double exposure,
               const std::optional<ScalarMapping>& mapping) {
  terrain::HeightMap map{image<float>(heights, "heights"), {}};
  if (colors) map.colors = image<Rgba8>(*colors, "colors");
  const double cells_a_unit = scale ? in_cells(map.heights, *scale) : 1;
  return lit_map(std::move(map), cells_a_unit, sun, shadows, ambient, sun_radius_deg, filter,
                 tiling, threads, lights, tone, exposure, mapping);
}

LitTerrain lit_file(const std::string& file, const std::optional<std::string>& colors,
                    const std::optional<double>& scale, const std::array<double, 2>& sun,
                    const std::string& shadows, double ambient, double sun_radius_deg,
                    const std::string& filter, const std::string& tiling, int threads,
                    const std::vector<Light>& lights, const std::string& tone, double exposure,
                    const std::optional<ScalarMapping>& mapping) {
  io::HeightGrid grid = io::read_heights(file, {});
  if (!scale && !grid.scale_known)
    throw Error(Errc::invalid_argument, file +
                                            ": does not say how long a cell is; give height_scale, "
                                            "how many cells high a unit of it is");
  double cells_a_unit = 1 / grid.units_per_cell;
  if (scale)
    cells_a_unit = in_cells(grid.heights, *scale);
  else
    for (float& h : grid.heights.pixels())
      h = static_cast<float>(static_cast<double>(h) / grid.units_per_cell);
  terrain::HeightMap map{std::move(grid.heights), {}};
  if (colors) map.colors = io::read_image(*colors);
  return lit_map(std::move(map), cells_a_unit, sun, shadows, ambient, sun_radius_deg, filter,
                 tiling, threads, lights, tone, exposure, mapping);
}

/// The defaults look from the south down on all of the map.
TerrainCamera camera(const LitTerrain& t, int rows, const std::optional<std::array<double, 2>>& at,
                     const std::optional<double>& altitude, double angle_deg,
                     const std::optional<double>& horizon_px, double roll_deg) {
  TerrainCamera c;
  c.x = at ? (*at)[0] : t.width / 2.0;
  c.y = at ? (*at)[1] : t.height * (800.0 / 1024);
  c.altitude = altitude.value_or(t.high + std::max((t.high - t.low) / 10, 1.0));
  c.angle_rad = angle_deg * kRadians;
  c.horizon_px = horizon_px.value_or(rows / 4);
  c.roll_rad = roll_deg * kRadians;
  return c;
}

TerrainOptions frame(const LitTerrain& t, int width, int height, double distance, double fov_deg,
                     double scale_px, const std::string& projection, const std::optional<Rgb>& sky,
                     double fog_density, double fog_start, const std::optional<Rgb>& fog_color,
                     const std::optional<double>& clearance, bool environment_behind) {
  TerrainOptions o;
  o.width = width;
  o.height = height;
  o.distance = distance;
  o.fov_rad = fov_deg * kRadians;
  o.scale_px = scale_px;
  o.step = 0;
  o.filter = t.filter;
  o.tiling = t.tiling;
  o.projection = named<terrain::Projection>("projection", projection, {"planar", "cylindrical"});
  const auto opaque = [](const Rgb& c) { return Rgba8{c[0], c[1], c[2], 255}; };
  if (environment_behind && sky)
    throw Error(Errc::invalid_argument,
                "sky: has no effect, because environment_behind shows the environment there; give "
                "fog a colour instead");
  if (sky)
    o.sky = opaque(*sky);
  else if (t.ground.lights.empty())
    o.sky = terrain::sky_in(o.sky, t.sun);
  o.fog = {fog_density, fog_start, {}};
  if (fog_color) o.fog.color = opaque(*fog_color);
  o.ground_clearance = clearance;
  check(o);
  return o;
}

class TerrainDrawer {
 public:
  explicit TerrainDrawer(int threads) : renderer_({Device::threads, threads, {}}) {}

  terrain::TerrainStats render(const LitTerrain& t, const TerrainCamera& from, TerrainOptions o,
                               const Output& color, const std::optional<Output>& depth,
                               bool environment_behind, const std::optional<Annotations>& notes) {
    if (notes) check_ground_annotations(*notes, t.meaning());
    terrain::TerrainTargets targets;
    targets.color8 = {static_cast<Rgba8*>(color.data()), o.width, o.height};
    Image<float> own_depth;
    if (depth) {
      targets.depth = {static_cast<float*>(depth->data()), o.width, o.height};
    } else if (environment_behind || (notes && notes->bounds)) {
      own_depth = Image<float>(o.width, o.height);
      targets.depth = own_depth.view();
    }
    for (;;) {
      const StopOnInterrupt interrupt;
      try {
        const nb::gil_scoped_release unlock;
        const terrain::Terrain map = seen_from(t, from, o);
        // Far ground in fog takes the colour behind it.
        if (environment_behind) o.sky = horizon_color(t.ground.lights, t.ground.tone, from);
        terrain::TerrainStats stats = renderer_.render(map, from, o, targets, interrupt.token());
        if (environment_behind)
          draw_environment_behind(t.ground.lights, t.ground.tone, o, stats.camera, targets,
                                  t.threads);
        if (notes) draw_ground_annotations(*notes, t.map, t.meaning(), o, stats.camera, targets);
        return stats;
      } catch (const Stopped&) {
      }
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
    }
  }

 private:
  terrain::TerrainRenderer renderer_;
};

}  // namespace

void bind_terrains(nb::module_& m) {
  using nb::arg;
  nb::class_<LitTerrain>(m, "LitTerrain")
      .def_prop_ro("lowest", [](const LitTerrain& t) { return t.low; })
      .def_prop_ro("highest", [](const LitTerrain& t) { return t.high; })
      .def("ground_at", [](const LitTerrain& t, double x, double y) {
        TerrainOptions o;
        o.filter = t.filter;
        o.tiling = t.tiling;
        return terrain::ground_at(t.map, x, y, o);
      });
  m.def("ends_at_edge", [](const std::string& file) { return io::ends_at_edge(file); });
  m.def("lit_terrain", lit, arg("heights"), arg("colors").none(), arg("scale").none(), arg("sun"),
        arg("shadows"), arg("ambient"), arg("sun_radius"), arg("filter"), arg("tiling"),
        arg("threads"), arg("lights"), arg("tone"), arg("exposure"), arg("mapping").none(),
        nb::call_guard<nb::gil_scoped_release>());
  m.def("lit_terrain_of_file", lit_file, arg("heights"), arg("colors").none(), arg("scale").none(),
        arg("sun"), arg("shadows"), arg("ambient"), arg("sun_radius"), arg("filter"), arg("tiling"),
        arg("threads"), arg("lights"), arg("tone"), arg("exposure"), arg("mapping").none(),
        nb::call_guard<nb::gil_scoped_release>());
  nb::class_<TerrainCamera>(m, "TerrainCamera");
  m.def("terrain_camera", camera, arg("terrain"), arg("rows"), arg("position").none(),
        arg("altitude").none(), arg("angle"), arg("horizon").none(), arg("roll"));
  nb::class_<TerrainOptions>(m, "TerrainFrame");
  m.def("terrain_frame", frame, arg("terrain"), arg("width"), arg("height"), arg("distance"),
        arg("fov"), arg("scale"), arg("projection"), arg("sky").none(), arg("fog_density"),
        arg("fog_start"), arg("fog_color").none(), arg("clearance").none(),
        arg("environment_behind"));
  nb::class_<TerrainDrawer>(m, "TerrainRenderer")
      .def(nb::init<int>(), arg("threads"))
      .def(
          "render",
          [](TerrainDrawer& by, const LitTerrain& t, const TerrainCamera& from,
             const TerrainOptions& o, const Output& color, const std::optional<Output>& depth,
             bool environment_behind, const std::optional<Annotations>& notes) {
            const terrain::TerrainStats s =
                by.render(t, from, o, color, depth, environment_behind, notes);
            nb::dict d;
            d["samples"] = s.samples;
            d["peak_bytes"] = s.peak_bytes;
            d["frame_ms"] = s.frame_ms;
            d["camera"] = nb::make_tuple(s.camera.x, s.camera.y, s.camera.altitude);
            return d;
          },
          arg("terrain"), arg("camera"), arg("frame"), arg("color"), arg("depth").none(),
          arg("environment_behind"), arg("annotations").none());
}

}  // namespace rastrum::python
