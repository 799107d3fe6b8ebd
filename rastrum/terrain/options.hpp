// What a caller chooses about a picture of a terrain, and what comes back beside it.
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/core/image.hpp>
#include <rastrum/core/stage_time.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/terrain/terrain.hpp>

namespace rastrum::terrain {

/// Where one stands and looks. The view is always level; looking up or down shifts the horizon.
struct TerrainCamera {
  double x = 512, y = 800;  ///< cells
  double altitude = 78;     ///< in the unit of the heights
  double angle_rad = 0;     ///< 0 looks along −y, π/2 along −x
  double horizon_px = 100;  ///< row of the horizon, from the top
  double roll_rad = 0;      ///< turns the picture about its centre, counter-clockwise

  bool operator==(const TerrainCamera&) const = default;
};

enum class MapFilter : std::uint8_t {
  none,      ///< the cell under the sample
  bilinear,  ///< between the centres of four cells, heights and colours
  mip,       ///< one cell of the pyramid: maximum of the heights, mean of the colours
};

enum class Method : std::uint8_t {
  fast,   ///< columns in blocks with a running minimum
  words,  ///< paper 3's: the `occlude` scan, the scatter and the `fill` scan
};

enum class Projection : std::uint8_t {
  planar,  ///< columns are equal steps on a plane, as lenses draw: straight lines stay straight
  cylindrical,  ///< columns are equal angles: nothing is stretched at wide angles, up to 360°
};

/// Colours fade to `color` by 1 − exp(−density · (distance − start)); density 0 is none.
struct Fog {
  double density = 0;            ///< per cell
  double start = 0;              ///< cells
  std::optional<Rgba8> color{};  ///< none: the sky's

  bool operator==(const Fog&) const = default;
};

inline constexpr Rgba8 kSky{0x90, 0x90, 0xE0, 255};

struct TerrainOptions {
  int width = 1280, height = 720;
  double distance = 800;  ///< cells; how far samples are taken, up to 8e6
  /// The original program bit for bit (docs/terrain.md): float64, its scale of 240 rows, 90°,
  /// 10 above the ground, steps of 1, 1.005, …. Fov, scale, steps, projection, filter (but none)
  /// and ground clearance are then refused unless they stand at their defaults.
  bool classic = false;
  double fov_rad = std::numbers::pi / 2;  ///< across; below π for planar, up to 2π for cylindrical
  /// Rows that a height of 1 takes at distance 1; 0: as many as columns in the picture's middle.
  double scale_px = 0;
  /// Distances are 1, 1 + step, … with steps that grow by `dz` each. Step 0 leaves them to the
  /// filter: `bilinear`, which has something to show within a cell, takes steps as long as a pixel
  /// is high at their distance (a share of it, so that `dz` is not used); the others take 1 and
  /// `dz`.
  double step = 1, dz = 0.005;
  MapFilter filter = MapFilter::none;
  Tiling tiling = Tiling::repeat;
  Projection projection = Projection::planar;
  Rgba8 sky = kSky;
  Fog fog{};
  /// The camera is lifted to this much above the ground under it before a frame; none: it stays
  /// where it is, under the ground too. `classic` always takes 10.
  std::optional<double> ground_clearance{};

  Method method = Method::fast;
  Device device = Device::threads;
  int threads = 0;           ///< 0: all
  std::optional<Isa> isa{};  ///< none: the best this machine has
};

/// Images to fill; an empty view is not computed. All must have the frame's size.
struct TerrainTargets {
  ImageView<Rgba8> color8{};
  ImageView<float> depth{};  ///< distance along the view (cells), +inf where the sky is
};

struct TerrainStats {
  TerrainCamera camera;             ///< as drawn: lifted from the ground where that was asked for
  std::uint64_t slices = 0;         ///< distances at which each column may be sampled
  std::uint64_t samples = 0;        ///< heights read; what is left out varies a little with where
                                    ///< the targets lie in memory
  std::uint64_t visible = 0;        ///< samples that were drawn
  std::uint64_t peak_bytes = 0;     ///< scratch and pyramids, beyond the terrain and the images
  std::uint64_t device_bytes = 0;   ///< of a GPU's memory: the map, the images, scratch
  Device device = Device::threads;  ///< that drew
  std::string device_why;  ///< why Device::automatic took it, or why not the one that was asked for
  std::vector<StageTime> stages;
  double frame_ms = 0;
  Isa isa = Isa::scalar;
};

}  // namespace rastrum::terrain
