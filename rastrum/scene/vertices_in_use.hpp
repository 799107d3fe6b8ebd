// The vertices that triangles use, in world space: what a fit looks at, more than once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <rastrum/mesh.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

class VerticesInUse {
 public:
  /// `scene` must outlive it. Throws Error{invalid_argument} for an index out of range.
  explicit VerticesInUse(const SceneView& scene) : scene_(scene) {
    // Instances of one mesh often follow each other.
    const MeshView* last = nullptr;
    for (const InstanceView& instance : scene.instances) {
      const MeshView& mesh = *instance.mesh();
      const bool same = last != nullptr && mesh.indices == last->indices &&
                        mesh.faces == last->faces &&
                        mesh.positions.size() == last->positions.size();
      if (!same) used_.push_back(used_of(mesh));
      used_by_.push_back(used_.size() - 1);
      last = &mesh;
    }
  }

  /// Calls f(Vec3d) for each finite vertex in use, once an instance, in their order.
  template <class F>
  void for_each(F&& f) const {
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
      const MeshView& mesh = *scene_.instances[i].mesh();
      const Mat4d& m = scene_.instances[i].object_to_world;
      const auto visit = [&](Vec3d p) {
        const auto row = [&](int r) {
          return m.m[r][0] * p.x + m.m[r][1] * p.y + m.m[r][2] * p.z + m.m[r][3];
        };
        const Vec3d q{row(0), row(1), row(2)};
        if (is_finite(q)) f(q);
      };
      const std::vector<bool>& used = used_[used_by_[i]];
      for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v]) visit(mesh.positions.wide(v));
    }
  }

 private:
  static std::vector<bool> used_of(const MeshView& mesh) {
    check_indices(mesh);
    std::vector<bool> used(mesh.positions.size());
    constexpr std::size_t kAtOnce = 256;
    std::uint32_t vertices[3 * kAtOnce];
    const std::size_t triangles = mesh.triangle_count();
    for (std::size_t t = 0; t < triangles; t += kAtOnce) {
      const std::size_t n = std::min(kAtOnce, triangles - t);
      mesh.read_triangles(t, n, vertices);
      for (std::size_t i = 0; i < 3 * n; ++i) used[vertices[i]] = true;
    }
    return used;
  }

  const SceneView scene_;
  std::vector<std::vector<bool>> used_;
  std::vector<std::size_t> used_by_;  ///< an instance's
};

}  // namespace rastrum
