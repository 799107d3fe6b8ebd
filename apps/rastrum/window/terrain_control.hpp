// SPDX-License-Identifier: BSD-3-Clause
// The camera and the sun of the terrain viewer, with the keys of paper 3's program. Speeds are per
// second, not per frame.
#pragma once

#include <span>

#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "camera_control.hpp"

namespace rastrum::cli::window {

/// Everything that held keys change.
struct TerrainPose {
  terrain::TerrainCamera camera;
  double distance = 800;  ///< cells
  double fov_rad = 1.5707963267948966;
  terrain::Sun sun;
};

class TerrainControl final : public CameraControl {
 public:
  explicit TerrainControl(const TerrainPose& home);

  /// The horizon keeps its share of the height.
  void resize(int width, int height);
  void advance(double dt_s);
  void go_home() override { place(home_); }
  void place(const TerrainPose& pose);

  [[nodiscard]] const TerrainPose& pose() const { return pose_; }
  [[nodiscard]] bool moving() const { return moves(keys()); }

  [[nodiscard]] static std::span<const KeyHelp> keys();

 private:
  void drag(double dx_px, double dy_px) override;
  void wheel(double notches) override;

  TerrainPose home_, pose_;
  double height_ = 0;  ///< px; 0: unknown
};

}  // namespace rastrum::cli::window
