// SPDX-License-Identifier: BSD-3-Clause
#include "contest.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <optional>

#include <bench/cuda/in_place.hpp>
#include <rastrum/image.hpp>
#include <rastrum/raster/draws/vertices.hpp>
#include <rastrum/render/access.hpp>

#include "attempt.hpp"

namespace rastrum::bench {
namespace {

using raster::BlockColors, raster::FrameGeometry, raster::VisibleBlock;

/// A colour from the key alone. It fetches no attribute, so frames show the cost of coverage and
/// visibility.
template <class Color>
class KeyShader final : public raster::BlockShader {
 public:
  explicit KeyShader(Color color) : color_(color) {}
  bool shade(const FrameGeometry&, const VisibleBlock& block, Isa,
             BlockColors& colors) const noexcept override {
    for (int i = 0; i < 64; ++i) {
      const Vec3 c = color_(block.keys[i]);
      colors.r[i] = c.x;
      colors.g[i] = c.y;
      colors.b[i] = c.z;
    }
    return true;
  }

 private:
  Color color_;
};

const raster::BlockShader& depth_cubed() {
  static const KeyShader shader([](std::uint64_t key) {
    const auto d = std::bit_cast<float>(static_cast<std::uint32_t>(key >> raster::kIdBits));
    const float grey = d * d * d;
    return Vec3{grey, grey, grey};
  });
  return shader;
}

std::uint64_t fold(std::uint64_t hash, std::uint64_t value) {
  return (hash ^ value) * 0x100000001b3U;
}
constexpr std::uint64_t kHashBegin = 0xcbf29ce484222325U;

std::uint64_t hash_of(const Image<std::int64_t>& ids) {
  std::uint64_t h = kHashBegin;
  for (const std::int64_t id : ids.pixels()) h = fold(h, static_cast<std::uint64_t>(id));
  return h;
}

/// Says why a frame was not drawn by what was asked for. Otherwise a build that ignores an option
/// would be measured under a false name.
std::string absent(const family::Options& wanted, const FrameStats& stats) {
  if (wanted.device == Device::cuda && stats.device != Device::cuda)
    return "left to the CPU: " + stats.device_why;
  const auto differs = [](const std::string& want, const std::string& got) {
    return want != "auto" && want != got;
  };
  return differs(wanted.rasterizer, stats.rasterizer) ||
                 differs(wanted.visibility, stats.visibility)
             ? "absent"
             : "";
}

void add_stages(const FrameStats& stats, std::map<std::string, std::vector<double>>& samples) {
  for (const auto& [name, ms] : stages_ms(stats)) samples[name].push_back(ms);
}

std::vector<std::pair<std::string, double>> medians(
    const FrameStats& order, const std::map<std::string, std::vector<double>>& samples) {
  std::vector<std::pair<std::string, double>> out;
  for (const StageTime& s : order.stages)
    if (std::ranges::find(out, s.name, &std::pair<std::string, double>::first) == out.end())
      if (const auto found = samples.find(s.name); found != samples.end())
        out.emplace_back(s.name, median(found->second));
  return out;
}

/// The subject and the picture in a device's memory.
struct OnDevice {
  MeshesInPlace meshes;
  InPlace frame;
  OnDevice(const Subject& subject, const family::Options& options)
      : frame(options, subject.camera, subject.width, subject.height) {
    meshes.add(subject.mesh);
  }
};

/// An entrant whose picture is right. It has one of the two ways to draw.
struct Racer {
  std::size_t index;
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<OnDevice> on_device;
  double first_ms = 0;
  std::map<std::string, std::vector<double>> stages;
};

}  // namespace

const raster::BlockShader& triangle_colors() {
  // A hash of the id, without a branch so that compilers vectorize it.
  static const KeyShader shader([](std::uint64_t key) {
    const std::uint32_t h = static_cast<std::uint32_t>(raster::id_of_key(key)) * 0x9e3779b1U;
    const auto channel = [](std::uint32_t byte) {
      return static_cast<float>(static_cast<int>(byte)) * (1.0F / 255.0F);
    };
    return Vec3{channel(h >> 24), channel(h >> 16 & 255U), channel(h >> 8 & 255U)};
  });
  return shader;
}

std::string why_not(const Error& e) {
  if (e.code() != Errc::invalid_argument) return e.what();
  const std::string_view what = e.what();
  return what.find("is called") != std::string_view::npos ? "absent" : std::string(what);
}

std::uint64_t hash_of(std::span<const std::uint64_t> keys) {
  std::uint64_t h = kHashBegin;
  for (const std::uint64_t key : keys) h = fold(h, key);
  return h;
}

FrameStats draw(Renderer& renderer, const Subject& subject, FrameOptions frame,
                const Targets& targets, const Pass& pass) {
  frame.width = subject.width;
  frame.height = subject.height;
  if (subject.facade_shader) {
    const InstanceView instance{subject.mesh, Mat4d::identity()};
    return renderer.render({.instances = {&instance, 1}}, subject.camera, frame, targets, pass);
  }
  const Mat4d to_clip = world_to_clip(subject.camera, subject.width, subject.height);
  const raster::MatrixVertices source(subject.mesh.positions, to_clip);
  raster::Draw draw;
  draw.source = source;
  draw.vertex_count = subject.mesh.positions.size();
  draw.indices = subject.mesh.indices.packed();
  draw.primitive_count = subject.mesh.triangle_count();
  const raster::BlockShader& shader = subject.shader != nullptr ? *subject.shader : depth_cubed();
  return RendererAccess::draw(renderer, {&draw, 1}, shader, {}, frame, targets, pass);
}

Fingerprint fingerprint(const Subject& subject, const Entrant& entrant) {
  const family::Options& options = entrant.options;
  if (entrant.in_place) {
    OnDevice there(subject, options);
    FrameStats stats;
    const std::uint64_t hash = hash_of(there.frame.ids(there.meshes, stats));
    return {hash, std::move(stats)};
  }
  Renderer renderer = family::make_renderer(options, options);
  Image<std::int64_t> ids(subject.width, subject.height);
  FrameStats stats = draw(renderer, subject, options, {.ids = ids});
  return {hash_of(ids), std::move(stats)};
}

std::vector<Result> contest(const Subject& subject, std::span<const Entrant> entrants,
                            const Plan& plan, double hopeless) {
  std::vector<Result> results(entrants.size());
  std::vector<Racer> racers;
  std::optional<std::uint64_t> right;
  for (std::size_t i = 0; i < entrants.size(); ++i) {
    const family::Options& options = entrants[i].options;
    Result& result = results[i];
    result.name = entrants[i].name;
    result.not_run = attempt([&]() -> std::string {
      const Fingerprint print = fingerprint(subject, entrants[i]);
      if (std::string why = absent(options, print.stats); !why.empty()) return why;
      if (!right) {
        Entrant plain;
        plain.options.threads = options.threads;
        right = fingerprint(subject, plain).ids;
      }
      result.wrong = print.ids != *right;
      result.stats = print.stats;
      return result.wrong ? "WRONG PICTURE" : "";
    });
    if (!result.ran()) continue;
    Racer racer{i, nullptr, nullptr, result.stats.frame_ms, {}};
    result.not_run = attempt([&]() -> std::string {
      if (entrants[i].in_place)
        racer.on_device = std::make_unique<OnDevice>(subject, options);
      else
        racer.renderer = std::make_unique<Renderer>(family::make_renderer(options, options));
      return "";
    });
    if (result.ran()) racers.push_back(std::move(racer));
  }

  Image<Rgba8> picture(subject.width, subject.height);
  const Targets targets{.color8 = picture};
  double fastest_ms = 1e300;
  for (const Racer& r : racers) fastest_ms = std::min(fastest_ms, r.first_ms);
  std::vector<Contender> contenders;
  std::vector<Result*> running;  // the results of the contenders
  for (Racer& r : racers) {
    if (r.first_ms > hopeless * fastest_ms) {
      results[r.index].timing = {results[r.index].name, {r.first_ms}};
      r.renderer.reset();
      r.on_device.reset();
      continue;
    }
    running.push_back(&results[r.index]);
    contenders.push_back({running.back()->name, [&r, &subject, entrants, &targets, &results] {
                            Result& result = results[r.index];
                            if (!result.ran()) return;
                            result.not_run = attempt([&]() -> std::string {
                              const std::uint64_t peak = result.stats.peak_bytes;
                              result.stats = r.on_device
                                                 ? r.on_device->frame.draw(r.on_device->meshes)
                                                 : draw(*r.renderer, subject,
                                                        entrants[r.index].options, targets);
                              result.stats.peak_bytes = std::max(peak, result.stats.peak_bytes);
                              add_stages(result.stats, r.stages);
                              return "";
                            });
                          }});
  }
  std::vector<Timing> timings = measure_interleaved(contenders, plan);
  for (std::size_t i = 0; i < running.size(); ++i) running[i]->timing = std::move(timings[i]);
  for (const Racer& r : racers)
    results[r.index].stages_ms = medians(results[r.index].stats, r.stages);
  return results;
}

Measured measured_ms(const Result& result, const Subject& subject, bool memory) {
  Measured m;
  m.not_run = result.not_run;
  if (!result.ran()) return m;
  m.value = result.timing.median_ms();
  m.spread = result.timing.spread();
  m.samples_ms = result.timing.samples_ms;
  m.scratch_bytes = result.stats.peak_bytes;
  if (memory)
    m.all_bytes = m.scratch_bytes + subject.mesh.positions.packed().size_bytes() +
                  subject.mesh.indices.packed().size_bytes() +
                  static_cast<std::uint64_t>(subject.width) *
                      static_cast<std::uint64_t>(subject.height) * sizeof(Rgba8);
  return m;
}

Measured measured_fps(const Result& result, const Subject& subject) {
  Measured m = measured_ms(result, subject, false);
  if (result.ran()) m.value = 1000 / m.value;
  return m;
}

}  // namespace rastrum::bench
