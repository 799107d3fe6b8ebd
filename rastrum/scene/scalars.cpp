// SPDX-License-Identifier: BSD-3-Clause
// A scene's scalars: which geometry shows some, their range, scalars made of coordinates.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/nearest_word.hpp>
#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/scene/scalars.hpp>

namespace rastrum {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Grows `range`, empty at first, by finite values. Returns how many are not finite.
template <class Values>
std::uint64_t grow(ScalarRange& range, const Values& values, bool above_zero = false) {
  std::uint64_t others = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double v = values[i];
    if (!std::isfinite(v)) {
      ++others;
    } else if (!above_zero || v > 0) {
      range.low = std::min(range.low, v);
      range.high = std::max(range.high, v);
    }
  }
  return others;
}

ScalarRange or_zero(ScalarRange range) {
  return range.low <= range.high ? range : ScalarRange{0, 0};
}

template <class F>
void for_each_scalars(const Scene& scene, F&& f) {
  for (const Mesh& mesh : scene.meshes)
    for (const NamedScalars& s : mesh.scalars) f(s);
  for (const Geometry& geometry : scene.geometries)
    std::visit(
        [&](const auto& g) {
          for (const NamedScalars& s : g.scalars) f(s);
        },
        geometry);
}

template <class G>
ArrayView<Vec3> positions_of(const G& g) {
  if constexpr (requires { g.centers; })
    return g.view().centers;
  else
    return g.view().positions;
}

void make_unique(Scene& scene) {
  std::vector<bool> mesh_taken(scene.meshes.size()), geometry_taken(scene.geometries.size());
  for (Instance& instance : scene.instances) {
    const auto take = [](auto& all, std::vector<bool>& taken, std::uint32_t& number) {
      if (number >= taken.size()) return;  // refused where it is drawn
      if (taken[number]) {
        all.push_back(all[number]);
        number = static_cast<std::uint32_t>(all.size() - 1);
      } else {
        taken[number] = true;
      }
    };
    if (instance.geometry)
      take(scene.geometries, geometry_taken, *instance.geometry);
    else
      take(scene.meshes, mesh_taken, instance.mesh);
  }
}

/// `value`: of a place in the world.
template <class Value>
void make_scalars(Scene& scene, const std::string& name, const Value& value) {
  make_unique(scene);
  for (const Instance& instance : scene.instances) {
    const auto make = [&](auto& g) {
      NamedScalars& s = g.scalars.emplace_back();
      s.name = name;
      const ArrayView<Vec3> positions = positions_of(g);
      for (std::size_t i = 0; i < positions.size(); ++i)
        s.values.push_back(value(moved_by(instance.object_to_world, positions.wide(i))));
    };
    if (instance.geometry)
      std::visit(make, scene.geometries[*instance.geometry]);
    else
      make(scene.meshes[instance.mesh]);
  }
}

}  // namespace

MeshScalarsView scalars_of(const InstanceView& instance) {
  if (instance.scalar) return {std::span(&*instance.scalar, 1), Per::mesh};
  return instance.geometry.visit([](const auto& g) -> MeshScalarsView {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(g)>, MeshView>)
      return g.scalars;
    else
      return {g.scalars, Per::vertex};
  });
}

bool shows_scalars(const SceneView& scene, const InstanceView& instance) {
  return !scene.scalar_mappings.empty() && !scalars_of(instance).empty();
}

ScalarRange scalars_in_use(const SceneView& scene, std::size_t mapping) {
  const FloatScope floats;
  if (mapping >= scene.scalar_mappings.size())
    throw Error(Errc::invalid_argument, "scalar mapping " + std::to_string(mapping) +
                                            " is out of range, there are " +
                                            std::to_string(scene.scalar_mappings.size()));
  ScalarRange range{kInfinity, -kInfinity};
  for (const InstanceView& instance : scene.instances)
    if (instance.visible && instance.scalar_mapping == mapping)
      grow(range, scalars_of(instance).values, scene.scalar_mappings[mapping].logarithmic);
  return range;
}

ScalarRange range_of(const ScalarMapping& mapping, ScalarRange in_use) {
  if (in_use.low <= in_use.high) return in_use;
  return mapping.logarithmic ? ScalarRange{1, 1} : ScalarRange{};
}

ScalarColors scalar_colors(const SceneView& scene, std::size_t mapping) {
  const FloatScope floats;
  if (mapping < scene.scalar_mappings.size()) {
    const ScalarMapping& m = scene.scalar_mappings[mapping];
    if (m.range || !m.categories.empty()) return ScalarColors(m, {0, 1});
  }
  const ScalarRange in_use = scalars_in_use(scene, mapping);
  const ScalarMapping& m = scene.scalar_mappings[mapping];
  return ScalarColors(m, range_of(m, in_use));
}

std::vector<ScalarSummary> scalar_summaries(const Scene& scene) {
  const FloatScope floats;
  std::vector<ScalarSummary> all;
  for_each_scalars(scene, [&](const NamedScalars& s) {
    auto at = std::ranges::find(all, s.name, &ScalarSummary::name);
    if (at == all.end()) at = all.insert(all.end(), {s.name, 0, {kInfinity, -kInfinity}, 0});
    at->values += s.values.size();
    at->nan += grow(at->range, s.values);
  });
  for (ScalarSummary& s : all) s.range = or_zero(s.range);
  return all;
}

bool has_scalars(const Scene& scene, const std::string& name) {
  bool known = false;
  for_each_scalars(scene, [&](const NamedScalars& s) { known |= s.name == name; });
  return known;
}

void show_scalars(Scene& scene, const std::string& name, const Bounds* whole) {
  const FloatScope floats;
  std::string names;
  if (!has_scalars(scene, name)) {
    if (name == "x" || name == "y" || name == "z") {
      make_scalars(scene, name, [&](const Vec3d& p) {
        return name == "x" ? p.x : name == "y" ? p.y : p.z;
      });
    } else if (name == "distance") {
      const Bounds box = whole != nullptr ? *whole : bounds(SceneBinding(scene).view());
      const Vec3d middle = (box.min + box.max) * 0.5;
      make_scalars(scene, name, [&](const Vec3d& p) { return length(p - middle); });
    } else {
      const std::vector<ScalarSummary> all = scalar_summaries(scene);
      std::vector<std::string_view> words{"distance"};
      for (const ScalarSummary& s : all) {
        names.append(s.name).append(", ");
        words.push_back(s.name);
      }
      throw Error(Errc::not_found, "there are no scalars called '" + name + "'" +
                                       did_you_mean(name, words) + " (there are " +
                                       (names.empty() ? "none but those" : names + "and those") +
                                       " of every scene: x, y, z, distance)");
    }
  }
  scene.shown_scalars = name;
}

ScalarRange finite_range(std::span<const double> values, bool above_zero) {
  ScalarRange r{kInfinity, -kInfinity};
  grow(r, values, above_zero);
  return or_zero(r);
}

}  // namespace rastrum
