// The camera of the mesh viewer as a state machine: events and time in, camera out.
#pragma once

#include <set>
#include <span>
#include <string>

#include <rastrum/camera.hpp>

#include "event.hpp"
#include "job/camera.hpp"

namespace rastrum::cli::window {

class MeshControl {
 public:
  /// `home`: the camera to begin with, returned as it is until something moves it.
  /// `follow_planes`: near and far are set for the scene as the camera moves; else they stay.
  MeshControl(const Camera& home, const BoundingSphere& scene, bool follow_planes);

  /// The window's size in pixels, for how far a drag reaches.
  void resize(int width, int height);
  void handle(const Event& event);
  /// Moves by what is held. Speeds are per second, so that the way does not depend on the frame
  /// rate.
  void advance(double dt_s);
  void go_home();
  /// Stands where `camera` stands, as a replayed path does; home stays.
  void place(const Camera& camera);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  /// Whether a key that moves is held or a drag is on: the next picture will differ.
  [[nodiscard]] bool moving() const;
  /// Counts the changes of the camera.
  [[nodiscard]] unsigned long version() const { return version_; }

  [[nodiscard]] static std::span<const KeyHelp> keys();

 private:
  struct Axes {
    Vec3d right, up, back;  ///< of the camera, orthonormal
  };
  [[nodiscard]] Axes axes() const;
  [[nodiscard]] bool held(const char* key) const { return held_.contains(key); }
  void orbit(double yaw_rad, double pitch_rad);
  void look(double yaw_rad, double pitch_rad);
  void shift(const Vec3d& by);
  void pan(double dx_px, double dy_px);
  void zoom(double factor);
  void drag(double dx_px, double dy_px);
  void update();
  static Vec3d rotated(const Vec3d& v, const Vec3d& up, double yaw_rad, double pitch_rad);

  enum class Drag { none, orbit, pan, look };

  Camera home_, camera_;
  BoundingSphere scene_;
  bool follow_planes_;
  Vec3d eye_, target_, up_;
  double width_ = 1280, height_ = 720;
  std::set<std::string, std::less<>> held_;
  bool fast_ = false;
  Drag drag_ = Drag::none;
  double x_ = 0, y_ = 0;
  unsigned long version_ = 0;
};

}  // namespace rastrum::cli::window
