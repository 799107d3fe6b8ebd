// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/scene/scene_vertices.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <list>
#include <map>
#include <string>

#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/parallel/shares.hpp>
#include <rastrum/points_and_lines.hpp>
#include <rastrum/scene/face_cuts.hpp>
#include <rastrum/scene/mesh_checks.hpp>
#include <rastrum/surfaces.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {
namespace {

constexpr std::size_t kRun = 1024;  ///< elements of a geometry: vertices, balls, ends

template <class G>
concept Round = std::same_as<G, SpheresView> || std::same_as<G, DiscsView> ||
    std::same_as<G, TubesView> || std::same_as<G, CylindersView>;
template <class G>
constexpr bool kHasEnds = std::same_as<G, LinesView> || std::same_as<G, CylindersView>;

template <class G>
const ArrayView<Vec3>& centers_or_positions(const G& g) {
  if constexpr (requires { g.centers; })
    return g.centers;
  else
    return g.positions;
}

/// The number of a geometry's elements, and the position of one.
template <class G>
std::size_t element_count(const G& g) {
  if constexpr (kHasEnds<G>)
    return 2 * g.size();
  else if constexpr (std::same_as<G, PointsView>)
    return g.size();
  else
    return centers_or_positions(g).size();
}
template <class G>
std::size_t position_of(const G& g, std::size_t i) {
  if constexpr (std::same_as<G, PointsView>)
    return g.vertex(i);
  else if constexpr (std::same_as<G, LinesView>)
    return g.vertex(i / 2, static_cast<int>(i % 2));
  else if constexpr (std::same_as<G, CylindersView>)
    return g.end(i / 2, static_cast<int>(i % 2));
  else
    return i;
}

std::size_t element_count(GeometryRef geometry) {
  return geometry.visit([](const auto& g) { return element_count(g); });
}
std::size_t run_count(GeometryRef geometry) {
  return (element_count(geometry) + kRun - 1) / kRun;
}

void check(const MeshView& g) {
  check_indices(g);
}
template <class G>
requires(std::same_as<G, PointsView> || std::same_as<G, LinesView>) void check(const G& g) {
  std::string problem = arrays_problem(g);
  if (const std::size_t at = first_beyond(g.indices, g.positions.size());
      problem.empty() && at != g.indices.size())
    problem = "indices[" + std::to_string(at) + "]: index " + g.indices.text(at) +
              " is out of range, there are " + std::to_string(g.positions.size()) + " positions";
  if (!problem.empty()) throw Error(Errc::invalid_argument, "points or lines: " + problem);
}
template <Round G>
void check(const G& g) {
  const std::size_t positions = centers_or_positions(g).size();
  if (g.radii.empty() || g.radii.size() >= positions) return;
  for (std::size_t i = 0; i < element_count(g); ++i)
    if (const std::size_t p = position_of(g, i); p >= g.radii.size() && p < positions)
      throw Error(Errc::invalid_argument, "radii: there are " + std::to_string(g.radii.size()) +
                                              ", and number " + std::to_string(p) +
                                              " is asked for");
}

std::vector<bool> used_of(const MeshView& given) {
  std::list<FaceCuts> cuts;
  const MeshView mesh = with_cuts(given, cuts);
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

/// Calls f for places around a ball: its extremes along the axes, and the edges and corners of its
/// cube, drawn in so that no plane that holds all of them cuts off more than a fortieth of the
/// radius.
template <class F>
void visit_ball(const Vec3d& centre, double radius, const F& f) {
  if (!(radius >= 0)) return;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const int n = x * x + y * y + z * z;
        if (n == 0) continue;
        const double s = n == 1 ? radius : radius * 1.13 / std::sqrt(static_cast<double>(n));
        f(centre + Vec3d{x * s, y * s, z * s});
      }
}

/// Calls f(position) for the elements [first, end) in use, or for places around them.
template <class F>
void visit_elements(const MeshView& g, const std::vector<bool>& used, std::size_t first,
                    std::size_t end, const F& f) {
  for (std::size_t v = first; v < end; ++v)
    if (used[v]) f(g.positions.wide(v));
}
template <class G, class F>
void visit_elements(const G& g, const std::vector<bool>&, std::size_t first, std::size_t end,
                    const F& f) {
  const ArrayView<Vec3>& positions = centers_or_positions(g);
  for (std::size_t i = first; i < end; ++i) {
    const std::size_t p = position_of(g, i);
    if constexpr (Round<G>) {
      if (p < positions.size())
        visit_ball(positions.wide(p), double{g.radii.empty() ? g.radius : g.radii[p]}, f);
    } else {
      f(positions.wide(p));
    }
  }
}

}  // namespace

template <class F>
void SceneVertices::visit(const Source& source, std::size_t run, const F& f) const {
  source.geometry.visit([&](const auto& g) {
    visit_elements(g, source.used, run * kRun, std::min(element_count(g), (run + 1) * kRun), f);
  });
}

SceneVertices::SceneVertices(const SceneView& scene) : scene_(scene) {
  // Sources by the memory that they read. Two of the same memory may still see it differently.
  std::multimap<std::array<const void*, 3>, std::uint32_t> sources_of;
  const auto source_of = [&](const MeshView& mesh) {
    const std::array<const void*, 3> key{
        mesh.positions.empty() ? nullptr : mesh.positions.address(0), mesh.indices.data(),
        mesh.faces.offsets.data()};
    const auto next = static_cast<std::uint32_t>(sources_.size());
    for (auto [at, end] = sources_of.equal_range(key); at != end; ++at) {
      const MeshView& other = *sources_[at->second].geometry.get_if<MeshView>();
      if (mesh.positions == other.positions && mesh.indices == other.indices &&
          mesh.faces == other.faces)
        return at->second;
    }
    sources_of.emplace(key, next);
    return next;
  };
  for (const InstanceView& instance : scene.instances) {
    const auto next = static_cast<std::uint32_t>(sources_.size());
    std::uint32_t source = next;
    if (!instances_.empty() && instance.geometry == scene.instances[instances_.size() - 1].geometry)
      source = instances_.back().source;
    else if (const MeshView* const mesh = instance.mesh())
      source = source_of(*mesh);
    if (source == next) {
      instance.geometry.visit([](const auto& g) { check(g); });
      sources_.push_back({instance.geometry});
      if (const MeshView* const mesh = instance.mesh()) sources_.back().used = used_of(*mesh);
    }
    const std::size_t runs = run_count(sources_[source].geometry);
    instances_.push_back({source, instance_of_.size()});
    instance_of_.insert(instance_of_.end(), runs,
                        static_cast<std::uint32_t>(instances_.size() - 1));
  }
  struct RunOfSource {
    std::uint32_t source, run;
  };
  std::vector<RunOfSource> all;
  for (Source& source : sources_) {
    source.boxes.resize(run_count(source.geometry));
    for (std::size_t run = 0; run < source.boxes.size(); ++run)
      all.push_back(
          {static_cast<std::uint32_t>(&source - sources_.data()), static_cast<std::uint32_t>(run)});
  }
  parallel::on_threads_of_its_own(all.size() * kRun, [&](auto& exec) {
    parallel::for_each_index(exec, all.size(), [&](std::size_t i) {
      Source& source = sources_[all[i].source];
      Box3d box;
      visit(source, all[i].run, [&](const Vec3d& p) {
        if (is_finite(p)) box.add(p);
      });
      source.boxes[all[i].run] = {box.min, box.max};
    });
  });
}

std::optional<FitVertices::Box> SceneVertices::box(std::size_t run) const {
  return sources_[instances_[instance_of_[run]].source].boxes[run_in_source(run)];
}

const Mat4d& SceneVertices::object_to_world(std::size_t run) const {
  return scene_.instances[instance_of_[run]].object_to_world;
}

void SceneVertices::read(
    std::span<const std::size_t> runs,
    FunctionRef<void(std::size_t i, std::span<const Vec3d> vertices)> f) const {
  parallel::on_threads_of_its_own(runs.size() * kRun, [&](auto& exec) {
    parallel::for_each_index(exec, runs.size(), [&](std::size_t i) {
      Vec3d some[kRun];
      std::size_t n = 0;
      visit(sources_[instances_[instance_of_[runs[i]]].source], run_in_source(runs[i]),
            [&](const Vec3d& p) {
              some[n++] = p;
              if (n < kRun) return;
              f(i, some);
              n = 0;
            });
      if (n != 0) f(i, {some, n});
    });
  });
}

}  // namespace rastrum
