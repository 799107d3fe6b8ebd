// `rastrum bench prepared`: frames of prepared meshes beside the same frames unprepared, and the
// trace of a tree that is there already (Embree). Every picture is compared first, bit by bit.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
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

/// What is drawn, twice, from one camera after the other.
struct Views {
  std::string name;
  std::vector<InstanceView> plain, prepared;
  std::vector<Camera> cameras;
  Cull cull = Cull::none;
  double prepare_ms = 0;
  std::uint64_t triangles = 0;
};

std::uint64_t counted(const FrameStats& stats, std::string_view name) {
  for (const auto& [counter, value] : stats.counters)
    if (counter == name) return value;
  return 0;
}

/// What was measured of a subject.
struct Outcome {
  double plain_ms = 0, prepared_ms = 0, ratio = 0, embree_ratio = 0;
  double outside = 0, away = 0, hidden = 0;  ///< shares of the triangles
};

class Turns {
 public:
  Turns(const TableOptions& options, Started<EmbreePeer>& embree)
      : options_(options), embree_(embree) {}

  /// `mesh`: for Embree; null: it is left out. Whether all pictures are equal goes to `right`.
  Outcome measure(const Views& s, const MeshView* mesh, int width, int height, bool& right) {
    Renderer plain({.threads = options_.threads}), prepared({.threads = options_.threads});
    FrameOptions frame;
    frame.width = width;
    frame.height = height;
    frame.shader = Shader::phong;
    frame.cull = s.cull;
    Image<Rgba8> a(width, height), b(width, height);
    Outcome out;
    for (const Camera& camera : s.cameras) {
      (void)plain.render({.instances = s.plain}, camera, frame, {.color8 = a});
      const FrameStats stats =
          prepared.render({.instances = s.prepared}, camera, frame, {.color8 = b});
      if (std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) != 0) {
        std::fprintf(stderr, "%s: the prepared picture is another\n", s.name.c_str());
        right = false;
      }
      const auto share = [&](std::string_view name) {
        return static_cast<double>(counted(stats, name)) / static_cast<double>(s.triangles) /
               static_cast<double>(s.cameras.size());
      };
      out.outside += share("triangles of clusters outside");
      out.away += share("triangles of clusters that face away");
      out.hidden += share("triangles of hidden clusters");
    }
    const auto all = [&](Renderer& renderer, const std::vector<InstanceView>& instances) {
      for (const Camera& camera : s.cameras)
        (void)renderer.render({.instances = instances}, camera, frame, {.color8 = a});
    };
    std::vector<Contender> contenders{{"plain", [&] { all(plain, s.plain); }},
                                      {"prepared", [&] { all(prepared, s.prepared); }}};
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
    return out;
  }

 private:
  const TableOptions& options_;
  Started<EmbreePeer>& embree_;
};

InstanceView instance_of(const MeshView& mesh) {
  InstanceView instance;
  instance.geometry = mesh;
  return instance;
}

/// Of the box of all that the camera of `--fit sphere` sees: from afar into the middle of it.
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

/// Through the long side of the box, at a third of its height, looking ahead and about.
std::vector<Camera> walk(const SceneView& scene, int steps) {
  const Bounds box = bounds(scene);
  const Vec3d low(box.min), size = Vec3d(box.max) - low;
  const bool along_x = size.x > size.z;
  std::vector<Camera> cameras;
  for (int i = 0; i < steps; ++i) {
    const double t = 0.1 + 0.8 * i / steps, turn = 1.2 * std::sin(9.0 * i / steps);
    Camera c;
    const double half = 0.5 + 0.02 * std::sin(5.0 * i / steps);
    c.eye = {low.x + size.x * (along_x ? t : half), low.y + size.y * 0.3,
             low.z + size.z * (along_x ? half : t)};
    const Vec3d ahead = along_x ? Vec3d{std::cos(turn), 0.1, std::sin(turn)}
                                : Vec3d{std::sin(turn), 0.1, std::cos(turn)};
    c.target = c.eye + ahead;
    c.near_plane = static_cast<float>(length(size) * 1e-4);
    cameras.push_back(c);
  }
  return cameras;
}

std::vector<Camera> around(const SceneView& scene, int count) {
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    // Points of a spiral on the sphere: each looks from elsewhere.
    const double z = 1 - (2.0 * i + 1) / count, angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    cameras.push_back(
        fit_camera(scene, 1.0472F, false, {-r * std::cos(angle), -z, -r * std::sin(angle)}));
  }
  return cameras;
}

/// Balls in a hall that the camera looks along: most are beside it, or behind others.
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

double ms_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

/// The least of three.
double prepare_ms(const MeshView& mesh, int threads) {
  double least = 0;
  for (int i = 0; i < 3; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const PreparedMesh prepared(mesh, threads);
    const double ms = ms_since(begin);
    least = i == 0 ? ms : std::min(least, ms);
  }
  return least;
}

}  // namespace

int run_prepared(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("prepared", "Frames of prepared meshes beside the same unprepared.");
  options.add_to(parser);
  if (const auto status = parser.parse(arguments)) return *status;
  options.resolve();
  Started<EmbreePeer> embree(options.threads);
  Turns contest(options, embree);
  Document document{"prepared", "Prepared meshes"};
  if (options.quick) document.notes.push_back(options.quick_note());
  document.notes.push_back(options.here() +
                           ", `phong`, one sample; all pictures were equal bits. Ratios are paired "
                           "medians; prepare: in frames unprepared. " +
                           embree.note);
  Grid grid{"",
            {"what", "size", "triangles", "ms", "prepared ms", "ms ÷ prepared", "outside, %",
             "away, %", "hidden, %", "prepare, frames", "Embree trace ÷ prepared"},
            {}};
  Plot plot;
  plot.title = document.title;
  plot.note = options.here();
  plot.y_title = "ms";
  Panel panel{"frame", {{"plain", {}, 0}, {"prepared", {}, 1}}};
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
    plot.places.push_back(s.name + " " + std::to_string(width));
    panel.series[0].values.push_back(m.plain_ms);
    panel.series[1].values.push_back(m.prepared_ms);
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
  constexpr int kLarge = 3;  // subdivided so often: only by name, and in full view
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
    s.plain = {instance_of(view)};
    s.prepared = {instance_of(prepared.view())};
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
    other.cameras = is_room ? walk(scene, cameras(24)) : flight(scene, cameras(24));
    add(other, nullptr, options.size(1024), options.size(1024));
    other.name = s.name + ", " + std::to_string(cameras(40)) + " cameras around";
    other.cameras = around(scene, cameras(40));
    add(other, nullptr, options.size(1024), options.size(1024));
  }
  if (options.mesh.empty() || options.mesh == "hall") {
    const Mesh ball = shapes::sphere(20, 20);
    const PreparedMesh prepared(ball.view(), 1);
    Views s;
    s.name = "a hall of balls";
    for (const Mat4d& place : hall(options.triangles(27'000))) {
      s.plain.push_back(instance_of(ball.view()));
      s.plain.back().object_to_world = place;
      s.prepared.push_back(instance_of(prepared.view()));
      s.prepared.back().object_to_world = place;
    }
    s.triangles = s.plain.size() * ball.triangle_count();
    Camera camera;
    camera.eye = {0.5, 0.5, 3.5};
    camera.target = {0.9, 0.6, -1};
    s.cameras = {camera};
    add(s, nullptr, options.size(1920), options.size(1080));
  }
  publish(std::move(document), std::move(grid), std::move(plot), std::move(panel), options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
