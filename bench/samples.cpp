// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench samples`: the cost of several samples a pixel over one, with and without triangles
// that are clipped. Each picture is compared with the serial reference's before the timing.
#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/fit.hpp>
#include <rastrum/render.hpp>

#include "measure.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "scenes.hpp"
#include "tables/document.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {
namespace {

constexpr std::array kSamples{1, 4, 8, 16};

struct SampledScene {
  std::string name;
  Mesh mesh;
  Camera camera;
};

Mesh two_triangles(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  Mesh mesh;
  mesh.positions = {a, b, c, d};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

std::vector<SampledScene> sampled_scenes(bool quick, const FrameOptions& frame) {
  const Camera above{.eye = {0, 1, 3}, .target = {0, 0.5, 0}};
  std::vector<SampledScene> all;
  all.push_back({"floor that reaches behind the eye",
                 two_triangles({-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50}), above});
  all.push_back({"wall of its size",
                 two_triangles({-2, -1.5, 0}, {2, -1.5, 0}, {2, 1, 0}, {-2, 1, 0}), above});
  if (quick) return all;
  for (const char* const scene : {"bunny", "brain", "sponza"}) {
    const SceneInfo& info = scene_by_name(scene);
    if (!available(info)) continue;
    SampledScene subject{scene, load(info), {}};
    const MeshView mesh = subject.mesh.view();
    const InstanceView instance{mesh};
    const SceneView view{{&instance, 1}};
    // A hall is seen from inside.
    subject.camera = info.name == "sponza" ? walk(view, 2).front()
                                           : fit_picture(view, {}, frame.width, frame.height);
    all.push_back(std::move(subject));
  }
  return all;
}

bool equals_reference(Renderer& renderer, const SampledScene& subject, const FrameOptions& frame) {
  const MeshView mesh = subject.mesh.view();
  const InstanceView instance{mesh};
  Image<Rgba8> ours(frame.width, frame.height), want(frame.width, frame.height);
  (void)renderer.render({{&instance, 1}}, subject.camera, frame, {.color8 = ours});
  (void)Renderer({.device = Device::serial})
      .render({{&instance, 1}}, subject.camera, frame, {.color8 = want});
  if (std::ranges::equal(ours.pixels(), want.pixels())) return true;
  std::fprintf(stderr, "%s, %d samples: the picture is not the serial reference's\n",
               subject.name.c_str(), frame.samples);
  return false;
}

}  // namespace

int run_samples(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("samples", "What several samples a pixel cost over one, at 640 × 480.");
  if (const auto status = options.read(parser, arguments)) return *status;
  FrameOptions frame = options.frame(640, 480);

  Document document = options.document("samples", "Samples a pixel");
  document.notes.push_back(options.here(frame) +
                           "; the pictures are the serial reference's. Ratios are paired medians.");
  Grid grid{"", {"scene", "shader", "ms", "4 ÷ 1", "8 ÷ 1", "16 ÷ 1"}, {}};
  Plot plot = options.plot(document, "scene", "four samples ÷ one");
  Panel panel{"frame", {{"flat", {}, 0}, {"phong", {}, 1}}};
  bool right = true;
  Renderer renderer({.threads = options.threads});
  for (const SampledScene& subject : sampled_scenes(options.quick, frame)) {
    progress(subject.name);
    const MeshView mesh = subject.mesh.view();
    const InstanceView instance{mesh};
    plot.places.push_back(subject.name);
    for (const Shader shader : {Shader::flat, Shader::phong}) {
      frame.shader = shader;
      Image<Rgba8> image(frame.width, frame.height);
      std::vector<Contender> contenders;
      for (const int samples : kSamples) {
        frame.samples = samples;
        right = equals_reference(renderer, subject, frame) && right;
        contenders.push_back(
            {std::to_string(samples), [&, frame] {
               (void)renderer.render({{&instance, 1}}, subject.camera, frame, {.color8 = image});
             }});
      }
      const std::vector<Timing> timings = measure_interleaved(contenders, options.plan());
      std::vector<std::string> row{subject.name, std::string(name(shader)),
                                   significant(timings[0].median_ms())};
      for (std::size_t k = 1; k < timings.size(); ++k)
        row.push_back(significant(median_ratio(timings[k], timings[0])));
      grid.rows.push_back(std::move(row));
      panel.series[shader == Shader::flat ? 0 : 1].values.push_back(
          median_ratio(timings[1], timings[0]));
      for (std::size_t k = 0; k < timings.size(); ++k)
        document.figures.push_back({{"scene", subject.name},
                                    {"shader", name(shader)},
                                    {"samples", kSamples[k]},
                                    {"ms", timings[k].median_ms()}});
    }
  }
  publish(std::move(document), std::move(grid), std::move(plot), std::move(panel), options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
