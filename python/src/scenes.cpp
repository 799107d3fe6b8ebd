// Scenes; see the header.
#include "scenes.hpp"

#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <rastrum/color.hpp>
#include <rastrum/color_map.hpp>
#include <rastrum/io.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::python {
namespace {

/// What begins the name of a shape in the place of a file, as the program has it.
constexpr std::string_view kBuiltin = "builtin:";

using Numbers4 = std::array<double, 4>;
using Numbers3 = std::array<double, 3>;

Vec4 vec4(const Numbers4& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]),
          static_cast<float>(v[3])};
}

Material material(const Numbers4& base_color, double metallic, double roughness,
                  const Numbers3& emissive, const std::string& alpha_mode, double alpha_cutoff,
                  bool double_sided, bool unlit, double opacity,
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
  (void)ScalarColors(m, {1, 2});  // throws where a field is wrong, whatever the numbers are
  return m;
}

std::pair<std::vector<Numbers4>, bool> map_named(const std::string& name) {
  const ColorMap map = color_map(name);
  std::vector<Numbers4> colors;
  for (const Vec4& c : map.colors) colors.push_back({c.x, c.y, c.z, c.w});
  return {colors, map.discrete};
}

}  // namespace

void ArrayScene::add_file(const std::string& file, std::optional<double> crease_deg) {
  Scene read = file.starts_with(kBuiltin) ? shapes::scene_from_spec(file.substr(kBuiltin.size()))
                                          : io::read_scene(file);
  if (crease_deg)
    for (Mesh& mesh : read.meshes)
      if (mesh.normals.empty())
        mesh.normals =
            crease_normals(mesh.positions, mesh.indices, static_cast<float>(*crease_deg));
  const std::size_t first = files_.instances.size(), count = read.instances.size();
  files_.append(std::move(read));
  order_.push_back(OfFile{first, count});
  bound_ = false;
}

void ArrayScene::show_scalars(const std::string& name, std::uint32_t mapping) {
  rastrum::show_scalars(files_, name);
  for (Instance& i : files_.instances) i.scalar_mapping = mapping;
  bound_ = false;
}

void ArrayScene::spread_isolines(std::size_t mapping, int count) {
  const ScalarRange range = scalar_colors(view(), mapping).range();
  ScalarMapping& m = mappings_.at(mapping);
  for (const overlay::Tick& tick : overlay::ticks(range.low, range.high, count, m.logarithmic))
    m.isolines.push_back(tick.value);
  bound_ = false;
}

void ArrayScene::add_texture(const Array& pixels) {
  if (pixels.ndim() != 3 || pixels.dtype() != nb::dtype<std::uint8_t>() ||
      (pixels.shape(2) != 3 && pixels.shape(2) != 4))
    throw Error(Errc::invalid_argument, "texture: must be (H, W, 3 or 4) of uint8");
  Texture texture;
  for (const std::size_t axis : {0U, 1U})
    if (pixels.shape(axis) > static_cast<std::size_t>(kMaxImageSize))
      throw Error(Errc::invalid_argument, "texture: sides of at most 32768 pixels are drawn");
  texture.image = {static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0))};
  const auto* const from = static_cast<const std::uint8_t*>(pixels.data());
  for (int y = 0; y < texture.image.height(); ++y)
    for (int x = 0; x < texture.image.width(); ++x) {
      const std::uint8_t* const at = from + y * pixels.stride(0) + x * pixels.stride(1);
      const auto channel = [&](int c) { return at[c * pixels.stride(2)]; };
      texture.image(x, y) = {channel(0), channel(1), channel(2),
                             pixels.shape(2) == 4 ? channel(3) : std::uint8_t{255}};
    }
  textures_.push_back(std::move(texture));
  bound_ = false;
}

void ArrayScene::add(nb::object geometry, const std::optional<Array>& transform, float opacity,
                     const std::optional<Vec4>& color, std::optional<std::uint32_t> material,
                     bool visible, const std::string& winding, std::optional<std::int64_t> id,
                     std::vector<ClipPlane> clip_planes, std::optional<double> scalar,
                     std::uint32_t mapping) {
  const auto& arrays = nb::cast<const ArrayGeometry&>(geometry);
  Added added{std::move(geometry), {}, std::move(clip_planes), arrays.has_colors};
  InstanceView& i = added.instance;
  i.geometry = arrays.view;
  if (transform) i.object_to_world = matrix(*transform, "transform");
  i.opacity = opacity;
  i.color = color;
  i.material = material;
  i.visible = visible;
  i.winding = named<Winding>("winding", winding, {"counter_clockwise", "clockwise", "either"});
  i.id = id;
  i.scalar = scalar;
  i.scalar_mapping = mapping;
  order_.push_back(std::move(added));
  bound_ = false;
}

void ArrayScene::bind(bool beside_materials) const {
  binding_.emplace(files_);
  instances_.clear();
  all_materials_ = files_.materials;
  const auto offset = static_cast<std::uint32_t>(all_materials_.size());
  const auto texture_offset = static_cast<std::int32_t>(files_.textures.size());
  for (Material m : materials_) {
    for (std::int32_t* t : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                            &m.occlusion_texture, &m.emissive_texture})
      if (*t != kNoTexture) *t += texture_offset;
    all_materials_.push_back(m);
  }
  // One span: copied only where both files and Python have some.
  all_textures_.clear();
  if (!files_.textures.empty() && !textures_.empty()) {
    all_textures_ = files_.textures;
    all_textures_.insert(all_textures_.end(), textures_.begin(), textures_.end());
  }
  // Beside what has a material, what has none looks as it did without.
  const bool any = beside_materials || !all_materials_.empty();
  std::uint32_t plain[2] = {};
  if (any) {
    plain[0] = static_cast<std::uint32_t>(all_materials_.size());
    all_materials_.push_back(plain_material(false));
    plain[1] = plain[0] + 1;
    all_materials_.push_back(plain_material(true));
  }
  // A file without materials drawn beside others was given some by append(); alone it has none.
  const bool plain_files = any && files_.materials.empty();
  for (const auto& entry : order_) {
    if (const auto* const file = std::get_if<OfFile>(&entry)) {
      for (std::size_t k = 0; k < file->count; ++k) {
        InstanceView i = binding_->view().instances[file->first + k];
        if (plain_files) {
          const bool colored =
              i.color || std::visit([](const auto& g) { return !g.colors.empty(); }, i.geometry);
          i.material = plain[colored ? 1 : 0];
        }
        instances_.push_back(i);
      }
      continue;
    }
    const Added& added = std::get<Added>(entry);
    InstanceView i = added.instance;
    i.clip_planes = added.clip_planes;
    if (i.material)
      *i.material += offset;
    else if (any)
      i.material = plain[added.has_colors || i.color ? 1 : 0];
    instances_.push_back(i);
  }
  bound_ = true;
  bound_beside_ = beside_materials;
}

SceneView ArrayScene::view(bool beside_materials) const {
  if (!bound_ || bound_beside_ != beside_materials) bind(beside_materials);
  const std::vector<Texture>& textures = !all_textures_.empty() ? all_textures_
                                         : textures_.empty()    ? files_.textures
                                                                : textures_;
  return {instances_, all_materials_, textures, mappings_};
}

std::uint64_t ArrayScene::primitive_count() const {
  std::uint64_t n = 0;
  for (const InstanceView& i : view().instances) n += rastrum::primitive_count(i.geometry);
  return n;
}

void bind_scenes(nb::module_& m) {
  using nb::arg;
  nb::class_<Material>(m, "Material");
  m.def("material", material, arg("base_color"), arg("metallic"), arg("roughness"), arg("emissive"),
        arg("alpha_mode"), arg("alpha_cutoff"), arg("double_sided"), arg("unlit"), arg("opacity"),
        arg("textures"));
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
  nb::class_<ArrayScene>(m, "Scene")
      .def(nb::init<>())
      .def("add_file", &ArrayScene::add_file, arg("file"), arg("crease").none(),
           nb::call_guard<nb::gil_scoped_release>())
      .def("show_scalars", &ArrayScene::show_scalars, arg("name"), arg("mapping"))
      .def("add_texture", &ArrayScene::add_texture, arg("pixels"))
      .def("add_material", &ArrayScene::add_material, arg("material"))
      .def("add_mapping", &ArrayScene::add_mapping, arg("mapping"))
      .def("spread_isolines", &ArrayScene::spread_isolines, arg("mapping"), arg("count"))
      .def_prop_ro("lights", [](const ArrayScene& s) { return s.files().lights; })
      .def(
          "scalar_range",
          [](const ArrayScene& s, std::size_t mapping) {
            const ScalarRange r = scalar_colors(s.view(), mapping).range();
            return std::pair(r.low, r.high);
          },
          arg("mapping"))
      .def(
          "add",
          [](ArrayScene& s, nb::object geometry, const std::optional<Array>& transform,
             float opacity, const std::optional<Numbers4>& color,
             std::optional<std::uint32_t> index, bool visible, const std::string& winding,
             std::optional<std::int64_t> id, const std::vector<Numbers4>& planes,
             std::optional<double> scalar, std::uint32_t mapping) {
            std::vector<ClipPlane> clip;
            for (const Numbers4& p : planes) clip.push_back({{p[0], p[1], p[2]}, p[3]});
            std::optional<Vec4> display;
            if (color) display = vec4(*color);
            s.add(std::move(geometry), transform, opacity, display, index, visible, winding, id,
                  std::move(clip), scalar, mapping);
          },
          arg("geometry"), arg("transform").none(), arg("opacity"), arg("color").none(),
          arg("material").none(), arg("visible"), arg("winding"), arg("id").none(),
          arg("clip_planes"), arg("scalar").none(), arg("mapping"))
      .def_prop_ro("primitives", &ArrayScene::primitive_count)
      .def_prop_ro("instances", [](const ArrayScene& s) { return s.view().instances.size(); })
      .def_prop_ro("has_materials", [](const ArrayScene& s) { return !s.view().materials.empty(); })
      .def_prop_ro("warnings", [](const ArrayScene& s) { return s.files().warnings; })
      .def("describe", [](const ArrayScene& s) { return io::describe(s.files()); })
      .def("bounds", [](const ArrayScene& s) -> std::optional<std::pair<Numbers3, Numbers3>> {
        const Bounds b = bounds(s.view());
        if (b.vertices_in_use == 0) return std::nullopt;
        return std::pair(Numbers3{b.min.x, b.min.y, b.min.z}, Numbers3{b.max.x, b.max.y, b.max.z});
      });
}

}  // namespace rastrum::python
