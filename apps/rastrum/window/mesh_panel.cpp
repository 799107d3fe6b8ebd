// SPDX-License-Identifier: BSD-3-Clause
// The controls of meshes. Each edits a copy of the settings, which is set if it has changed.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/parallel/exec.hpp>

#include "mesh_subject.hpp"
#include "panel.hpp"

namespace rastrum::cli::window {
namespace {

constexpr float kSectionName = 70;  ///< px of a section's switch

bool choose_shader(Shader& shader) {
  const std::vector<std::string_view> names = shader_names();
  std::string now(name(shader));
  if (!choose_name("shader", {names.begin(), names.end()}, now)) return false;
  shader = shader_from_name(now);
  return true;
}

bool choose_transparency(TransparencyOptions& t) {
  std::string now = transparency_name(t);
  bool changed = choose_name("transparency", transparency_names(t), now);
  constexpr int kMostFilter = 64;
  if (int filter = filter_of(t); !changed && filter != 0) {
    changed = ImGui::SliderInt("filter", &filter, 1, kMostFilter);
    now = "filter:" + std::to_string(std::clamp(filter, 1, kMostFilter));
  }
  if (changed) parse_transparency(now, t);
  return changed;
}

bool choose_samples(int& samples) {
  std::vector<std::string> names;
  for (const int n : kSampleCounts) names.push_back(std::to_string(n));
  std::string now = std::to_string(samples);
  if (!choose_name("samples", names, now)) return false;
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

/// A map's colours from left to right.
void draw_strip(const ColorMap& map, int steps, float width) {
  ScalarMapping shown;
  shown.map = map;
  shown.steps = steps;
  const ScalarColors colors(shown, {0, 1});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight();
  constexpr int kParts = 96;
  for (int i = 0; i < kParts; ++i) {
    const Vec4 c = colors((i + 0.5) / kParts);
    const float x0 = std::floor(at.x + width * static_cast<float>(i) / kParts);
    const float x1 = std::floor(at.x + width * static_cast<float>(i + 1) / kParts);
    list.AddRectFilled({x0, at.y}, {x1, at.y + height},
                       ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, 1}));
  }
  ImGui::Dummy({width, height});
}

/// Lists maps beside their colours.
bool choose_map(MeshSettings& s) {
  bool changed = false;
  if (!ImGui::BeginCombo("colours", s.map.c_str(), ImGuiComboFlags_HeightLargest)) return false;
  constexpr float kStrip = 94;
  for (const std::string_view n : color_map_names()) {
    const std::string name(n);
    const ColorMap map = color_map(n);
    const ImVec2 at = ImGui::GetCursorPos();
    if (ImGui::Selectable(("##" + name).c_str(), name == s.map)) {
      s.map = name;
      s.notes.scalars.mapping.map = map;
      changed = true;
    }
    ImGui::SetCursorPos(at);
    draw_strip(map, 0, kStrip);
    ImGui::SameLine();
    ImGui::TextUnformatted(name.c_str());
  }
  ImGui::EndCombo();
  return changed;
}

bool choose_scalars(const LoadedScene& scene, MeshSettings& s) {
  ScalarOptions& o = s.notes.scalars;
  std::vector<std::string> names;
  for (const ScalarSummary& summary : scene.scalars) names.push_back(summary.name);
  bool changed = choose_name_or_none("numbers", "none", names, o.name);
  if (changed) o.mapping.range.reset();
  if (o.name.empty()) {
    if (changed) o.bar_title.reset();
    return changed;
  }
  changed |= choose_map(s);
  draw_strip(o.mapping.map, o.mapping.steps, ImGui::CalcItemWidth());
  const auto found = std::ranges::find(scene.scalars, o.name, &ScalarSummary::name);
  const ScalarRange all = found == scene.scalars.end() ? ScalarRange{} : found->range;
  ScalarRange range = o.mapping.range.value_or(all);
  const auto speed = static_cast<float>((all.high - all.low) / 400);
  bool moved =
      ImGui::DragScalar("from", ImGuiDataType_Double, &range.low, speed, nullptr, nullptr, "%.6g");
  moved |=
      ImGui::DragScalar("to", ImGuiDataType_Double, &range.high, speed, nullptr, nullptr, "%.6g");
  if (moved && range.low <= range.high) {
    o.mapping.range = range;
    changed = true;
  }
  if (o.mapping.range && ImGui::Button("all of them")) {
    o.mapping.range.reset();
    changed = true;
  }
  changed |=
      ImGui::SliderInt("steps", &o.mapping.steps, 0, 20, o.mapping.steps == 0 ? "blended" : "%d");
  if (range.low > 0 || o.mapping.logarithmic)
    changed |= ImGui::Checkbox("logarithmic", &o.mapping.logarithmic);
  bool bar = o.bar();
  if (ImGui::Checkbox("bar", &bar)) {
    if (bar)
      o.bar_title = o.name;
    else
      o.bar_title.reset();
    changed = true;
  }
  return changed;
}

bool choose_lights(const LoadedScene& scene, MeshSettings& s) {
  std::vector<std::string> names{"default", "headlight", "studio"};
  if (!s.file_lights.empty()) names.emplace_back("file");
  bool changed = choose_name_or_none("lights", "as given", names, s.lights);
  changed |= ImGui::Checkbox("shadows", &s.render.shadows);
  ImGui::SameLine();
  changed |= ImGui::Checkbox("occlusion", &s.notes.occlusion);
  ImGui::SameLine();
  changed |= ImGui::Checkbox("eye-dome", &s.notes.dome);
  if (shader_of(s.render.shader, scene.has_materials) != Shader::material) return changed;
  changed |= choose_value("tone", kTones, s.render.tone.tone);
  if (s.render.tone.tone != Tone::none)
    changed |= ImGui::SliderFloat("exposure", &s.render.tone.exposure_stops, -8, 8, "%.2f stops");
  return changed;
}

bool choose_lines(AnnotationOptions& a) {
  bool changed = ImGui::Checkbox("silhouettes", &a.silhouettes);
  ImGui::SameLine();
  changed |= ImGui::Checkbox("edges", &a.edges);
  changed |= ImGui::Checkbox("axes", &a.axes);
  ImGui::SameLine();
  changed |= ImGui::Checkbox("bounds", &a.bounds);
  return changed;
}

/// The slider and the button of an active section.
bool drag_section(Section& section, const ScalarRange& all) {
  ImGui::SameLine(kSectionName);
  bool changed =
      ImGui::SliderScalar("##at", ImGuiDataType_Double, &section.at, &all.low, &all.high, "%.6g");
  ImGui::SameLine();
  if (ImGui::Button("turn")) {
    section.below = !section.below;
    changed = true;
  }
  return changed;
}

bool choose_sections(const Bounds& box, const Camera& camera, MeshSettings& s) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  constexpr Vec3d kDirections[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  bool changed = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Section& section = s.sections[axis];
    const ScalarRange all = reach(box, kDirections[axis]);
    ImGui::PushID(static_cast<int>(axis));
    if (ImGui::Checkbox(kAxes[axis], &section.on)) {
      changed = true;
      if (section.at <= all.low || section.at >= all.high) section.at = (all.low + all.high) / 2;
    }
    if (section.on) changed |= drag_section(section, all);
    ImGui::PopID();
  }
  ImGui::PushID("view");
  ViewSection& view = s.view_section;
  if (ImGui::Checkbox("view", &view.on)) {
    // From the present camera each time.
    if (view.on) view = section_of_view(camera, box);
    changed = true;
  }
  if (view.on) changed |= drag_section(view, reach(box, view.direction));
  ImGui::PopID();
  return changed;
}

}  // namespace

void draw_mesh_controls(MeshSubject& subject) {
  MeshSubject::Settings s = subject.settings();
  family::Options& r = s.render;
  bool changed = choose_shader(r.shader);
  changed |= choose_name("rasterizer", axis_names(family::rasterizer_axis()), r.rasterizer);
  changed |= choose_name("visibility", axis_names(family::visibility_axis()), r.visibility);
  changed |= ImGui::SliderFloat("opacity", &r.opacity, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
  changed |= choose_transparency(r.transparency);
  changed |= choose_samples(r.samples);
  changed |= choose_threads(r);
  if (ImGui::CollapsingHeader("Numbers as colours")) changed |= choose_scalars(subject.scene(), s);
  if (ImGui::CollapsingHeader("Light")) changed |= choose_lights(subject.scene(), s);
  if (ImGui::CollapsingHeader("Lines")) changed |= choose_lines(s.notes);
  if (ImGui::CollapsingHeader("Sections"))
    changed |= choose_sections(subject.scene().box, subject.control().camera(), s);
  changed |= ImGui::Checkbox("heat map", &s.heat_map);
  ImGui::SameLine();
  if (ImGui::Button("home")) subject.control().go_home();
  if (changed) subject.set(std::move(s));
}

}  // namespace rastrum::cli::window
