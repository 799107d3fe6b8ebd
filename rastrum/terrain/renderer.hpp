// Voxel space: the picture of a terrain from the samples along its columns, near to far (Freeman's
// patent of 1996; Macke's program; paper 3). docs/terrain.md has the rules.
#pragma once

#include <memory>
#include <stop_token>

#include <rastrum/core/mat.hpp>
#include <rastrum/terrain/options.hpp>
#include <rastrum/terrain/terrain.hpp>

namespace rastrum::terrain {

/// Draws frames with one set of options; keeps threads, scratch and pyramids between frames, and
/// with Device::cuda the map that was drawn last in the device's memory. What a device cannot draw,
/// a caller's function for one, is drawn by the CPU's threads, and TerrainStats::device_why says
/// so.
///
/// Threads and stopping: as Renderer (render/render.hpp). Calls from several threads are drawn one
/// after the other; a frame whose `stop` is asked to stop throws parallel::Stopped.
class TerrainRenderer {
 public:
  /// Throws Error{invalid_argument} that names an option out of range, Error{no_device}.
  explicit TerrainRenderer(TerrainOptions options);
  ~TerrainRenderer();
  TerrainRenderer(TerrainRenderer&&) noexcept;
  TerrainRenderer& operator=(TerrainRenderer&&) noexcept;

  /// Fills `targets`. The picture depends on terrain, camera and options alone: not on the method
  /// (but for MapFilter and cells that are the same), device, threads or instruction set.
  /// Cost: O(width · slices + width · height). Throws Error{invalid_argument} for a camera that is
  /// not finite or farther than 1e12 cells away, or targets of another size;
  /// Error{out_of_memory} for a map that is too large for the CUDA device that was asked for.
  TerrainStats render(const Terrain& terrain, const TerrainCamera& camera,
                      const TerrainTargets& targets, std::stop_token stop = {});

  [[nodiscard]] const TerrainOptions& options() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The height of the ground at a point as it is drawn near by: of the cell, between the centres of
/// four with MapFilter::bilinear; NaN in a hole.
[[nodiscard]] double ground_at(const Terrain& terrain, double x, double y,
                               const TerrainOptions& options);

/// The camera as it stands `clearance` above the ground under it, if it was lower.
[[nodiscard]] TerrainCamera above_ground(const Terrain& terrain, const TerrainCamera& camera,
                                         double clearance, Tiling tiling = Tiling::repeat);

}  // namespace rastrum::terrain
