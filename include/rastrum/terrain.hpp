// SPDX-License-Identifier: BSD-3-Clause
// Voxel space: draws a terrain from samples along the columns of its picture, near to far
// (Freeman's patent of 1996; Macke's program; paper 3). docs/terrain_rules.md has the rules.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <rastrum/config.hpp>
#include <rastrum/device.hpp>
#include <rastrum/held.hpp>
#include <rastrum/image.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/stop.hpp>

namespace RASTRUM_API rastrum {
namespace terrain {

/// The ground beyond a map's edge: the map again, its mirror image, its outermost cells, or
/// nothing, as in a hole.
enum class Tiling : std::uint8_t { repeat, mirror, clamp, none };

/// The cell, in a map of `size` cells, to which coordinate `i` belongs; divisions are floored, not
/// truncated. With `none` it is the cell at the edge; is_beyond() tells that nothing is there.
[[nodiscard]] RASTRUM_HD inline std::int64_t tiled(std::int64_t i, std::int64_t size,
                                                   Tiling tiling) {
  if (static_cast<std::uint64_t>(i) < static_cast<std::uint64_t>(size)) return i;
  const auto modulo = [](std::int64_t a, std::int64_t n) {
    const std::int64_t r = a % n;
    return r < 0 ? r + n : r;
  };
  if (tiling == Tiling::repeat) return modulo(i, size);
  if (tiling == Tiling::clamp || tiling == Tiling::none) return i < 0 ? 0 : i < size ? i : size - 1;
  const std::int64_t m = modulo(i, 2 * size);
  return m < size ? m : 2 * size - 1 - m;
}

/// Whether a map of `size` cells has nothing at coordinate `i`.
[[nodiscard]] RASTRUM_HD inline bool is_beyond(std::int64_t i, std::int64_t size, Tiling tiling) {
  return tiling == Tiling::none &&
         static_cast<std::uint64_t>(i) >= static_cast<std::uint64_t>(size);
}

/// A terrain of cells; row 0 is north (−y), columns go east.
struct HeightMap {
  Image<float> heights{};  ///< in cells; NaN is a hole, through which one sees what lies behind
  Image<Rgba8> colors{};   ///< of any size, stretched over the map; empty: grey by height
};

/// A terrain without cells: functions of places in the plane. Both are called from several threads
/// at once, for n samples of a row of the picture; coordinates may be any finite numbers.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual void heights(const double* x, const double* y, std::size_t n, float* out) const = 0;
  virtual void colors(const double* x, const double* y, std::size_t n, Rgba8* out) const = 0;
};

class RASTRUM_INSIDE LitFunction;

/// A terrain to look at. It never changes, is cheap to copy (a move is a copy), and threads may
/// share it.
class Terrain {
 public:
  Terrain(const Terrain&) = default;
  Terrain& operator=(const Terrain&) = default;
  /// Takes over the map. Throws Error{invalid_argument} if it has no cell. O(cells).
  explicit Terrain(HeightMap map);
  explicit Terrain(Shared<const Surface> surface);
  /// The terrain of a function with its light (function_terrain, terrain_light.hpp).
  explicit Terrain(Shared<const LitFunction> function);

  /// A terrain of `float height(double x, double y)` and `Rgba8 color(double x, double y)`.
  template <class Height, class Color>
  [[nodiscard]] static Terrain of(Height height, Color color);

  /// The same heights under other colours, of any size: a map's light, for one. O(1) beside the
  /// move. Throws Error{invalid_argument} for a terrain that is no map, and for empty colours.
  [[nodiscard]] Terrain with_colors(Image<Rgba8> colors) const;

  [[nodiscard]] bool is_map() const { return surface_ == nullptr; }
  /// The map's heights, and its colours; both require is_map().
  [[nodiscard]] const Shared<const Image<float>>& heights() const { return heights_; }
  [[nodiscard]] const Shared<const Image<Rgba8>>& colors() const { return colors_; }
  /// The largest height of a map, NaN left out; −inf where there is none. +inf for functions.
  [[nodiscard]] float highest() const { return highest_; }
  /// The functions. Throws Error{invalid_argument} for a map.
  [[nodiscard]] const Surface& surface() const;
  /// The surface, if function_terrain made it; else null.
  [[nodiscard]] const LitFunction* lit_function() const { return lit_function_; }

  /// The height at a point, unfiltered; NaN in a hole.
  [[nodiscard]] float height_at(double x, double y, Tiling tiling = Tiling::repeat) const;
  /// The colour at a point, unfiltered.
  [[nodiscard]] Rgba8 color_at(double x, double y, Tiling tiling = Tiling::repeat) const;

 private:
  Shared<const Image<float>> heights_;
  Shared<const Image<Rgba8>> colors_;
  Shared<const Surface> surface_;
  const LitFunction* lit_function_ = nullptr;
  float highest_ = 0;
};

template <class Height, class Color>
Terrain Terrain::of(Height height, Color color) {
  class Functions final : public Surface {
   public:
    Functions(Height h, Color c) : height_(std::move(h)), color_(std::move(c)) {}
    void heights(const double* x, const double* y, std::size_t n, float* out) const override {
      for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<float>(height_(x[i], y[i]));
    }
    void colors(const double* x, const double* y, std::size_t n, Rgba8* out) const override {
      for (std::size_t i = 0; i < n; ++i) out[i] = color_(x[i], y[i]);
    }

   private:
    Height height_;
    Color color_;
  };
  return Terrain(Shared<const Surface>(
      Owner<const Surface>(new Functions(std::move(height), std::move(color)))));
}

// The options of a picture of a terrain, and its results beside the images.

/// Where one stands and looks. The view is always level: looking up or down shifts the horizon.
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

struct RASTRUM_INSIDE AddedMethod;

enum class Projection : std::uint8_t {
  planar,  ///< columns are equal steps on a plane, as lenses draw: straight lines stay straight
  cylindrical,  ///< columns are equal angles: nothing is stretched at wide angles, up to 360°
};

/// Colours fade to `color` by 1 − exp(−density · (distance − start)); density 0: there is no fog.
struct Fog {
  double density = 0;            ///< per cell
  double start = 0;              ///< cells
  std::optional<Rgba8> color{};  ///< none: the sky's

  bool operator==(const Fog&) const = default;
};

inline constexpr Rgba8 kSky{0x90, 0x90, 0xE0, 255};

/// How one frame is to look, and what draws it.
struct TerrainOptions {
  int width = 1280, height = 720;
  double distance = 800;  ///< cells; how far samples are taken, up to 8e6
  /// Draws as the original program, bit for bit (docs/terrain_rules.md): float64, a scale of 240
  /// rows, 90°, 10 above the ground, steps of 1, 1.005, …. Field of view, scale, steps, projection,
  /// filter and ground clearance must then stand at their defaults, and tiling `none` is refused.
  bool classic = false;
  double fov_rad = std::numbers::pi / 2;  ///< across; below π for planar, up to 2π for cylindrical
  /// Rows that a height of 1 takes at distance 1, up to 1e7; 0: as many as columns that a width of
  /// 1 takes in the picture's middle.
  double scale_px = 0;
  /// Samples are taken at the distances 1, 1 + step, …; each step is `dz` longer than the one
  /// before. Step 0 leaves them to the filter. `bilinear`, which has something to show within a
  /// cell, takes steps as long as a pixel is high at their distance (a share of it, so that `dz` is
  /// not used); the others take 1 and `dz`.
  double step = 1, dz = 0.005;
  MapFilter filter = MapFilter::none;
  Tiling tiling = Tiling::repeat;
  Projection projection = Projection::planar;
  Rgba8 sky = kSky;
  Fog fog{};
  /// Before a frame the camera is lifted to at least this height above the ground under it; none:
  /// it stays where it is, under the ground too. `classic` always takes 10.
  std::optional<double> ground_clearance{};
  /// Another way to draw the same picture: rastrum/family.hpp has paper 3's. Null: Rastrum's own.
  const AddedMethod* added = nullptr;
};

/// Throws Error{invalid_argument} that names what is out of range. Each frame begins with this
/// check.
void check(const TerrainOptions& options);

/// Options of a renderer, which hold for all its frames.
struct TerrainRendererOptions {
  Device device = Device::threads;
  int threads = 0;           ///< 0: all
  std::optional<Isa> isa{};  ///< none: the best this machine has

  bool operator==(const TerrainRendererOptions&) const = default;
};

/// Images to fill; an empty view is not computed. All must have the frame's size.
struct TerrainTargets {
  ImageView<Rgba8> color8{};
  ImageView<float> depth{};  ///< distance along the view (cells), +inf where the sky is
};

/// The result of a frame beside its picture.
struct TerrainStats {
  TerrainCamera camera;             ///< as drawn: lifted from the ground where that was asked for
  std::uint64_t slices = 0;         ///< distances at which each column may be sampled
  std::uint64_t samples = 0;        ///< heights read; what is left out varies a little with where
                                    ///< the targets lie in memory
  std::uint64_t visible = 0;        ///< samples that were drawn
  std::uint64_t peak_bytes = 0;     ///< scratch and pyramids, beyond the terrain and the images
  std::uint64_t device_bytes = 0;   ///< a GPU's memory for the map, the images, scratch
  Device device = Device::threads;  ///< the one that drew
  std::string device_why;  ///< why Device::automatic took it, or why it is not the one asked for
  std::vector<StageTime> stages;
  double frame_ms = 0;
  Isa isa = Isa::scalar;
};

/// Draws frames, each with its own options. It keeps threads, scratch and pyramids between frames,
/// and with Device::cuda the map that was drawn last in the device's memory. Terrains that a device
/// cannot draw, such as a caller's function, are drawn by the CPU's threads, and
/// TerrainStats::device_why says so.
///
/// Threads and stopping: as Renderer (render.hpp). Calls from several threads are drawn one
/// after the other; a frame whose `stop` is asked to stop throws Stopped.
class TerrainRenderer {
 public:
  /// Throws Error{invalid_argument} that names an option out of range, Error{no_device}.
  explicit TerrainRenderer(TerrainRendererOptions options = {});
  ~TerrainRenderer();
  TerrainRenderer(TerrainRenderer&&) noexcept;
  TerrainRenderer& operator=(TerrainRenderer&&) noexcept;

  /// Fills `targets`. The picture depends on terrain, camera and options alone, not on
  /// TerrainOptions::added, the device, threads or instruction set.
  /// Cost: O(width · slices + width · height). Throws Error{invalid_argument} that names an option
  /// out of range, for a camera that is not finite or farther than 1e12 cells away, and for targets
  /// of another size; Error{out_of_memory} for a map that is too large for the CUDA device that was
  /// asked for.
  TerrainStats render(const Terrain& terrain, const TerrainCamera& camera,
                      const TerrainOptions& frame, const TerrainTargets& targets,
                      StopToken stop = {});

  /// The options, with the device that Device::automatic took.
  [[nodiscard]] const TerrainRendererOptions& options() const;

 private:
  struct RASTRUM_INSIDE Impl;
  Held<Owner<Impl>> impl_;
};

/// The height of the ground at a point as it is drawn near by: that of the cell or, with
/// MapFilter::bilinear, one between the centres of four cells; NaN in a hole.
[[nodiscard]] double ground_at(const Terrain& terrain, double x, double y,
                               const TerrainOptions& options);

/// The camera, lifted to `clearance` above the ground under it if it was lower.
[[nodiscard]] TerrainCamera above_ground(const Terrain& terrain, const TerrainCamera& camera,
                                         double clearance, Tiling tiling = Tiling::repeat);

// The matrix that takes points of the world to the pixels of the terrain's picture, so that meshes
// and sprites compose with it by depth.

/// Maps (x, height, y, 1), which is Rastrum's world with +y up and the map's rows along +z, to clip
/// space: x and y as everywhere (docs/conventions.md), depth z/w = near / distance, reversed, with
/// an infinite far plane. The horizon is a shear, the roll a rotation of the picture. A point on a
/// sample that is drawn falls into its column and on the upper edge of its first row; this holds
/// for the columns and rows of `classic` (W/2 across, 240 down), too. Throws
/// Error{invalid_argument} for the cylindrical projection, which is no matrix. Round the matrix to
/// float32 for draws; far from the map's corner give positions relative to the camera instead, and
/// a camera at 0, 0.
[[nodiscard]] Mat4d world_to_clip(const TerrainOptions& options, const TerrainCamera& camera,
                                  double near = 1);

/// The reversed depth that world_to_clip gives a distance: 0 at +inf, the sky.
[[nodiscard]] inline float reversed_depth(float distance, double near = 1) {
  return static_cast<float>(near / static_cast<double>(distance));
}

}  // namespace terrain
}  // namespace rastrum
