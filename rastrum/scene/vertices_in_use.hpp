// SPDX-License-Identifier: BSD-3-Clause
// A scene's vertices in world space, which a fit reads several times.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include <rastrum/core/vectors.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/scene/fit_ranks.hpp>
#include <rastrum/scene/scene_vertices.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

class VerticesInUse {
 public:
  /// `scene` and the beyond() of `ranks` (may be null) must outlive this. Throws as SceneVertices.
  explicit VerticesInUse(const SceneView& scene, const FitRanks* ranks = nullptr)
      : scene_(scene), beyond_(ranks == nullptr ? nullptr : ranks->beyond()) {}

  /// Adds all finite vertices in use, in world space and in order, to `none`, and returns the
  /// result. Q::add(Vec3d) adds one, Q::merge(Q) the result of later ones. A Q keeps maxima of
  /// functions of one vertex: values() so far, bounds(box) as upper bounds in a box. So a run with
  /// a known box is read only if it may change the result.
  template <class Q>
  [[nodiscard]] Q reduce(const Q& none) const {
    Q all = none;
    add(scene_, none, all);
    if (beyond_ != nullptr) add(*beyond_, none, all);
    return all;
  }

  /// A box in world space, larger than its contents by more than float64's rounding.
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
    /// A few thousand roundings of float64; some ten occur.
    static constexpr double kMargin = 1e-12;
    Vec3d centre, half;
  };

 private:
  /// Merges the vertices' result into `all`.
  template <class Q>
  static void add(const FitVertices& vertices, const Q& none, Q& all) {
    const std::size_t n = vertices.runs();
    constexpr std::size_t kAsked = std::tuple_size_v<decltype(none.values())>;
    // First reads runs without a known box, and those that promise most. Boxes are asked for twice
    // and nothing is kept for skipped runs, since a mesh at many nodes has as many runs as these
    // together.
    std::vector<std::size_t> first;
    std::size_t seeds[kAsked];
    double most[kAsked] = {};
    std::ranges::fill(seeds, n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::optional<FitVertices::Box> box = vertices.box(i);
      if (!box) first.push_back(i);
      if (!box || is_empty(*box)) continue;
      const auto bounds = none.bounds(WorldBox(*box, vertices.object_to_world(i)));
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
    const std::vector<Q> of_first = read(vertices, first, none);
    Q best = all;
    for (const Q& q : of_first) best.merge(q);

    // Then reads runs that may still win, and merges all in order.
    std::vector<std::size_t> some;
    std::size_t merged = 0;
    const auto merge = [&](std::size_t end) {
      const std::vector<Q> of_some = read(vertices, some, none);
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
      const std::optional<FitVertices::Box> box = vertices.box(i);
      if (!box || is_empty(*box)) continue;
      const auto bounds = none.bounds(WorldBox(*box, vertices.object_to_world(i)));
      const auto values = best.values();
      bool wins = false;  // written so that NaN is read
      for (std::size_t k = 0; k < kAsked; ++k) wins = wins || !(bounds[k] < values[k]);
      if (!wins) continue;
      some.push_back(i);
      if (some.size() == kAtOnce) merge(i + 1);
    }
    merge(n);
  }

  /// Runs with known boxes that are read together: enough for all threads.
  static constexpr std::size_t kAtOnce = 1024;

  [[nodiscard]] static bool is_empty(const FitVertices::Box& box) {
    return !(box.min.x <= box.max.x);
  }

  /// The result of each of these runs, which rise, from `none`.
  template <class Q>
  [[nodiscard]] static std::vector<Q> read(const FitVertices& from,
                                           std::span<const std::size_t> runs, const Q& none) {
    std::vector<Q> made(runs.size(), none);
    if (runs.empty()) return made;
    from.read(runs, [&](std::size_t i, std::span<const Vec3d> vertices) {
      const Mat4d& m = from.object_to_world(runs[i]);
      Q q = made[i];  // a copy: other threads write beside it
      for (const Vec3d& p : vertices)
        if (const Vec3d w = moved_by(m, p); is_finite(w)) q.add(w);
      made[i] = q;
    });
    return made;
  }

  const SceneVertices scene_;
  const FitVertices* beyond_;
};

/// The box of vertices, for VerticesInUse::reduce.
struct ExtentOfVertices : Box3d {
  void merge(const ExtentOfVertices& later) { Box3d::add(later); }
  [[nodiscard]] std::array<double, 6> values() const {
    return {max.x, max.y, max.z, -min.x, -min.y, -min.z};
  }
  [[nodiscard]] static std::array<double, 6> bounds(const VerticesInUse::WorldBox& b) {
    return {b.centre.x + b.half.x, b.centre.y + b.half.y, b.centre.z + b.half.z,
            b.half.x - b.centre.x, b.half.y - b.centre.y, b.half.z - b.centre.z};
  }
};

/// The box of all vertices, alike on all ranks; `vertices` becomes these. Finds errors in a rank's
/// vertices.
inline Box3d extent_of(const SceneView& scene, FitRanks* ranks,
                       std::optional<VerticesInUse>& vertices) {
  ExtentOfVertices extent;
  own_work(ranks, [&] {
    vertices.emplace(scene, ranks);
    extent = vertices->reduce(extent);
  });
  gather_boxes(ranks, extent);
  return extent;
}

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
