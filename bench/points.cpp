// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench points`: clouds of points of one pixel and of three, beside OpenGL's points (Mesa
// llvmpipe) of one pixel and VTK's. Before the timing, each picture's ids are compared with the
// serial reference's.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "cloud.hpp"
#include "machine.hpp"
#include "measure.hpp"
#include "peers/gl_peer.hpp"
#include "peers/started.hpp"
#include "peers/vtk_peer.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "tables/document.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {
namespace {

struct Cloud {
  std::vector<Vec3> positions;
  std::vector<Rgba8> colors;
  PointsView view;

  Cloud(std::size_t n, int width, int height) {
    Noise noise;
    positions.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
      positions.push_back(place(noise, double(width) / height));
      const auto channel = [&] { return static_cast<std::uint8_t>(256 * noise.next()); };
      colors.push_back({channel(), channel(), channel(), 255});
    }
    view.positions = positions;
  }
};

struct CloudWay {
  const char* name;
  float point_size;
  bool colored;
};
constexpr CloudWay kCloudWays[] = {
    {"1 px, id", 1, false}, {"1 px, colours", 1, true}, {"3 px, id", 3, false}};

/// The bytes that a frame must move over the bandwidths: positions read, 4 bytes a pixel written.
double floor_ms(std::size_t points, int width, int height, const MachineLimits& machine) {
  return (12.0 * static_cast<double>(points) / machine.read_gbs +
          4.0 * width * height / machine.stream_gbs) /
         1e6;
}

}  // namespace

int run_points(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("points", "Frames of clouds of points at 1920 × 1080.");
  if (const auto status = options.read(parser, arguments)) return *status;
  FrameOptions frame = options.frame(1920, 1080);
  frame.background = {0, 0, 0, 1};
  const MachineLimits machine = measure_machine(options.threads);
  Document document = options.document("points", "Clouds of points");
  document.notes.push_back(options.here(frame) +
                           "; the ids are the serial reference's. CPU ms are of all threads.");
  Started<GlPeer> gl_started(options.threads);
  Started<VtkPeer> vtk_started(options.threads);
  document.notes.push_back(gl_started.note + "; " + vtk_started.note +
                           " (its point gaussian mapper without splats).");
  std::optional<GlPeer>& gl = gl_started.peer;
  std::optional<VtkPeer>& vtk = vtk_started.peer;
  Grid grid{"",
            {"points", "drawn", "ms", "CPU ms", "set up ms", "draw ms", "fragments", "MB",
             "floor ms", "as theirs"},
            {}};
  Plot plot = options.plot(document, "points", "ms");
  Panel panel{"frame", {}};
  for (const CloudWay& way : kCloudWays)
    panel.series.push_back({way.name, {}, static_cast<int>(panel.series.size())});
  bool right = true;
  for (const std::size_t most : {std::size_t{1'000'000}, std::size_t{10'000'000}}) {
    const std::size_t n = options.triangles(most);
    Cloud cloud(n, frame.width, frame.height);
    const Camera camera = camera_at_origin();
    Renderer renderer({.threads = options.threads}), reference({.device = Device::serial});
    plot.places.push_back(std::to_string(n));
    if (gl) {
      gl->set_points(cloud.positions);
      gl->set_view(camera, frame.width, frame.height);
    }
    if (vtk) {
      vtk->set_points(cloud.positions);
      vtk->set_view(camera, frame.width, frame.height);
      vtk->draw(1);
    }
    std::vector<PointsView> views;
    std::vector<FrameStats> stats(std::size(kCloudWays));
    Image<Rgba8> image(frame.width, frame.height);
    std::vector<Contender> contenders;
    // How well the peers, which come last, agree: llvmpipe by its ids, VTK by its coverage.
    std::vector<std::optional<double>> share(std::size(kCloudWays));
    for (std::size_t w = 0; w < std::size(kCloudWays); ++w) {
      cloud.view.point_size = kCloudWays[w].point_size;
      cloud.view.colors = {};
      if (kCloudWays[w].colored)
        cloud.view.colors = ArrayView<Vec4>::rgb(&cloud.colors[0].r, n, sizeof(Rgba8));
      views.push_back(cloud.view);
    }
    for (std::size_t w = 0; w < std::size(kCloudWays); ++w) {
      const InstanceView instance{views[w]};
      const SceneView scene{{&instance, 1}, {}, {}};
      FrameOptions own = frame;
      own.shader = kCloudWays[w].colored ? Shader::flat : Shader::id;
      Image<std::int64_t> ids(frame.width, frame.height), expected(frame.width, frame.height);
      (void)renderer.render(scene, camera, own, {.ids = ids});
      (void)reference.render(scene, camera, own, {.ids = expected});
      right = right && std::ranges::equal(ids.pixels(), expected.pixels());
      if (gl && w == 0) {
        gl->draw_ids();
        share.push_back(equal_share(ids, gl->ids()));
      }
      if (vtk && w == 0) {
        own.background = {};
        (void)renderer.render(scene, camera, own, {.color8 = image});
        own.background = frame.background;
        share.push_back(common_coverage(image, vtk->picture()));
      }
      contenders.push_back({kCloudWays[w].name, [&, own, scene, w] {
                              stats[w] = renderer.render(scene, camera, own, {.color8 = image});
                            }});
    }
    if (gl) contenders.push_back({"llvmpipe, 1 px, id", [&] { gl->draw_ids(); }});
    if (vtk) contenders.push_back({"VTK, 1 px", [&] { vtk->draw(1); }});
    progress(std::to_string(n) + " points");
    const std::vector<Timing> timings = measure_interleaved(contenders, options.plan());
    for (std::size_t w = 0; w < timings.size(); ++w) {
      const Timing& timing = timings[w];
      const bool ours = w < std::size(kCloudWays);
      auto stages = stages_ms(ours ? stats[w] : FrameStats{});
      grid.rows.push_back({std::to_string(n), timing.name, significant(timing.median_ms()),
                           significant(median(timing.cpu_samples_ms)),
                           ours ? significant(stages["setup and bin"]) : "",
                           ours ? significant(stages["draw and shade"]) : "",
                           ours ? std::to_string(stats[w].fragments) : "",
                           ours ? megabytes(stats[w].peak_bytes) : "",
                           significant(floor_ms(n, frame.width, frame.height, machine)),
                           share[w] ? significant(*share[w], 5) : ""});
      if (ours) panel.series[w].values.push_back(timing.median_ms());
      document.figures.push_back({{"points", n},
                                  {"drawn", timing.name},
                                  {"ms", timing.median_ms()},
                                  {"cpu_ms", median(timing.cpu_samples_ms)}});
    }
  }
  publish(std::move(document), std::move(grid), std::move(plot), std::move(panel), options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
