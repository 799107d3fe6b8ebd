// SPDX-License-Identifier: BSD-3-Clause
// Draws the environment around a terrain, where its picture has no ground.
#include <rastrum/on_terrain.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/render/around.hpp>
#include <rastrum/render/terrain_camera.hpp>
#include <rastrum/terrain/roll.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum {
namespace {

void check_around(std::span<const Light> lights, const ToneMapping& tone) {
  check_lights(lights);
  check_tone(tone);
  if (!has_environment(lights))
    reject("the lights have no environment that could be seen behind the ground");
}

class TerrainRays {
 public:
  TerrainRays(const terrain::TerrainOptions& options, const terrain::TerrainCamera& camera) {
    if (options.projection == terrain::Projection::planar) {
      planar_ = raster::ViewRays::of(terrain_lens(options, camera), options.width, options.height);
      return;
    }
    upright_ = terrain::upright_of(options, camera);
    roll_.emplace(camera.roll_rad, options.width, options.height);
    scale_px_ = terrain::scale_px(upright_->options);
    if (camera.roll_rad == 0)
      for (int x = 0; x < options.width; ++x)
        columns_.push_back(turn(roll_->position(options.width, options.height, x, 0).x));
  }

  [[nodiscard]] Vec3 at(int x, int y) const {
    if (planar_)
      return planar_->d + planar_->dx * (static_cast<float>(x) + 0.5F) +
             planar_->dy * (static_cast<float>(y) + 0.5F);
    // Columns are equal angles, rows equal heights on a cylinder.
    const terrain::TerrainOptions& o = upright_->options;
    const terrain::TerrainCamera& c = upright_->camera;
    const terrain::Roll::Position p = roll_->position(o.width, o.height, x, y);
    const auto [sin, cos] = columns_.empty() ? turn(p.x) : columns_[static_cast<std::size_t>(x)];
    return Vec3(Vec3d{-sin, (c.horizon_px - p.y) / scale_px_, -cos});
  }

 private:
  /// `x_px`: in the upright picture.
  [[nodiscard]] elementary::SinCos turn(double x_px) const {
    return elementary::sin_cos(upright_->camera.angle_rad -
                               (x_px / upright_->options.width - 0.5) * upright_->options.fov_rad);
  }

  std::optional<raster::ViewRays> planar_;
  std::optional<terrain::Upright> upright_;
  std::optional<terrain::Roll> roll_;
  double scale_px_ = 1;
  std::vector<elementary::SinCos> columns_;  ///< unless the picture is rolled: a turn per column
};

}  // namespace

void draw_environment_behind(std::span<const Light> lights, const ToneMapping& tone,
                             const terrain::TerrainOptions& options,
                             const terrain::TerrainCamera& camera,
                             const terrain::TerrainTargets& picture, int threads) {
  const FloatScope floats;
  check_around(lights, tone);
  terrain::check(options);
  terrain::check(camera);
  if (picture.depth.empty())
    reject(
        "an environment is drawn where a terrain's picture has no ground, which its depth "
        "says: draw it with TerrainTargets::depth");
  check_size(picture.depth, options.width, options.height, "the depth target");
  check_size(picture.color8, options.width, options.height, "the color8 target");
  if (picture.color8.empty()) return;
  const Around around(lights, tone, terrain_camera(camera), options.width, options.height);
  const TerrainRays rays(options, camera);
  parallel::Threads exec(threads);
  parallel::for_each_index(
      exec, static_cast<std::size_t>(options.height),
      [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < options.width; ++x) {
          if (!std::isinf(picture.depth(x, y))) continue;
          const Vec3 c = around.shown(around.light(rays.at(x, y)));
          picture.color8(x, y) = raster::to_straight_rgba8({c.x, c.y, c.z, 1});
        }
      },
      8);
}

Rgba8 horizon_color(std::span<const Light> lights, const ToneMapping& tone,
                    const terrain::TerrainCamera& camera) {
  const FloatScope floats;
  check_around(lights, tone);
  const Around around(lights, tone, terrain_camera(camera), 1, 1);
  constexpr int kDirections = 256;
  Vec3 sum;
  for (int i = 0; i < kDirections; ++i) {
    const auto [sin, cos] = elementary::sin_cos(i * (2 * std::numbers::pi / kDirections));
    sum = sum + around.light(Vec3(Vec3d{sin, 0, cos}));
  }
  const Vec3 c = around.shown(sum * (1.0F / kDirections));
  return raster::to_straight_rgba8({c.x, c.y, c.z, 1});
}

}  // namespace rastrum
