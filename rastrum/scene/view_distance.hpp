// SPDX-License-Identifier: BSD-3-Clause
// The distance along a camera's axis by reversed depth, with all that pixels share found once.
#pragma once

#include <limits>

#include <rastrum/camera.hpp>

namespace rastrum {

/// Each kind of camera has the distance (p − d q) / (d r + s), in this order. Terms that a kind
/// lacks are 0 or 1, which changes no bit.
struct DistanceByDepth {
  double p = 0, q = 0, r = 0, s = 1;

  [[nodiscard]] double operator()(float depth) const {
    if (!(depth > 0)) return std::numeric_limits<double>::infinity();
    const double d = depth;
    return (p - d * q) / (d * r + s);
  }
};

[[nodiscard]] DistanceByDepth distance_by_depth(const Camera& camera);

}  // namespace rastrum
