// The vertices that triangles use, in world space: what a fit looks at, more than once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/points_and_lines.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/scene/mesh_checks.hpp>
#include <rastrum/surfaces.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// Calls f(centre, radius) for balls whose convex hull holds what a geometry that is no mesh draws.
/// Indices and offsets must be in range. Throws Error{invalid_argument} for too few radii.
template <class F>
void for_each_ball(const GeometryView& geometry, F&& f) {
  const auto radius = [](const auto& g, std::size_t i) {
    if (g.radii.empty()) return g.radius;
    if (i >= g.radii.size())
      throw Error(Errc::invalid_argument, "radii: there are " + std::to_string(g.radii.size()) +
                                              ", and number " + std::to_string(i) +
                                              " is asked for");
    return g.radii[i];
  };
  const auto all = [&](const auto& g, const ArrayView<Vec3>& centres, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) f(centres.wide(i), radius(g, i));
  };
  if (const auto* const s = std::get_if<SpheresView>(&geometry)) all(*s, s->centers, s->size());
  if (const auto* const d = std::get_if<DiscsView>(&geometry)) all(*d, d->centers, d->size());
  if (const auto* const t = std::get_if<TubesView>(&geometry))
    all(*t, t->positions, t->positions.size());
  if (const auto* const c = std::get_if<CylindersView>(&geometry))
    for (std::size_t i = 0; i < c->size(); ++i)
      for (const int end : {0, 1})
        if (const std::size_t k = c->end(i, end); k < c->positions.size())
          f(c->positions.wide(k), radius(*c, k));
}

/// Calls f(Vec3d) for the positions that points and lines use; of other geometries, for none.
/// Offsets must be in range. Throws Error{invalid_argument} for an index that is not.
template <class F>
void for_each_position(const GeometryView& geometry, F&& f) {
  const auto check = [](const auto& g) {
    std::string problem = arrays_problem(g);
    if (const std::size_t at = first_beyond(g.indices, g.positions.size());
        problem.empty() && at != g.indices.size())
      problem = "indices[" + std::to_string(at) + "]: index " + g.indices.text(at) +
                " is out of range, there are " + std::to_string(g.positions.size()) + " positions";
    if (!problem.empty()) throw Error(Errc::invalid_argument, "points or lines: " + problem);
  };
  if (const auto* const p = std::get_if<PointsView>(&geometry)) {
    check(*p);
    for (std::size_t i = 0; i < p->size(); ++i) f(p->positions.wide(p->vertex(i)));
  }
  if (const auto* const l = std::get_if<LinesView>(&geometry)) {
    check(*l);
    for (std::size_t s = 0; s < l->size(); ++s)
      for (const int end : {0, 1}) f(l->positions.wide(l->vertex(s, end)));
  }
}

class VerticesInUse {
 public:
  /// `scene` must outlive it, and what `ranks` (may be null) has beyond it. Throws
  /// Error{invalid_argument} for an index out of range.
  explicit VerticesInUse(const SceneView& scene, const FitRanks* ranks = nullptr)
      : scene_(scene), beyond_(ranks == nullptr ? nullptr : ranks->beyond()) {
    // Instances of one mesh often follow each other.
    const MeshView* last = nullptr;
    for (const InstanceView& instance : scene.instances) {
      if (instance.mesh() == nullptr) {
        used_by_.push_back(0);
        continue;
      }
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
    const auto place = [&](const Mat4d& m, Vec3d p) {
      const auto row = [&](int r) {
        return m.m[r][0] * p.x + m.m[r][1] * p.y + m.m[r][2] * p.z + m.m[r][3];
      };
      const Vec3d q{row(0), row(1), row(2)};
      if (is_finite(q)) f(q);
    };
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
      const Mat4d& m = scene_.instances[i].object_to_world;
      const auto visit = [&](Vec3d p) { place(m, p); };
      if (scene_.instances[i].mesh() == nullptr) {
        for_each_ball(scene_.instances[i].geometry,
                      [&](Vec3d centre, float radius) { visit_ball(centre, radius, visit); });
        for_each_position(scene_.instances[i].geometry, visit);
        continue;
      }
      const MeshView& mesh = *scene_.instances[i].mesh();
      const std::vector<bool>& used = used_[used_by_[i]];
      for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v]) visit(mesh.positions.wide(v));
    }
    if (beyond_ == nullptr) return;
    beyond_->for_each_run([&](std::span<const Vec3d> run) {
      for (const Vec3d& p : run) place(beyond_->object_to_world(), p);
    });
  }

 private:
  /// Places about a ball: its extremes along the axes, and the edges and corners of the cube about
  /// it, drawn in so that no plane that holds all of them cuts off more than a fortieth of the
  /// radius.
  template <class Visit>
  static void visit_ball(Vec3d centre, double radius, const Visit& visit) {
    if (!(radius >= 0)) return;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const int n = x * x + y * y + z * z;
          if (n == 0) continue;
          const double s = n == 1 ? radius : radius * 1.13 / std::sqrt(static_cast<double>(n));
          visit(centre + Vec3d{x * s, y * s, z * s});
        }
  }

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
  const FitVertices* beyond_;
  std::vector<std::vector<bool>> used_;
  std::vector<std::size_t> used_by_;  ///< an instance's
};

}  // namespace rastrum
