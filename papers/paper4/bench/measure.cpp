// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper4/bench/measure.hpp>

#include <algorithm>
#include <functional>

#include <bench/report.hpp>
#include <bench/stand_ins.hpp>
#include <papers/paper4/published.hpp>
#include <rastrum/error.hpp>
#include <rastrum/family.hpp>

namespace rastrum::bench {
namespace {

/// For pictures in float32, and for VTK's of 8 bits, which are blended layer by layer.
constexpr double kTolerance = 1.0 / 255, kTolerance8 = 4.0 / 255;
/// The least share of covered pixels within the tolerance. Others differ: normals turn over at
/// silhouettes, vertices round differently, and near ties in depth change the order.
constexpr double kLeastShare = 0.99;
/// A frame that takes longer is timed once only.
constexpr double kLong_ms = 5000;

/// Runs f. An error's text becomes the lap's `not_run`.
template <class F>
void try_lap(Lap& lap, F&& f) {
  try {
    f();
  } catch (const Error& e) {
    lap.not_run = e.what();
  } catch (const std::bad_alloc&) {
    lap.not_run = "out of memory";
  }
}

/// Laps that take turns.
class Race {
 public:
  /// Runs `frame` once now. The lap must outlive `run`.
  void enter(Lap& lap, std::function<void()> frame) {
    try_lap(lap, [&] {
      const double ms = timed_ms(frame);
      lap.timing = {lap.name, {ms}};
      if (ms > kLong_ms) return;
      contenders_.push_back({lap.name, std::move(frame)});
      laps_.push_back(&lap);
    });
  }
  void run(const Plan& plan) {
    std::vector<Timing> timings = measure_interleaved(contenders_, plan);
    for (std::size_t i = 0; i < laps_.size(); ++i) laps_[i]->timing = std::move(timings[i]);
  }

 private:
  std::vector<Contender> contenders_;
  std::vector<Lap*> laps_;
};

/// The renderer and the options of a lap of ours.
struct Ours {
  Renderer renderer;
  FrameOptions frame;
};

/// One view of one mesh, and what all its frames share.
class View {
 public:
  View(const Mesh& mesh, Size size, const TransparencyPlan& plan)
      : mesh_(mesh.view()),
        camera_(whole_view(mesh)),
        size_(size),
        plan_(plan),
        picture8_(size.width, size.height) {}

  [[nodiscard]] const Camera& camera() const { return camera_; }

  [[nodiscard]] family::Options options(const TransparencyOptions& transparency,
                                        float opacity) const {
    family::Options o;
    o.width = size_.width;
    o.height = size_.height;
    o.threads = plan_.threads;
    o.opacity = opacity;
    o.transparency = transparency;
    return o;
  }

  FrameStats draw(Ours& ours, const Targets& targets) const {
    const InstanceView instance{mesh_};
    return ours.renderer.render({.instances = {&instance, 1}}, camera_, ours.frame, targets);
  }

  /// Draws a lap of ours: fills its float picture and counts the wrong pixels.
  std::unique_ptr<Ours> check(Lap& lap, const family::Options& o, Image<Vec4>& picture) const {
    std::unique_ptr<Ours> ours;
    try_lap(lap, [&] {
      ours = std::make_unique<Ours>(Ours{family::make_renderer(o, o), o});
      Image<std::uint8_t> errors(size_.width, size_.height);
      lap.stats = draw(*ours, {.color = picture, .errors = errors});
      // Otherwise a build that ignores an option would be measured under a false name.
      if (lap.stats.fragments != 0 && counter(lap.stats, "translucent fragments") == 0)
        throw Error(Errc::unsupported, "absent: nothing was translucent");
      lap.wrong_pixels = static_cast<std::uint64_t>(
          std::ranges::count_if(errors.pixels(), [](std::uint8_t e) { return e != 0; }));
    });
    if (!lap.not_run.empty()) ours.reset();
    return ours;
  }

  void enter(Race& race, Lap& lap, Ours* ours) {
    if (ours == nullptr) return;
    race.enter(lap, [this, &lap, ours] {
      const std::uint64_t peak = lap.stats.peak_bytes;
      lap.stats = draw(*ours, {.color8 = picture8_});
      lap.stats.peak_bytes = std::max(peak, lap.stats.peak_bytes);
    });
  }

 private:
  MeshView mesh_;
  Camera camera_;
  Size size_;
  const TransparencyPlan& plan_;
  Image<Rgba8> picture8_;
};

/// Compares a peer's picture with what it should equal.
void judge(Lap& lap, const Image<Vec4>& expected, const Image<Vec4>& picture, double tolerance) {
  lap.error = picture_error(expected, picture, tolerance);
  lap.wrong = lap.error.share() < kLeastShare;
  if (lap.wrong)
    lap.not_run =
        "WRONG PICTURE: " + significant(100 * lap.error.share(), 4) + " % of the pixels are right";
}

void check_gl(Lap& lap, GlBlending method, const Image<Vec4>& expected, GlTransparency& gl,
              const TransparencyPlan& plan) {
  try_lap(lap, [&] {
    const auto frame = gl.draw(method, plan.opacity, GlPrecision::float32, plan.patience_ms);
    lap.passes = frame.passes;
    lap.at_least = !frame.complete;
    if (frame.complete) judge(lap, expected, gl.picture(), kTolerance);
  });
}

void measure_peers(Race& race, TransparencyRow& row, const View& view,
                   const std::vector<Image<Vec4>>& pictures, TransparencyPeers& peers,
                   const TransparencyPlan& plan) {
  const bool comparable = row.ours[kExact].not_run.empty() && row.ours[kUnsorted].not_run.empty();
  for (std::size_t p = 0; p < kPeerCount; ++p) {
    Lap& lap = row.peers[p];
    lap.name = kPeerNames[p];
    lap.not_run = p == kVtkPeeling ? peers.vtk.why_not() : peers.gl.why_not();
    if (lap.not_run.empty() && !comparable) lap.not_run = "nothing to compare it with";
  }
  if (peers.gl && comparable) {
    try_lap(row.peers[kGlUnsorted],
            [&] { peers.gl->set_view(view.camera(), row.size.width, row.size.height); });
    for (const auto method : {GlBlending::unsorted, GlBlending::lists, GlBlending::peeling}) {
      Lap& lap = row.peers[static_cast<std::size_t>(method)];
      lap.not_run = row.peers[kGlUnsorted].not_run;
      if (!lap.not_run.empty()) continue;
      check_gl(lap, method, pictures[method == GlBlending::unsorted ? kUnsorted : kExact],
               *peers.gl.peer, plan);
      if (lap.not_run.empty())
        race.enter(lap, [&lap, &plan, &peers, method] {
          const auto frame =
              peers.gl->draw(method, plan.opacity, GlPrecision::rgba8, plan.patience_ms);
          lap.at_least = lap.at_least || !frame.complete;
        });
    }
  }
  Lap& vtk = row.peers[kVtkPeeling];
  if (!peers.vtk || !comparable) return;
  if (row.peers[kGlPeeling].at_least) {
    vtk.not_run = "llvmpipe alone ran out of patience";
    return;
  }
  try_lap(vtk, [&] {
    peers.vtk->set_view(view.camera(), row.size.width, row.size.height);
    peers.vtk->draw(plan.opacity);
    judge(vtk, pictures[kExact], peers.vtk->picture(), kTolerance8);
  });
  if (vtk.not_run.empty()) race.enter(vtk, [&] { peers.vtk->draw(plan.opacity); });
}

/// Counts the frame's work with `tiled`, which records every piece in every block that it touches.
/// `grouped` makes fragments of micro triangles without a block.
void count_work(TransparencyRow& row, const Mesh& mesh, const View& view,
                const TransparencyPlan& plan) {
  Lap counted;
  family::Options o = view.options(kTechniques[kExact].options, plan.opacity);
  o.rasterizer = "tiled";
  Image<Vec4> unused(row.size.width, row.size.height);
  view.check(counted, o, unused);
  const std::uint64_t fragments = counter(counted.stats, "translucent fragments");
  const std::uint64_t blocks = counter(counted.stats, "layer blocks");
  row.deepest = counter(counted.stats, "deepest");
  row.work.vertices = mesh.positions.size();
  row.work.triangles = mesh.triangle_count();
  row.work.fragments = row.work.blended = fragments;
  row.work.pixels =
      static_cast<std::uint64_t>(row.size.width) * static_cast<std::uint64_t>(row.size.height);
  if (blocks != 0)
    row.samples_per_block = static_cast<double>(fragments) / static_cast<double>(blocks);
  row.floor = floor_of(row.work, plan.machine);
  Ours opaque{Renderer({.threads = plan.threads}), view.options(kTechniques[kExact].options, 1)};
  row.opaque_bytes = view.draw(opaque, {.color = unused}).peak_bytes;
}

/// Compares the device's pictures with the threads' of the same technique, pixel by pixel.
void measure_device(Race& race, TransparencyRow& row, View& view,
                    const std::vector<Image<Vec4>>& pictures, const TransparencyPlan& plan,
                    std::vector<std::unique_ptr<Ours>>& renderers) {
  row.device_floor_ms = floor_of(row.work, plan.device).bytes_ms;
  row.device.resize(kOnDevice.size());
  for (std::size_t i = 0; i < row.device.size(); ++i) {
    const Technique& technique = kTechniques[kOnDevice[i]];
    Lap& lap = row.device[i];
    lap.name = std::string(technique.name).append(", cuda");
    lap.not_run = row.ours[kOnDevice[i]].not_run;
    if (!lap.not_run.empty()) continue;
    family::Options o = view.options(technique.options, plan.opacity);
    o.device = Device::cuda;
    Image<Vec4> picture(row.size.width, row.size.height);
    std::unique_ptr<Ours> renderer = view.check(lap, o, picture);
    if (renderer && lap.stats.device != Device::cuda)
      lap.not_run = "left to the CPU: " + lap.stats.device_why;
    if (lap.not_run.empty()) {
      lap.error = picture_error(pictures[kOnDevice[i]], picture, kTolerance);
      lap.wrong = lap.error.far != 0;
      if (lap.wrong)
        lap.not_run = "WRONG PICTURE: " + std::to_string(lap.error.far) + " pixels differ";
    }
    if (!lap.not_run.empty()) continue;
    renderers.push_back(std::move(renderer));
    view.enter(race, lap, renderers.back().get());
  }
}

void measure_thresholds(TransparencyRow& row, View& view, const TransparencyPlan& plan) {
  Race race;
  std::vector<std::unique_ptr<Ours>> renderers;
  Image<Vec4> picture(row.size.width, row.size.height);
  row.thresholds.resize(2 * kThresholdOpacities.size());
  for (std::size_t i = 0; i < row.thresholds.size(); ++i) {
    TransparencyOptions options = kTechniques[kExact].options;
    if (i % 2 == 1) options.alpha_threshold = paper4::kAlphaThreshold;
    Lap& lap = row.thresholds[i];
    lap.name = std::string(i % 2 == 1 ? "threshold" : "exact") + " at opacity " +
               significant(static_cast<double>(kThresholdOpacities[i / 2]), 1);
    renderers.push_back(
        view.check(lap, view.options(options, kThresholdOpacities[i / 2]), picture));
    view.enter(race, lap, renderers.back().get());
  }
  race.run(plan.plan);
}

}  // namespace

double ratio(const Lap& a, const Lap& b) {
  return a.ran() && b.ran() ? median_ratio(a.timing, b.timing) : 0;
}

bool TransparencyRow::right() const {
  return std::ranges::none_of(peers, &Lap::wrong) && std::ranges::none_of(ours, &Lap::wrong) &&
         std::ranges::none_of(device, &Lap::wrong);
}

std::uint64_t TransparencyRow::list_bytes() const {
  return GlTransparency::kNodeBytes * work.fragments + 4 * work.pixels;
}

TransparencyRow measure_transparency(const Mesh& mesh, Size size, TransparencyPeers& peers,
                                     const TransparencyPlan& plan) {
  TransparencyRow row;
  row.size = size;
  View view(mesh, size, plan);
  count_work(row, mesh, view, plan);

  Race race;
  std::vector<std::unique_ptr<Ours>> renderers;
  std::vector<Image<Vec4>> pictures;
  row.ours.resize(kTechniques.size());
  row.peers.resize(kPeerCount);
  for (std::size_t i = 0; i < kTechniques.size(); ++i) {
    Lap& lap = row.ours[i];
    lap.name = kTechniques[i].name;
    pictures.emplace_back(size.width, size.height);
    renderers.push_back(
        view.check(lap, view.options(kTechniques[i].options, plan.opacity), pictures[i]));
    if (lap.not_run.empty()) lap.error = picture_error(pictures[kExact], pictures[i], kTolerance);
    view.enter(race, lap, renderers.back().get());
  }
  if (plan.on_cuda) measure_device(race, row, view, pictures, plan, renderers);
  measure_peers(race, row, view, pictures, peers, plan);
  race.run(plan.plan);
  renderers.clear();
  measure_thresholds(row, view, plan);
  return row;
}

}  // namespace rastrum::bench
