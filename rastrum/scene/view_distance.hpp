// SPDX-License-Identifier: BSD-3-Clause
// The distance along a camera's axis by reversed depth, with all that does not change from pixel to
// pixel found once.
#pragma once

#include <limits>

#include <rastrum/camera.hpp>

namespace rastrum {

/// view_distance of each kind of camera is a fraction of two lines of depth, (p − d q) / (d r + s)
/// in this order, where what a kind has not is 0 or 1: that changes no bit.
struct DistanceByDepth {
  double p = 0, q = 0, r = 0, s = 1;

  [[nodiscard]] double operator()(float depth) const {
    if (!(depth > 0)) return std::numeric_limits<double>::infinity();
    const double d = depth;
    return (p - d * q) / (d * r + s);
  }
};

/// Throws as view_distance does.
[[nodiscard]] DistanceByDepth distance_by_depth(const Camera& camera);

}  // namespace rastrum
