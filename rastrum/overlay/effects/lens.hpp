// SPDX-License-Identifier: BSD-3-Clause
// From a pixel and its distance back to the camera's axes, for cameras of any kind.
#pragma once

#include <rastrum/camera.hpp>

namespace rastrum::overlay {

/// The point of pixel (x, y) at distance d along the view axis, in the camera's axes: (u, v, −1) ·
/// d in perspective, else (u, v, −d), with u = (ux x + uy y) + u0 and v = vy y + v0, x and y at the
/// pixel's centre.
struct Lens {
  bool perspective = true;
  double ux = 0, uy = 0, u0 = 0, vy = 0, v0 = 0;
};

/// Throws Error{invalid_argument} where depth does not tell the distance along the axis.
[[nodiscard]] Lens lens_of(const Camera& camera, int width, int height);

}  // namespace rastrum::overlay
