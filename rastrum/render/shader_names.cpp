// SPDX-License-Identifier: BSD-3-Clause
// The names of the built-in shaders, and the choice of `automatic`.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/raster/draws/shader_table.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene/instance_runs.hpp>

namespace rastrum {
std::vector<std::string_view> shader_names() {
  std::vector<std::string_view> names;
  for (const raster::ShaderRow& r : raster::kShaders) names.push_back(r.name);
  return names;
}

std::string_view name(Shader shader) {
  check_enum(shader, raster::kLastShader, "the shader");
  return raster::row_of(shader).name;
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
  for (std::size_t i = 0; i < raster::kShaders.size(); ++i) {
    const raster::ShaderRow& row = raster::kShaders[i];
    if (row.name == wanted) return static_cast<Shader>(i);
    known.append(i == 0 ? "" : ", ").append(row.name);
  }
  reject("no shader is called '", wanted, "'; there are ", known);
}

}  // namespace rastrum
