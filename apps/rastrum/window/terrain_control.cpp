// SPDX-License-Identifier: BSD-3-Clause
#include "terrain_control.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rastrum::cli::window {
namespace {

// Per second of a held key. The original program also moves some 90 cells per second.
constexpr double kMove = 90;                     // cells
constexpr double kTurn = 1;                      // rad
constexpr double kHorizon = 0.5;                 // heights of the window
constexpr double kClimb = 90;                    // cells
constexpr double kDistance = 2;                  // factor
constexpr double kFov = std::numbers::pi / 6;    // rad
constexpr double kSunTurn = 45, kSunClimb = 15;  // degrees
constexpr double kRoll = 0.5;                    // rad
constexpr double kLeastDistance = 10, kMostDistance = 1e6;
constexpr double kLeastFov = 0.1, kMostFov = 3;  // rad; a planar picture ends before π

constexpr KeyHelp kTerrainControlKeys[] = {
    {"w, s", "move forward, back"},
    {"a, d", "turn left, right"},
    {"q, e", "look up, down (horizon)"},
    {"r, f", "height up, down"},
    {"up, down", "see farther, less far"},
    {"o, l", "wider, narrower field of view"},
    {"u, j", "sun higher, lower"},
    {"n, m", "sun left, right"},
    {"left, right", "roll"},
    {"left shift, right shift", "held: four times as fast"},
    {"home", "back to the beginning"},
};

}  // namespace

std::span<const KeyHelp> TerrainControl::keys() {
  return kTerrainControlKeys;
}

TerrainControl::TerrainControl(const TerrainPose& home) : home_(home), pose_(home) {}

void TerrainControl::place(const TerrainPose& pose) {
  pose_ = pose;
  ++version_;
}

void TerrainControl::resize(int, int height) {
  if (height_ > 0 && height != height_) {
    home_.camera.horizon_px *= height / height_;
    pose_.camera.horizon_px *= height / height_;
    ++version_;
  }
  height_ = height;
}

/// The view follows the pointer: the horizon exactly, the angle about as fast.
void TerrainControl::drag(double dx_px, double dy_px) {
  pose_.camera.angle_rad += dx_px * pose_.fov_rad / std::max(height_ * 1.5, 1.0);
  pose_.camera.horizon_px += dy_px;
  ++version_;
}

void TerrainControl::wheel(double notches) {
  pose_.camera.altitude += notches * kClimb / 10;
  ++version_;
}

void TerrainControl::advance(double dt_s) {
  const TerrainPose before = pose_;
  terrain::TerrainCamera& c = pose_.camera;
  const double t = dt_s * pace();
  c.angle_rad += way("a", "d") * kTurn * t;
  const double step = way("w", "s") * kMove * t;
  c.x -= std::sin(c.angle_rad) * step;
  c.y -= std::cos(c.angle_rad) * step;
  c.horizon_px += way("q", "e") * kHorizon * height_ * t;
  c.altitude += way("r", "f") * kClimb * t;
  c.roll_rad += way("left", "right") * kRoll * t;
  // Values from a file or a person may exceed the range of keys, until a key is held.
  if (const double w = way("up", "down"); w != 0)
    pose_.distance =
        std::clamp(pose_.distance * std::pow(kDistance, w * t), kLeastDistance, kMostDistance);
  if (const double w = way("o", "l"); w != 0)
    pose_.fov_rad = std::clamp(pose_.fov_rad + w * kFov * t, kLeastFov, kMostFov);
  pose_.sun.azimuth_deg =
      std::fmod(pose_.sun.azimuth_deg + way("m", "n") * kSunTurn * t + 360, 360);
  pose_.sun.elevation_deg =
      std::clamp(pose_.sun.elevation_deg + way("u", "j") * kSunClimb * t, -90.0, 90.0);
  const bool changed = !(c == before.camera) || pose_.distance != before.distance ||
                       pose_.fov_rad != before.fov_rad ||
                       pose_.sun.azimuth_deg != before.sun.azimuth_deg ||
                       pose_.sun.elevation_deg != before.sun.elevation_deg;
  if (changed) ++version_;
}

}  // namespace rastrum::cli::window
