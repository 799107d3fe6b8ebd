// The table of the built-in shaders, and the shader that `automatic` takes.
#include <array>
#include <span>
#include <string>
#include <string_view>

#include <rastrum/core/enum.hpp>
#include <rastrum/error.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/render.hpp>
#include <rastrum/render/shader_table.hpp>
#include <rastrum/scene/instance_runs.hpp>

namespace rastrum {
namespace {

/// A row for each shader, in the order of the enum.
struct Row {
  std::string_view name;
  bool lit = false;     ///< by FrameOptions::lights
  bool device = false;  ///< arrays may be memory of the device (in_place)
};
constexpr std::array kShaders{
    Row{"auto"},
    Row{"flat", false, true},
    Row{"depth"},
    Row{"normal", false, true},
    Row{"id", false, true},
    Row{"lambert", true, true},
    Row{"phong", true, true},
    Row{"material", true},
    Row{"wireframe"},
};

const Row& row(Shader shader) {
  return kShaders[static_cast<std::size_t>(shader)];
}

}  // namespace

std::vector<std::string_view> shader_names() {
  std::vector<std::string_view> names;
  for (const Row& r : kShaders) names.push_back(r.name);
  return names;
}

void check(Shader shader) {
  check_enum(shader, static_cast<Shader>(kShaders.size() - 1), "the shader");
}

std::string_view name(Shader shader) {
  check(shader);
  return row(shader).name;
}

bool takes_lights(Shader shader) {
  return row(shader).lit;
}

bool draws_in_place(Shader shader) {
  return row(shader).device;
}

Shader shader_for(Shader shader, const SceneView& scene) {
  if (shader != Shader::automatic) return shader;
  return scene.materials.empty() ? Shader::phong : Shader::material;
}

Cull material_cull(const InstanceView& instance, std::span<const Material> materials,
                   Shader shader) {
  // Other geometry than meshes is closed, or meant to be seen from both sides.
  if (instance.mesh() == nullptr) return Cull::none;
  const MeshView& mesh = *instance.mesh();
  if (shader != Shader::material || materials.empty() ||
      (!instance.material && !mesh.face_materials.empty()) ||
      materials[instance.material.value_or(mesh.material)].double_sided)
    return Cull::none;
  return Cull::back;
}

Cull cull_on_screen(const InstanceView& instance, Cull cull) {
  return raster::Draw::effective_cull(cull, winding_of(instance));
}

Shader shader_from_name(std::string_view wanted) {
  std::string known;
  for (std::size_t i = 0; i < kShaders.size(); ++i) {
    if (kShaders[i].name == wanted) return static_cast<Shader>(i);
    known += (i == 0 ? "" : ", ") + std::string(kShaders[i].name);
  }
  throw Error(Errc::invalid_argument,
              "no shader is called '" + std::string(wanted) + "'; there are " + known);
}

}  // namespace rastrum
