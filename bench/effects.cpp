// `rastrum bench effects`: what ambient occlusion, eye-dome lighting, silhouettes, edges, lights
// and shadows add to a frame at 1920 × 1080, and the whole of --studio. Each factor and lit picture
// is compared with the plain code's before anything is timed.
#include <algorithm>
#include <string>
#include <vector>

#include <rastrum/digest.hpp>
#include <rastrum/effects.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "measure.hpp"
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
constexpr const char* kNames[kEffects] = {"occlusion", "eye dome", "silhouettes", "edges"};

void apply(Effects& effects, int which, Pictures& p, const Camera& camera, double radius,
           const SceneEdges& edges) {
  if (which == 0)
    effects.ambient_occlusion({.view_depth = p.depth.view()}, camera, {.radius = radius}, p.factor);
  if (which == 1) effects.eye_dome(p.surface(), camera, {}, p.factor);
  if (which == 2) effects.silhouettes(p.surface(), camera, {}, p.factor);
  if (which == 3) effects.edges(p.primitives.view(), edges, camera, 1, p.factor);
}

/// Frames of other lights than the fixed one, and what --studio draws.
struct LitFrame {
  const char* name;
  FrameOptions options;
  bool occlusion = false;
};

std::vector<LitFrame> lit_frames(const FrameOptions& plain) {
  FrameOptions kit = plain, shadows = plain, studio = plain;
  kit.lights = studio.lights = light_kit();
  shadows.lights = {Light{.kind = DirectionalLight{{-0.4F, -0.6F, -1}}, .of_camera = true}};
  shadows.shadows = true;
  studio.samples = 4;
  return {{"studio's lights", kit}, {"one light, shadows", shadows}, {"studio", studio, true}};
}

void draw(Renderer& renderer, Effects& effects, const LitFrame& frame, const SceneView& scene,
          const Camera& camera, double radius, Pictures& p) {
  Targets targets{.color8 = p.color};
  if (frame.occlusion) targets.view_depth = p.depth;
  (void)renderer.render(scene, camera, frame.options, targets);
  if (!frame.occlusion) return;
  effects.ambient_occlusion({.view_depth = p.depth.view()}, camera, {.radius = radius}, p.factor);
  effects.darken(p.color, {}, p.factor.view());
}

}  // namespace

int run_effects(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("effects",
                      "Occlusion, eye-dome lighting, silhouettes, edges, lights, shadows and "
                      "--studio at 1920 × 1080.");
  options.add_to(parser, false);
  if (const auto status = parser.parse(arguments)) return *status;
  options.resolve();
  FrameOptions frame;
  frame.width = options.size(1920);
  frame.height = options.size(1080);
  frame.shader = Shader::phong;
  Document document{"effects", "Effects over finished pictures"};
  if (options.quick) document.notes.push_back(options.quick_note());
  document.notes.push_back(
      std::to_string(frame.width) + " × " + std::to_string(frame.height) + ", " + options.here() +
      ", ms; an effect with its way into the colours; the factors are the plain "
      "code's, bit by bit.");
  Grid grid{"",
            {"scene", "phong", "with view depth", "and ids, normals, instances", "occlusion",
             "eye dome", "silhouettes", "edges", "studio's lights", "one light, shadows", "studio",
             "with occlusion ÷ phong", "studio ÷ phong"},
            {}};
  Plot plot;
  plot.title = document.title;
  plot.note = options.here();
  plot.x_title = "scene";
  plot.y_title = "ms";
  plot.kind = Plot::Kind::bars;
  Panel panel{"frame and effects", {}};
  bool right = true;
  // A surface that takes light from itself nearly everywhere, whatever data is there.
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
    const double radius = 0.075 * static_cast<double>(length(box.max - box.min));
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
    for (const LitFrame& l : lit) {
      draw(renderer, effects, l, binding.view(), camera, radius, p);
      draw(scalar, reference, l, binding.view(), camera, radius, plain);
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
          {l.name, [&] { draw(renderer, effects, l, binding.view(), camera, radius, p); }});
    const std::vector<Timing> timings = measure_interleaved(contenders, options.plan());
    std::vector<std::string> row{std::string(info.name)};
    for (std::size_t i = 0; i < timings.size(); ++i) {
      row.push_back(significant(timings[i].median_ms()));
      document.figures.push_back(
          {{"scene", info.name}, {"what", timings[i].name}, {"ms", timings[i].median_ms()}});
    }
    plot.places.emplace_back(info.name);
    panel.series.resize(timings.size());
    for (std::size_t i = 0; i < timings.size(); ++i) {
      panel.series[i].name = timings[i].name;
      panel.series[i].color = static_cast<int>(i);
      panel.series[i].values.push_back(timings[i].median_ms());
    }
    row.push_back(
        significant((timings[1].median_ms() + timings[3].median_ms()) / timings[0].median_ms()));
    row.push_back(significant(median_ratio(timings.back(), timings[0])));
    grid.rows.push_back(std::move(row));
  }
  document.grids.push_back(std::move(grid));
  plot.panels = {std::move(panel)};
  document.plot = std::move(plot);
  publish(document, options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
