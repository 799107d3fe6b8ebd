// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/scene_checks.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/raster/shade/plain_surface.hpp>
#include <rastrum/render/surfaces.hpp>
#include <rastrum/scene/mesh_checks.hpp>
#include <rastrum/scene/mesh_clusters.hpp>

namespace rastrum {
namespace {

/// On all threads: a million triangles take one thread a millisecond.
std::size_t first_beyond(const IndexView& indices, std::size_t size, parallel::Threads* threads) {
  constexpr std::size_t kGrain = 1 << 16;
  const std::size_t parts = (indices.size() + kGrain - 1) / kGrain;
  if (threads == nullptr || parts < 2) return rastrum::first_beyond(indices, size);
  std::vector<std::size_t> first(parts);
  parallel::for_each_index(*threads, parts, [&](std::size_t part) {
    const std::size_t end = std::min((part + 1) * kGrain, indices.size());
    const std::size_t at = rastrum::first_beyond(indices, size, part * kGrain, end);
    first[part] = at == end ? indices.size() : at;
  });
  return *std::ranges::min_element(first);
}

class InstanceCheck {
 public:
  InstanceCheck(const InstanceView& instance, std::size_t number, parallel::Threads* threads)
      : instance_(instance), number_(number), threads_(threads) {}

  void arrays(const MeshView& mesh) const {
    none(faces_problem(mesh));
    if (mesh.clusters != nullptr && !mesh.clusters->is_of(mesh))
      fail(
          "its positions or triangles are not those that were prepared; prepare it again "
          "(PreparedMesh)");
    if (mesh.triangle_count() == 0) return;  // nothing is read
    attribute(mesh, mesh.normals, "normals");
    attribute(mesh, mesh.texcoords, "texcoords");
    attribute(mesh, mesh.colors, "colors");
    color_space(mesh);
    if (!mesh.scalars.empty())
      as_many(mesh, mesh.scalars.values.size(), mesh.scalars.per, "scalars");
  }
  template <class G>
  void arrays(const G& points_or_lines) const {
    none(arrays_problem(points_or_lines));
    color_space(points_or_lines);
  }
  void arrays(const SpheresView& s) const { quadrics(s, s.size(), "spheres"); }
  void arrays(const DiscsView& d) const {
    quadrics(d, d.size(), "discs");
    none(count_problem(d.normals.size(), "normals", d.size(), "discs"));
  }
  void arrays(const CylindersView& c) const {
    quadrics(c, c.positions.size(), "positions");
    if (const std::size_t ends = c.indices.empty() ? c.positions.size() : c.indices.size();
        ends % 2 != 0)
      fail(text_of("the number of ends, ", ends, ", is odd"));
    if (const std::size_t at = first_beyond(c.indices, c.positions.size(), threads_);
        at != c.indices.size())
      fail(text_of("indices[", at, "]: index ", c.indices.text(at), " is out of range, there are ",
                   c.positions.size(), " positions"));
  }
  void arrays(const TubesView& t) const {
    quadrics(t, t.positions.size(), "positions");
    const auto refuse = [&](std::size_t i, const std::string& why) {
      fail(text_of("offsets[", i, "] is ", t.offsets.text(i), why));
    };
    // Negative offsets are beyond all positions.
    for (std::size_t i = 0; i < t.offsets.size(); ++i)
      if (t.offsets.wide(i) > t.positions.size())
        refuse(i, text_of(", but there are ", t.positions.size(), " positions"));
      else if (i > 0 && t.offsets.wide(i) <= t.offsets.wide(i - 1))
        refuse(i, ", which does not lie above the one before, " + t.offsets.text(i - 1));
  }
  void material(std::size_t materials) const {
    none(material_problem(raster::material_of(instance_), materials));
  }
  void mapping(std::size_t mappings) const {
    if (mappings != 0 && instance_.scalar_mapping >= mappings)
      fail(text_of("scalar mapping ", instance_.scalar_mapping, " is out of range, there are ",
                   mappings));
  }
  void place() const {
    const auto& last = instance_.object_to_world.m[3];
    if (last[0] == 0 && last[1] == 0 && last[2] == 0 && last[3] == 1) return;
    std::string numbers;
    for (const double v : last) numbers.append(" ").append(number_text(v));
    fail(text_of(
        "the last row of its object_to_world must be 0 0 0 1, not", numbers,
        "; matrices multiply columns, so a translation is the last column (matrix_from_columns)"));
  }
  void look() const {
    if (instance_.winding > Winding::either)
      check_enum(instance_.winding, Winding::either, name() + ": its winding");
    // Written so that a NaN fails.
    if (!(instance_.opacity >= 0 && instance_.opacity <= 1))
      fail("its opacity must lie in [0, 1], not " + number_text(instance_.opacity));
    if (const auto& c = instance_.color; c && !(std::isfinite(c->x) && std::isfinite(c->y) &&
                                                std::isfinite(c->z) && std::isfinite(c->w)))
      fail("its colour must be four finite numbers");
  }

 private:
  void none(const std::string& problem) const {
    if (!problem.empty()) fail(problem);
  }
  [[nodiscard]] std::string name() const { return "instance " + std::to_string(number_); }
  [[noreturn]] void fail(const std::string& problem) const { reject(name(), ": ", problem); }

  template <class G>
  void color_space(const G& geometry) const {
    if (geometry.color_space > ColorSpace::linear)
      check_enum(geometry.color_space, ColorSpace::linear, name() + ": its color_space");
  }

  /// Arrays with one value per element, or none.
  template <class G>
  void quadrics(const G& geometry, std::size_t count, const char* elements) const {
    const auto each = [&](std::size_t values, const char* array) {
      if (values != 0) none(count_problem(values, array, count, elements));
    };
    each(geometry.radii.size(), "radii");
    each(geometry.colors.size(), "colors");
    each(geometry.scalars.size(), "scalars");
  }

  template <class T>
  void attribute(const MeshView& mesh, const AttributeView<T>& a, const char* what) const {
    if (a.empty()) return;
    const std::string array(what);
    if (!a.indices.empty()) {
      none(count_problem(a.indices.size(), array + ".indices", mesh.corner_count(), "corners"));
      if (const std::size_t at = first_beyond(a.indices, a.values.size(), threads_);
          at != a.indices.size())
        fail(text_of(array, ".indices[", at, "]: index ", a.indices.text(at),
                     " is out of range, there are ", a.values.size()));
      return;
    }
    as_many(mesh, a.values.size(), a.per, array);
  }

  void as_many(const MeshView& mesh, std::size_t values, Per per, const std::string& array) const {
    if (per > Per::mesh) check_enum(per, Per::mesh, name() + ": " + array + ".per");
    const auto require = [&](std::size_t count, const char* elements) {
      none(count_problem(values, array, count, elements));
    };
    switch (per) {
      case Per::vertex:
        return require(mesh.positions.size(), "positions");
      case Per::corner:
        return require(mesh.corner_count(), "corners");
      case Per::face:
        return require(mesh.face_count(), "faces");
      case Per::mesh:
        return require(1, "meshes");
    }
  }

  const InstanceView& instance_;
  std::size_t number_;
  parallel::Threads* threads_;
};

/// On all threads, since a scene may have a million instances.
void check_transforms(const InstanceRuns& runs, parallel::Threads* threads) {
  if (runs.firsts().instances.empty()) return;
  const std::size_t last = runs.firsts().instances.size() - 1;
  const std::span instances(runs.instances(0), runs.number(last) + runs.length(last));
  const auto check = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double sum = 0;  // NaN where one of them is not finite
      for (const auto& row : instances[i].object_to_world.m)
        for (const double x : row) sum += x * 0;
      if (sum != 0) reject("instance ", i, ": object_to_world must be finite numbers");
    }
  };
  constexpr std::size_t kGrain = 4096;
  if (threads == nullptr || instances.size() <= kGrain) return check(0, instances.size());
  parallel::for_each_index(*threads, (instances.size() + kGrain - 1) / kGrain, [&](std::size_t k) {
    check(k * kGrain, std::min((k + 1) * kGrain, instances.size()));
  });
}

template <class T>
bool is_packed(const AttributeView<T>& a) {
  return a.values.is_packed() && a.indices.is_packed() && a.per == Per::vertex;
}

}  // namespace

void check_scene(const InstanceRuns& runs, parallel::Threads* threads) {
  check_transforms(runs, threads);
  const SceneView& scene = runs.firsts();
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const InstanceCheck check(scene.instances[i], runs.number(i), threads);
    const GeometryRef geometry = scene.instances[i].geometry;
    // Instances of one view mostly lie together.
    if (i == 0 || geometry != scene.instances[i - 1].geometry) {
      if (const MeshView* const mesh = scene.instances[i].mesh()) check.arrays(*mesh);
      if (const auto* const points = geometry.get_if<PointsView>()) check.arrays(*points);
      if (const auto* const lines = geometry.get_if<LinesView>()) check.arrays(*lines);
    }
    if (is_points_or_lines(geometry)) check.material(scene.materials.size());
    check.mapping(scene.scalar_mappings.size());
    check.look();
    for (std::size_t k = 0; k < runs.length(i); ++k)
      InstanceCheck(runs.instances(i)[k], runs.number(i) + k, threads).place();
  }
}

void check_surfaces(const InstanceRuns& runs) {
  const SceneView& scene = runs.firsts();
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    if (const auto geometry = quadrics_of(scene.instances[i].geometry)) {
      const InstanceCheck check(scene.instances[i], runs.number(i), nullptr);
      check.material(scene.materials.size());
      std::visit([&](const auto& g) { check.arrays(g); }, *geometry);
    }
}

std::string why_not_on_device(const SceneView& scene) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const InstanceView& instance = scene.instances[i];
    if (shows_scalars(scene, instance))
      return text_of("instance ", i, " shows scalars, which only the CPU colours");
    if (is_points_or_lines(instance.geometry))
      return text_of("instance ", i, " has points or lines, which only the CPU draws");
    if (instance.mesh() == nullptr) continue;
    const MeshView& m = *instance.mesh();
    const auto say = [&](const char* what) {
      return text_of("instance ", i, " has ", what, ", which the device does not read");
    };
    if (!m.is_packed_list()) return say("faces or indices that are no list of uint32 triangles");
    if (!m.positions.is_packed() || !is_packed(m.normals) || !is_packed(m.texcoords) ||
        !is_packed(m.colors) || !m.face_materials.is_packed())
      return say("arrays that are not packed float32 or uint32, one value a vertex");
    if (instance.opacity != 1 || instance.color || !instance.visible)
      return say("its own opacity, colour or visibility");
  }
  return {};
}

}  // namespace rastrum
