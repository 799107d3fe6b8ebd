// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/scene/instance_runs.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <rastrum/scene/mesh_clusters.hpp>

namespace rastrum {
namespace {

/// 32 bits number a run's vertices and triangles.
constexpr std::size_t kMostOfRun = std::size_t{1} << 31;

/// Instances that are compared at once: some 100 µs.
constexpr std::size_t kGrain = 4096;

bool are_finite(const Vec4& c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z) && std::isfinite(c.w);
}

bool are_alike(const std::optional<Vec4>& a, const std::optional<Vec4>& b) {
  if (!a || !b) return !a && !b;
  return are_finite(*a) && are_finite(*b) && (a->w >= 1) == (b->w >= 1);
}

bool has_scalars(const InstanceView& i) {
  return i.scalar || !i.mesh()->scalars.empty();
}

/// An instance with NaN is like no other.
bool are_alike(const InstanceView& a, const InstanceView& b) {
  return a.mesh() != nullptr && b.mesh() != nullptr && a.opacity == b.opacity &&
         a.material == b.material && a.visible == b.visible && a.winding == b.winding &&
         are_alike(a.color, b.color) &&
         is_mirroring(a.object_to_world) == is_mirroring(b.object_to_world) &&
         a.clip_planes.empty() && b.clip_planes.empty() && !has_scalars(a) && !has_scalars(b) &&
         (a.geometry == b.geometry || *a.mesh() == *b.mesh());
}

std::size_t longest_run(const InstanceView& instance) {
  const MeshView& mesh = *instance.mesh();
  const std::size_t one =
      std::max({mesh.positions.size(), mesh.corner_count(), mesh.triangle_count()});
  return std::max<std::size_t>(1, kMostOfRun / std::max<std::size_t>(one, 1));
}

}  // namespace

bool is_mirroring(const Mat4d& object_to_world) {
  const auto& m = object_to_world.m;
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return determinant < 0;
}

Winding winding_of(const InstanceView& instance) {
  const bool turns = instance.mesh() != nullptr && instance.winding != Winding::either &&
                     is_mirroring(instance.object_to_world);
  if (!turns) return instance.winding;
  return instance.winding == Winding::clockwise ? Winding::counter_clockwise : Winding::clockwise;
}

InstanceRuns::InstanceRuns(const SceneView& scene, bool joins, parallel::Threads* threads)
    : scene_(scene), firsts_(scene) {
  const std::span<const InstanceView> all = scene.instances;
  if (!joins || all.size() < 2) return;
  std::vector<std::uint8_t> joined(all.size());  // to the one before
  const auto compare = [&](std::size_t part) {
    const std::size_t end = std::min((part + 1) * kGrain, all.size());
    for (std::size_t i = std::max<std::size_t>(part * kGrain, 1); i < end; ++i)
      joined[i] = are_alike(all[i - 1], all[i]) ? 1 : 0;
  };
  const std::size_t parts = (all.size() + kGrain - 1) / kGrain;
  parallel::for_each_index(parts > 1 ? threads : nullptr, parts, compare);
  if (std::ranges::none_of(joined, [](std::uint8_t j) { return j != 0; })) return;

  std::size_t end = 0;  // where a run from the last first instance must end
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (joined[i] != 0 && i < end) continue;
    begin_.push_back(i);
    list_.push_back(all[i]);
    // No instance joins one that is not a mesh.
    end = all[i].mesh() == nullptr ? 0 : i + longest_run(all[i]);
  }
  begin_.push_back(all.size());
  firsts_.instances = list_;
}

void InstanceRuns::cut_faces(parallel::Threads* threads) {
  const auto wants = [](const InstanceView& i) {
    return i.mesh() != nullptr && i.mesh()->faces.kind == FaceKind::polygons;
  };
  if (std::ranges::none_of(firsts_.instances, wants)) return;
  if (list_.empty()) list_.assign(firsts_.instances.begin(), firsts_.instances.end());
  firsts_.instances = list_;
  GeometryRef given;  // instances of one mesh mostly lie together
  for (InstanceView& i : list_) {
    if (!wants(i)) continue;
    if (meshes_.empty() || i.geometry != given) {
      MeshView mesh = *i.mesh();
      if (mesh.clusters != nullptr)
        mesh.cuts = mesh.clusters->mesh.cuts;
      else if (!meshes_.empty() && mesh.positions == meshes_.back().positions &&
               mesh.indices == meshes_.back().indices && mesh.faces == meshes_.back().faces)
        mesh.cuts = meshes_.back().cuts;
      meshes_.push_back(with_cuts(mesh, cuts_, threads));
    }
    given = i.geometry;
    i.geometry = meshes_.back();
  }
}

}  // namespace rastrum
