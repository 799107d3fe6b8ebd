// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench materials`: frames of the `material` shader beside the same formula in GLSL on
// Mesa's llvmpipe, in one interleaved run, after a comparison of their pictures.
//
// A frame of Rastrum goes from the caller's scene in memory to finished RGBA8 in memory. llvmpipe
// has static buffers and textures and one draw per material; its frame ends with glFinish, and the
// picture stays in place. llvmpipe is timed as installed, with its approximate filters.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <bench/measure.hpp>
#include <bench/options.hpp>
#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/scenes.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

#include "compare.hpp"
#include "gl_materials.hpp"
#include "selection.hpp"
#include "started.hpp"

namespace rastrum::bench {
namespace {

constexpr double kMaterialsGoal = 6;  ///< llvmpipe's time over ours, textured

// The same limits as in `peers`. The least share was 99.979 %, inside sponza. Pixels differ at the
// edges of holes, where a mask's alpha is its cutoff but for rounding, at silhouettes, and between
// nearly equal depths.
constexpr int kMaterialsTolerance = 1;  ///< of 255
constexpr double kMaterialsShare = 0.999;

struct MaterialsOptions : PeerOptions {
  std::string pictures;  ///< the folder for both pictures of each row; empty: none
};

struct MaterialsScene {
  Scene scene;
  std::vector<std::pair<std::string, Camera>> views;
};

/// Sponza with its materials, from outside and inside; other scenes as geometry only.
MaterialsScene materials_scene(const SceneInfo& info) {
  MaterialsScene s;
  const std::string name(info.name);
  const bool is_hall = info.name == "sponza";
  if (is_hall) {
    s.scene = load_whole(info);
  } else {
    s.scene.meshes.push_back(load(info));
    s.scene.instances.push_back({});
  }
  const SceneBinding bound(s.scene);
  s.views.emplace_back(name, fit_camera(bound.view(), Camera{}.fov_rad, false));
  if (is_hall) {
    // Looks along the hall: cloth and walls near and far, leaves with masks.
    constexpr std::size_t kStep = 7;
    s.views.emplace_back(name + ", within", walk(bound.view(), 24)[kStep]);
  }
  return s;
}

struct MaterialsRow {
  std::string scene;
  Size size;
  std::uint64_t triangles = 0;
  std::size_t textures = 0;
  std::optional<ColorDifference> difference{};
  std::optional<Timing> ours{}, gl{};

  [[nodiscard]] bool is_right() const {
    return !difference || difference->share() >= kMaterialsShare;
  }
  [[nodiscard]] double ratio() const { return gl && ours ? median_ratio(*gl, *ours) : 0; }
  [[nodiscard]] bool misses_goal() const { return gl && textures != 0 && ratio() < kMaterialsGoal; }
};

nlohmann::json to_json(const MaterialsRow& row) {
  nlohmann::json j = {{"scene", row.scene},         {"size", size_text(row.size)},
                      {"triangles", row.triangles}, {"textures", row.textures},
                      {"right", row.is_right()},    {"misses_goal", row.misses_goal()}};
  if (row.difference)
    j["difference"] = {{"tolerance", kMaterialsTolerance},
                       {"share", row.difference->share()},
                       {"covered", row.difference->covered},
                       {"one_only", row.difference->one_only},
                       {"largest", row.difference->largest}};
  if (row.ours) j["rastrum"] = to_json(*row.ours);
  if (row.gl) j["llvmpipe"] = to_json(*row.gl);
  if (row.gl) j["ratio_llvmpipe"] = row.ratio();
  return j;
}

void write_pictures(const MaterialsRow& row, const Image<Rgba8>& ours, const Image<Rgba8>& theirs,
                    const std::filesystem::path& folder) {
  std::string name = row.scene + "-" + size_text(row.size);
  std::erase(name, ',');
  std::ranges::replace(name, ' ', '-');
  std::filesystem::create_directories(folder);
  io::write_png(folder / (name + "-rastrum.png"), ours);
  io::write_png(folder / (name + "-llvmpipe.png"), theirs);
}

MaterialsRow measure_materials(const std::string& name, const SceneView& scene,
                               const Camera& camera, Size size, GlMaterials* gl,
                               const MaterialsOptions& options) {
  Renderer renderer({.threads = options.threads});
  const FrameOptions frame{.width = size.width, .height = size.height, .shader = Shader::material};
  Image<Rgba8> ours(size.width, size.height);
  const Targets targets{.color8 = ours};
  MaterialsRow row{name, size};
  row.textures = scene.textures.size();
  for (const InstanceView& i : scene.instances) row.triangles += primitive_count(i.geometry);

  renderer.render(scene, camera, frame, targets);
  std::vector<Contender> contenders{
      {"rastrum", [&] { renderer.render(scene, camera, frame, targets); }}};
  if (gl != nullptr) {
    gl->set_view(camera, size.width, size.height);
    gl->draw();
    const Image<Rgba8> theirs = gl->colors();
    row.difference = compare_colors(ours, theirs, kMaterialsTolerance);
    if (!options.pictures.empty()) write_pictures(row, ours, theirs, options.pictures);
    if (!row.is_right()) return row;
    contenders.push_back({"llvmpipe", [&] { gl->draw(); }});
  }
  std::vector<Timing> timings = measure_interleaved(contenders, {.rounds = options.rounds});
  row.ours = std::move(timings[0]);
  if (gl != nullptr) row.gl = std::move(timings[1]);
  return row;
}

void print_materials(const Table& table, const MaterialsRow& row) {
  const auto ms = [](const std::optional<Timing>& t) {
    return t ? significant(t->median_ms()) : "-";
  };
  std::string note;
  if (!row.is_right()) note = "WRONG PICTURE";
  if (row.misses_goal()) note = significant(row.ratio()) + " < " + significant(kMaterialsGoal, 1);
  table.print_row({row.scene, size_text(row.size), std::to_string(row.triangles),
                   std::to_string(row.textures), ms(row.ours),
                   row.ours ? significant(row.ours->spread() * 100, 2) : "-", ms(row.gl),
                   row.gl ? significant(row.ratio()) : "-",
                   row.difference ? significant(row.difference->share() * 100, 5) : "-", note});
}

}  // namespace

int run_materials(std::span<const std::string_view> arguments) {
  MaterialsOptions options;
  std::vector<SceneInfo> scenes;
  for (const char* name : {"sponza", "bunny", "dragon", "brain"})
    scenes.push_back(scene_by_name(name));
  Selection selection(std::move(scenes), {{1024, 1024}, {1920, 1080}});
  OptionParser parser("materials",
                      "Frames of `material` beside the same formula on llvmpipe, interleaved: "
                      "sponza with its textures, other scenes without any.");
  parser.add_option("--pictures", options.pictures, "write both pictures of each row into FOLDER")
      ->type_name("FOLDER");
  if (const auto status = options.read(parser, selection, arguments)) return *status;

  Started<GlMaterials> started(options.threads);
  GlMaterials* const gl = started.peer ? &*started.peer : nullptr;
  std::printf("%s\n%s\n%d threads, %d rounds\n\n", machine_text().c_str(), started.line().c_str(),
              options.threads, options.rounds);
  const Table table({{"scene", 14, true},
                     {"size", 9, true},
                     {"triangles", 9},
                     {"textures", 8},
                     {"ours ms", 8},
                     {"± %", 4},
                     {"llvmpipe", 8},
                     {"ratio", 6},
                     {"alike %", 7},
                     {"goal missed", 11, true}});
  table.print_head();
  nlohmann::json rows = nlohmann::json::array();
  bool right = true;
  for (const SceneInfo& info : selection.scenes()) {
    const MaterialsScene subject = materials_scene(info);
    const SceneBinding bound(subject.scene);
    if (gl != nullptr) gl->set_scene(bound.view());
    for (const auto& [name, camera] : subject.views)
      for (const Size size : selection.sizes()) {
        const MaterialsRow row = measure_materials(name, bound.view(), camera, size, gl, options);
        print_materials(table, row);
        rows.push_back(to_json(row));
        right = right && row.is_right();
      }
  }
  std::printf(
      "\nratio: llvmpipe's time over ours, the median over rounds. alike: covered pixels whose "
      "channels are at most %d of 255 apart.\n",
      kMaterialsTolerance);
  if (!options.json.empty()) {
    nlohmann::json document = {{"benchmark", "materials"},
                               {"machine", machine_json()},
                               {"threads", options.threads},
                               {"rounds", options.rounds},
                               {"rows", rows}};
    if (gl != nullptr) document["llvmpipe"] = gl->description();
    write_json(options.json, document);
  }
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
