// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <string_view>
#include <tuple>
#include <utility>

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <rastrum/color.hpp>
#include <rastrum/color_map.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/io.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::python {
namespace {

/// Begins a shape's name in place of a file.
constexpr std::string_view kBuiltin = "builtin:";

using Numbers4 = std::array<double, 4>;
using Numbers3 = std::array<double, 3>;

Vec4 vec4(const Numbers4& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]),
          static_cast<float>(v[3])};
}

Material material(const Numbers4& base_color, double metallic, double roughness,
                  const Numbers3& emissive, const std::string& alpha_mode, double alpha_cutoff,
                  bool double_sided, bool unlit, double opacity, const Numbers3& classic,
                  const std::array<std::int32_t, 5>& textures) {
  Material m;
  m.base_color = vec4(base_color);
  m.metallic = static_cast<float>(metallic);
  m.roughness = static_cast<float>(roughness);
  m.emissive = {static_cast<float>(emissive[0]), static_cast<float>(emissive[1]),
                static_cast<float>(emissive[2])};
  m.alpha_mode = named<AlphaMode>("alpha_mode", alpha_mode, {"opaque", "mask", "blend"});
  m.alpha_cutoff = static_cast<float>(alpha_cutoff);
  m.double_sided = double_sided;
  m.unlit = unlit;
  m.opacity = static_cast<float>(opacity);
  m.classic = {static_cast<float>(classic[0]), static_cast<float>(classic[1]),
               static_cast<float>(classic[2])};
  m.base_color_texture = textures[0];
  m.metallic_roughness_texture = textures[1];
  m.normal_texture = textures[2];
  m.occlusion_texture = textures[3];
  m.emissive_texture = textures[4];
  return m;
}

using Interval = std::pair<double, double>;

ScalarMapping mapping(const std::vector<Numbers4>& colors, bool discrete,
                      const std::optional<Interval>& range, bool logarithmic, bool symmetric,
                      int steps, const std::vector<double>& categories,
                      const std::optional<Numbers4>& below, const std::optional<Numbers4>& above,
                      const Numbers4& nan, const std::vector<Interval>& opacity,
                      const std::vector<double>& isolines, const Numbers4& isoline_color,
                      double isoline_px) {
  ScalarMapping m;
  m.map = {"", {}, discrete};
  for (const Numbers4& c : colors) m.map.colors.push_back(vec4(c));
  if (range) m.range = {range->first, range->second};
  m.logarithmic = logarithmic;
  m.symmetric = symmetric;
  m.steps = steps;
  m.categories = categories;
  if (below) m.below = vec4(*below);
  if (above) m.above = vec4(*above);
  m.nan = vec4(nan);
  for (const auto& [value, alpha] : opacity)
    m.opacity.push_back({value, static_cast<float>(alpha)});
  m.isolines = isolines;
  m.isoline_color = vec4(isoline_color);
  m.isoline_px = static_cast<float>(isoline_px);
  (void)ScalarColors(m, {1, 2});  // throws for a field that is wrong for any numbers
  return m;
}

std::pair<std::vector<Numbers4>, bool> map_named(const std::string& name) {
  const ColorMap map = color_map(name);
  std::vector<Numbers4> colors;
  for (const Vec4& c : map.colors) colors.push_back({c.x, c.y, c.z, c.w});
  return {colors, map.discrete};
}

}  // namespace

void ArrayScene::add_file(const std::string& file, std::optional<double> crease_deg,
                          std::optional<std::uint64_t> memory_limit, bool allow_outside) {
  io::ReadOptions options{.allow_outside = allow_outside};
  if (memory_limit) options.memory_limit = *memory_limit;
  Scene read;
  {
    const nb::gil_scoped_release unlock;
    read = file.starts_with(kBuiltin) ? shapes::scene_from_spec(file.substr(kBuiltin.size()))
                                      : io::read_scene(file, options);
    if (crease_deg)
      for (Mesh& mesh : read.meshes)
        if (mesh.normals.empty())
          mesh.normals =
              crease_normals(mesh.view().positions, mesh.indices, static_cast<float>(*crease_deg));
  }
  const nb::ft_lock_guard lock(mutex_);
  const std::size_t first = files_.instances.size(), count = read.instances.size();
  files_.append(std::move(read));
  order_.push_back(OfFile{first, count});
  primitives_.reset();
  bound_.reset();
}

void ArrayScene::show_scalars(const std::string& name, std::uint32_t mapping) {
  const nb::ft_lock_guard lock(mutex_);
  rastrum::show_scalars(files_, name);
  for (Instance& i : files_.instances) i.scalar_mapping = mapping;
  bound_.reset();
}

void ArrayScene::spread_isolines(std::size_t mapping, int count) {
  const ScalarRange range = scalar_colors(show().view, mapping).range();
  const nb::ft_lock_guard lock(mutex_);
  ScalarMapping& m = mappings_.at(mapping);
  for (const overlay::Tick& tick : overlay::ticks(range.low, range.high, count, m.logarithmic))
    m.isolines.push_back(tick.value);
  bound_.reset();
}

std::size_t ArrayScene::add_texture(const Array& pixels) {
  if (pixels.ndim() != 3 || pixels.dtype() != nb::dtype<std::uint8_t>() ||
      (pixels.shape(2) != 3 && pixels.shape(2) != 4))
    throw Error(Errc::invalid_argument, "texture: must be (H, W, 3 or 4) of uint8");
  Texture texture;
  for (const std::size_t axis : {0U, 1U})
    if (pixels.shape(axis) > static_cast<std::size_t>(kMaxImageSize))
      throw Error(Errc::invalid_argument, "texture: its sides must have at most 32768 pixels");
  texture.image = {static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0))};
  const auto* const from = static_cast<const std::uint8_t*>(pixels.data());
  for (int y = 0; y < texture.image.height(); ++y)
    for (int x = 0; x < texture.image.width(); ++x) {
      const std::uint8_t* const at = from + y * pixels.stride(0) + x * pixels.stride(1);
      const auto channel = [&](int c) { return at[c * pixels.stride(2)]; };
      texture.image(x, y) = {channel(0), channel(1), channel(2),
                             pixels.shape(2) == 4 ? channel(3) : std::uint8_t{255}};
    }
  const nb::ft_lock_guard lock(mutex_);
  bound_.reset();
  // A frame may be using the textures that exist. The fence orders what the last one read before
  // what is written here.
  if (textures_.use_count() > 1)
    textures_ = std::make_shared<std::vector<Texture>>(*textures_);
  else
    std::atomic_thread_fence(std::memory_order_acquire);
  textures_->push_back(std::move(texture));
  return textures_->size() - 1;
}

void ArrayScene::set_materials(std::vector<Material> materials,
                               std::vector<std::optional<std::uint32_t>> of_things) {
  const nb::ft_lock_guard lock(mutex_);
  if (of_things.size() != things_)
    throw Error(Errc::invalid_argument, "materials: there are " + std::to_string(things_) +
                                            " things, not " + std::to_string(of_things.size()));
  materials_ = std::move(materials);
  material_of_ = std::move(of_things);
  bound_.reset();
}

void ArrayScene::add_mapping(const ScalarMapping& mapping) {
  const nb::ft_lock_guard lock(mutex_);
  mappings_.push_back(mapping);
  bound_.reset();
}

void ArrayScene::add(nb::object geometry, nb::object look, std::optional<double> scalar,
                     std::uint32_t mapping) {
  (void)nb::cast<const ArrayGeometry&>(geometry);
  (void)nb::cast<const Look&>(look);
  const nb::ft_lock_guard lock(mutex_);
  order_.push_back(Added{std::move(geometry), std::move(look), scalar, mapping, things_++});
  material_of_.emplace_back();
  primitives_.reset();
  bound_.reset();
}

struct ArrayScene::Bound {
  explicit Bound(const Scene& files) : binding(files) {}

  SceneBinding binding;
  std::vector<Material> materials{};
  std::vector<std::optional<std::uint32_t>> material_of{};  ///< for each thing, of `materials`
  std::vector<Texture> all_textures{};  ///< of files and Python, if both have some
  std::shared_ptr<const std::vector<Texture>> of_python{};
  std::vector<ScalarMapping> mappings{};
  std::span<const Texture> textures{};
  bool beside_materials = false;
  bool any_materials = false;   ///< then instances without a material get a plain one
  std::uint32_t plain[2] = {};  ///< without colours, with colours
  bool plain_files = false;
};

std::shared_ptr<const ArrayScene::Bound> ArrayScene::bind(bool beside_materials) const {
  auto bound = std::make_shared<Bound>(files_);
  Bound& b = *bound;
  b.beside_materials = beside_materials;
  b.materials = files_.materials;
  b.material_of = material_of_;
  for (std::optional<std::uint32_t>& m : b.material_of)
    if (m) *m += static_cast<std::uint32_t>(b.materials.size());
  const auto texture_offset = static_cast<std::int32_t>(files_.textures.size());
  for (Material m : materials_) {
    for (std::int32_t* t : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                            &m.occlusion_texture, &m.emissive_texture})
      if (*t != kNoTexture) *t += texture_offset;
    b.materials.push_back(m);
  }
  b.of_python = textures_;
  if (!files_.textures.empty() && !textures_->empty()) {
    b.all_textures = files_.textures;
    b.all_textures.insert(b.all_textures.end(), textures_->begin(), textures_->end());
  }
  b.textures = !b.all_textures.empty() ? b.all_textures
               : textures_->empty()    ? files_.textures
                                       : *textures_;
  // Plain materials keep the look of things without a material beside others.
  b.any_materials = beside_materials || !b.materials.empty();
  if (b.any_materials) {
    b.plain[0] = static_cast<std::uint32_t>(b.materials.size());
    b.materials.push_back(plain_material(false));
    b.plain[1] = b.plain[0] + 1;
    b.materials.push_back(plain_material(true));
  }
  // append() gives plain materials to a file without any beside others; a file alone has none.
  b.plain_files = b.any_materials && files_.materials.empty();
  b.mappings = mappings_;
  return bound;
}

ArrayScene::Shown ArrayScene::show(bool beside_materials) const {
  Shown shown;
  {
    const nb::ft_lock_guard lock(mutex_);
    if (!bound_ || bound_->beside_materials != beside_materials) bound_ = bind(beside_materials);
    shown.bound = bound_;
  }
  const Bound& b = *shown.bound;
  shown.instances.reserve(files_.instances.size() + things_);
  std::vector<std::size_t> planes;  // how many each instance has
  planes.reserve(files_.instances.size() + things_);
  for (const auto& entry : order_) {
    if (const auto* const file = std::get_if<OfFile>(&entry)) {
      for (std::size_t k = 0; k < file->count; ++k) {
        InstanceView i = b.binding.view().instances[file->first + k];
        if (b.plain_files) {
          const bool colored =
              i.color || i.geometry.visit([](const auto& g) { return !g.colors.empty(); });
          i.material = b.plain[colored ? 1 : 0];
        }
        shown.instances.push_back(i);
        planes.push_back(0);
      }
      continue;
    }
    const Added& added = std::get<Added>(entry);
    const auto& arrays = nb::cast<const ArrayGeometry&>(added.geometry);
    const auto& look = nb::cast<const Look&>(added.look);
    // Another thread may be changing it.
    const nb::ft_object_guard lock(added.look);
    InstanceView i;
    i.geometry = *shown.geometries.emplace_back(arrays.view);
    if (look.transform) i.object_to_world = matrix(*look.transform, "transform");
    i.opacity = look.opacity;
    i.color = look.color;
    if (b.material_of[added.number])
      i.material = b.material_of[added.number];
    else if (b.any_materials)
      i.material = b.plain[arrays.has_colors || i.color ? 1 : 0];
    i.visible = look.visible;
    i.casts_shadows = look.casts_shadows;
    i.winding = look.winding;
    i.id = look.id;
    planes.push_back(look.clip_planes.size());
    shown.planes.insert(shown.planes.end(), look.clip_planes.begin(), look.clip_planes.end());
    i.scalar = added.scalar;
    i.scalar_mapping = added.mapping;
    shown.of_things.push_back(shown.instances.size());
    shown.instances.push_back(i);
  }
  // Now that all planes are there, their memory stays.
  std::span<const ClipPlane> rest(shown.planes);
  for (std::size_t i = 0; i < planes.size(); rest = rest.subspan(planes[i++]))
    if (planes[i] > 0) shown.instances[i].clip_planes = rest.first(planes[i]);
  shown.view = {shown.instances, b.materials, b.textures, b.mappings};
  return shown;
}

SceneView ArrayScene::Shown::at(std::span<const double> transforms,
                                std::vector<InstanceView>& moved) const {
  moved = instances;
  for (std::size_t t = 0; t < of_things.size(); ++t)
    std::copy_n(transforms.begin() + static_cast<std::ptrdiff_t>(16 * t), 16,
                &moved[of_things[t]].object_to_world.m[0][0]);
  SceneView there = view;
  there.instances = moved;
  return there;
}

std::uint64_t ArrayScene::primitive_count() const {
  {
    const nb::ft_lock_guard lock(mutex_);
    if (primitives_) return *primitives_;
  }
  std::uint64_t count = 0;
  for (const InstanceView& i : show().instances) count += rastrum::primitive_count(i.geometry);
  const nb::ft_lock_guard lock(mutex_);
  primitives_ = count;
  return count;
}

void bind_scenes(nb::module_& m) {
  using nb::arg;
  nb::class_<Material>(m, "Material");
  m.def("material", material, arg("base_color"), arg("metallic"), arg("roughness"), arg("emissive"),
        arg("alpha_mode"), arg("alpha_cutoff"), arg("double_sided"), arg("unlit"), arg("opacity"),
        arg("classic"), arg("textures"));
  nb::class_<ScalarMapping>(m, "Mapping");
  m.def("mapping", mapping, arg("colors"), arg("discrete"), arg("range").none(), arg("logarithmic"),
        arg("symmetric"), arg("steps"), arg("categories"), arg("below").none(), arg("above").none(),
        arg("nan"), arg("opacity"), arg("isolines"), arg("isoline_color"), arg("isoline_px"));
  m.def(
      "color_of",
      [](const std::string& text) -> std::optional<std::array<int, 4>> {
        const std::optional<Rgba8> c = color_of(text);
        if (!c) return std::nullopt;
        return std::array<int, 4>{c->r, c->g, c->b, c->a};
      },
      arg("text"));
  m.def("color_names", [] {
    std::vector<std::string> names;
    for (const std::string_view n : color_names()) names.emplace_back(n);
    return names;
  });
  m.def("color_map", map_named, arg("name"));
  m.def("color_map_names", [] {
    std::vector<std::string> names;
    for (const std::string_view n : color_map_names()) names.emplace_back(n);
    return names;
  });
  nb::class_<Look>(m, "Look")
      .def(nb::init<>())
      .def_prop_rw(
          "transform", [](const Look& l) { return l.transform; },
          [](Look& l, const std::optional<Array>& transform) {
            if (transform) (void)matrix(*transform, "transform");
            l.transform = transform;
          },
          arg("transform").none(), nb::lock_self())
      .def_rw("opacity", &Look::opacity, nb::lock_self())
      .def_rw("visible", &Look::visible, nb::lock_self())
      .def_rw("casts_shadows", &Look::casts_shadows, nb::lock_self())
      .def_prop_rw(
          "color",
          [](const Look& l) -> std::optional<Numbers4> {
            if (!l.color) return std::nullopt;
            return Numbers4{l.color->x, l.color->y, l.color->z, l.color->w};
          },
          [](Look& l, const std::optional<Numbers4>& color) {
            l.color.reset();
            if (color) l.color = vec4(*color);
          },
          arg("color").none(), nb::lock_self())
      .def_prop_rw(
          "winding", [](const Look& l) { return static_cast<int>(l.winding); },
          [](Look& l, const std::string& winding) {
            l.winding =
                named<Winding>("winding", winding, {"counter_clockwise", "clockwise", "either"});
          },
          nb::lock_self())
      .def_rw("id", &Look::id, arg("id").none(), nb::lock_self())
      .def_prop_rw(
          "clip_planes", [](const Look& l) { return l.clip_planes.size(); },
          [](Look& l, const std::vector<Numbers4>& planes) {
            l.clip_planes.clear();
            for (const Numbers4& p : planes) l.clip_planes.push_back({{p[0], p[1], p[2]}, p[3]});
          },
          nb::lock_self());
  nb::class_<ArrayScene>(m, "Scene")
      .def(nb::init<>())
      .def("add_file", &ArrayScene::add_file, arg("file"), arg("crease").none(),
           arg("memory_limit").none(), arg("allow_outside"))
      .def("show_scalars", &ArrayScene::show_scalars, arg("name"), arg("mapping"))
      .def("add_texture", &ArrayScene::add_texture, arg("pixels"))
      .def("set_materials", &ArrayScene::set_materials, arg("materials"), arg("of_things"))
      .def("add_mapping", &ArrayScene::add_mapping, arg("mapping"))
      .def("spread_isolines", &ArrayScene::spread_isolines, arg("mapping"), arg("count"))
      .def_prop_ro("lights", [](const ArrayScene& s) { return s.files().lights; })
      .def(
          "scalar_range",
          [](const ArrayScene& s, std::size_t mapping) {
            const ScalarRange r = scalar_colors(s.show().view, mapping).range();
            return std::pair(r.low, r.high);
          },
          arg("mapping"))
      .def("add", &ArrayScene::add, arg("geometry"), arg("look"), arg("scalar").none(),
           arg("mapping"))
      .def_prop_ro("primitives", &ArrayScene::primitive_count)
      .def_prop_ro("instances", [](const ArrayScene& s) { return s.show().view.instances.size(); })
      .def_prop_ro("has_materials",
                   [](const ArrayScene& s) { return !s.show().view.materials.empty(); })
      .def_prop_ro("warnings", [](const ArrayScene& s) { return s.files().warnings; })
      .def("describe", [](const ArrayScene& s) { return io::describe(s.files()); })
      .def(
          "ball",
          [](const ArrayScene& s, const std::optional<Array>& transforms) {
            const ArrayScene::Shown shown = s.show();
            std::vector<InstanceView> moved;
            const BoundingSphere b =
                bounding_sphere(transforms ? shown.at(doubles(*transforms), moved) : shown.view);
            return std::tuple(b.centre.x, b.centre.y, b.centre.z, b.radius);
          },
          arg("transforms").none())
      .def("bounds", [](const ArrayScene& s) -> std::optional<std::pair<Numbers3, Numbers3>> {
        const Bounds b = bounds(s.show().view);
        if (b.vertices_in_use == 0) return std::nullopt;
        return std::pair(Numbers3{b.min.x, b.min.y, b.min.z}, Numbers3{b.max.x, b.max.y, b.max.z});
      });
}

}  // namespace rastrum::python
