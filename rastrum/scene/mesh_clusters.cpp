// SPDX-License-Identifier: BSD-3-Clause
// Clusters along Hilbert's curve: triangles are sorted, stably, by their middles' place on it, and
// cut where a cluster is full. (Curve: Skilling, "Programming the Hilbert curve", 2004; cones:
// Shirman and Abi-Ezzi, "The cone of normals technique", 1993.)
#include <rastrum/scene/mesh_clusters.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/sort_by_key.hpp>
#include <rastrum/scene/mesh_checks.hpp>

namespace rastrum {
namespace {

/// Triangles that one thread cuts into clusters, whatever the number of threads, so that a mesh has
/// one set of clusters.
constexpr std::size_t kChunk = std::size_t{1} << 14;
constexpr int kCurveBits = 10;  ///< per axis
/// The place of triangles that are not finite: after the whole curve.
constexpr std::uint64_t kOffCurve = std::uint64_t{1} << 3 * kCurveBits;
constexpr int kMaterialShift = 3 * kCurveBits + 1;
/// How many triangles ahead are fetched.
constexpr std::size_t kAhead = 16;
/// A normal is too unsure if the least height is a smaller part of the longest edge.
constexpr double kThin = 1e-6;

template <class F>
void for_each_part(parallel::Threads* threads, std::size_t n, std::size_t part, const F& f) {
  const std::size_t parts = (n + part - 1) / part;
  parallel::for_each_index(threads, parts,
                           [&](std::size_t i) { f(i, i * part, std::min(n, (i + 1) * part)); });
}

/// Cells of 2^kCurveBits per axis, whose places on the curve are found together.
struct Cells {
  static constexpr std::size_t kCount = 64;
  std::uint32_t x[3][kCount];
  std::uint32_t place[kCount];

  /// Without branches, so that compilers vectorize it.
  void find_places() {
    constexpr std::uint32_t kTop = 1U << (kCurveBits - 1);
    for (std::uint32_t q = kTop; q > 1; q /= 2)
      for (auto& axis : x)
        for (std::size_t i = 0; i < kCount; ++i) {
          // Inverts the lower bits of x[0] where the bit is set, else swaps them with the axis's.
          const std::uint32_t set = (axis[i] & q) != 0 ? q - 1 : 0;
          const std::uint32_t other = (x[0][i] ^ axis[i]) & (set ^ (q - 1));
          x[0][i] ^= other | set;
          axis[i] ^= other;
        }
    for (std::size_t i = 0; i < kCount; ++i) {
      const std::uint32_t y = x[1][i] ^ x[0][i], z = x[2][i] ^ y;
      std::uint32_t t = 0;
      for (std::uint32_t q = kTop; q > 1; q /= 2) t ^= (z & q) != 0 ? q - 1 : 0;
      place[i] = spread(x[0][i] ^ t) << 2 | spread(y ^ t) << 1 | spread(z ^ t);
    }
  }

 private:
  /// Spreads bits to every third place.
  static std::uint32_t spread(std::uint32_t v) {
    static_assert(kCurveBits <= 10);
    v = (v | v << 16) & 0x030000FFU;
    v = (v | v << 8) & 0x0300F00FU;
    v = (v | v << 4) & 0x030C30C3U;
    return (v | v << 2) & 0x09249249U;
  }
};

/// Round outwards, so that a float32 box holds the float64 one.
float float_below(double v) {
  const auto f = static_cast<float>(v);
  return f > v ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float float_above(double v) {
  const auto f = static_cast<float>(v);
  return f < v ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

struct Chunk {
  std::vector<MeshCluster> clusters;  ///< their first vertices count from the chunk's
  std::vector<std::uint8_t> corners;
  std::vector<std::uint32_t> vertex;
};

/// The vertices of a cluster by their numbers in the mesh.
class LocalVertices {
 public:
  LocalVertices() { restart(); }
  void restart() {
    std::fill(std::begin(key_), std::end(key_), kNoIndex);
    count_ = 0;
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] std::size_t slot(std::uint32_t vertex) const {
    return from((vertex * 0x9E3779B9U) >> 22, vertex);
  }
  [[nodiscard]] bool is_free(std::size_t slot) const { return key_[slot] == kNoIndex; }
  /// Returns the vertex's number in the cluster; appends a new one to `vertices`. Others may have
  /// been added since slot().
  std::uint32_t add(std::uint32_t vertex, std::size_t slot, std::vector<std::uint32_t>& vertices) {
    const std::size_t at = from(slot, vertex);
    if (key_[at] == vertex) return number_[at];
    key_[at] = vertex;
    vertices.push_back(vertex);
    return number_[at] = static_cast<std::uint16_t>(count_++);
  }

 private:
  static constexpr std::size_t kSlots = 1024;
  [[nodiscard]] std::size_t from(std::size_t at, std::uint32_t vertex) const {
    while (key_[at] != kNoIndex && key_[at] != vertex) at = (at + 1) % kSlots;
    return at;
  }
  std::uint32_t key_[kSlots];
  std::uint16_t number_[kSlots];
  std::uint32_t count_ = 0;
};

class Builder {
 public:
  Builder(MeshClusters& out, parallel::Threads* threads)
      : out_(out), threads_(threads), mesh_(out.mesh), count_(out.mesh.triangle_count()) {}

  void build() {
    read();
    sort();
    cut();
    bound();
  }

 private:
  [[nodiscard]] Vec3d position(std::uint32_t v) const {
    return mesh_.positions.is_wide() ? mesh_.positions.wide(v) : Vec3d(mesh_.positions[v]);
  }
  [[nodiscard]] std::uint32_t material(std::size_t triangle) const {
    return mesh_.face_materials.empty() ? 0 : mesh_.face_materials[mesh_.place(triangle).face];
  }

  void read() {
    if (mesh_.is_packed_list() && !mesh_.indices.empty()) {
      vertices_ = mesh_.indices.data();
      return;
    }
    own_vertices_.resize(count_ * 3);
    for_each_part(threads_, count_, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      mesh_.read_triangles(begin, end - begin, own_vertices_.data() + begin * 3);
    });
    vertices_ = own_vertices_.data();
  }

  void sort() {
    std::vector<Box3d> boxes((mesh_.positions.size() + kChunk - 1) / kChunk);
    for_each_part(threads_, mesh_.positions.size(), kChunk,
                  [&](std::size_t i, std::size_t begin, std::size_t end) {
                    for (std::size_t v = begin; v < end; ++v)
                      if (const Vec3d p = position(static_cast<std::uint32_t>(v)); is_finite(p))
                        boxes[i].add(p);
                  });
    Box3d box;
    for (const Box3d& b : boxes) box.add(b);
    const Vec3d size = box.max - box.min;
    // Cells are cubes, so that a flat mesh has no thin ones.
    const double longest = std::max({size.x, size.y, size.z});
    const double scale = longest > 0 ? (1 << kCurveBits) / longest : 0;
    const auto cell = [&](double at) {
      const double c = at * scale;  // NaN and overflow go to an end
      return c > 0 ? static_cast<std::uint32_t>(std::min(c, (1 << kCurveBits) - 1.0)) : 0U;
    };
    out_.triangle.resize(count_);
    std::vector<std::uint64_t> keys(count_);
    for_each_part(threads_, count_, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      Cells cells;
      for (std::size_t first = begin; first < end; first += Cells::kCount) {
        const std::size_t n = std::min(Cells::kCount, end - first);
        std::uint64_t high[Cells::kCount];  // above the place: material, and what is off the curve
        for (std::size_t i = 0; i < Cells::kCount; ++i) {
          const std::size_t t = first + (i < n ? i : 0);
          const std::uint32_t* const v = vertices_ + t * 3;
          const Vec3d middle =
              (position(v[0]) + position(v[1]) + position(v[2])) * (1.0 / 3) - box.min;
          cells.x[0][i] = cell(middle.x);
          cells.x[1][i] = cell(middle.y);
          cells.x[2][i] = cell(middle.z);
          high[i] =
              std::uint64_t{material(t)} << kMaterialShift | (is_finite(middle) ? 0 : kOffCurve);
        }
        cells.find_places();
        for (std::size_t i = 0; i < n; ++i) {
          const bool off = (high[i] & kOffCurve) != 0;
          keys[first + i] = high[i] | (off ? 0 : cells.place[i]);
          out_.triangle[first + i] = static_cast<std::uint32_t>(first + i);
        }
      }
    });
    if (threads_ != nullptr) {
      parallel::sort_by_key(*threads_, keys, out_.triangle);
    } else {
      parallel::Serial serial;
      parallel::sort_by_key(serial, keys, out_.triangle);
    }
    keys_ = std::move(keys);
  }

  void cut() {
    std::vector<Chunk> chunks((count_ + kChunk - 1) / kChunk);
    for_each_part(threads_, count_, kChunk, [&](std::size_t i, std::size_t begin, std::size_t end) {
      cut_chunk(begin, end, chunks[i]);
    });
    std::size_t clusters = 0, vertices = 0;
    std::vector<std::pair<std::size_t, std::size_t>> first;  // cluster and vertex of each chunk
    for (const Chunk& c : chunks) {
      first.emplace_back(clusters, vertices);
      clusters += c.clusters.size();
      vertices += c.vertex.size();
    }
    if (vertices > kNoIndex)
      throw Error(Errc::unsupported, "a mesh of " + std::to_string(count_) +
                                         " triangles has too many vertices to be prepared");
    out_.clusters.resize(clusters);
    out_.vertex.resize(vertices);
    out_.corners.resize(count_ * 3);
    const bool wide = mesh_.positions.is_wide();
    (wide ? out_.wide.resize(vertices) : out_.positions.resize(vertices));
    for_each_part(threads_, chunks.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      const Chunk& chunk = chunks[i];
      const auto [c, v] = first[i];
      for (std::size_t k = 0; k < chunk.clusters.size(); ++k) {
        out_.clusters[c + k] = chunk.clusters[k];
        out_.clusters[c + k].first_vertex += static_cast<std::uint32_t>(v);
      }
      std::copy(chunk.corners.begin(), chunk.corners.end(),
                out_.corners.begin() + static_cast<std::ptrdiff_t>(i * kChunk * 3));
      for (std::size_t k = 0; k < chunk.vertex.size(); ++k) {
        out_.vertex[v + k] = chunk.vertex[k];
        if (wide)
          out_.wide[v + k] = mesh_.positions.wide(chunk.vertex[k]);
        else
          out_.positions[v + k] = mesh_.positions[chunk.vertex[k]];
      }
    });
  }

  void cut_chunk(std::size_t begin, std::size_t end, Chunk& out) const {
    out.corners.reserve((end - begin) * 3);
    LocalVertices local;
    // A cluster's triangles have one material, and all or none are on the curve.
    const auto kind = [&](std::size_t t) { return keys_[t] >> (kMaterialShift - 1); };
    for (std::size_t t = begin; t < end; ++t) {
      // Prefetches, because vertices lie anywhere in the mesh.
      __builtin_prefetch(vertices_ + std::size_t{out_.triangle[std::min(t + kAhead, end - 1)]} * 3);
      const std::uint32_t* const v = vertices_ + std::size_t{out_.triangle[t]} * 3;
      std::size_t slots[3];
      std::uint32_t added = 0;
      for (int c = 0; c < 3; ++c) {
        slots[c] = local.slot(v[c]);
        added += local.is_free(slots[c]) ? 1U : 0U;
      }
      if (t == begin || out.clusters.back().triangles == out_.way.triangles ||
          local.count() + added > MeshCluster::kVertices || kind(t) != kind(t - 1)) {
        if (t != begin) order_vertices(out);
        local.restart();
        for (int c = 0; c < 3; ++c) slots[c] = local.slot(v[c]);
        MeshCluster& next = out.clusters.emplace_back();
        next.first_triangle = static_cast<std::uint32_t>(t);
        next.first_vertex = static_cast<std::uint32_t>(out.vertex.size());
      }
      for (int c = 0; c < 3; ++c)
        out.corners.push_back(static_cast<std::uint8_t>(local.add(v[c], slots[c], out.vertex)));
      MeshCluster& cluster = out.clusters.back();
      ++cluster.triangles;
      cluster.vertices = static_cast<std::uint16_t>(local.count());
    }
    if (begin != end) order_vertices(out);
  }

  /// Puts the last cluster's vertices in the mesh's order, so that frames write them in the runs
  /// that shading reads.
  static void order_vertices(Chunk& out) {
    const MeshCluster& cluster = out.clusters.back();
    std::uint32_t* const vertex = out.vertex.data() + cluster.first_vertex;
    std::uint64_t order[MeshCluster::kVertices];  // the mesh's number, and ours
    for (std::uint32_t v = 0; v < cluster.vertices; ++v)
      order[v] = std::uint64_t{vertex[v]} << 8 | v;
    std::sort(order, order + cluster.vertices);
    std::uint8_t place[MeshCluster::kVertices];
    for (std::uint32_t v = 0; v < cluster.vertices; ++v) {
      vertex[v] = static_cast<std::uint32_t>(order[v] >> 8);
      place[order[v] & 255] = static_cast<std::uint8_t>(v);
    }
    const std::size_t corners = cluster.triangles * std::size_t{3};
    for (std::size_t i = out.corners.size() - corners; i < out.corners.size(); ++i)
      out.corners[i] = place[out.corners[i]];
  }

  void bound() {
    for_each_part(threads_, out_.clusters.size(), 64,
                  [&](std::size_t, std::size_t begin, std::size_t end) {
                    for (std::size_t c = begin; c < end; ++c) bound(out_.clusters[c]);
                  });
    const auto add = [](MeshClusters::Box& box, Vec3 min, Vec3 max, bool finite, bool first) {
      box.finite = finite && (first || box.finite);
      box.min = first ? min : least(box.min, min);
      box.max = first ? max : greatest(box.max, max);
    };
    out_.nodes.resize((out_.clusters.size() + MeshClusters::kNode - 1) / MeshClusters::kNode);
    for (std::size_t c = 0; c < out_.clusters.size(); ++c) {
      const MeshCluster& cluster = out_.clusters[c];
      add(out_.nodes[c / MeshClusters::kNode], cluster.min, cluster.max, cluster.finite,
          c % MeshClusters::kNode == 0);
    }
    for (std::size_t n = 0; n < out_.nodes.size(); ++n)
      add(out_.all, out_.nodes[n].min, out_.nodes[n].max, out_.nodes[n].finite, n == 0);
  }

  void bound(MeshCluster& cluster) const {
    const auto at = [&](std::size_t vertex) {
      const std::size_t i = cluster.first_vertex + vertex;
      return out_.positions.empty() ? out_.wide[i] : Vec3d(out_.positions[i]);
    };
    Box3d box;
    cluster.finite = true;
    for (std::size_t v = 0; v < cluster.vertices; ++v) {
      const Vec3d p = at(v);
      // Positions that overflow float32 count as infinite.
      cluster.finite = cluster.finite && is_finite(Vec3d(Vec3(p)));
      box.add(p);
    }
    if (!cluster.finite) return;
    cluster.min = {float_below(box.min.x), float_below(box.min.y), float_below(box.min.z)};
    cluster.max = {float_above(box.max.x), float_above(box.max.y), float_above(box.max.z)};

    Vec3d normals[MeshCluster::kTriangles], sum{};
    std::size_t n = 0;
    double longest = 0, least = std::numeric_limits<double>::infinity();
    bool unsure = false;
    for (std::size_t t = 0; t < cluster.triangles; ++t) {
      const std::uint8_t* const corner =
          out_.corners.data() + (cluster.first_triangle + t) * std::size_t{3};
      const Vec3d a = at(corner[0]), b = at(corner[1]), c = at(corner[2]);
      const Vec3d e[3] = {b - a, c - a, c - b};
      double edge = 0, shortest = std::numeric_limits<double>::infinity();
      for (const Vec3d& v : e) {
        edge = std::max(edge, length(v));
        shortest = std::min(shortest, length(v));
      }
      longest = std::max(longest, edge);
      // Two equal corners stay equal: no area on any screen. (Corners in float64 may become equal
      // later, which makes no triangle larger.)
      if (!(shortest > 0)) continue;
      const Vec3d normal = cross(e[0], e[1]);
      const double twice_area = length(normal);
      const double height = twice_area / edge;
      if (!(height > kThin * edge)) {
        unsure = true;
        continue;
      }
      least = std::min(least, height);
      normals[n] = normal * (1 / twice_area);
      sum = sum + normals[n++];
    }
    cluster.longest_edge = float_above(longest * (1 + 1e-9));
    if (unsure || n == 0 || !(length(sum) > 0)) return;
    cluster.least_height = float_below(least * (1 - 1e-9));
    cluster.axis = Vec3(normalize(sum));
    double cosine = 1;
    for (std::size_t t = 0; t < n; ++t)
      cosine = std::min(cosine, dot(normals[t], Vec3d(cluster.axis)));
    // The axis is float32, and normals are as exact as kThin allows.
    cosine -= 1e-5;
    if (!(cosine > 0)) return;
    cluster.cosine = float_below(cosine);
    cluster.sine =
        float_above(std::sqrt(1 - double{cluster.cosine} * double{cluster.cosine}) + 1e-7);
  }

  MeshClusters& out_;
  parallel::Threads* threads_;
  const MeshView& mesh_;
  std::size_t count_;
  std::vector<std::uint32_t> own_vertices_;
  const std::uint32_t* vertices_ = nullptr;
  std::vector<std::uint64_t> keys_;  ///< by place
};

/// Whether two numbers have the same value; all NaNs are equal.
bool are_equal(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

#if defined(NDEBUG)
/// Triangles that is_of() compares.
constexpr std::size_t kLooks = 8;
#endif

}  // namespace

MeshClusters::MeshClusters(const MeshView& of, parallel::Threads* threads, Way how)
    : way(how), mesh(of) {
  mesh.clusters = nullptr;
  mesh = with_cuts(mesh, cuts, threads);
  if (mesh.triangle_count() >= kNoIndex)
    throw Error(Errc::unsupported, "a mesh of " + std::to_string(mesh.triangle_count()) +
                                       " triangles cannot be prepared; fewer than 2^32 can");
  Builder(*this, threads).build();
}

std::uint64_t MeshClusters::bytes() const {
  const auto of = [](const auto& v) { return std::uint64_t{v.capacity() * sizeof(v[0])}; };
  return of(clusters) + of(triangle) + of(corners) + of(vertex) + of(positions) + of(wide) +
         of(nodes);
}

bool MeshClusters::is_as_it_was(const MeshCluster& c, std::size_t place) const {
  std::uint32_t vertices[3];
  mesh.read_triangles(triangle[place], 1, vertices);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t at = c.first_vertex + corners[3 * place + k];
    if (vertices[k] != vertex[at]) return false;
    const Vec3d now = mesh.positions.is_wide() ? mesh.positions.wide(vertices[k])
                                               : Vec3d(mesh.positions[vertices[k]]);
    const Vec3d then = wide.empty() ? Vec3d(positions[at]) : wide[at];
    if (!are_equal(now.x, then.x) || !are_equal(now.y, then.y) || !are_equal(now.z, then.z))
      return false;
  }
  return true;
}

std::size_t MeshClusters::first_changed() const {
  for (const MeshCluster& c : clusters)
    for (std::size_t t = 0; t < c.triangles; ++t)
      if (!is_as_it_was(c, c.first_triangle + t)) return c.first_triangle + t;
  return triangle.size();
}

bool MeshClusters::is_of(const MeshView& other) const {
  if (other.positions != mesh.positions || other.indices != mesh.indices ||
      other.faces != mesh.faces || other.face_materials != mesh.face_materials)
    return false;
#if !defined(NDEBUG)
  return first_changed() == triangle.size();
#else
  for (std::size_t look = 0; look < std::min(kLooks, clusters.size()); ++look) {
    const MeshCluster& c = clusters[(clusters.size() - 1) * look / kLooks];
    if (!is_as_it_was(c, c.first_triangle)) return false;
  }
  return true;
#endif
}

}  // namespace rastrum
