// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <rastrum/core/angle.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/arena.hpp>
#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/scan.hpp>
#include <rastrum/parallel/shares.hpp>
#include <rastrum/parallel/tabulate.hpp>
#include <rastrum/scene/weld.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {
namespace {

struct Face {
  Vec3d normal;
  double squared = 0;  ///< the normal's length, squared; 0: takes no part
};
inline Face face_of(const ArrayView<Vec3>& positions, const std::array<std::uint32_t, 3>& v) {
  const Vec3d a = positions.wide(v[0]);
  Face f{cross(positions.wide(v[1]) - a, positions.wide(v[2]) - a)};
  f.squared = dot(f.normal, f.normal);
  if (!std::isfinite(f.squared)) f.squared = 0;
  return f;
}

/// The faces around a point, and their groups. Keeps its memory from point to point.
class Fan {
 public:
  void clear() { faces_.clear(); }
  /// `before` and `after`: the points next to this one along the face.
  void add(const Face& face, std::uint32_t after, std::uint32_t before) {
    faces_.push_back({face, after, before, 0});
  }

  /// Groups faces that share edges whose angle has at least this cosine.
  void join(double cosine) {
    if (goes_round(cosine)) {
      for (Part& part : faces_) part.parent = 0;
      return;
    }
    spokes_.clear();
    for (std::uint32_t i = 0; i < faces_.size(); ++i) {
      faces_[i].parent = i;
      spokes_.push_back({faces_[i].after, i});
      spokes_.push_back({faces_[i].before, i});
    }
    std::sort(spokes_.begin(), spokes_.end());
    for (std::size_t i = 1; i < spokes_.size(); ++i) {
      const Spoke &a = spokes_[i - 1], &b = spokes_[i];
      if (a.end != b.end || !is_smooth(faces_[a.face], faces_[b.face], cosine)) continue;
      const std::uint32_t first = first_of(a.face), second = first_of(b.face);
      faces_[std::max(first, second)].parent = std::min(first, second);
    }
  }

  /// Appends the groups' normals, in the order of their first faces, and calls put(i, place in
  /// `normals`) for each face.
  template <class Put>
  void sum(std::vector<Vec3>& normals, const Put& put) {
    sums_.resize(faces_.size());
    for (std::uint32_t i = 0; i < faces_.size(); ++i) {
      const std::uint32_t first = first_of(i);
      Sum& s = sums_[first];
      if (first == i) s = {{}, 0};
      s.normal = s.normal + faces_[i].face.normal;
    }
    for (std::uint32_t i = 0; i < faces_.size(); ++i) {
      const std::uint32_t first = first_of(i);
      if (first == i) {
        sums_[i].place = static_cast<std::uint32_t>(normals.size());
        normals.push_back(Vec3(direction_of(sums_[i].normal).value_or(Vec3d{})));
      }
      put(i, sums_[first].place);
    }
  }

 private:
  static constexpr double kFarFromZero = 1e-280;  ///< where products keep all their bits
  struct Part {
    Face face;
    std::uint32_t after, before;
    std::uint32_t parent;
  };
  struct Spoke {
    std::uint32_t end, face;
    auto operator<=>(const Spoke&) const = default;
  };
  struct Sum {
    Vec3d normal;
    std::uint32_t place;
  };

  static bool is_smooth(const Part& a, const Part& b, double cosine) {
    const double dotted = dot(a.face.normal, b.face.normal);
    // Mostly the answer needs no roots, whose rounding errors are some 10^-15 of them.
    constexpr double kClearly = 1 + 1e-12;
    const double most = cosine * cosine * a.face.squared * b.face.squared;
    if (cosine > 0 && most > kFarFromZero && dotted > 0) {
      if (dotted * dotted > most * kClearly) return true;
      if (dotted * dotted * kClearly < most) return false;
    }
    return dotted >= cosine * (std::sqrt(a.face.squared) * std::sqrt(b.face.squared));
  }

  /// Whether smooth edges lead all the way round, as inside a smooth surface. Then join needs no
  /// sort for its only group.
  [[nodiscard]] bool goes_round(double cosine) const {
    constexpr std::size_t kMost = 32;  // each is searched among all
    const std::size_t n = faces_.size();
    if (n > kMost) return false;
    std::size_t at = 0;
    for (std::size_t passed = 0; passed < n; ++passed) {
      std::size_t next = 0;
      while (next < n && faces_[next].before != faces_[at].after) ++next;
      if (next == n || !is_smooth(faces_[at], faces_[next], cosine)) return false;
      at = next;
      if (at == 0) return passed + 1 == n;
    }
    return false;
  }
  std::uint32_t first_of(std::uint32_t face) {
    while (faces_[face].parent != face)
      face = faces_[face].parent = faces_[faces_[face].parent].parent;
    return face;
  }

  std::vector<Part> faces_;
  std::vector<Spoke> spokes_;
  std::vector<Sum> sums_;
};

/// `Number` counts corners. It is small because fresh pages are much of the cost.
template <class Number, class Exec>
Attribute<Vec3> crease_normals_on(Exec& exec, const ArrayView<Vec3>& positions,
                                  std::span<const std::uint32_t> indices, std::size_t triangles,
                                  double cosine) {
  const auto triangle = [&](std::size_t t) {
    const auto first = static_cast<std::uint32_t>(3 * t);
    return indices.empty() ? std::array{first, first + 1, first + 2}
                           : std::array{indices[3 * t], indices[3 * t + 1], indices[3 * t + 2]};
  };
  const JoinedPoints points =
      weld(exec, positions.size(), [&](std::uint32_t v) { return positions.wide(v); });

  // Corners of triangles without area take no part. No point has this number.
  const auto none = static_cast<std::uint32_t>(points.count);
  auto point_of = parallel::make_buffer<std::uint32_t>(exec, 3 * triangles);
  parallel::for_each_block(exec, triangles, [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t t = first; t < end; ++t) {
      const std::array<std::uint32_t, 3> v = triangle(t);
      const bool takes_part = face_of(positions, v).squared > 0;
      for (std::size_t c = 0; c < 3; ++c)
        point_of[3 * t + c] = takes_part ? points.of_vertex[v[c]] : none;
    }
  });

  // The corners at point p, in the order of triangles: corners[begin[p]] to corners[begin[p + 1]].
  // A share has the corners at a range of points.
  auto begin = parallel::make_buffer<Number>(exec, points.count + 1);
  auto next = parallel::make_buffer<Number>(exec, points.count);
  const auto each_of_share = [&](const auto& f) {
    parallel::for_each_share(exec, [&](std::size_t share, std::size_t shares) {
      const std::size_t low = points.count * share / shares;
      const std::size_t size = points.count * (share + 1) / shares - low;
      for (std::size_t corner = 0; corner < 3 * triangles; ++corner)
        if (point_of[corner] - low < size) f(point_of[corner], static_cast<Number>(corner));
    });
  };
  parallel::tabulate(exec, next, [](std::size_t) { return Number{0}; });
  each_of_share([&](std::size_t p, Number) { ++next[p]; });
  const std::span starts(begin.data(), points.count);
  begin[points.count] = parallel::exclusive_scan(exec, next, starts, Number{0});
  parallel::tabulate(exec, next, [&](std::size_t p) { return begin[p]; });
  auto corners = parallel::make_buffer<Number>(exec, begin[points.count]);
  each_of_share([&](std::size_t p, Number corner) { corners[next[p]++] = corner; });

  // Groups count from 0 in each run of points, whose begin is known when all are done. So the
  // result does not depend on the number of threads.
  Attribute<Vec3> normals;
  normals.indices.resize(3 * triangles);
  std::vector<std::vector<Vec3>> values(parallel::block_count(points.count));
  parallel::for_each_block(exec, points.count,
                           [&](std::size_t run, std::size_t first_point, std::size_t end) {
                             Fan fan;
                             for (std::size_t p = first_point; p < end; ++p) {
                               fan.clear();
                               for (std::size_t i = begin[p]; i < begin[p + 1]; ++i) {
                                 const std::uint64_t t = corners[i] / 3, c = corners[i] % 3;
                                 const std::array<std::uint32_t, 3> v = triangle(t);
                                 fan.add(face_of(positions, v), point_of[3 * t + (c + 1) % 3],
                                         point_of[3 * t + (c + 2) % 3]);
                               }
                               fan.join(cosine);
                               fan.sum(values[run], [&](std::size_t i, std::uint32_t value) {
                                 normals.indices[corners[begin[p] + i]] = value;
                               });
                             }
                           });
  std::vector<std::size_t> first(values.size() + 1, 1);  // 0: corners without a group
  for (std::size_t run = 0; run < values.size(); ++run)
    first[run + 1] = first[run] + values[run].size();
  normals.values.resize(first.back());
  parallel::for_each_index(exec, values.size(), [&](std::size_t run) {
    std::ranges::copy(values[run],
                      normals.values.begin() + static_cast<std::ptrdiff_t>(first[run]));
  });
  parallel::for_each_block(
      exec, 3 * triangles, [&](std::size_t, std::size_t first_corner, std::size_t end) {
        for (std::size_t c = first_corner; c < end; ++c)
          if (point_of[c] != none)
            normals.indices[c] += static_cast<std::uint32_t>(first[point_of[c] / parallel::kBlock]);
      });
  return normals;
}

}  // namespace

Attribute<Vec3> crease_normals(const ArrayView<Vec3>& positions,
                               std::span<const std::uint32_t> indices, double crease_deg) {
  const FloatScope floats;
  if (!(crease_deg >= 0 && crease_deg <= 180))
    throw Error(
        Errc::invalid_argument,
        "crease_normals: the angle must lie in 0 to 180 degrees, not " + number_text(crease_deg));
  const double cosine = sin_cos_degrees(crease_deg).cos;
  MeshView mesh;
  mesh.positions = positions;
  mesh.indices = indices;
  check_indices(mesh);
  const std::size_t triangles = mesh.triangle_count();
  return parallel::on_threads_of_its_own(triangles, [&](auto& exec) {
    return 3 * triangles <= std::numeric_limits<std::uint32_t>::max()
               ? crease_normals_on<std::uint32_t>(exec, positions, indices, triangles, cosine)
               : crease_normals_on<std::uint64_t>(exec, positions, indices, triangles, cosine);
  });
}

}  // namespace rastrum
