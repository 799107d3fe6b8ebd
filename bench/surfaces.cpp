// `rastrum bench spheres` and `rastrum bench tubes`: many small exact surfaces. The ids of each
// picture are compared with the serial reference's before anything is timed. Embree traces the same
// with rays, in turns with our frames; its picture is compared with ours first.
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "cloud.hpp"
#include "measure.hpp"
#include "peers/compare.hpp"
#include "peers/embree_peer.hpp"
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
  InstanceView instance;
};

/// About 10 px across.
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
  made.instance.geometry = spheres;
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
  made.instance.geometry = tubes;
}

using Make = void (*)(Made&, std::size_t, int, int);

/// Embree's times beside ours, of one scene.
class Peer {
 public:
  explicit Peer(int threads) {
    try {
      embree_.emplace(threads);
      note_ = embree_->description() + ", built and traced apart; ratios are paired medians.";
    } catch (const Error& e) {
      if (e.code() != Errc::no_device) throw;
      note_ = e.what();
    }
  }
  [[nodiscard]] const std::string& note() const { return note_; }

  /// The times of `ours` and, where there is a peer, of building and of tracing. The share of
  /// pixels whose colours agree within 4/255 goes to `agreement`.
  std::vector<Timing> measure(const Made& made, const Camera& camera, const Contender& ours,
                              const Image<Rgba8>& picture, const Plan& plan, double& agreement) {
    std::vector<Contender> all{ours};
    Image<Rgba8> traced(picture.width(), picture.height());
    if (embree_) {
      if (made.offsets.empty())
        embree_->set_spheres(made.positions, made.radii);
      else
        embree_->set_tubes(made.positions, made.radii, made.offsets);
      embree_->build();
      embree_->trace(camera, traced);
      ours.frame();
      agreement = compare_colors(picture, traced, 4).share();
      all.push_back({"build", [&] { embree_->build(); }});
      all.push_back({"trace", [&] { embree_->trace(camera, traced); }});
    }
    return measure_interleaved(all, plan);
  }

 private:
  std::optional<EmbreePeer> embree_;
  std::string note_;
};

/// The least share of pixels whose colours must agree with the peer's. What differs are pixels on a
/// silhouette, whose colour is another sphere's: Embree's rays are in float32.
constexpr double kAgreement = 0.97;

int run_surfaces(std::span<const std::string_view> arguments, const char* name, const char* what,
                 std::size_t most, Make make) {
  TableOptions options;
  OptionParser parser(name, std::string("Frames of many ") + what + " at 1920 × 1080.");
  options.add_to(parser, false);
  if (const auto status = parser.parse(arguments)) return *status;
  options.resolve();
  FrameOptions frame;
  frame.width = options.size(1920);
  frame.height = options.size(1080);
  frame.background = {0, 0, 0, 0};  // as the peer's
  Document document{name, std::string("Many ") + what};
  if (options.quick) document.notes.push_back(options.quick_note());
  document.notes.push_back(std::to_string(frame.width) + " × " + std::to_string(frame.height) +
                           ", " + options.here() + "; the ids are the serial reference's.");
  Peer peer(options.threads);
  document.notes.push_back(peer.note());
  Grid grid{"",
            {what, "shader", "ms", "set up ms", "draw ms", "fragments", "MB", "Embree build ÷ ours",
             "trace ÷ ours", "same pixels"},
            {}};
  Plot plot;
  plot.title = document.title;
  plot.note = options.here();
  plot.x_title = what;
  plot.y_title = "ms";
  Panel panel{"frame", {{"id", {}, 0}, {"phong", {}, 1}}};
  bool right = true;
  for (const std::size_t n : {most / 10, most}) {
    Made made;
    make(made, options.triangles(n), frame.width, frame.height);
    const SceneView scene{{&made.instance, 1}, {}, {}};
    const Camera camera = camera_at_origin();
    Renderer renderer({.threads = options.threads});
    Image<std::int64_t> ids(frame.width, frame.height), expected(frame.width, frame.height);
    frame.shader = Shader::id;
    (void)renderer.render(scene, camera, frame, {.ids = ids});
    Renderer reference({.device = Device::serial});
    (void)reference.render(scene, camera, frame, {.ids = expected});
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x) right = right && ids(x, y) == expected(x, y);
    plot.places.push_back(std::to_string(options.triangles(n)));
    for (const Shader shader : {Shader::id, Shader::phong}) {
      frame.shader = shader;
      Image<Rgba8> image(frame.width, frame.height);
      FrameStats stats;
      const Contender contender{std::string(rastrum::name(shader)), [&] {
                                  stats = renderer.render(scene, camera, frame, {.color8 = image});
                                }};
      // The peer shades as `phong` does.
      const bool has_peer = shader == Shader::phong;
      double agreement = 1;
      const std::vector<Timing> timings =
          has_peer ? peer.measure(made, camera, contender, image, options.plan(), agreement)
                   : measure_interleaved({&contender, 1}, options.plan());
      right = right && agreement >= kAgreement;
      const Timing& timing = timings.front();
      const auto ratio = [&](std::size_t of) {
        return timings.size() <= of ? std::string()
                                    : significant(median_ratio(timings[of], timing));
      };
      const auto stage = [&](std::string_view of) {
        double ms = 0;
        for (const auto& s : stats.stages)
          if (s.name == of) ms += s.end_ms - s.begin_ms;
        return significant(ms);
      };
      grid.rows.push_back({std::to_string(options.triangles(n)), contender.name,
                           significant(timing.median_ms()), stage("setup and bin"),
                           stage("draw and shade"), std::to_string(stats.fragments),
                           significant(static_cast<double>(stats.peak_bytes) / 1e6), ratio(1),
                           ratio(2), timings.size() > 1 ? significant(agreement) : ""});
      panel.series[shader == Shader::id ? 0 : 1].values.push_back(timing.median_ms());
      document.figures.push_back({{"primitives", options.triangles(n)},
                                  {"shader", contender.name},
                                  {"ms", timing.median_ms()},
                                  {"fragments", stats.fragments},
                                  {"bytes", stats.peak_bytes}});
      if (timings.size() > 1) {
        document.figures.back()["embree_build_ms"] = timings[1].median_ms();
        document.figures.back()["embree_trace_ms"] = timings[2].median_ms();
        document.figures.back()["agreement"] = agreement;
      }
    }
  }
  plot.panels = {std::move(panel)};
  document.grids.push_back(std::move(grid));
  document.plot = std::move(plot);
  publish(document, options.out);
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
