// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/overlay/effects/lens.hpp>

#include <cmath>
#include <optional>

#include <rastrum/core/reject.hpp>
#include <rastrum/mat.hpp>

namespace rastrum::overlay {

Lens lens_of(const Camera& camera, int width, int height) {
  const std::optional<Mat4d> to_world = inverse(world_to_camera(camera));
  if (!to_world) reject("effects: the camera's matrix is singular");
  const Mat4d p = world_to_clip(camera, width, height) * *to_world;
  // w is −z · k or a constant k. Other terms are rounding of the composition.
  const auto& w = p.m[3];
  Lens lens;
  lens.perspective = std::fabs(w[2]) > std::fabs(w[3]);
  const double k = lens.perspective ? -w[2] : w[3], small = 1e-6 * std::fabs(k);
  if (!(k != 0) || std::fabs(w[0]) > small || std::fabs(w[1]) > small ||
      (lens.perspective ? false : std::fabs(w[2]) > small))
    reject("effects: planes of equal depth of the camera's matrix are not across its axis");
  // x_clip = m00 x + m01 y + m02 z + m03, y likewise. In perspective x = u d, z = −d and w = k d.
  const double along = lens.perspective ? -1 : 0;
  const double m00 = p.m[0][0] / k, m01 = p.m[0][1] / k, m11 = p.m[1][1] / k;
  const double m0 = (along != 0 ? along * p.m[0][2] : p.m[0][3]) / k,
               m1 = (along != 0 ? along * p.m[1][2] : p.m[1][3]) / k;
  if (m00 == 0 || m11 == 0) reject("effects: the camera's matrix is singular");
  // NDC is 2 x / W − 1 and 1 − 2 y / H.
  lens.vy = -2.0 / height / m11;
  lens.v0 = (1 - m1) / m11;
  lens.ux = 2.0 / width / m00;
  lens.uy = -m01 * lens.vy / m00;
  lens.u0 = (-1 - m0 - m01 * lens.v0) / m00;
  return lens;
}

}  // namespace rastrum::overlay
