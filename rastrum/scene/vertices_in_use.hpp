// The vertices that triangles use, in world space: what a fit looks at, more than once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <tuple>
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

  /// What all finite vertices in use make of `none`, in their order, in world space: Q::add(Vec3d)
  /// of each, Q::merge(Q) of what later ones have made. A Q has maxima of functions of a vertex,
  /// and no other vertex changes it: values() are those so far, and no vertex in a box has more
  /// than bounds(box), an array of the same size. So those beyond the scene whose boxes are known
  /// are read only where one may change the result.
  template <class Q>
  [[nodiscard]] Q reduce(const Q& none) const {
    Q all = none;
    for_each_of_scene([&](const Vec3d& p) { all.add(p); });
    if (beyond_ == nullptr) return all;
    const std::size_t n = beyond_->runs();
    constexpr std::size_t kAsked = std::tuple_size_v<decltype(none.values())>;
    // Read whatever comes: runs that nobody knows, and those that promise most. Boxes are asked for
    // twice, and nothing is kept of those that are left out: of a mesh at many nodes there are as
    // many runs as in all its nodes together.
    std::vector<std::size_t> first;
    std::size_t seeds[kAsked];
    double most[kAsked] = {};
    std::ranges::fill(seeds, n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::optional<FitVertices::Box> box = beyond_->box(i);
      if (!box) first.push_back(i);
      if (!box || is_empty(*box)) continue;
      const auto bounds = none.bounds(WorldBox(*box, beyond_->object_to_world(i)));
      for (std::size_t k = 0; k < kAsked; ++k)
        if (seeds[k] == n || bounds[k] > most[k]) {
          seeds[k] = i;
          most[k] = bounds[k];
        }
    }
    for (const std::size_t i : seeds)
      if (i != n) first.push_back(i);
    std::ranges::sort(first);
    first.erase(std::unique(first.begin(), first.end()), first.end());
    const std::vector<Q> of_first = read(first, none);
    Q best = all;
    for (const Q& q : of_first) best.merge(q);

    // Then those that may still win, merged in the order of all.
    std::vector<std::size_t> some;
    std::size_t merged = 0;
    const auto merge = [&](std::size_t end) {
      const std::vector<Q> of_some = read(some, none);
      for (std::size_t i = 0; i < some.size(); ++i) {
        for (; merged < first.size() && first[merged] < some[i]; ++merged)
          all.merge(of_first[merged]);
        all.merge(of_some[i]);
        best.merge(of_some[i]);
      }
      some.clear();
      for (; merged < first.size() && first[merged] < end; ++merged) all.merge(of_first[merged]);
    };
    std::size_t next = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (next < first.size() && first[next] == i) {
        ++next;
        continue;
      }
      const std::optional<FitVertices::Box> box = beyond_->box(i);
      if (!box || is_empty(*box)) continue;
      const auto bounds = none.bounds(WorldBox(*box, beyond_->object_to_world(i)));
      const auto values = best.values();
      bool wins = false;  // written so that what is no number is read
      for (std::size_t k = 0; k < kAsked; ++k) wins = wins || !(bounds[k] < values[k]);
      if (!wins) continue;
      some.push_back(i);
      if (some.size() == kAtOnce) merge(i + 1);
    }
    merge(n);
    return all;
  }

  /// A box in world space, a little larger than what is in it, as float64 finds that.
  struct WorldBox {
    WorldBox(const FitVertices::Box& box, const Mat4d& m) {
      const Vec3d c{(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2,
                    (box.min.z + box.max.z) / 2};
      const Vec3d h{(box.max.x - box.min.x) / 2, (box.max.y - box.min.y) / 2,
                    (box.max.z - box.min.z) / 2};
      const auto row = [&](int r, double& middle, double& reach) {
        const auto& a = m.m[r];
        const double x = std::abs(a[0]), y = std::abs(a[1]), z = std::abs(a[2]);
        middle = a[0] * c.x + a[1] * c.y + a[2] * c.z + a[3];
        reach = x * h.x + y * h.y + z * h.z +
                kMargin * (x * (std::abs(c.x) + h.x) + y * (std::abs(c.y) + h.y) +
                           z * (std::abs(c.z) + h.z) + std::abs(a[3]));
      };
      row(0, centre.x, half.x);
      row(1, centre.y, half.y);
      row(2, centre.z, half.z);
    }
    /// Of some ten roundings of float64 a few thousand times.
    static constexpr double kMargin = 1e-12;
    Vec3d centre, half;
  };

 private:
  /// Runs that are read together, where their boxes are known: enough for all threads.
  static constexpr std::size_t kAtOnce = 1024;

  [[nodiscard]] static bool is_empty(const FitVertices::Box& box) {
    return !(box.min.x <= box.max.x);
  }

  /// What each of these runs, which rise, makes of `none`.
  template <class Q>
  [[nodiscard]] std::vector<Q> read(std::span<const std::size_t> runs, const Q& none) const {
    std::vector<Q> made(runs.size(), none);
    if (runs.empty()) return made;
    beyond_->read(runs, [&](std::size_t i, std::span<const Vec3d> vertices) {
      const Mat4d& m = beyond_->object_to_world(runs[i]);
      Q q = made[i];  // one's own: others write beside it
      for (const Vec3d& p : vertices) place(m, p, [&](const Vec3d& w) { q.add(w); });
      made[i] = q;
    });
    return made;
  }

  template <class F>
  static void place(const Mat4d& m, Vec3d p, const F& f) {
    const auto row = [&](int r) {
      return m.m[r][0] * p.x + m.m[r][1] * p.y + m.m[r][2] * p.z + m.m[r][3];
    };
    const Vec3d q{row(0), row(1), row(2)};
    if (is_finite(q)) f(q);
  }

  /// Calls f(Vec3d) for each finite vertex in use, once an instance, in their order.
  template <class F>
  void for_each_of_scene(const F& f) const {
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
      const Mat4d& m = scene_.instances[i].object_to_world;
      const auto visit = [&](Vec3d p) { place(m, p, f); };
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
  }

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
    constexpr std::size_t kSome = 256;
    std::uint32_t vertices[3 * kSome];
    const std::size_t triangles = mesh.triangle_count();
    for (std::size_t t = 0; t < triangles; t += kSome) {
      const std::size_t n = std::min(kSome, triangles - t);
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

/// The box of vertices, for VerticesInUse::reduce; of nothing from infinity to −infinity.
struct ExtentOfVertices {
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3d low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  std::uint64_t count = 0;  ///< at least 1 where there is one; all of a scene's own

  void add(const Vec3d& p) {
    ++count;
    merge_box(p, p);
  }
  void merge(const ExtentOfVertices& later) {
    count += later.count;
    merge_box(later.low, later.high);
  }
  [[nodiscard]] std::array<double, 6> values() const {
    return {high.x, high.y, high.z, -low.x, -low.y, -low.z};
  }
  [[nodiscard]] static std::array<double, 6> bounds(const VerticesInUse::WorldBox& b) {
    return {b.centre.x + b.half.x, b.centre.y + b.half.y, b.centre.z + b.half.z,
            b.half.x - b.centre.x, b.half.y - b.centre.y, b.half.z - b.centre.z};
  }

 private:
  void merge_box(const Vec3d& p, const Vec3d& q) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, q.x), std::max(high.y, q.y), std::max(high.z, q.z)};
  }
};

/// The greatest distance from `centre`, for VerticesInUse::reduce.
struct ReachOfVertices {
  Vec3d centre;
  double reach = 0;

  void add(const Vec3d& p) { reach = std::max(reach, length(p - centre)); }
  void merge(const ReachOfVertices& later) { reach = std::max(reach, later.reach); }
  [[nodiscard]] std::array<double, 1> values() const { return {reach}; }
  [[nodiscard]] std::array<double, 1> bounds(const VerticesInUse::WorldBox& b) const {
    const Vec3d d = b.centre - centre;
    const double most =
        length(Vec3d{std::abs(d.x) + b.half.x, std::abs(d.y) + b.half.y, std::abs(d.z) + b.half.z});
    return {most + VerticesInUse::WorldBox::kMargin * (most + length(centre))};
  }
};

}  // namespace rastrum
