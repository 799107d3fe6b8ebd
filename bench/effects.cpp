// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench effects`: what ambient occlusion, eye-dome lighting, silhouettes, edges, lights,
// shadows, environments, numbers, layers and all of --studio add to a frame at 1920 × 1080, beside
// VTK's occlusion and depth peeling. Our factors and pictures are compared with the plain code's
// before the timing, VTK's pictures by their coverage.
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <rastrum/digest.hpp>
#include <rastrum/effects.hpp>
#include <rastrum/environment.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "measure.hpp"
#include "peers/started.hpp"
#include "peers/vtk_peer.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "scenes.hpp"
#include "tables/document.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {
namespace {

struct Pictures {
  Image<Rgba8> color;
  Image<float> depth, factor;
  Image<Vec3> normals;
  Image<std::int64_t> ids, primitives;  ///< of instances; Targets::ids

  Pictures(int width, int height)
      : color(width, height),
        depth(width, height),
        factor(width, height),
        normals(width, height),
        ids(width, height),
        primitives(width, height) {}
  [[nodiscard]] Surface surface() const { return {depth.view(), normals.view(), ids.view()}; }
};

constexpr int kEffects = 4;
constexpr int kVtkSamples = 16;  ///< of occlusion, as in VTK; studio has its own number
constexpr const char* kGlass = "translucent, exact";
constexpr const char* kNames[kEffects] = {"occlusion", "eye dome", "silhouettes", "edges"};

void apply(Effects& effects, int which, Pictures& p, const Camera& camera, double radius,
           const SceneEdges& edges) {
  if (which == 0)
    effects.ambient_occlusion({.view_depth = p.depth.view()}, camera,
                              {.radius = radius, .samples = kVtkSamples}, p.factor);
  if (which == 1) effects.eye_dome(p.surface(), camera, {}, p.factor);
  if (which == 2) effects.silhouettes(p.surface(), camera, {}, p.factor);
  if (which == 3) effects.edges(p.primitives.view(), edges, camera, 1, p.factor);
}

/// Frames with other lights, numbers or layers, and the frame of --studio.
struct LitFrame {
  const char* name;
  FrameOptions options;
  bool occlusion = false;
  int numbers = 0;  ///< 1: as colours, 2: also with isolines
};

std::vector<LitFrame> lit_frames(const FrameOptions& plain) {
  FrameOptions kit = plain, shadows = plain, environment = plain, glass = plain, studio = plain;
  kit.lights = studio.lights = light_kit();
  shadows.lights = {Light{.kind = DirectionalLight{{-0.4F, -0.6F, -1}}, .of_camera = true}};
  shadows.shadows = true;
  const Image<Vec3> room = builtin_environment(BuiltinEnvironment::room);
  environment.lights = {Light{.kind = EnvironmentLight{Environment(room.view())}}};
  glass.opacity = 0.5F;
  studio.samples = 4;
  return {{"studio's lights", kit},
          {"one light, shadows", shadows},
          {"an environment", environment},
          {"numbers as colours", plain, false, 1},
          {"numbers, isolines", plain, false, 2},
          {kGlass, glass},
          {"studio", studio, true}};
}

/// The scene with heights as numbers.
Scene with_numbers(const Scene& scene, bool isolines) {
  Scene numbers = scene;
  show_scalars(numbers, "y");
  numbers.scalar_mappings.resize(1);
  if (!isolines) return numbers;
  const ScalarRange range = scalar_colors(SceneBinding(numbers).view()).range();
  for (int i = 1; i < 10; ++i)
    numbers.scalar_mappings[0].isolines.push_back(range.low + i * (range.high - range.low) / 10);
  return numbers;
}

void draw(Renderer& renderer, Effects& effects, const LitFrame& frame, const SceneView& scene,
          const Camera& camera, double radius, Pictures& p) {
  Targets targets{.color8 = p.color};
  if (frame.occlusion) targets.view_depth = p.depth;
  (void)renderer.render(scene, camera, frame.options, targets);
  if (!frame.occlusion) return;
  effects.occlude({.view_depth = p.depth.view()}, camera, {.radius = radius}, p.color, {});
}

/// The mean of red, green and blue over covered pixels, of 255.
double brightness(const Image<Vec4>& picture) {
  double sum = 0, count = 0;
  for (const Vec4& c : picture.pixels()) {
    if (c.w == 0) continue;
    sum += 85.0 * (static_cast<double>(c.x) + c.y + c.z);
    ++count;
  }
  return count == 0 ? 0 : sum / count;
}

/// Adds VTK's frames of one scene: its `phong`, with its occlusion, and peeled layers.
void time_vtk(VtkPeer& vtk, const Mesh& mesh, const Camera& camera, const FrameOptions& frame,
              double radius, const Image<Rgba8>& ours, std::vector<Contender>& contenders,
              const std::function<void(const std::string&, const std::string&)>& say) {
  vtk.set_mesh(mesh.view());
  vtk.set_view(camera, frame.width, frame.height);
  vtk.set_occlusion(0);
  vtk.draw(1);
  const Image<Vec4> open = vtk.picture();
  vtk.set_occlusion(radius);
  vtk.draw(1);
  say("VTK covers of what either does", significant(common_coverage(ours, open), 4));
  say("VTK's brightness with occlusion",
      significant(brightness(vtk.picture()) / brightness(open), 3));
  contenders.push_back({"VTK, phong", [&vtk] {
                          vtk.set_occlusion(0);
                          vtk.draw(1);
                        }});
  contenders.push_back({"VTK, occlusion", [&vtk, radius] {
                          vtk.set_occlusion(radius);
                          vtk.draw(1);
                        }});
}

}  // namespace

int run_effects(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("effects",
                      "Occlusion, eye-dome lighting, silhouettes, edges, lights, shadows, numbers, "
                      "layers and --studio at 1920 × 1080, beside VTK's occlusion and peeling.");
  if (const auto status = options.read(parser, arguments)) return *status;
  FrameOptions frame = options.frame(1920, 1080);
  frame.shader = Shader::phong;
  Document document = options.document("effects", "Effects over finished pictures");
  document.notes.push_back(
      options.here(frame) +
      ", ms; an effect with its way into the colours; the factors are the plain "
      "code's, bit by bit.");
  Started<VtkPeer> vtk_started(options.threads);
  std::optional<VtkPeer>& vtk = vtk_started.peer;
  document.notes.push_back(vtk_started.note +
                           ": the peers' phong; its occlusion has as many samples (16) and as wide "
                           "a reach as ours in the row `occlusion` (studio has 8), and its peeling "
                           "takes all layers (one round of it "
                           "where a frame takes 4 s, else three).");
  // A row for each timed frame, a column for each scene.
  Grid grid{"", {"ms"}, {}};
  Plot plot = options.plot(document, "scene", "ms");
  plot.kind = Plot::Kind::bars;
  Panel panel{"frame and effects", {}};
  bool right = true;
  // The gyroid occludes itself nearly everywhere and needs no data file.
  std::vector<SceneInfo> scenes{{"gyroid", {}, "gyroid?cells=64"}};
  for (const SceneInfo& info : peer_scenes())
    if (!info.soup && available(info) && !(options.quick && info.subdivide > 0))
      scenes.push_back(info);
  for (const SceneInfo& info : scenes) {
    Scene scene;
    scene.meshes.push_back(load(info));
    scene.instances.resize(1);
    const SceneBinding binding(scene);
    const Camera camera =
        fit_picture(binding.view(), {.eye = {1, 0.7, 1.4}}, frame.width, frame.height);
    const Bounds box = bounds(binding.view());
    const double radius = 0.075 * length(box.max - box.min);
    Pictures p(frame.width, frame.height), plain(frame.width, frame.height);
    Renderer renderer({.threads = options.threads});
    Effects effects(options.threads), reference(1, Isa::scalar);
    const SceneEdges edges(binding.view(), 30);
    const Targets all{.color8 = p.color,
                      .ids = p.primitives,
                      .instances = p.ids,
                      .camera_normals = p.normals,
                      .view_depth = p.depth};
    (void)renderer.render(binding.view(), camera, frame, all);
    plain.depth = p.depth;
    plain.normals = p.normals;
    plain.ids = p.ids;
    plain.primitives = p.primitives;
    for (int i = 0; i < kEffects; ++i) {
      apply(effects, i, p, camera, radius, edges);
      apply(reference, i, plain, camera, radius, edges);
      right = right && digest(p.factor.view()) == digest(plain.factor.view());
    }
    const std::vector<LitFrame> lit = lit_frames(frame);
    Renderer scalar({.threads = options.threads, .isa = Isa::scalar});
    const Scene numbers[2] = {with_numbers(scene, false), with_numbers(scene, true)};
    const SceneBinding bindings[3] = {SceneBinding(scene), SceneBinding(numbers[0]),
                                      SceneBinding(numbers[1])};
    for (const LitFrame& l : lit) {
      const SceneView view = bindings[l.numbers].view();
      draw(renderer, effects, l, view, camera, radius, p);
      draw(scalar, reference, l, view, camera, radius, plain);
      right = right && digest(p.color.view()) == digest(plain.color.view());
    }
    std::vector<Contender> contenders{
        {"phong",
         [&] { (void)renderer.render(binding.view(), camera, frame, {.color8 = p.color}); }},
        {"with view depth",
         [&] {
           (void)renderer.render(binding.view(), camera, frame,
                                 {.color8 = p.color, .view_depth = p.depth});
         }},
        {"and ids, normals, instances",
         [&] { (void)renderer.render(binding.view(), camera, frame, all); }}};
    for (int i = 0; i < kEffects; ++i)
      contenders.push_back({kNames[i], [&, i] {
                              apply(effects, i, p, camera, radius, edges);
                              effects.darken(p.color, {}, p.factor.view());
                            }});
    for (const LitFrame& l : lit)
      contenders.push_back(
          {l.name,
           [&] { draw(renderer, effects, l, bindings[l.numbers].view(), camera, radius, p); }});
    const auto say = [&](const std::string& what, const std::string& cell) {
      grid.cell(what, std::string(info.name)) = cell;
    };
    std::vector<std::pair<std::string, std::string>> of_vtk;
    // Peeling takes seconds, so a smoke test has it once.
    const bool beside_vtk = vtk && (!options.quick || &info == &scenes.front());
    if (beside_vtk) {
      (void)renderer.render(binding.view(), camera, frame, {.color8 = p.color});
      time_vtk(*vtk, scene.meshes[0], camera, frame, radius, p.color, contenders,
               [&](const std::string& what, const std::string& cell) {
                 of_vtk.emplace_back(what, cell);
               });
    }
    progress(std::string(info.name));
    std::vector<Timing> timings = measure_interleaved(contenders, options.plan());
    if (beside_vtk) {
      // VTK's frames take seconds, so there are few rounds.
      const LitFrame& glass =
          *std::find_if(lit.begin(), lit.end(), [](const LitFrame& l) { return l.name == kGlass; });
      vtk->set_occlusion(0);
      const std::vector<Contender> two{
          {kGlass, [&] { draw(renderer, effects, glass, binding.view(), camera, radius, p); }},
          {"VTK, peeling", [&] { vtk->draw(0.5F); }}};
      Plan plan = options.plan();
      plan.rounds = 1;
      std::vector<Timing> peeled = measure_interleaved(two, plan);
      constexpr double kPatienceMs = 4000;
      plan.rounds = std::min(options.plan().rounds, 3);
      if (plan.rounds > 1 && peeled[1].median_ms() < kPatienceMs)
        peeled = measure_interleaved(two, plan);
      timings.push_back(peeled[1]);
      of_vtk.emplace_back("VTK, peeling ÷ translucent, exact",
                          significant(median_ratio(peeled[1], peeled[0])));
    }
    const auto named = [&](std::string_view name) -> const Timing& {
      return *std::find_if(timings.begin(), timings.end(),
                           [&](const Timing& t) { return t.name == name; });
    };
    plot.places.emplace_back(info.name);
    panel.series.resize(timings.size());
    for (std::size_t i = 0; i < timings.size(); ++i) {
      const double ms = timings[i].median_ms();
      say(timings[i].name, significant(ms));
      document.figures.push_back({{"scene", info.name}, {"what", timings[i].name}, {"ms", ms}});
      panel.series[i].name = timings[i].name;
      panel.series[i].color = static_cast<int>(i);
      panel.series[i].values.push_back(ms);
    }
    const double phong = named("phong").median_ms(),
                 occluded = named("with view depth").median_ms() + named("occlusion").median_ms();
    say("with occlusion ÷ phong", significant(occluded / phong));
    say("studio ÷ phong", significant(median_ratio(named("studio"), named("phong"))));
    if (beside_vtk) {
      say("VTK, phong ÷ phong", significant(median_ratio(named("VTK, phong"), named("phong"))));
      say("VTK, occlusion ÷ with occlusion",
          significant(named("VTK, occlusion").median_ms() / occluded));
      for (const auto& [what, cell] : of_vtk) say(what, cell);
    }
  }
  publish(std::move(document), std::move(grid), std::move(plot), std::move(panel), options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
