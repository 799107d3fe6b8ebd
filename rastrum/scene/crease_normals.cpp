#include <rastrum/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <rastrum/core/angle.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/scene/weld.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {
namespace {

/// Fewer are done before other threads have begun.
constexpr std::size_t kFewTriangles = 1 << 15;
/// A thread's turn.
constexpr std::size_t kFaceRun = 1 << 14, kPointRun = 1 << 12;

/// The cross product of two edges: twice the area long.
Vec3d area_vector(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3d e1 = {double{b.x} - a.x, double{b.y} - a.y, double{b.z} - a.z};
  const Vec3d e2 = {double{c.x} - a.x, double{c.y} - a.y, double{c.z} - a.z};
  return {e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x};
}

struct Face {
  Vec3d normal;
  double length = 0;  ///< 0: takes no part
};

/// The groups of the triangles around one point; its memory is kept from point to point.
class Groups {
 public:
  void begin(std::size_t faces) {
    spokes_.clear();
    parent_.resize(faces);
    for (std::uint32_t i = 0; i < faces; ++i) parent_[i] = i;
  }
  /// Face `face` of the point has an edge from it to `end`.
  void add_edge(std::uint32_t face, std::uint32_t end) { spokes_.push_back({end, face}); }

  /// Joins what `smooth(face, face)` says of two that share an edge.
  template <class Smooth>
  void join(const Smooth& smooth) {
    std::sort(spokes_.begin(), spokes_.end());
    for (std::size_t i = 1; i < spokes_.size(); ++i) {
      const Spoke &a = spokes_[i - 1], &b = spokes_[i];
      if (a.end != b.end || !smooth(a.face, b.face)) continue;
      const std::uint32_t first = first_of(a.face), second = first_of(b.face);
      parent_[std::max(first, second)] = std::min(first, second);
    }
  }
  /// The first face of the group of `face`.
  std::uint32_t first_of(std::uint32_t face) {
    while (parent_[face] != face) face = parent_[face] = parent_[parent_[face]];
    return face;
  }

 private:
  struct Spoke {
    std::uint32_t end, face;
    auto operator<=>(const Spoke&) const = default;
  };
  std::vector<Spoke> spokes_;
  std::vector<std::uint32_t> parent_;
};

Vec3 normal_of(const Vec3d& sum) {
  const double l = std::sqrt(dot(sum, sum));
  if (!(l > 0) || !std::isfinite(l)) return {};
  return {static_cast<float>(sum.x / l), static_cast<float>(sum.y / l),
          static_cast<float>(sum.z / l)};
}

}  // namespace

Attribute<Vec3> crease_normals(std::span<const Vec3> positions,
                               std::span<const std::uint32_t> indices, double crease_deg) {
  if (!(crease_deg >= 0 && crease_deg <= 180))
    throw Error(Errc::invalid_argument,
                "crease_normals: the angle must lie in 0 to 180 degrees, not " +
                    std::to_string(crease_deg));
  const double cosine = sin_cos_degrees(crease_deg).cos;
  MeshView mesh;
  mesh.positions = positions;
  mesh.indices = indices;
  check_indices(mesh);
  const std::size_t triangles = mesh.triangle_count();
  std::optional<parallel::Threads> threads;
  if (triangles >= kFewTriangles) threads.emplace();
  const auto for_each = [&](std::size_t runs, const auto& run) {
    if (threads) return parallel::for_each_index(*threads, runs, run);
    for (std::size_t i = 0; i < runs; ++i) run(i);
  };

  const JoinedPoints points =
      weld(positions.size(), [&](std::uint32_t v) { return Vec3d(positions[v]); });
  const auto point = [&](std::size_t corner) { return points.of_vertex[mesh.vertex(corner)]; };
  std::vector<Face> faces(triangles);
  // The corners at point p, in the order of triangles: corners[begin[p]] to corners[begin[p + 1]].
  std::vector<std::size_t> begin(points.count + 1);
  for_each((triangles + kFaceRun - 1) / kFaceRun, [&](std::size_t run) {
    const std::size_t end = std::min(triangles, (run + 1) * kFaceRun);
    for (std::size_t t = run * kFaceRun; t < end; ++t) {
      Face& f = faces[t];
      f.normal = area_vector(positions[mesh.vertex(3 * t)], positions[mesh.vertex(3 * t + 1)],
                             positions[mesh.vertex(3 * t + 2)]);
      f.length = std::sqrt(dot(f.normal, f.normal));
      if (!std::isfinite(f.length)) f.length = 0;
    }
  });
  for (std::size_t t = 0; t < triangles; ++t)
    if (faces[t].length > 0)
      for (std::size_t c = 0; c < 3; ++c) ++begin[point(3 * t + c) + 1];
  for (std::size_t p = 0; p < points.count; ++p) begin[p + 1] += begin[p];
  std::vector<std::uint64_t> corners(begin.back());
  {
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (std::size_t t = 0; t < triangles; ++t)
      if (faces[t].length > 0)
        for (std::size_t c = 0; c < 3; ++c) corners[next[point(3 * t + c)]++] = 3 * t + c;
  }

  // The groups of a run of points count from 0; where the run's own begin is known when all are
  // done. So threads change nothing.
  Attribute<Vec3> normals;
  normals.indices.resize(3 * triangles);
  std::vector<std::vector<Vec3>> values((points.count + kPointRun - 1) / kPointRun);
  for_each(values.size(), [&](std::size_t run) {
    Groups groups;
    std::vector<Vec3d> sums;
    std::vector<std::uint32_t> value;
    const std::size_t end = std::min(points.count, (run + 1) * kPointRun);
    for (std::size_t p = run * kPointRun; p < end; ++p) {
      const std::span<const std::uint64_t> around(corners.data() + begin[p],
                                                  begin[p + 1] - begin[p]);
      const auto face = [&](std::size_t i) -> const Face& { return faces[around[i] / 3]; };
      groups.begin(around.size());
      for (std::uint32_t i = 0; i < around.size(); ++i) {
        const std::uint64_t t = around[i] / 3, c = around[i] % 3;
        groups.add_edge(i, point(3 * t + (c + 1) % 3));
        groups.add_edge(i, point(3 * t + (c + 2) % 3));
      }
      groups.join([&](std::uint32_t a, std::uint32_t b) {
        return dot(face(a).normal, face(b).normal) >= cosine * (face(a).length * face(b).length);
      });
      sums.assign(around.size(), {});
      for (std::uint32_t i = 0; i < around.size(); ++i) {
        Vec3d& sum = sums[groups.first_of(i)];
        const Vec3d& n = face(i).normal;
        sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
      }
      value.resize(around.size());
      for (std::uint32_t i = 0; i < around.size(); ++i) {
        const std::uint32_t first = groups.first_of(i);
        if (first == i) {
          value[i] = static_cast<std::uint32_t>(values[run].size());
          values[run].push_back(normal_of(sums[i]));
        }
        normals.indices[around[i]] = value[first];
      }
    }
  });
  std::vector<std::size_t> first(values.size() + 1, 1);  // 0: of corners that have no group
  for (std::size_t run = 0; run < values.size(); ++run)
    first[run + 1] = first[run] + values[run].size();
  normals.values.resize(first.back());
  for_each(values.size(), [&](std::size_t run) {
    std::ranges::copy(values[run],
                      normals.values.begin() + static_cast<std::ptrdiff_t>(first[run]));
    const std::size_t end = std::min(points.count, (run + 1) * kPointRun);
    for (std::size_t i = begin[run * kPointRun]; i < begin[end]; ++i)
      normals.indices[corners[i]] += static_cast<std::uint32_t>(first[run]);
  });
  return normals;
}

}  // namespace rastrum
