// SPDX-License-Identifier: BSD-3-Clause
// Edges of visible triangles: each pixel draws the sides of the triangle that its id names. A
// hidden triangle has no pixel, so no depth is compared and no offset is needed. Two faces in view
// each draw half of a shared side.
#include <rastrum/overlay/effects/edges.hpp>

#include <algorithm>
#include <cmath>

#include <rastrum/core/reject.hpp>

namespace rastrum::overlay {

void check_edge_width(double width_px) {
  if (!(width_px > 0 && width_px <= 64))
    reject("the width of edges must lie in (0, 64] px, got ", width_px);
}

void TriangleSides::find(std::int64_t id) {
  id_ = id;
  count_ = 0;
  if (id < 0) return;
  const SceneEdges::Place place = edges_.find(id);
  const std::uint8_t drawn = edges_.sides(place);
  if (drawn == 0) return;
  const InstanceView& instance = edges_.scene().instances[place.instance];
  if (place.instance != instance_) {
    instance_ = place.instance;
    object_to_clip_ = to_clip_ * instance.object_to_world;
  }
  const MeshView& mesh = *instance.mesh();
  std::uint32_t vertex[3];
  mesh.read_triangles(static_cast<std::size_t>(place.primitive), 1, vertex);
  // Homogeneous positions in the picture (px), also behind the eye. The line through two of them is
  // their cross product.
  Vec3d corner[3];
  for (int c = 0; c < 3; ++c) {
    const Vec3d p = mesh.positions.wide(vertex[c]);
    const auto row = [&](int i) {
      const auto& m = object_to_clip_.m[i];
      return ((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3];
    };
    const double x = row(0), y = row(1), w = row(3);
    corner[c] = {(x + w) * (0.5 * width_), (w - y) * (0.5 * height_), w};
  }
  for (int c = 0; c < 3; ++c) {
    if ((drawn >> c & 1) == 0) continue;
    const Vec3d line = cross(corner[c], corner[(c + 1) % 3]);
    const double scale = std::sqrt(line.x * line.x + line.y * line.y);
    // Both ends coincide: no line.
    if (!(scale > 0) || !std::isfinite(scale)) continue;
    line_[count_++] = {line.x / scale, line.y / scale, line.z / scale};
  }
}

float TriangleSides::factor(std::int64_t id, int x, int y) {
  if (id != id_) find(id);
  double covered = 0;
  for (int i = 0; i < count_; ++i) {
    const Vec3d& l = line_[i];
    const double away = std::fabs((l.x * (x + 0.5) + l.y * (y + 0.5)) + l.z);
    covered = std::max(covered, std::min(half_px_ + 0.5 - away, 1.0));
  }
  return static_cast<float>(1 - covered);
}

}  // namespace rastrum::overlay
