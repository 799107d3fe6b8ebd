// SPDX-License-Identifier: BSD-3-Clause
// Scenes of the C interface: views of the caller's arrays.
#include <rastrum/c/handles.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include <rastrum/array.hpp>
#include <rastrum/color_map.hpp>
#include <rastrum/core/enum.hpp>
#include <rastrum/scalars.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::c {

static_assert(RASTRUM_FLOAT32 == static_cast<int>(NumberType::float32) &&
              RASTRUM_FLOAT64 == static_cast<int>(NumberType::float64) &&
              RASTRUM_UINT8 == static_cast<int>(NumberType::uint8) &&
              RASTRUM_INT8 == static_cast<int>(NumberType::int8) &&
              RASTRUM_UINT16 == static_cast<int>(NumberType::uint16) &&
              RASTRUM_INT16 == static_cast<int>(NumberType::int16) &&
              RASTRUM_UINT32 == static_cast<int>(NumberType::uint32) &&
              RASTRUM_INT32 == static_cast<int>(NumberType::int32) &&
              RASTRUM_UINT64 == static_cast<int>(NumberType::uint64) &&
              RASTRUM_INT64 == static_cast<int>(NumberType::int64));
static_assert(RASTRUM_PER_VERTEX == static_cast<int>(Per::vertex) &&
              RASTRUM_PER_CORNER == static_cast<int>(Per::corner) &&
              RASTRUM_PER_FACE == static_cast<int>(Per::face) &&
              RASTRUM_PER_MESH == static_cast<int>(Per::mesh));

namespace {

/// Makes a view of array.hpp or scalars.hpp. `channels`: those of its values if `a` gives none.
template <class View>
View view_of(const rastrum_array& a, int channels = 1) {
  if (a.count == 0) return {};
  if (a.data == nullptr) array_detail::refuse_null(a.count);
  const auto type = to_enum<NumberType>(a.type);
  check_enum(type, NumberType::int64, "array: its type");
  require(a.channels >= 0, "array: ", a.channels, " channels");
  if (a.channels > 0) channels = a.channels;
  const std::size_t value = bytes_of(type) * static_cast<std::size_t>(channels);
  const std::ptrdiff_t stride =
      a.stride_bytes != 0 ? a.stride_bytes : static_cast<std::ptrdiff_t>(value);
  const auto forward = static_cast<std::size_t>(stride);
  const std::size_t step = stride < 0 ? 0 - forward : forward;
  require(a.count <= std::numeric_limits<std::ptrdiff_t>::max() / step, "array: ", a.count,
          " values, every ", stride, " bytes, do not fit into memory");
  // C gives no size of the memory: it ends with the last value.
  const auto* const first = static_cast<const std::byte*>(a.data);
  const std::span<const std::byte> reach = array_detail::reach(first, a.count, stride, value);
  return View::in(reach, {.type = type,
                          .channels = channels,
                          .count = a.count,
                          .offset_bytes = static_cast<std::size_t>(first - reach.data()),
                          .stride_bytes = stride});
}

IndexView indices_of(const rastrum_array& a) {
  return view_of<IndexView>(a);
}
ArrayView<Vec3> vectors_of(const rastrum_array& a) {
  return view_of<ArrayView<Vec3>>(a, 3);
}
ArrayView<float> floats_of(const rastrum_array& a) {
  return view_of<ArrayView<float>>(a);
}

void append(rastrum_scene& scene, const InstanceView& instance,
            std::shared_ptr<GeometryView> geometry, size_t* number) {
  scene.geometries.resize(scene.instances.size());  // drops what a failed append has left
  scene.geometries.push_back(std::move(geometry));
  scene.instances.push_back(instance);
  scene.instances.back().geometry = *scene.geometries.back();
  if (number != nullptr) *number = scene.instances.size() - 1;
}

/// Adds the geometry that f() makes.
template <class F>
rastrum_status add(rastrum_scene* scene, size_t* number, const F& f) noexcept {
  return guarded(
      [&] { append(at(scene, "the scene"), {}, std::make_shared<GeometryView>(f()), number); });
}

InstanceView& instance_of(rastrum_scene* scene, size_t number) {
  const std::size_t count = at(scene, "the scene").instances.size();
  require(number < count, "there is no instance ", number, ": the scene has ", count);
  return scene->instances[number];
}

template <class F>
rastrum_status with_instance(rastrum_scene* scene, size_t number, const F& f) noexcept {
  return guarded([&] { f(instance_of(scene, number)); });
}

/// Calls f(geometry), which returns whether this kind of geometry has the attribute.
template <class F>
rastrum_status with_geometry(rastrum_scene* scene, size_t number, const char* what,
                             const F& f) noexcept {
  return with_instance(scene, number, [&](InstanceView& instance) {
    std::shared_ptr<GeometryView>& geometry = scene->geometries[number];
    if (geometry.use_count() > 1) geometry = std::make_shared<GeometryView>(*geometry);
    instance.geometry = *geometry;
    require(std::visit(f, *geometry), "instance ", number, ": its kind of geometry has no ", what);
  });
}

Per per_of(int per) {
  check_enum(to_enum<Per>(per), Per::mesh, "per");
  return to_enum<Per>(per);
}

/// Sets an attribute of a mesh, or of a geometry with one value per element.
template <class T>
void set(AttributeView<T>& attribute, const ArrayView<T>& values, int per) {
  attribute = {values, {}, per_of(per)};
}
void set(MeshScalarsView& attribute, const ScalarView& values, int per) {
  attribute = {values, per_of(per)};
}
template <class View>
void set(View& attribute, const View& values, int per) {
  require(per == RASTRUM_PER_VERTEX, "per: only meshes have values of corners and faces");
  attribute = values;
}

ScalarMapping& color_map_of(rastrum_scene* scene, size_t number) {
  const std::size_t count = at(scene, "the scene").color_maps.size();
  require(number < count, "there is no colour map ", number, ": the scene has ", count);
  return scene->color_maps[number];
}

}  // namespace

#pragma GCC visibility push( \
    default)  // as in rastrum.h, whose declarations are in another namespace
extern "C" {

rastrum_scene* rastrum_scene_new() {
  return made([] { return new rastrum_scene; });
}

void rastrum_scene_free(rastrum_scene* scene) {
  delete scene;
}

rastrum_status rastrum_scene_add_mesh(rastrum_scene* scene, rastrum_array positions,
                                      rastrum_array indices, size_t* instance) {
  return add(scene, instance, [&] {
    return MeshView{.positions = vectors_of(positions), .indices = indices_of(indices)};
  });
}

rastrum_status rastrum_scene_add_points(rastrum_scene* scene, rastrum_array positions,
                                        float size_px, size_t* instance) {
  return add(scene, instance,
             [&] { return PointsView{.positions = vectors_of(positions), .point_size = size_px}; });
}

rastrum_status rastrum_scene_add_lines(rastrum_scene* scene, rastrum_array positions,
                                       rastrum_array indices, float width_px, size_t* instance) {
  return add(scene, instance, [&] {
    return LinesView{
        .positions = vectors_of(positions), .indices = indices_of(indices), .line_width = width_px};
  });
}

rastrum_status rastrum_scene_add_spheres(rastrum_scene* scene, rastrum_array centers, float radius,
                                         size_t* instance) {
  return add(scene, instance,
             [&] { return SpheresView{.centers = vectors_of(centers), .radius = radius}; });
}

rastrum_status rastrum_scene_add_cylinders(rastrum_scene* scene, rastrum_array positions,
                                           rastrum_array indices, float radius, size_t* instance) {
  return add(scene, instance, [&] {
    return CylindersView{
        .positions = vectors_of(positions), .indices = indices_of(indices), .radius = radius};
  });
}

rastrum_status rastrum_scene_add_tubes(rastrum_scene* scene, rastrum_array positions, float radius,
                                       size_t* instance) {
  return add(scene, instance,
             [&] { return TubesView{.positions = vectors_of(positions), .radius = radius}; });
}

rastrum_status rastrum_scene_add_copy(rastrum_scene* scene, size_t instance, size_t* copy) {
  return guarded([&] {
    const InstanceView same = instance_of(scene, instance);
    append(*scene, same, scene->geometries[instance], copy);
  });
}

rastrum_status rastrum_scene_add_color_map(rastrum_scene* scene, const char* colors,
                                           size_t* color_map) {
  return guarded([&] {
    ScalarMapping mapping{.map = color_map_or_list(&at(colors, "the name of the colour map"))};
    at(scene, "the scene").color_maps.push_back(std::move(mapping));
    if (color_map != nullptr) *color_map = scene->color_maps.size() - 1;
  });
}

rastrum_status rastrum_scene_set_color_range(rastrum_scene* scene, size_t color_map, double low,
                                             double high) {
  return guarded([&] { color_map_of(scene, color_map).range = ScalarRange{low, high}; });
}

rastrum_status rastrum_instance_set_transform(rastrum_scene* scene, size_t instance,
                                              const double matrix[16]) {
  return with_instance(scene, instance, [&](InstanceView& i) {
    i.object_to_world = c::matrix(matrix, "the matrix");
  });
}

rastrum_status rastrum_instance_set_offsets(rastrum_scene* scene, size_t instance,
                                            rastrum_array offsets) {
  return with_geometry(scene, instance, "offsets", [&]<class G>(G& g) {
    const IndexView view = indices_of(offsets);
    if constexpr (std::is_same_v<G, MeshView>) g.faces = {FaceKind::polygons, view};
    if constexpr (std::is_same_v<G, LinesView>) g.kind = LineKind::polylines;
    if constexpr (requires { g.offsets; }) g.offsets = view;
    return std::is_same_v<G, MeshView> || requires {
      g.offsets;
    };
  });
}

rastrum_status rastrum_instance_set_normals(rastrum_scene* scene, size_t instance,
                                            rastrum_array normals, int per) {
  return with_geometry(scene, instance, "normals", [&]<class G>(G& g) {
    if constexpr (requires { g.normals; }) set(g.normals, vectors_of(normals), per);
    return requires {
      g.normals;
    };
  });
}

rastrum_status rastrum_instance_set_colors(rastrum_scene* scene, size_t instance,
                                           rastrum_array colors, int per) {
  return with_geometry(scene, instance, "colours", [&](auto& g) {
    set(g.colors, view_of<ArrayView<Vec4>>(colors, 4), per);
    return true;
  });
}

rastrum_status rastrum_instance_set_scalars(rastrum_scene* scene, size_t instance,
                                            rastrum_array scalars, int per, size_t color_map) {
  return with_geometry(scene, instance, "scalars", [&](auto& g) {
    (void)color_map_of(scene, color_map);
    set(g.scalars, view_of<ScalarView>(scalars), per);
    scene->instances[instance].scalar_mapping = static_cast<std::uint32_t>(color_map);
    return true;
  });
}

rastrum_status rastrum_instance_set_radii(rastrum_scene* scene, size_t instance,
                                          rastrum_array radii) {
  return with_geometry(scene, instance, "radii", [&]<class G>(G& g) {
    if constexpr (requires { g.radii; }) g.radii = floats_of(radii);
    if constexpr (requires { g.sizes; }) g.sizes = floats_of(radii);
    return requires {
      g.radii;
    }
    || requires {
      g.sizes;
    };
  });
}

rastrum_status rastrum_instance_set_color(rastrum_scene* scene, size_t instance,
                                          const float rgba[4]) {
  return with_instance(scene, instance, [&](InstanceView& i) {
    i.color = rgba == nullptr ? std::nullopt : std::optional(vec4(rgba, "rgba"));
  });
}

rastrum_status rastrum_instance_set_opacity(rastrum_scene* scene, size_t instance, float opacity) {
  return with_instance(scene, instance, [&](InstanceView& i) { i.opacity = opacity; });
}

rastrum_status rastrum_instance_set_visible(rastrum_scene* scene, size_t instance, int visible) {
  return with_instance(scene, instance, [&](InstanceView& i) { i.visible = visible != 0; });
}

rastrum_status rastrum_instance_set_id(rastrum_scene* scene, size_t instance, int64_t id) {
  return with_instance(scene, instance, [&](InstanceView& i) { i.id = id; });
}

}  // extern "C"
#pragma GCC visibility pop
}  // namespace rastrum::c
