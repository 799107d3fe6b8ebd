// SPDX-License-Identifier: BSD-3-Clause
#include "panel.hpp"

#include <imgui.h>

#include <algorithm>
#include <utility>

namespace rastrum::cli::window {
namespace {

constexpr float kPanelWidth = 330, kMargin = 8;
const ImVec4 kErrorColor{1, 0.45F, 0.4F, 1};
const ImVec4 kQuiet{0.7F, 0.7F, 0.7F, 1};

/// Each stage as a bar at its time in the frame.
void draw_stages(const Figures& figures) {
  const double whole = std::max(figures.frame_ms, 1e-6);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float width = ImGui::GetContentRegionAvail().x;
  const float height = ImGui::GetTextLineHeight();
  for (const StageTime& stage : figures.stages) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const auto x = [&](double ms) {
      return at.x + width * static_cast<float>(std::clamp(ms / whole, 0.0, 1.0));
    };
    list.AddRectFilled({at.x, at.y}, {at.x + width, at.y + height}, IM_COL32(255, 255, 255, 16));
    list.AddRectFilled({x(stage.begin_ms), at.y},
                       {std::max(x(stage.end_ms), x(stage.begin_ms) + 1), at.y + height},
                       IM_COL32(70, 130, 200, 190));
    ImGui::Text("%-12s %8.2f ms", stage.name.c_str(), stage.end_ms - stage.begin_ms);
  }
}

void draw_times(Viewer& viewer) {
  const Drawn* const picture = viewer.picture();
  if (picture == nullptr) {
    ImGui::TextUnformatted("drawing the first picture");
    return;
  }
  const Figures& f = picture->figures;
  ImGui::Text("%.2f ms, %d x %d%s", f.frame_ms, picture->image.width(), picture->image.height(),
              viewer.is_full() ? "" : " (moving)");
  const std::vector<float>& ms = viewer.history_ms();
  if (!ms.empty())
    ImGui::PlotLines("##times", ms.data(), static_cast<int>(ms.size()), 0, nullptr, 0,
                     *std::max_element(ms.begin(), ms.end()) * 1.1F, {-1, 40});
}

void draw_rows(const Figures& figures) {
  if (!ImGui::BeginTable("rows", 2, ImGuiTableFlags_SizingFixedFit)) return;
  for (const auto& [what, value] : figures.rows) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(what.c_str());
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", value.c_str());
  }
  ImGui::EndTable();
}

void draw_keys(const std::vector<KeyHelp>& keys) {
  for (const KeyHelp& k : keys)
    ImGui::TextWrapped("%s: %s", std::string(k.keys).c_str(), std::string(k.what).c_str());
}

void choose_hovering(Viewer& viewer) {
  bool hovers = viewer.hovers();
  if (ImGui::Checkbox("values under the pointer", &hovers)) viewer.set_hovers(hovers);
}

void draw_moving(Viewer& viewer) {
  bool adaptive = viewer.options().adaptive;
  if (ImGui::Checkbox("fewer pixels while moving", &adaptive)) viewer.set_adaptive(adaptive);
  auto target = static_cast<float>(viewer.options().target_ms);
  if (adaptive && ImGui::SliderFloat("ms a frame", &target, 5, 200, "%.0f"))
    viewer.set_target(double{target});
}

void offer_texts(Viewer& viewer) {
  constexpr std::pair<const char*, const char*> kButtons[] = {{".sh", "copy command line"},
                                                              {".py", "copy Python"}};
  for (const auto& [ending, label] : kButtons) {
    if (ImGui::Button(label))
      if (const std::string text = viewer.copy(ending); !text.empty())
        ImGui::SetClipboardText(text.c_str());
    ImGui::SameLine();
  }
  ImGui::NewLine();
}

void draw_message(const std::string& what, const ImVec4& color) {
  if (what.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextWrapped("%s", what.c_str());
  ImGui::PopStyleColor();
}

}  // namespace

Area draw_panel(Viewer& viewer, const Controls& controls) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({kMargin, kMargin}, ImGuiCond_Once);
  ImGui::SetNextWindowSizeConstraints({kPanelWidth, 0},
                                      {kPanelWidth, std::max(screen.y - 2 * kMargin, kMargin)});
  ImGui::SetNextWindowBgAlpha(0.8F);
  ImGui::Begin("rastrum", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PushItemWidth(kPanelWidth * 0.55F);
  draw_message(viewer.error(), kErrorColor);
  draw_times(viewer);
  ImGui::Separator();
  controls();
  offer_texts(viewer);
  choose_hovering(viewer);
  draw_moving(viewer);
  // A glance has other stages than a whole picture. Here they move nothing.
  if (viewer.picture() != nullptr && ImGui::CollapsingHeader("Figures")) {
    draw_stages(viewer.picture()->figures);
    draw_rows(viewer.picture()->figures);
  }
  if (ImGui::CollapsingHeader("Keys")) {
    draw_keys(viewer.subject().keys());
    draw_keys(Viewer::keys());
    ImGui::TextWrapped(
        "Hold the pointer still: see what is under it; click: see that in the title. Drag: orbit; "
        "with the right button: look around; with the middle one or Shift: pan. Wheel: zoom.");
    ImGui::TextWrapped("Drop a file on the window to open it.");
  }
  // Below, so that it does not move what is about to be clicked.
  draw_message(viewer.notice(), kQuiet);
  ImGui::PopItemWidth();
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  ImGui::End();
  return {at.x, at.y, at.x + size.x, at.y + size.y};
}

void draw_hovered(const Viewer& viewer) {
  const Picked* const picked = viewer.hovered();
  if (picked == nullptr) return;
  // From the viewer, because ImGui asks the screen, which may be late. Opens towards the middle.
  const auto x = static_cast<float>(viewer.pointer()->first);
  const auto y = static_cast<float>(viewer.pointer()->second);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const bool right = x > size.x / 2, low = y > size.y / 2;
  constexpr float kBeside = 14;
  ImGui::SetNextWindowPos({x + (right ? -kBeside : kBeside), y + (low ? -kBeside : kBeside)},
                          ImGuiCond_Always, {right ? 1.0F : 0.0F, low ? 1.0F : 0.0F});
  ImGui::BeginTooltip();
  if (!picked->value.empty()) ImGui::TextUnformatted(picked->value.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text,
                        picked->value.empty() ? ImGui::GetStyleColorVec4(ImGuiCol_Text) : kQuiet);
  ImGui::TextUnformatted(picked->what.c_str());
  if (!picked->where.empty()) ImGui::TextUnformatted(picked->where.c_str());
  ImGui::PopStyleColor();
  ImGui::EndTooltip();
}

void draw_messages(const Viewer& viewer) {
  if (viewer.error().empty()) return;
  ImGui::SetNextWindowPos({kMargin, kMargin});
  ImGui::SetNextWindowSize({kPanelWidth, 0});
  ImGui::Begin("error", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize);
  draw_message(viewer.error(), kErrorColor);
  draw_message(viewer.notice(), kQuiet);
  ImGui::End();
}

bool choose_name(const char* label, const std::vector<std::string>& names, std::string& now) {
  bool changed = false;
  if (!ImGui::BeginCombo(label, now.c_str())) return false;
  for (const std::string& name : names)
    if (ImGui::Selectable(name.c_str(), name == now) && name != now) {
      now = name;
      changed = true;
    }
  ImGui::EndCombo();
  return changed;
}

bool choose_name_or_none(const char* label, const std::string& none, std::vector<std::string> names,
                         std::string& value) {
  names.insert(names.begin(), none);
  std::string now = value.empty() ? none : value;
  if (!choose_name(label, names, now)) return false;
  value = now == none ? "" : now;
  return true;
}

}  // namespace rastrum::cli::window
