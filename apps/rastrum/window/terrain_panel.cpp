// SPDX-License-Identifier: BSD-3-Clause
// The controls of a terrain. Each edits a copy, which is set if it has changed.
#include <imgui.h>

#include <string>
#include <utility>

#include <rastrum/family.hpp>

#include "panel.hpp"
#include "parse/light_options.hpp"
#include "terrain_subject.hpp"

namespace rastrum::cli::window {
namespace {

bool slide(const char* label, double& value, float least, float most, const char* format,
           ImGuiSliderFlags flags = ImGuiSliderFlags_None) {
  auto v = static_cast<float>(value);
  if (!ImGui::SliderFloat(label, &v, least, most, format, flags)) return false;
  value = double{v};
  return true;
}

/// Lights instead of the sun, and annotations.
bool edit_ground(TerrainSubject::Settings& s) {
  bool changed =
      choose_name_or_none("lights", "as given", {"sun", "headlight", "studio"}, s.lights);
  if (!s.frame().lights.empty()) {
    ToneMapping& tone = s.shown.frame.tone;
    changed |= choose_value("tone", kTones, tone.tone);
    if (tone.tone != Tone::none)
      changed |= ImGui::SliderFloat("exposure", &tone.exposure_stops, -4, 4, "%.1f stops");
  }
  changed |= ImGui::Checkbox("axes", &s.shown.ground.axes);
  ImGui::SameLine();
  return ImGui::Checkbox("bounds", &s.shown.ground.bounds) || changed;
}

bool edit_pose(TerrainPose& p) {
  bool changed = slide("distance", p.distance, 10, 10000, "%.0f", ImGuiSliderFlags_Logarithmic);
  changed |= slide("field of view", p.fov_rad, 0.1F, 3, "%.2f rad");
  changed |= slide("sun azimuth", p.sun.azimuth_deg, 0, 360, "%.0f deg");
  changed |= slide("sun elevation", p.sun.elevation_deg, -10, 90, "%.0f deg");
  changed |= slide("altitude", p.camera.altitude, -100, 1000, "%.0f");
  changed |= slide("roll", p.camera.roll_rad, -3.2F, 3.2F, "%.2f rad");
  return changed;
}

}  // namespace

void draw_terrain_controls(TerrainSubject& subject) {
  TerrainPose pose = subject.control().pose();
  if (edit_pose(pose)) subject.place(pose);
  TerrainSubject::Settings s = subject.settings();
  terrain::TerrainOptions& o = s.options;
  bool changed = choose_value("filter", kFilters, o.filter);
  changed |= choose_value("shadows", kShadows, s.light.shadows);
  changed |= edit_ground(s);
  changed |= slide("fog", o.fog.density, 0, 0.02F, "%.4f");
  changed |= slide("fog begins", o.fog.start, 0, 2000, "%.0f");
  changed |= choose_value("tiling", kTilings, o.tiling);
  changed |= choose_value("projection", kProjections, o.projection);
  std::string method = o.added == nullptr ? "fast" : "words";
  if (choose_name("method", {"fast", "words"}, method)) {
    o.added = method == "fast" ? nullptr : &family::terrain_words();
    changed = true;
  }
  changed |= ImGui::Checkbox("classic", &o.classic);
  if (changed) subject.set(std::move(s));
  if (ImGui::Button("next map")) subject.next_map();
}

}  // namespace rastrum::cli::window
