// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/projection.hpp"

#include <cmath>
#include <cstddef>

namespace rastrum::test {
namespace {

constexpr float kGuardMinPx = -32768.0F;
constexpr float kGuardMaxPx = 65536.0F;

bool in_guard_band(float px) {
  return px >= kGuardMinPx && px <= kGuardMaxPx;
}

}  // namespace

Mat4d object_to_clip(const Camera& camera, const Mat4d& object_to_world, int width, int height) {
  const Mat4d clip = world_to_clip(camera, width, height);
  Mat4d out;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += clip.m[i][k] * object_to_world.m[k][j];
      out.m[i][j] = sum;
    }
  }
  return out;
}

ClipVertex to_clip(const Mat4d& m, Vec3 p) {
  float row[4];
  bool finite = true;
  for (int i = 0; i < 4; ++i) {
    float sum = static_cast<float>(m.m[i][0]) * p.x;
    const float y = static_cast<float>(m.m[i][1]) * p.y;
    sum = sum + y;
    const float z = static_cast<float>(m.m[i][2]) * p.z;
    sum = sum + z;
    row[i] = sum + static_cast<float>(m.m[i][3]);
    finite = finite && std::isfinite(row[i]);
  }
  if (finite) return {row[0], row[1], row[2], row[3]};
  double wide[4];
  for (int i = 0; i < 4; ++i)
    wide[i] = m.m[i][0] * p.x + m.m[i][1] * p.y + m.m[i][2] * p.z + m.m[i][3];
  return {wide[0], wide[1], wide[2], wide[3]};
}

bool snap(const ClipVertex& c, int width, int height, SnappedVertex& out) {
  const auto x = static_cast<float>(c.x), y = static_cast<float>(c.y), z = static_cast<float>(c.z),
             w = static_cast<float>(c.w);
  if (!(w > 0) || !(w - z >= 0)) return false;
  const float half_w = 0.5F * static_cast<float>(width);
  const float half_h = 0.5F * static_cast<float>(height);
  const float inv_w = 1.0F / w;
  const float ndc_x = x * inv_w;
  const float ndc_y = y * inv_w;
  const float scaled_x = ndc_x * half_w;
  const float scaled_y = ndc_y * half_h;
  const float px = scaled_x + half_w;
  const float py = half_h - scaled_y;
  if (!in_guard_band(px) || !in_guard_band(py)) return false;
  // Times 256 is exact; the default rounding mode is to nearest even.
  out.x_fx8 = std::llrint(px * 256.0F);
  out.y_fx8 = std::llrint(py * 256.0F);
  out.depth = z * inv_w;
  return std::isfinite(out.depth);
}

std::vector<ProjectedTriangle> project(const SceneView& scene, const Camera& camera, int width,
                                       int height) {
  std::vector<ProjectedTriangle> out;
  std::int64_t id = 0;
  for (const InstanceView& instance : scene.instances) {
    const Mat4d m = object_to_clip(camera, instance.object_to_world, width, height);
    const MeshView& mesh = *instance.mesh();
    const auto axis = [&o = instance.object_to_world.m](int i) {
      return Vec3d{o[0][i], o[1][i], o[2][i]};
    };
    const bool mirrored = dot(cross(axis(0), axis(1)), axis(2)) < 0;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t, ++id) {
      ProjectedTriangle p;
      p.id = id;
      p.mirrored = mirrored;
      p.snapped.id = id;
      bool is_finite = true, whole = true;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t corner = 3 * t + c;
        const Vec3 position = mesh.positions[mesh.indices.empty() ? corner : mesh.indices[corner]];
        p.clip[c] = to_clip(m, position);
        is_finite = is_finite && std::isfinite(position.x) && std::isfinite(position.y) &&
                    std::isfinite(position.z);
        p.has_position[c] = snap(p.clip[c], width, height, p.snapped.v[c]);
        whole = whole && p.has_position[c];
      }
      p.fate = !is_finite ? Fate::dropped : whole ? Fate::whole : Fate::needs_clip;
      out.push_back(p);
    }
  }
  return out;
}

std::array<Real, 3> exact_weights(const ProjectedTriangle& t, int width, int height, int px,
                                  int py) {
  const Real x = px + Real(0.5), y = py + Real(0.5);
  std::array<Real, 3> out;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    if (t.fate == Fate::whole) {
      const auto& a = t.snapped.v[j];
      const auto& b = t.snapped.v[k];
      const Real ax = Real(a.x_fx8) / 256, ay = Real(a.y_fx8) / 256;
      const Real bx = Real(b.x_fx8) / 256, by = Real(b.y_fx8) / 256;
      out[i] = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / Real(t.clip[i].w);
    } else {
      // The determinant of the two other corners and the sample, in homogeneous px.
      const auto corner = [&](std::size_t n) {
        const Real w = t.clip[n].w;
        return std::array<Real, 3>{(Real(t.clip[n].x) + w) * width / 2,
                                   (w - Real(t.clip[n].y)) * height / 2, w};
      };
      const auto a = corner(j), b = corner(k);
      out[i] = (a[1] * b[2] - a[2] * b[1]) * x + (a[2] * b[0] - a[0] * b[2]) * y +
               (a[0] * b[1] - a[1] * b[0]);
    }
  }
  return out;
}

}  // namespace rastrum::test
