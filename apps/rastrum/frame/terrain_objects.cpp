// SPDX-License-Identifier: BSD-3-Clause
#include "terrain_objects.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

#include "job/inputs.hpp"
#include "job/progress.hpp"
#include "parse/arguments.hpp"

namespace rastrum::cli {
namespace {

/// INPUT[@name=value,…]
TerrainObject parse_object(const char* option, const std::string& text, bool is_sprite) {
  TerrainObject object{text, text, is_sprite, {}};
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) {
    if (is_sprite)
      throw UsageError(option, "say where it stands, as in '" + text + "@x=500,y=700'");
    return object;
  }
  object.input = text.substr(0, at);
  std::optional<double> x, y, scale, turn_deg;
  Standing standing;
  bool stands = false;
  const std::string size = is_sprite ? "size" : "scale";
  const std::pair<std::string_view, std::optional<double>*> fields[] = {
      {"x", &x}, {"y", &y}, {"height", &standing.height}, {size, &scale}, {"turn", &turn_deg}};
  std::string look;  // the part that the input takes (input_spec.hpp)
  for (const std::string& item : parts_of(text.substr(at + 1), ",")) {
    const std::size_t equals = std::min(item.find('='), item.size());
    const std::string name = item.substr(0, equals);
    constexpr std::string_view kLooks[] = {"rx", "ry", "rz", "color", "opacity"};
    if (!is_sprite && std::ranges::find(kLooks, name) != std::end(kLooks)) {
      look.append(look.empty() ? "@" : ",").append(item);
      continue;
    }
    stands = true;
    const auto field = std::ranges::find(fields, name, [](const auto& f) { return f.first; });
    if (field == std::end(fields) || (is_sprite && name == "turn"))
      throw UsageError(option, "expected " +
                                   std::string(is_sprite ? "x, y, height and size"
                                                         : "x, y, height, scale, turn, rx, ry, "
                                                           "rz, color and opacity") +
                                   " after @, got '" + item + "'");
    *field->second = parse_number(std::string(option).append(" ").append(name),
                                  std::string_view(item).substr(std::min(equals + 1, item.size())));
    if (scale && !(*scale > 0))
      throw UsageError(option, size + " must be above 0 in '" + text + "'");
  }
  object.input += look;
  if (!stands) return object;
  if (!x || !y) throw UsageError(option, "x and y are missing in '" + text + "'");
  standing.x = *x;
  standing.y = *y;
  standing.scale = scale.value_or(standing.scale);
  standing.turn_deg = turn_deg.value_or(standing.turn_deg);
  object.standing = standing;
  return object;
}

/// Scaled and turned about the origin, then moved.
Mat4d placement(const Standing& s, double up) {
  Mat4d m = rotation(rotation_about({0, 1, 0}, s.turn_deg * kDegree));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m.m[i][j] *= s.scale;
  m.m[0][3] = s.x;
  m.m[1][3] = up;
  m.m[2][3] = s.y;
  return m;
}

double ground_under(const TerrainObject& object, const terrain::Terrain& terrain,
                    const terrain::TerrainOptions& options) {
  const Standing& s = *object.standing;
  if (terrain.is_map()) {
    const int width = terrain.heights()->width(), height = terrain.heights()->height();
    if (!(s.x >= 0 && s.x < width && s.y >= 0 && s.y < height))
      throw UsageError(object.text, "stands off the map, which has " + std::to_string(width) + "x" +
                                        std::to_string(height) +
                                        " cells; give the height of its foot, as in height=20");
  }
  const double ground = terrain::ground_at(terrain, s.x, s.y, options);
  if (!std::isfinite(ground))
    throw UsageError(
        object.text,
        "stands in a hole of the terrain; give the height of its foot, as in height=20");
  return ground;
}

}  // namespace

void add_terrain_objects(Parser app, TerrainObjectArguments& a) {
  app = app.under("Meshes and sprites");
  const auto add_object = [&](const char* name, const char* type, const char* help,
                              bool is_sprite) {
    app.add_repeated(name, type, help, [&a, name, is_sprite](const std::string& text) {
      a.objects.push_back(parse_object(name, text, is_sprite));
    });
  };
  add_object("--mesh", "INPUT[@x=X,y=Y,...]",
             "a file or builtin:SHAPE as `render` takes them, +y up, at cell X, Y; height=H of its "
             "lowest point (the ground's), scale=S (1), turn=DEG counter-clockwise (0); rx, ry, "
             "rz, color and opacity as `render` has them. Without a place its x, y and z are the "
             "terrain's x, height and y. May be repeated",
             false);
  add_object("--sprite", "FILE@x=X,y=Y,...",
             "a .png or .jpg that faces the camera, blended by its alpha, at cell X, Y; height=H "
             "of its foot (the ground's), size=S cells high (1). May be repeated",
             true);
  add_shading_options(app, a.scene);
  add_blending_options(app, a.scene);
  add_rasterizer_options(app, a.scene);
}

void check_terrain_objects(const TerrainObjectArguments& a,
                           const terrain::TerrainOptions& options) {
  if (a.objects.empty()) return;
  const char* option = a.objects.front().is_sprite ? "--sprite" : "--mesh";
  if (options.projection != terrain::Projection::planar)
    throw UsageError(option, "needs --projection planar, where straight edges stay straight");
  if (a.scene.render.shader == Shader::depth)
    throw UsageError("--shader", "depth needs a whole picture; take another shader on a terrain");
  if (a.scene.render.tone != ToneMapping{} && a.scene.render.shader != Shader::automatic &&
      a.scene.render.shader != Shader::material)
    throw UsageError("--shader",
                     "--tone needs linear light, which the shader material has; take that");
}

TerrainObjects::TerrainObjects(const TerrainObjectArguments& a, const TerrainLook& options,
                               Timeline& timeline, Progress& progress)
    : options_(options) {
  bool has_materials = false;  // of files; a given colour keeps the plain shader
  for (const TerrainObject& object : a.objects) {
    const std::size_t first = scene_.instances.size();
    progress.show("loading " + object.input);
    if (object.is_sprite) {
      scene_.append(sprite(io::read_image(object.input, a.scene.reading.options)));
      has_materials = true;
    } else {
      Inputs inputs =
          load_inputs({object.input}, a.scene.normals, timeline, progress, a.scene.reading);
      set_sizes(inputs.scene, a.scene.sizes);
      has_materials |= inputs.has_materials;
      scene_.append(std::move(inputs.scene));
    }
    parts_.push_back({object, first, scene_.instances.size()});
    if (object.is_sprite) facing_.push_back(first);
  }
  family::Options render = a.scene.render;
  render.width = options.width;
  render.height = options.height;
  // The depth lies on the host, whatever drew the terrain.
  render.device = options.device == Device::serial ? Device::serial : Device::threads;
  render.threads = options.threads;
  render.isa = options.isa;
  // Only the material shader maps light.
  if (render.shader == Shader::automatic && render.tone != ToneMapping{})
    render.shader = Shader::material;
  render.shader = shader_of(render.shader, has_materials);
  frame_ = render;
  frame_.environment_behind = false;  // it lies behind the ground already
  painter_.emplace(family::make_renderer(render, render));
}

void TerrainObjects::place(const terrain::Terrain& terrain) {
  {
    const SceneBinding own(scene_);
    const SceneView whole = own.view();
    for (const Part& part : parts_) {
      if (!part.object.standing) continue;
      const Standing& s = *part.object.standing;
      const double foot = s.height ? *s.height : ground_under(part.object, terrain, options_);
      const SceneView alone{.instances =
                                whole.instances.subspan(part.first, part.last - part.first)};
      const Bounds box = bounds(alone);
      const double lowest = box.vertices_in_use > 0 ? box.min.y : 0;
      const Mat4d m = placement(s, foot - s.scale * lowest);
      for (std::size_t i = part.first; i < part.last; ++i)
        scene_.instances[i].object_to_world = m * scene_.instances[i].object_to_world;
    }
  }
  binding_.emplace(scene_);
}

void TerrainObjects::draw(const terrain::TerrainTargets& picture, terrain::TerrainStats& stats) {
  const FrameStats drawn =
      painter_->draw({binding_->view(), facing_}, frame_, options_, stats.camera, picture);
  stats.stages.push_back({"objects", stats.frame_ms, stats.frame_ms + drawn.frame_ms});
  stats.frame_ms += drawn.frame_ms;
  stats.peak_bytes += drawn.peak_bytes;
  if (stats.device == Device::cuda)
    stats.device_why.append(stats.device_why.empty() ? "" : "; ")
        .append("the CPU draws meshes and sprites");
}

}  // namespace rastrum::cli
