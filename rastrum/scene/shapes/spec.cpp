// SPDX-License-Identifier: BSD-3-Clause
// Shapes by name: the table behind `builtin:…`, `rastrum make` and `--help`.

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <span>
#include <system_error>
#include <type_traits>
#include <utility>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/error.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::shapes {
namespace {

struct Parameter {
  const char* name;
  const char* value;  ///< the default
};

/// As text, in the table's order.
class Arguments {
 public:
  Arguments(const char* shape, std::span<const Parameter> parameters,
            std::vector<std::string_view> values)
      : shape_(shape), parameters_(parameters), values_(std::move(values)) {}

  template <class T>
  [[nodiscard]] T get(std::size_t i) const {
    const std::string_view text = values_[i];
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
      throw Error(Errc::invalid_argument,
                  std::string(shape_) + ": " + parameters_[i].name + " must be " +
                      (std::is_floating_point_v<T> ? "a number" : "a whole number in range") +
                      ", got '" + std::string(text) + "'");
    return value;
  }

 private:
  const char* shape_;
  std::span<const Parameter> parameters_;
  std::vector<std::string_view> values_;
};

struct Shape {
  const char* name;
  std::vector<Parameter> parameters;
  const char* description;
  Scene (*make)(const Arguments&);
};

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.emplace_back();
  return scene;
}
template <class G>
requires std::constructible_from<Geometry, G> Scene scene_of(G geometry) {
  Scene scene;
  scene.geometries.emplace_back(std::move(geometry));
  scene.instances.emplace_back().geometry = 0;
  return scene;
}

template <class Made, class... Args, std::size_t... kPlaces>
Scene call(Made (*shape)(Args...), const Arguments& a, std::index_sequence<kPlaces...>) {
  return scene_of(shape(a.get<Args>(kPlaces)...));
}
template <class Made, class... Args>
Scene call(Made (*shape)(Args...), const Arguments& a) {
  return call(shape, a, std::index_sequence_for<Args...>());
}
template <auto kShape>
Scene make(const Arguments& a) {
  return call(kShape, a);
}

const std::vector<Shape>& table() {
  static const std::vector<Shape> shapes = {
      {"teapot",
       {{"n", "16"}},
       "Newell's teapot, 32 Bézier patches of n × n quads (64 n² triangles)",
       make<teapot>},
      {"sphere",
       {{"rings", "32"}, {"segments", "64"}},
       "latitude-longitude sphere of radius 1 (2 (rings − 1) segments triangles)",
       make<sphere>},
      {"torus_knot",
       {{"p", "2"}, {"q", "3"}, {"segments", "256"}, {"sides", "24"}, {"tube", "0.25"}},
       "tube around the (p, q) torus knot (2 segments sides triangles)",
       make<torus_knot>},
      {"boxes",
       {{"count", "4"}, {"fill", "0.6"}},
       "count³ boxes of edge `fill` in a grid of unit cells (12 count³ triangles)",
       make<boxes>},
      {"hairball",
       {{"strands", "22500"}, {"segments", "64"}, {"width", "0.002"}, {"seed", "1"}},
       "crossing curves in the unit ball as thin ribbons (2 strands segments triangles)",
       make<hairball>},
      {"gyroid",
       {{"cells", "64"}, {"periods", "2"}},
       "gyroid surface by marching cubes on a grid of cells³",
       make<gyroid>},
      {"soup",
       {{"count", "10000"}, {"min_size", "0.01"}, {"max_size", "0.2"}, {"seed", "1"}},
       "random triangles with edges from min_size to max_size in the cube [−1, 1]³",
       make<soup>},
      {"spheres",
       {{"count", "1000"}, {"min_radius", "0.02"}, {"max_radius", "0.2"}, {"seed", "1"}},
       "random spheres in the cube [−1, 1]³, exact",
       make<spheres>},
      {"cylinders",
       {{"count", "500"}, {"length", "0.4"}, {"radius", "0.04"}, {"seed", "1"}},
       "random cones in the cube [−1, 1]³, exact",
       make<cylinders>},
      {"tube",
       {{"p", "2"}, {"q", "3"}, {"segments", "256"}, {"radius", "0.15"}},
       "tube around the curve of the (p, q) torus knot, exact",
       make<tube>},
      {"discs",
       {{"count", "1000"}, {"min_radius", "0.02"}, {"max_radius", "0.2"}, {"seed", "1"}},
       "random discs in the cube [−1, 1]³, exact",
       make<discs>},
  };
  return shapes;
}

template <class Items>
std::string names_of(const Items& items) {
  std::string names;
  for (const auto& item : items) names.append(names.empty() ? "" : ", ").append(item.name);
  return names;
}

const Shape& find_shape(std::string_view name) {
  for (const Shape& s : table())
    if (s.name == name) return s;
  throw Error(Errc::invalid_argument,
              "no shape '" + std::string(name) + "'; known are " + names_of(table()));
}

}  // namespace

Scene scene_from_spec(std::string_view spec) {
  const FloatScope floats;
  const std::size_t question = spec.find('?');
  const Shape& shape = find_shape(spec.substr(0, question));
  std::vector<std::string_view> values;
  for (const Parameter& p : shape.parameters) values.emplace_back(p.value);

  std::vector<bool> given(values.size());
  std::string_view rest =
      question == std::string_view::npos ? std::string_view{} : spec.substr(question + 1);
  while (!rest.empty()) {
    const std::string_view item = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(item.size() + 1, rest.size()));
    const std::size_t equals = item.find('=');
    const std::string_view key = item.substr(0, equals);
    std::size_t i = 0;
    while (i < values.size() && shape.parameters[i].name != key) ++i;
    if (i == values.size())
      throw Error(Errc::invalid_argument, std::string(shape.name) + ": no parameter '" +
                                              std::string(key) + "'; known are " +
                                              names_of(shape.parameters));
    if (equals == std::string_view::npos || given[i])
      throw Error(Errc::invalid_argument,
                  std::string(shape.name) + ": " + std::string(key) +
                      (given[i] ? " is given twice"
                                : " needs a value, as in " + std::string(key) + "=" +
                                      shape.parameters[i].value));
    given[i] = true;
    values[i] = item.substr(equals + 1);
  }
  return shape.make(Arguments(shape.name, shape.parameters, std::move(values)));
}

Mesh from_spec(std::string_view spec) {
  const FloatScope floats;
  Scene scene = scene_from_spec(spec);
  if (scene.meshes.empty())
    throw Error(Errc::invalid_argument,
                "'" + std::string(spec) + "' is no mesh: its surfaces are drawn as they are");
  return std::move(scene.meshes.front());
}

std::vector<ShapeInfo> catalogue() {
  std::vector<ShapeInfo> infos;
  for (const Shape& s : table()) {
    std::string parameters;
    for (const Parameter& p : s.parameters)
      parameters.append(parameters.empty() ? "" : "&").append(p.name).append("=").append(p.value);
    infos.push_back({s.name, parameters, s.description});
  }
  return infos;
}

}  // namespace rastrum::shapes
