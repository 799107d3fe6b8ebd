// The camera and the sun of the terrain viewer as a state machine, with the keys of paper 3's
// program; unlike there, speeds are per second, not per frame.
#pragma once

#include <set>
#include <span>
#include <string>

#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "event.hpp"

namespace rastrum::cli::window {

/// All that keys change by and by.
struct TerrainPose {
  terrain::TerrainCamera camera;
  double distance = 800;  ///< cells
  double fov_rad = 1.5707963267948966;
  terrain::Sun sun;
};

class TerrainControl {
 public:
  explicit TerrainControl(const TerrainPose& home);

  /// The window's height in pixels; the horizon stays at the same part of it.
  void resize(int width, int height);
  void handle(const Event& event);
  void advance(double dt_s);
  void place(const TerrainPose& pose);

  [[nodiscard]] const TerrainPose& pose() const { return pose_; }
  [[nodiscard]] bool moving() const;
  [[nodiscard]] unsigned long version() const { return version_; }

  [[nodiscard]] static std::span<const KeyHelp> keys();

 private:
  [[nodiscard]] bool held(const char* key) const { return held_.contains(key); }
  [[nodiscard]] double way(const char* forth, const char* back) const {
    return static_cast<double>(held(forth)) - static_cast<double>(held(back));
  }

  TerrainPose home_, pose_;
  double height_ = 0;  ///< px; 0: not known yet
  std::set<std::string, std::less<>> held_;
  bool dragging_ = false;
  double x_ = 0, y_ = 0;
  unsigned long version_ = 0;
};

}  // namespace rastrum::cli::window
