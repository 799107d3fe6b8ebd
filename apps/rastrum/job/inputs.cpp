// SPDX-License-Identifier: BSD-3-Clause
#include "inputs.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <variant>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/shapes.hpp>

#include "parse/arguments.hpp"
#include "progress.hpp"

namespace rastrum::cli {
namespace {

Scene make_builtin(const std::string& input, const std::string& source) {
  const std::string spec = source.substr(kBuiltin.size());
  Scene scene;
  try {
    scene = shapes::scene_from_spec(spec);
  } catch (const Error& e) {
    if (e.code() == Errc::invalid_argument) throw UsageError(input, e.what());
    throw;
  }
  for (Mesh& mesh : scene.meshes)
    if (mesh.name.empty()) mesh.name = spec.substr(0, spec.find('?'));
  return scene;
}

Vec4 linear(Vec4 display) {
  const auto channel = [](float c) {
    return raster::decode_tables().srgb[static_cast<std::size_t>(std::lround(c * 255))];
  };
  return {channel(display.x), channel(display.y), channel(display.z), 1};
}

/// Replaces base colours, their textures and vertex colours.
void paint(Scene& scene, const Look& look) {
  if (look.color) {
    for (Mesh& mesh : scene.meshes) mesh.colors = {};
    for (Geometry& geometry : scene.geometries)
      std::visit([](auto& g) { g.colors = {}; }, geometry);
  }
  if (scene.materials.empty()) add_plain_materials(scene);
  double opacity = look.opacity;
  if (look.color) opacity *= double{look.color->w};
  for (Material& m : scene.materials) {
    if (look.color) {
      const Vec4 base = linear(*look.color);
      m.base_color = {base.x, base.y, base.z, m.base_color.w};
      m.base_color_texture = kNoTexture;
    }
    m.opacity = static_cast<float>(opacity);
  }
}

struct Loaded {
  Scene scene;
  bool has_materials = false;  ///< of the file
};

Scene read(const std::string& source, const InputReading& reading) {
  const auto& [format, options] = reading;
  if (!is_unnamed(source, format)) return io::read_scene(source, options);
  check_inputs({source}, format);  // opening a pipe would wait for its writer
  const io::MappedFile file(is_stdin(source) ? "/dev/stdin" : source);
  return io::decode_scene(file.bytes(), format, is_stdin(source) ? "standard input" : source,
                          options);
}

void place_and_paint(Scene& scene, const InputSpec& spec) {
  if (spec.placement != Placement{}) scene.place(spec.placement.matrix());
  if (spec.look.given()) paint(scene, spec.look);
}

Loaded load(const std::string& input, const InputReading& reading) {
  const InputSpec spec = parse_input(input);
  Loaded loaded;
  Scene& scene = loaded.scene;
  scene = spec.source.starts_with(kBuiltin) ? make_builtin(input, spec.source)
                                            : read(spec.source, reading);
  loaded.has_materials = !scene.materials.empty();
  place_and_paint(scene, spec);
  return loaded;
}

/// Unindexed corners share nothing: their vertex normals are the face normals that the renderer
/// takes anyway.
void choose_normals(Mesh& mesh, const NormalOptions& options) {
  if (options.kind == Normals::file && !mesh.normals.empty()) return;
  mesh.normals = {};
  if (options.kind == Normals::face) return;
  const ArrayView<Vec3> positions = mesh.view().positions;
  if (options.kind != Normals::vertex && options.crease_deg < 180)
    mesh.normals = crease_normals(positions, mesh.indices, options.crease_deg);
  else if (!mesh.indices.empty())
    mesh.normals.values = vertex_normals(positions, mesh.indices);
}

}  // namespace

void finish_input(Scene& scene, const std::string& input, const NormalOptions& normals) {
  place_and_paint(scene, parse_input(input));
  for (Mesh& mesh : scene.meshes) choose_normals(mesh, normals);
}

Scene load_input(const std::string& input, const InputReading& reading) {
  return load(input, reading).scene;
}

Inputs load_inputs(const std::vector<std::string>& inputs, const NormalOptions& normals,
                   Timeline& timeline, Progress& progress, const InputReading& reading) {
  Inputs all;
  std::vector<Scene> scenes;
  for (const std::string& input : inputs) {
    progress.show("loading " + input);
    timeline.measure("load " + input, "load", [&] {
      Loaded loaded = load(input, reading);
      all.has_materials |= loaded.has_materials;
      scenes.push_back(std::move(loaded.scene));
    });
  }
  std::uint64_t first_id = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::uint64_t triangles = scenes[i].primitive_count();
    all.parts.push_back({inputs[i], first_id, triangles});
    first_id += triangles;
    all.scene.append(std::move(scenes[i]));
  }
  progress.show("computing normals");
  timeline.measure("normals", "load", [&] {
    for (Mesh& mesh : all.scene.meshes) choose_normals(mesh, normals);
  });
  return all;
}

void set_sizes(Scene& scene, const PixelSizes& sizes) {
  for (Geometry& geometry : scene.geometries) {
    if (auto* const points = std::get_if<Points>(&geometry)) points->point_size = sizes.point;
    if (auto* const lines = std::get_if<Lines>(&geometry)) lines->line_width = sizes.line;
  }
}

std::size_t animation_count(const Scene& scene) {
  std::size_t most = 0;
  for (const Motion& motion : scene.motions) most = std::max(most, motion.animations.size());
  return most;
}

void pose_inputs(Inputs& inputs, const NormalOptions& normals, double seconds,
                 std::size_t animation) {
  for (const std::uint32_t mesh : pose(inputs.scene, seconds, animation))
    choose_normals(inputs.scene.meshes[mesh], normals);
}

Image<std::int32_t> inputs_of_ids(ImageView<const std::int64_t> ids,
                                  std::span<const InputPart> parts) {
  Image<std::int32_t> inputs(ids.width, ids.height);
  for (int y = 0; y < ids.height; ++y)
    for (int x = 0; x < ids.width; ++x) {
      if (ids(x, y) < 0) {
        inputs(x, y) = -1;
        continue;
      }
      const auto id = static_cast<std::uint64_t>(ids(x, y));
      // The last part that begins at or before it: an empty part begins with the next.
      const auto after = std::upper_bound(
          parts.begin(), parts.end(), id,
          [](std::uint64_t value, const InputPart& part) { return value < part.first_id; });
      inputs(x, y) = static_cast<std::int32_t>(after - parts.begin()) - 1;
    }
  return inputs;
}

}  // namespace rastrum::cli
