// The controls of meshes: each edits a copy of the settings, which is set where one has changed.
#include <imgui.h>

#include <algorithm>
#include <string>
#include <vector>

#include <rastrum/parallel/exec.hpp>

#include "mesh_subject.hpp"
#include "panel.hpp"
#include "transparency.hpp"

namespace rastrum::cli::window {
namespace {

std::vector<std::string> with_auto(const std::vector<family::AxisInfo>& axis) {
  std::vector<std::string> names{"auto"};
  for (const family::AxisInfo& info : axis) names.push_back(info.name);
  return names;
}

bool choose_shader(Shader& shader) {
  std::vector<std::string> names;
  for (const std::string_view n : shader_names()) names.emplace_back(n);
  std::string now(name(shader));
  if (!choose_name("shader", names, now)) return false;
  shader = shader_from_name(now);
  return true;
}

bool choose_transparency(TransparencyOptions& t) {
  bool changed = false;
  std::vector<std::string> names = transparency_names();
  std::string now = names[static_cast<std::size_t>(t.method)];
  if (choose_name("transparency", names, now)) {
    t.method =
        static_cast<Transparency>(std::find(names.begin(), names.end(), now) - names.begin());
    changed = true;
  }
  constexpr int kMostFilter = 64;
  if (t.method == Transparency::filter)
    changed |= ImGui::SliderInt("filter", &t.filter, 1, kMostFilter);
  return changed;
}

bool choose_samples(int& samples) {
  std::string now = std::to_string(samples);
  if (!choose_name("samples", {"1", "4", "8", "16"}, now)) return false;
  samples = std::stoi(now);
  return true;
}

bool choose_threads(RendererOptions& r) {
  static const int most = parallel::Threads(0).concurrency();
  bool serial = r.device == Device::serial;
  bool changed = ImGui::Checkbox("serial reference device", &serial);
  if (changed) r.device = serial ? Device::serial : Device::threads;
  if (serial) return changed;
  int threads = r.threads == 0 ? most : r.threads;
  if (ImGui::SliderInt("threads", &threads, 1, std::max(most, threads))) {
    r.threads = threads;
    changed = true;
  }
  return changed;
}

}  // namespace

void draw_mesh_controls(MeshSubject& subject) {
  MeshSubject::Settings s = subject.settings();
  family::Options& r = s.render;
  bool changed = choose_shader(r.shader);
  changed |= choose_name("rasterizer", with_auto(family::rasterizer_axis()), r.rasterizer);
  changed |= choose_name("visibility", with_auto(family::visibility_axis()), r.visibility);
  changed |= ImGui::SliderFloat("opacity", &r.opacity, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
  changed |= choose_transparency(r.transparency);
  changed |= choose_samples(r.samples);
  changed |= choose_threads(r);
  changed |= ImGui::Checkbox("heat map", &s.heat_map);
  ImGui::SameLine();
  if (ImGui::Button("home")) subject.control().go_home();
  if (changed) subject.set(std::move(s));
}

}  // namespace rastrum::cli::window
