// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_control.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rastrum::cli::window {
namespace {

constexpr double kFlySpeed = 0.5;   ///< scene radii per second
constexpr double kTurnSpeed = 1.5;  ///< rad per second
constexpr double kZoomSpeed = 2;    ///< factor per second
constexpr double kWheelZoom = 1.15;
constexpr double kPole = 0.01;  ///< rad between the view and straight up or down

constexpr KeyHelp kMeshControlKeys[] = {
    {"w, s", "fly forward, back"},     {"a, d", "fly left, right"},
    {"q, e", "fly down, up"},          {"left, right, up, down", "orbit"},
    {"=, -", "zoom in, out"},          {"left shift, right shift", "held: four times as fast"},
    {"home", "back to the beginning"},
};

}  // namespace

std::span<const KeyHelp> MeshControl::keys() {
  return kMeshControlKeys;
}

MeshControl::MeshControl(const Camera& home, const BoundingSphere& scene, bool follow_planes)
    : home_(home), scene_(scene), follow_planes_(follow_planes) {
  go_home();
}

void MeshControl::go_home() {
  place(home_);
}

void MeshControl::place(const Camera& camera) {
  camera_ = camera;
  eye_ = camera.eye;
  target_ = camera.target;
  up_ = normalize(camera.up);
  ++version_;
}

void MeshControl::resize(int width, int height) {
  width_ = std::max(width, 1);
  height_ = std::max(height, 1);
}

MeshControl::Axes MeshControl::axes() const {
  const Vec3d back = normalize(eye_ - target_);
  const Vec3d right = normalize(cross(up_, back));
  return {right, cross(back, right), back};
}

/// Turns `v` about `up`, then towards it (pitch > 0) without reaching it.
Vec3d MeshControl::rotated(const Vec3d& v, const Vec3d& up, double yaw_rad, double pitch_rad) {
  const double size = length(v), along = dot(v, up) / size;
  const Vec3d across = v * (1 / size) - up * along;
  const double flat_length = length(across);
  const Vec3d flat = across * (1 / flat_length), side = cross(up, flat);
  const double limit = std::numbers::pi / 2 - kPole;
  const double pitch = std::clamp(std::atan2(along, flat_length) + pitch_rad, -limit, limit);
  const Vec3d turned = flat * std::cos(yaw_rad) + side * std::sin(yaw_rad);
  return (turned * std::cos(pitch) + up * std::sin(pitch)) * size;
}

void MeshControl::orbit(double yaw_rad, double pitch_rad) {
  eye_ = target_ + rotated(eye_ - target_, up_, yaw_rad, pitch_rad);
}

void MeshControl::look(double yaw_rad, double pitch_rad) {
  target_ = eye_ + rotated(target_ - eye_, up_, yaw_rad, pitch_rad);
}

void MeshControl::shift(const Vec3d& by) {
  eye_ = eye_ + by;
  target_ = target_ + by;
}

/// Points as far away as the target stay under the pointer.
void MeshControl::pan(double dx_px, double dy_px) {
  const double distance = length(eye_ - target_);
  const double across = camera_.orthographic ? double{camera_.orthographic_height}
                                             : 2 * distance * std::tan(double{camera_.fov_rad} / 2);
  const double unit = across / std::min(width_, height_);
  const Axes a = axes();
  shift((a.up * dy_px - a.right * dx_px) * unit);
}

/// `factor` > 1 comes nearer; a parallel projection shows less instead. Nothing is visible beyond
/// the bounds.
void MeshControl::zoom(double factor) {
  constexpr double kNearest = 1e-4, kFarthest = 1e4;  // scene radii
  const double r = scene_.radius;
  if (camera_.orthographic) {
    const double height = double{camera_.orthographic_height} / factor;
    camera_.orthographic_height =
        static_cast<float>(std::clamp(height, kNearest * r, kFarthest * r));
    return;
  }
  const Vec3d offset = eye_ - target_;
  const double distance = length(offset);
  const double scale = std::clamp(distance / factor, kNearest * r, kFarthest * r) / distance;
  eye_ = target_ + offset * scale;
}

void MeshControl::update() {
  camera_.eye = eye_;
  camera_.target = target_;
  if (follow_planes_) place_planes(camera_, scene_);
  ++version_;
}

void MeshControl::drag(double dx_px, double dy_px) {
  // The smaller side of the window is half a turn.
  const double turn = std::numbers::pi / std::min(width_, height_);
  if (drag_ == Drag::pan)
    pan(dx_px, dy_px);
  else if (drag_ == Drag::orbit)
    orbit(-dx_px * turn, dy_px * turn);
  else
    look(-dx_px * turn / 2, -dy_px * turn / 2);
  update();
}

void MeshControl::begin_drag(const Event& press) {
  if (press.button == Button::right)
    drag_ = Drag::look;
  else
    drag_ = press.button == Button::middle || press.shift ? Drag::pan : Drag::orbit;
}

void MeshControl::wheel(double notches) {
  zoom(std::pow(kWheelZoom, notches));
  update();
}

void MeshControl::advance(double dt_s) {
  const double forward = way("w", "s"), right = way("d", "a"), up = way("e", "q");
  const double yaw = way("right", "left"), pitch = way("up", "down"), nearer = way("=", "-");
  if (forward == 0 && right == 0 && up == 0 && yaw == 0 && pitch == 0 && nearer == 0) return;
  const double t = dt_s * pace();
  if (forward != 0 || right != 0 || up != 0) {
    const Axes a = axes();
    const double step = t * kFlySpeed * scene_.radius;
    shift((a.right * right + up_ * up - a.back * forward) * step);
    // A parallel projection looks the same from everywhere along its axis.
    if (camera_.orthographic && forward != 0) zoom(std::pow(kZoomSpeed, forward * t));
  }
  if (yaw != 0 || pitch != 0) orbit(yaw * t * kTurnSpeed, pitch * t * kTurnSpeed);
  if (nearer != 0) zoom(std::pow(kZoomSpeed, nearer * t));
  update();
}

}  // namespace rastrum::cli::window
