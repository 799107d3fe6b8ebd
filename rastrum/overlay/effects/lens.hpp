// SPDX-License-Identifier: BSD-3-Clause
// From a pixel and its distance back to camera space.
#pragma once

#include <rastrum/camera.hpp>

namespace rastrum::overlay {

/// The point of pixel (x, y) (its centre) at distance d along the view axis, in camera space: (u,
/// v, −1) · d in perspective, else (u, v, −d), with u = (ux x + uy y) + u0 and v = vy y + v0.
struct Lens {
  bool perspective = true;
  double ux = 0, uy = 0, u0 = 0, vy = 0, v0 = 0;
};

/// Throws Error{invalid_argument} if depth does not determine the distance along the axis.
[[nodiscard]] Lens lens_of(const Camera& camera, int width, int height);

}  // namespace rastrum::overlay
