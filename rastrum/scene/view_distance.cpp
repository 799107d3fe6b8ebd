#include <rastrum/camera.hpp>

#include <cassert>
#include <cmath>
#include <limits>

namespace rastrum {

double view_distance(const Camera& camera, float depth) {
  assert(!camera.matrix);
  if (!(depth > 0)) return std::numeric_limits<double>::infinity();
  const double d = depth, n = camera.near_plane, f = camera.far_plane;
  if (camera.orthographic) return f - d * (f - n);
  return std::isinf(f) ? n / d : n * f / (d * (f - n) + n);
}

}  // namespace rastrum
