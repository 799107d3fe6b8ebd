// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench prepared`: frames of prepared meshes beside the same frames unprepared, and
// Embree's trace of a finished tree. Every picture is compared first, bit by bit.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/prepared_mesh.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "measure.hpp"
#include "peers/embree_peer.hpp"
#include "peers/started.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "scenes.hpp"
#include "tables/document.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {
namespace {

/// A scene drawn plain and prepared, from one camera after the other.
struct Views {
  std::string name;
  std::vector<InstanceView> plain, prepared;
  std::vector<Camera> cameras;
  bool is_flight = false;  ///< whether its frames are listed one by one
  Cull cull = Cull::none;
  double prepare_ms = 0;
  std::uint64_t triangles = 0;
};

/// One frame of a subject, and the share of the triangles that was set up.
struct OfCamera {
  double share = 1, plain_ms = 0, prepared_ms = 0;
};

struct Outcome {
  double plain_ms = 0, prepared_ms = 0, ratio = 0, embree_ratio = 0;
  double outside = 0, away = 0, hidden = 0;  ///< shares of the triangles
  std::vector<OfCamera> cameras;
};

class Turns {
 public:
  Turns(const TableOptions& options, int samples, Started<EmbreePeer>& embree)
      : options_(options), samples_(samples), embree_(embree) {}

  /// `mesh` is for Embree; null leaves it out. Clears `right` if a picture differs.
  Outcome measure(const Views& s, const MeshView* mesh, int width, int height, bool& right) {
    Renderer plain({.threads = options_.threads}), prepared({.threads = options_.threads});
    FrameOptions frame;
    frame.width = width;
    frame.height = height;
    frame.shader = Shader::phong;
    frame.samples = samples_;
    frame.cull = s.cull;
    Image<Rgba8> a(width, height), b(width, height);
    Outcome out;
    for (const Camera& camera : s.cameras) {
      (void)plain.render({.instances = s.plain}, camera, frame, {.color8 = a});
      const FrameStats stats =
          prepared.render({.instances = s.prepared}, camera, frame, {.color8 = b});
      if (!same_bits(a, b)) {
        std::fprintf(stderr, "%s: the prepared picture is another\n", s.name.c_str());
        right = false;
      }
      const auto share = [&](std::string_view name) {
        return static_cast<double>(counter(stats, name)) / static_cast<double>(s.triangles);
      };
      const double outside = share("triangles of clusters outside");
      const double away = share("triangles of clusters that face away");
      const double hidden = share("triangles of hidden clusters");
      const auto n = static_cast<double>(s.cameras.size());
      out.outside += outside / n;
      out.away += away / n;
      out.hidden += hidden / n;
      out.cameras.push_back({1 - outside - away - hidden});
    }
    // Times all cameras in turn, because a frame begins with what the last one saw.
    std::vector<std::vector<double>> plain_ms(s.cameras.size()), prepared_ms(s.cameras.size());
    const auto all = [&](Renderer& renderer, const std::vector<InstanceView>& instances,
                         std::vector<std::vector<double>>& times) {
      for (std::size_t i = 0; i < s.cameras.size(); ++i)
        times[i].push_back(timed_ms([&] {
          (void)renderer.render({.instances = instances}, s.cameras[i], frame, {.color8 = a});
        }));
    };
    std::vector<Contender> contenders{
        {"plain", [&] { all(plain, s.plain, plain_ms); }},
        {"prepared", [&] { all(prepared, s.prepared, prepared_ms); }}};
    if (mesh != nullptr && embree_.peer) {
      embree_.peer->set_mesh(*mesh);
      embree_.peer->build();
      contenders.push_back({"trace", [&] {
                              for (const Camera& camera : s.cameras) embree_.peer->trace(camera, b);
                            }});
    }
    const std::vector<Timing> timings = measure_interleaved(contenders, options_.plan());
    const double frames = static_cast<double>(s.cameras.size());
    out.plain_ms = timings[0].median_ms() / frames;
    out.prepared_ms = timings[1].median_ms() / frames;
    out.ratio = median_ratio(timings[0], timings[1]);
    if (timings.size() > 2) out.embree_ratio = median_ratio(timings[2], timings[1]);
    for (std::size_t i = 0; i < out.cameras.size(); ++i) {
      out.cameras[i].plain_ms = median(std::move(plain_ms[i]));
      out.cameras[i].prepared_ms = median(std::move(prepared_ms[i]));
    }
    return out;
  }

 private:
  const TableOptions& options_;
  int samples_;
  Started<EmbreePeer>& embree_;
};

/// The frames of flights by the share of the triangles that was set up: a table, and a panel for
/// each flight.
class ByShare {
 public:
  ByShare() {
    plot_.title = "Frames by the share of the triangles that is set up";
    plot_.x_title = "share, %";
    plot_.y_title = "ms";
    for (std::size_t i = 0; i < kSteps; ++i) plot_.places.push_back(name(i));
  }
  void add(const std::string& what, const std::vector<OfCamera>& cameras) {
    Panel panel{what, {{"plain", {}, 0}, {"prepared", {}, 1}}};
    for (std::size_t step = 0; step < kSteps; ++step) {
      OfCamera sum{0};
      double n = 0;
      for (const OfCamera& c : cameras) {
        if (std::min(static_cast<std::size_t>(c.share * kSteps), kSteps - 1) != step) continue;
        sum = {sum.share + c.share, sum.plain_ms + c.plain_ms, sum.prepared_ms + c.prepared_ms};
        ++n;
      }
      panel.series[0].values.push_back(n == 0 ? kGap : sum.plain_ms / n);
      panel.series[1].values.push_back(n == 0 ? kGap : sum.prepared_ms / n);
      if (n == 0) continue;
      grid_.rows.push_back({what, name(step), significant(n), significant(100 * sum.share / n),
                            significant(sum.plain_ms / n), significant(sum.prepared_ms / n),
                            significant(sum.plain_ms / sum.prepared_ms)});
    }
    plot_.panels.push_back(std::move(panel));
  }
  void finish(Document& document, const TableOptions& options) {
    plot_.note = options.here();
    document.grids.push_back(std::move(grid_));
    document.plot = std::move(plot_);
  }

 private:
  static constexpr std::size_t kSteps = 10;
  static std::string name(std::size_t step) {
    return std::to_string(step * 100 / kSteps) + "–" + std::to_string((step + 1) * 100 / kSteps);
  }
  Grid grid_{
      "Frames of flights by the share of the triangles that is set up",
      {"flight", "share, %", "frames", "mean share, %", "ms", "prepared ms", "ms ÷ prepared"},
      {}};
  Plot plot_;
};

/// A flight from the camera of `--fit sphere`, which sees the whole scene, towards the centre of
/// the scene's box.
std::vector<Camera> flight(const SceneView& scene, int steps) {
  const Camera from = fit_camera(scene, 1.0472F, false);
  std::vector<Camera> cameras;
  for (int i = 0; i < steps; ++i) {
    Camera c = from;
    const double t = 0.9 * (i + 0.5) / steps;
    c.eye = from.eye + (from.target - from.eye) * t;
    c.near_plane = static_cast<float>(length(from.target - from.eye) * 1e-3);
    cameras.push_back(c);
  }
  return cameras;
}

std::vector<Camera> around(const SceneView& scene, int count) {
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    // Points of a spiral on the sphere, for views from all sides.
    const double z = 1 - (2.0 * i + 1) / count, angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    cameras.push_back(
        fit_camera(scene, 1.0472F, false, {-r * std::cos(angle), -z, -r * std::sin(angle)}));
  }
  return cameras;
}

/// Balls in a hall that the camera looks along. Most are outside the view or hidden.
std::vector<Mat4d> hall(std::size_t count) {
  std::vector<Mat4d> places;
  const auto across = static_cast<std::size_t>(std::cbrt(static_cast<double>(count)));
  for (std::size_t i = 0; i < count; ++i) {
    Mat4d m = Mat4d::identity();
    for (int k = 0; k < 3; ++k) m.m[k][k] = 0.4;
    m.m[0][3] = static_cast<double>(i % across) - static_cast<double>(across) / 2;
    m.m[1][3] = static_cast<double>(i / across % across) - static_cast<double>(across) / 2;
    m.m[2][3] = static_cast<double>(i / across / across) - static_cast<double>(across) / 2;
    places.push_back(m);
  }
  return places;
}

Views hall_of(const std::string& name, const MeshView& ball, const PreparedMesh& prepared,
              std::size_t count) {
  Views s;
  s.name = name;
  s.triangles = count * ball.triangle_count();
  for (const Mat4d& place : hall(count)) {
    s.plain.push_back({ball, place});
    s.prepared.push_back({prepared.view(), place});
  }
  return s;
}

/// The least of three times.
double prepare_ms(const MeshView& mesh, int threads) {
  const auto once = [&] { return timed_ms([&] { (void)PreparedMesh(mesh, threads); }); };
  return std::min({once(), once(), once()});
}

}  // namespace

int run_prepared(std::span<const std::string_view> arguments) {
  TableOptions options;
  options.rounds = 3;
  int samples = 1;
  OptionParser parser("prepared",
                      "Frames of prepared meshes beside the same unprepared. --mesh NAME: sponza, "
                      "brain and its kin, or hall, of 27,000 and of a million balls. All of it "
                      "takes some minutes and 6 GB.");
  parser.add_option("--samples", samples, "samples a pixel: 1, 4, 8, 16 (default: 1)")
      ->range(1, 16);
  if (const auto status = options.read(parser, arguments, true)) return *status;
  Started<EmbreePeer> embree(options.threads);
  Turns contest(options, samples, embree);
  Document document = options.document("prepared", "Prepared meshes");
  document.notes.push_back(options.here() + ", `phong`, " + std::to_string(samples) +
                           " samples a pixel; all pictures were equal bits. Ratios are paired "
                           "medians; prepare: in frames unprepared. " +
                           embree.note);
  Grid grid{"",
            {"what", "size", "triangles", "ms", "prepared ms", "ms ÷ prepared", "outside, %",
             "away, %", "hidden, %", "prepare, frames", "Embree trace ÷ prepared"},
            {}};
  ByShare by_share;
  bool right = true;
  const auto add = [&](const Views& s, const MeshView* mesh, int width, int height) {
    progress(s.name + " " + std::to_string(width) + "x" + std::to_string(height));
    const Outcome m = contest.measure(s, mesh, width, height, right);
    const auto percent = [](double share) { return significant(100 * share); };
    grid.rows.push_back({s.name, std::to_string(width) + "×" + std::to_string(height),
                         std::to_string(s.triangles), significant(m.plain_ms),
                         significant(m.prepared_ms), significant(m.ratio), percent(m.outside),
                         percent(m.away), percent(m.hidden),
                         s.prepare_ms > 0 ? significant(s.prepare_ms / m.plain_ms) : "",
                         m.embree_ratio > 0 ? significant(m.embree_ratio) : ""});
    if (s.is_flight) by_share.add(s.name, m.cameras);
    for (std::size_t i = 0; s.is_flight && i < m.cameras.size(); ++i)
      document.figures.push_back({{"what", s.name},
                                  {"frame", i},
                                  {"share", m.cameras[i].share},
                                  {"ms", m.cameras[i].plain_ms},
                                  {"prepared_ms", m.cameras[i].prepared_ms}});
    document.figures.push_back({{"what", s.name},
                                {"width", width},
                                {"height", height},
                                {"triangles", s.triangles},
                                {"ms", m.plain_ms},
                                {"prepared_ms", m.prepared_ms},
                                {"ratio", m.ratio},
                                {"outside", m.outside},
                                {"away", m.away},
                                {"hidden", m.hidden},
                                {"prepare_ms", s.prepare_ms},
                                {"embree_ratio", m.embree_ratio}});
  };
  const auto cameras = [&](int n) { return options.quick ? 3 : n; };
  std::vector<const SceneInfo*> infos;
  constexpr int kLarge = 3;  // scenes subdivided this often run only by name, in full view
  if (options.mesh.empty()) {
    for (const SceneInfo& info : peer_scenes())
      if (info.subdivide < kLarge && available(info) &&
          (!options.quick || info.name == "scattered"))
        infos.push_back(&info);
  } else if (options.mesh != "hall") {
    infos.push_back(&scene_by_name(options.mesh));
  }
  for (const SceneInfo* const info : infos) {
    Mesh mesh = load(*info);
    if (mesh.triangle_count() < 20'000) continue;
    const MeshView view = mesh.view();
    Views s;
    s.name = info->name;
    s.triangles = view.triangle_count();
    s.prepare_ms = prepare_ms(view, options.threads);
    const PreparedMesh prepared(view, options.threads);
    s.plain = {InstanceView{view}};
    s.prepared = {InstanceView{prepared.view()}};
    const SceneView scene{.instances = s.plain};
    s.cameras = {fit_camera(scene, 1.0472F, false)};
    add(s, &view, options.size(1024), options.size(1024));
    add(s, &view, options.size(1920), options.size(1080));
    if (info->subdivide >= kLarge) continue;
    Views other = s;
    other.prepare_ms = 0;
    other.name = s.name + ", culled";
    other.cull = Cull::back;
    add(other, nullptr, options.size(1024), options.size(1024));
    other.cull = Cull::none;
    const bool is_room = info->name == "sponza";
    other.name = s.name + (is_room ? ", walked through" : ", flown into");
    other.is_flight = true;
    other.cameras = is_room ? walk(scene, cameras(24)) : flight(scene, cameras(24));
    add(other, nullptr, options.size(1024), options.size(1024));
    other.is_flight = false;
    other.name = s.name + ", " + std::to_string(cameras(40)) + " cameras around";
    other.cameras = around(scene, cameras(40));
    add(other, nullptr, options.size(1024), options.size(1024));
  }
  if (options.mesh.empty() || options.mesh == "hall") {
    const Mesh ball = shapes::sphere(20, 20), small = shapes::sphere(4, 6);
    const MeshView ball_view = ball.view(), small_view = small.view();
    const PreparedMesh prepared(ball_view, 1), prepared_small(small_view, 1);
    Views s = hall_of("a hall of balls", ball_view, prepared, options.triangles(27'000));
    Camera camera;
    camera.eye = {0.5, 0.5, 3.5};
    camera.target = {0.9, 0.6, -1};
    s.cameras = {camera};
    add(s, nullptr, options.size(1920), options.size(1080));
    // These frames take seconds, so there are few of them.
    s = hall_of("a million balls, flown into", small_view, prepared_small,
                options.triangles(1'000'000));
    s.cameras = flight({.instances = s.plain}, cameras(8));
    s.is_flight = true;
    add(s, nullptr, options.size(1920), options.size(1080));
  }
  document.grids.insert(document.grids.begin(), std::move(grid));
  by_share.finish(document, options);
  publish(document, options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
