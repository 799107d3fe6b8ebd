// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench spheres` and `rastrum bench tubes`: many small exact surfaces. Before the timing,
// each picture's ids are compared with the serial reference's. Embree traces the same surfaces and
// VTK draws the spheres on llvmpipe, in turns with our frames; their pictures are compared with
// ours first.
#include <algorithm>
#include <cstdio>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "cloud.hpp"
#include "measure.hpp"
#include "peers/compare.hpp"
#include "peers/embree_peer.hpp"
#include "peers/started.hpp"
#include "peers/vtk_peer.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "tables/document.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {
namespace {

struct Made {
  std::vector<Vec3> positions;
  std::vector<float> radii;
  std::vector<std::uint32_t> offsets;
  GeometryView geometry;
};

/// Spheres about 10 px across.
void make_spheres(Made& made, std::size_t n, int width, int height) {
  Noise noise;
  SpheresView spheres;
  for (std::size_t i = 0; i < n; ++i) {
    made.positions.push_back(place(noise, double(width) / height));
    made.radii.push_back(noise.between(0.6, 1.4) * 5 * 2 / static_cast<float>(height) *
                         -made.positions.back().z);
  }
  spheres.centers = made.positions;
  spheres.radii = made.radii;
  made.geometry = spheres;
}

/// Polylines of 10 segments of about 20 px, 5 px thick.
void make_tubes(Made& made, std::size_t n, int width, int height) {
  Noise noise;
  TubesView tubes;
  for (std::size_t i = 0; i < n; i += 10) {
    made.offsets.push_back(static_cast<std::uint32_t>(made.positions.size()));
    Vec3 p = place(noise, double(width) / height);
    const float step = 20 * 2 / static_cast<float>(height) * -p.z;
    for (int k = 0; k <= 10; ++k) {
      made.positions.push_back(p);
      made.radii.push_back(step / 8);
      p = p +
          Vec3{noise.between(-step, step), noise.between(-step, step), noise.between(-step, step)};
    }
  }
  made.offsets.push_back(static_cast<std::uint32_t>(made.positions.size()));
  tubes.positions = made.positions;
  tubes.offsets = made.offsets;
  tubes.radii = made.radii;
  made.geometry = tubes;
}

using Make = void (*)(Made&, std::size_t, int, int);

/// The least share of pixels whose colours are within 4/255 of the peer's, or that both cover. The
/// others lie on silhouettes, where the peers' float32 shows another sphere.
constexpr double kAgreement = 0.99;

class SurfacePeers {
 public:
  explicit SurfacePeers(int threads) : embree_(threads), vtk_(threads) {}
  [[nodiscard]] std::string note() const {
    return embree_.note + ", built and traced apart; " + vtk_.note +
           " (its sphere mapper; it has none for tubes). Ratios are paired medians.";
  }

  /// Times `ours` and the available peers in turns, "build", "trace" and "vtk", after comparing
  /// their pictures with `picture`. Clears `right` if they do not agree.
  std::vector<Timing> measure(const Made& made, const Camera& camera, const Contender& ours,
                              const Image<Rgba8>& picture, const Plan& plan, bool& right) {
    std::vector<Contender> all{ours};
    Image<Rgba8> traced(picture.width(), picture.height());
    ours.frame();
    if (embree_.peer) {
      EmbreePeer& embree = *embree_.peer;
      if (made.offsets.empty())
        embree.set_spheres(made.positions, made.radii);
      else
        embree.set_tubes(made.positions, made.radii, made.offsets);
      embree.build();
      embree.trace(camera, traced);
      expect("Embree", compare_colors(picture, traced, 4).share(), right);
      all.push_back({"build", [&embree] { embree.build(); }});
      all.push_back({"trace", [&] { embree.trace(camera, traced); }});
    }
    if (vtk_.peer && made.offsets.empty()) {
      VtkPeer& vtk = *vtk_.peer;
      vtk.set_spheres(made.positions, made.radii);
      vtk.set_view(camera, picture.width(), picture.height());
      vtk.draw(1);
      expect("VTK", common_coverage(picture, vtk.picture()), right);
      all.push_back({"vtk", [&vtk] { vtk.draw(1); }});
    }
    return measure_interleaved(all, plan);
  }

 private:
  static void expect(const char* who, double agreement, bool& right) {
    if (agreement >= kAgreement) return;
    std::fprintf(stderr, "%s has the same at %.4f of the pixels only\n", who, agreement);
    right = false;
  }

  Started<EmbreePeer> embree_;
  Started<VtkPeer> vtk_;
};

int run_surfaces(std::span<const std::string_view> arguments, const char* name, const char* what,
                 std::size_t most, Make make) {
  TableOptions options;
  OptionParser parser(name, std::string("Frames of many ") + what + " at 1920 × 1080.");
  if (const auto status = options.read(parser, arguments)) return *status;
  FrameOptions frame = options.frame(1920, 1080);
  frame.background = {0, 0, 0, 0};  // as the peer's
  Document document = options.document(name, std::string("Many ") + what);
  document.notes.push_back(options.here(frame) + "; the ids are the serial reference's.");
  SurfacePeers peers(options.threads);
  document.notes.push_back(peers.note());
  Grid grid{"",
            {what, "shader", "ms", "set up ms", "draw ms", "fragments", "MB", "Embree build ÷ ours",
             "trace ÷ ours", "VTK ÷ ours"},
            {}};
  Plot plot = options.plot(document, what, "ms");
  Panel panel{"frame", {{"id", {}, 0}, {"phong", {}, 1}}};
  bool right = true;
  for (const std::size_t n : {most / 10, most}) {
    Made made;
    make(made, options.triangles(n), frame.width, frame.height);
    const InstanceView instance{made.geometry};
    const SceneView scene{{&instance, 1}, {}, {}};
    const Camera camera = camera_at_origin();
    Renderer renderer({.threads = options.threads});
    Image<std::int64_t> ids(frame.width, frame.height), expected(frame.width, frame.height);
    frame.shader = Shader::id;
    (void)renderer.render(scene, camera, frame, {.ids = ids});
    Renderer reference({.device = Device::serial});
    (void)reference.render(scene, camera, frame, {.ids = expected});
    right = right && equal_share(ids, expected) == 1;
    plot.places.push_back(std::to_string(options.triangles(n)));
    for (const Shader shader : {Shader::id, Shader::phong}) {
      frame.shader = shader;
      Image<Rgba8> image(frame.width, frame.height);
      FrameStats stats;
      const Contender contender{std::string(rastrum::name(shader)), [&] {
                                  stats = renderer.render(scene, camera, frame, {.color8 = image});
                                }};
      // The peer shades as `phong` does.
      const std::vector<Timing> timings =
          shader == Shader::phong
              ? peers.measure(made, camera, contender, image, options.plan(), right)
              : measure_interleaved({&contender, 1}, options.plan());
      const Timing& timing = timings.front();
      const auto ratio = [&](std::string_view of) {
        const auto found = std::ranges::find(timings, of, &Timing::name);
        return found == timings.end() ? std::string() : significant(median_ratio(*found, timing));
      };
      auto stages = stages_ms(stats);
      grid.rows.push_back({std::to_string(options.triangles(n)), contender.name,
                           significant(timing.median_ms()), significant(stages["setup and bin"]),
                           significant(stages["draw and shade"]), std::to_string(stats.fragments),
                           megabytes(stats.peak_bytes), ratio("build"), ratio("trace"),
                           ratio("vtk")});
      panel.series[shader == Shader::id ? 0 : 1].values.push_back(timing.median_ms());
      document.figures.push_back({{"primitives", options.triangles(n)},
                                  {"shader", contender.name},
                                  {"ms", timing.median_ms()},
                                  {"fragments", stats.fragments},
                                  {"bytes", stats.peak_bytes}});
      for (std::size_t k = 1; k < timings.size(); ++k)
        document.figures.back()[timings[k].name + "_ms"] = timings[k].median_ms();
    }
  }
  publish(std::move(document), std::move(grid), std::move(plot), std::move(panel), options.out);
  return right ? 0 : 1;
}

}  // namespace

int run_spheres(std::span<const std::string_view> options) {
  return run_surfaces(options, "spheres", "spheres of about 10 px", 1000000, make_spheres);
}

int run_tubes(std::span<const std::string_view> options) {
  return run_surfaces(options, "tubes", "tubes' segments", 100000, make_tubes);
}

}  // namespace rastrum::bench
