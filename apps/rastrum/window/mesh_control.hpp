// SPDX-License-Identifier: BSD-3-Clause
// The camera of the mesh viewer: events and time in, camera out.
#pragma once

#include <span>

#include <rastrum/camera.hpp>

#include "camera_control.hpp"
#include "job/camera.hpp"

namespace rastrum::cli::window {

class MeshControl final : public CameraControl {
 public:
  /// `home`: the first camera, returned as it is until something moves it. `follow_planes`: near
  /// and far follow the scene as the camera moves.
  MeshControl(const Camera& home, const BoundingSphere& scene, bool follow_planes);

  /// In pixels, for the reach of a drag.
  void resize(int width, int height);
  /// Speeds are per second, so that the way does not depend on the frame rate.
  void advance(double dt_s);
  void go_home() override;
  /// For a replayed path; home stays.
  void place(const Camera& camera);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] bool moving() const { return moves(keys()); }

  [[nodiscard]] static std::span<const KeyHelp> keys();

 private:
  struct Axes {
    Vec3d right, up, back;  ///< of the camera, orthonormal
  };
  [[nodiscard]] Axes axes() const;
  void orbit(double yaw_rad, double pitch_rad);
  void look(double yaw_rad, double pitch_rad);
  void shift(const Vec3d& by);
  void pan(double dx_px, double dy_px);
  void zoom(double factor);
  void begin_drag(const Event& press) override;
  void drag(double dx_px, double dy_px) override;
  void wheel(double notches) override;
  void update();
  static Vec3d rotated(const Vec3d& v, const Vec3d& up, double yaw_rad, double pitch_rad);

  enum class Drag { orbit, pan, look };

  Camera home_, camera_;
  BoundingSphere scene_;
  bool follow_planes_;
  Vec3d eye_, target_, up_;
  double width_ = 1280, height_ = 720;
  Drag drag_ = Drag::orbit;  ///< of the last drag
};

}  // namespace rastrum::cli::window
