// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/memory.hpp>
#include <rastrum/core/no_memory.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/turn.hpp>
#include <rastrum/program.hpp>
#include <rastrum/raster/bin/tile_grid.hpp>
#include <rastrum/raster/context/stopwatch.hpp>
#include <rastrum/raster/draws/shader_table.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/shade/mixed_draws.hpp>
#include <rastrum/raster/shade/shader.hpp>
#include <rastrum/raster/shade/texture.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/render/depth_greys.hpp>
#include <rastrum/render/scene_checks.hpp>
#include <rastrum/render/scene_draws.hpp>
#include <rastrum/render/shadows.hpp>
#include <rastrum/render/surface_of_key.hpp>
#include <rastrum/render/surroundings_pass.hpp>
#include <rastrum/render/target_checks.hpp>
#include <rastrum/render/tone_pass.hpp>

namespace rastrum {
namespace {

/// Pictures of up to so many pixels are drawn side by side, a thread each,
constexpr std::int64_t kSmall = 512 * 512;
/// if each thread has so much memory.
constexpr std::uint64_t kEnough = std::uint64_t{64} << 20;

}  // namespace

void check(const FrameOptions& o) {
  const FloatScope floats;
  check_image_size(o.width, o.height);
  check_enum(o.shader, raster::kLastShader, "the shader");
  check_enum(o.cull, Cull::front, "cull");
  check_enum(o.transparency.method, Transparency::added, "the method of transparency");
  const Vec4 b = o.background;
  require(std::isfinite(b.x) && std::isfinite(b.y) && std::isfinite(b.z) && std::isfinite(b.w),
          "the background must be four finite numbers");
  // Written so that a NaN fails.
  require(o.opacity >= 0 && o.opacity <= 1, "opacity must lie in [0, 1]");
  require(o.transparency.method != Transparency::added || o.transparency.added != nullptr,
          "transparency: the method 'added' needs TransparencyOptions::added");
  require(o.transparency.alpha_threshold > 0 && o.transparency.alpha_threshold <= 1,
          "the alpha threshold must be > 0 and at most 1");
  require(o.samples == 1 || o.samples == 4 || o.samples == 8 || o.samples == 16,
          "samples must be 1, 4, 8 or 16");
  raster::check_clip_planes(o.clip_planes, "the frame: ");
  check_lights(o.lights);
  require(o.shadow_size == 0 || (o.shadow_size >= 64 && o.shadow_size <= 8192),
          "the size of shadows must be 64 to 8192 texels, or 0 for one that suits the picture");
  require(o.shadow_distance >= 0 && std::isfinite(o.shadow_distance),
          "the distance of shadows must be finite and not negative; 0 is as far as is seen");
  check_tone(o.tone);
}

struct Renderer::Impl {
  Impl(RendererOptions given, DeviceChoice choice, bool plain, MakeFrameDrawer maker);

  struct Call {
    const FrameOptions& frame;
    const Targets& targets;
    Pass pass{};
    RendererAccess::Apart apart{};
    raster::ForDevice device{};
    const raster::KnownBlocks* known = nullptr;  ///< blocks to shade; null: the scene is drawn
    bool is_shadow_map = false;

    [[nodiscard]] Call with(const FrameOptions& other, const Targets& filled) const {
      return {other, filled, pass, apart, device, known, is_shadow_map};
    }
  };
  FrameStats render_in_turn(const SceneView& scene, const Camera& camera, const Call& call,
                            StopToken stop) {
    return parallel::in_turn(one_at_a_time, stop, [&] {
      check(call.frame);
      return render(scene, camera, call);
    });
  }
  FrameStats render(const SceneView& scene, const Camera& camera, Call call);
  /// Without the environment behind the scene.
  FrameStats render_alone(const SceneView& scene, const Camera& camera, Call call);
  FrameStats draw_depth(SceneDraws& scene, const Call& call);
  /// Draws the shadow maps of `frame`. `peak` becomes the most bytes in use meanwhile.
  std::span<const raster::LightShadow> draw_shadows(const SceneView& scene, const Camera& camera,
                                                    const FrameOptions& frame, std::uint64_t& peak,
                                                    ShadowRanks* ranks = nullptr);
  /// `scene`: the scene of these draws; null: programs.
  FrameStats draw(std::span<raster::Draw> draws, const raster::Shading& shading,
                  const raster::Testing& test, const Call& call, const SceneDraws* scene = nullptr);

  void make_drawer();

  std::mutex one_at_a_time;
  RendererOptions options;
  std::string device_why;
  Isa isa = Isa::scalar;
  MemoryAccount memory;
  raster::TextureSet textures{memory};
  raster::TextureSet light_textures{memory};  ///< separate: shadow maps use fewer
  std::unique_ptr<parallel::Threads> threads;
  MakeFrameDrawer make;
  /// The frames that the drawer has scratch for. Scratch never shrinks, so with limited memory
  /// frames of another kind begin with a new drawer.
  struct Kind {
    int width = 0, height = 0, samples = 0;
    bool layers = false;
    bool operator==(const Kind&) const = default;
  } kind;
  std::unique_ptr<raster::FrameDrawer> drawer;
  Shadows shadows{memory};
  Image<float> own_depth;               ///< of Shader::depth, kept while frames use it
  std::vector<Renderer> of_one_thread;  ///< for small pictures that are drawn side by side
};

Renderer::Impl::Impl(RendererOptions given, DeviceChoice choice, bool plain, MakeFrameDrawer maker)
    : options(given), make(std::move(maker)) {
  if (options.threads < 0 || options.threads > 4096)
    reject("threads must lie between 0 (all) and 4096");
  options.device = choice.device;
  device_why = std::move(choice.why);
  isa = choose_isa(options.isa);
  if (options.device != Device::serial && !plain)
    threads = std::make_unique<parallel::Threads>(options.threads, &memory);
  else
    isa = Isa::scalar;
  make_drawer();
}

void Renderer::Impl::make_drawer() {
  drawer.reset();
  drawer = make({options.device, device_why, options.memory_limit}, memory, threads.get());
}

Renderer::Renderer(RendererOptions options)
    : Renderer(RendererAccess::make(options, choose_device(options.device), false,
                                    rastrum::make_drawer)) {}
Renderer::Renderer(Owner<Impl> impl) : impl_("Renderer", std::move(impl)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const RendererOptions& Renderer::options() const {
  return impl_->options;
}

Renderer RendererAccess::make(RendererOptions options, DeviceChoice choice, bool plain,
                              MakeFrameDrawer make) {
  return Renderer(in_memory([&] {
    return std::make_unique<Renderer::Impl>(options, std::move(choice), plain, std::move(make));
  }));
}

FrameStats Renderer::render(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                            const Targets& targets, const Pass& pass, StopToken stop) {
  return impl_->render_in_turn(scene, camera, {frame, targets, pass}, stop);
}

std::vector<FrameStats> Renderer::render_many(std::span<const ScenePicture> pictures,
                                              const FrameOptions& frame, StopToken stop) {
  std::vector<FrameStats> stats(pictures.size());
  const auto draw = [&](Renderer& by, std::size_t i) {
    const ScenePicture& p = pictures[i];
    stats[i] = by.render(p.scene, p.camera, frame, p.targets, {}, stop);
  };
  const std::int64_t pixels = std::int64_t{frame.width} * frame.height;
  if (!RendererAccess::draw_side_by_side(
          *this, pictures.size(), pixels,
          [&](Renderer& by, std::size_t, std::size_t i) { draw(by, i); }, stop))
    for (std::size_t i = 0; i < pictures.size(); ++i) draw(*this, i);
  return stats;
}

bool RendererAccess::draw_side_by_side(
    Renderer& renderer, std::size_t count, std::int64_t pixels,
    const std::function<void(Renderer&, std::size_t, std::size_t)>& draw, StopToken stop) {
  Renderer::Impl& impl = *renderer.impl_;
  const int threads = impl.threads == nullptr ? 1 : impl.threads->concurrency();
  const std::size_t workers = std::min(static_cast<std::size_t>(threads), count);
  RendererOptions one = impl.options;
  one.threads = 1;
  one.memory_limit /= static_cast<std::uint64_t>(threads);
  const bool limited = impl.options.memory_limit != 0;
  if (impl.options.device != Device::threads || workers < 2 || pixels > kSmall ||
      (limited && one.memory_limit < kEnough))
    return false;
  parallel::in_turn(impl.one_at_a_time, stop, [&] {
    if (limited) impl.make_drawer();     // without the scratch of earlier frames
    std::vector<Renderer> of_this_call;  // then none is kept beside later frames'
    std::vector<Renderer>& renderers = limited ? of_this_call : impl.of_one_thread;
    while (renderers.size() < workers) renderers.emplace_back(one);
    std::atomic<std::size_t> next{0};
    parallel::for_each_in_order(*impl.threads, workers, [&](std::size_t worker) {
      try {
        for (std::size_t i; (i = next++) < count;) draw(renderers[worker], worker, i);
      } catch (...) {
        next = count;  // the others begin no more
        throw;
      }
    });
  });
  return true;
}

FrameStats Renderer::render_in_place(const SceneView& scene, const Camera& camera,
                                     const FrameOptions& frame, const Targets& targets,
                                     StopToken stop, std::optional<DeviceStream> after) {
  return impl_->render_in_turn(
      scene, camera,
      {.frame = frame,
       .targets = targets,
       .device = {.in_place = impl_->options.device == Device::cuda, .after = after}},
      stop);
}

FrameStats RendererAccess::render(Renderer& renderer, const SceneView& scene, const Camera& camera,
                                  const FrameOptions& frame, const Targets& targets,
                                  const Pass& pass, const Apart& apart, StopToken stop) {
  return renderer.impl_->render_in_turn(scene, camera, {frame, targets, pass, apart}, stop);
}

FrameStats RendererAccess::shade(Renderer& renderer, const SceneView& scene, const Camera& camera,
                                 const FrameOptions& frame, const Targets& targets,
                                 const Pass& pass, const raster::KnownBlocks& known,
                                 std::span<const raster::LightShadow> shadows) {
  return renderer.impl_->render_in_turn(
      scene, camera, {frame, targets, pass, {.shadows = shadows}, raster::ForDevice(), &known}, {});
}

parallel::Threads* RendererAccess::threads(Renderer& renderer) {
  return renderer.impl_->threads.get();
}

std::span<const raster::LightShadow> RendererAccess::shadows(Renderer& renderer,
                                                             const SceneView& scene,
                                                             const Camera& camera,
                                                             const FrameOptions& frame,
                                                             ShadowRanks& ranks) {
  std::uint64_t peak = 0;
  return renderer.impl_->draw_shadows(scene, camera, frame, peak, &ranks);
}

FrameStats RendererAccess::draw(Renderer& renderer, std::span<raster::Draw> draws,
                                const raster::Shading& shading, const raster::Testing& test,
                                const FrameOptions& frame, const Targets& targets, const Pass& pass,
                                StopToken stop) {
  Renderer::Impl& impl = *renderer.impl_;
  parallel::CallingTurn turn(impl.one_at_a_time, stop);
  return turn.run([&] {
    check(frame);
    return impl.draw(draws, shading, test, {frame, targets, pass});
  });
}

FrameStats Renderer::draw(std::span<const ProgramDraw> draws, const FrameOptions& frame,
                          const Targets& targets, const Pass& pass, StopToken stop) {
  // A program's exceptions pass unchanged; only the copies are the library's errors.
  std::vector<raster::Draw> copies =
      in_memory([&] { return std::vector<raster::Draw>(draws.begin(), draws.end()); });
  return RendererAccess::draw(*this, copies, {}, {}, frame, targets, pass, stop);
}

namespace {

/// Runs `pass` as the last stage of a frame.
template <class Pass>
void add_stage(FrameStats& stats, const char* label, const Pass& pass) {
  const raster::Stopwatch watch;
  pass();
  const double end_ms = stats.frame_ms + watch.elapsed_ms();
  stats.stages.push_back({label, stats.frame_ms, end_ms});
  stats.frame_ms = end_ms;
}

}  // namespace

FrameStats Renderer::Impl::render(const SceneView& scene, const Camera& camera, Call call) {
  SurroundingsPass around;
  if (!SurroundingsPass::wanted(call.frame, call.targets, call.pass))
    return render_alone(scene, camera, call);
  check_targets(call.targets, call.frame, !call.apart.part);
  FrameOptions over_nothing = call.frame;
  over_nothing.background = {};
  const Targets targets = around.targets(call.frame, call.targets);
  FrameStats stats = render_alone(scene, camera, call.with(over_nothing, targets));
  add_stage(stats, "environment",
            [&] { around.draw(call.frame, camera, call.targets, threads.get()); });
  return stats;
}

FrameStats Renderer::Impl::render_alone(const SceneView& scene, const Camera& camera, Call call) {
  const FrameOptions& o = call.frame;
  const Shader taken = shader_for(o.shader, scene);
  if (call.device.in_place) check_in_place(scene, call.targets, taken, o);
  // A device reads no copies. Clip planes are in each instance's object space.
  InstanceRuns runs(scene, options.device != Device::cuda && o.clip_planes.empty(), threads.get());
  if (!call.device.in_place) {
    check_scene(runs, threads.get());
    runs.cut_faces(threads.get());
  }
  if (!call.apart.part) check_apart(call.targets, runs);
  if (options.device == Device::cuda) call.device.why_not = why_not_on_device(scene);
  if (call.device.why_not.empty() && (!o.lights.empty() || call.is_shadow_map))
    call.device.why_not = "the frame has its own lights, which only the CPU has";
  if (call.device.why_not.empty() && taken == Shader::classic)
    call.device.why_not = "only the CPU has the shader classic";
  raster::check_materials(runs);
  check_surfaces(runs);
  check_outputs(call.targets, true, taken == Shader::material);
  check_instance_ids(call.targets, scene);
  TonePass tone;
  const bool tones = TonePass::wanted(o, call.targets, taken, call.pass);
  if (tones) check_targets(call.targets, o, !call.apart.part);
  const Targets targets = tones ? tone.targets(o, call.targets) : call.targets;
  const Call drawn = call.with(o, targets);
  const bool lit = raster::row_of(taken).lights;
  const raster::Stopwatch watch;
  std::uint64_t shadows_peak = 0;
  const auto shadowed = !lit || !call.apart.shadows.empty()
                            ? call.apart.shadows
                            : draw_shadows(scene, camera, o, shadows_peak);
  const double shadows_ms = watch.elapsed_ms();
  SceneDraws of(runs, camera, {o, targets, taken, call.device.in_place, shadowed},
                call.is_shadow_map ? light_textures : textures, threads.get());
  if (taken != Shader::depth) own_depth = {};
  FrameStats stats = taken == Shader::depth ? draw_depth(of, drawn)
                                            : draw(of.draws(), of.shading(), of.test(), drawn, &of);
  stats.shader = name(taken);
  stats.peak_bytes = std::max(stats.peak_bytes, shadows_peak);
  if (!shadowed.empty()) {
    for (StageTime& stage : stats.stages) {
      stage.begin_ms += shadows_ms;
      stage.end_ms += shadows_ms;
    }
    stats.stages.insert(stats.stages.begin(), {"shadows", 0, shadows_ms});
    stats.frame_ms += shadows_ms;
  }
  if (tones) add_stage(stats, "tone", [&] { tone.draw(o, call.targets, threads.get()); });
  return stats;
}

std::span<const raster::LightShadow> Renderer::Impl::draw_shadows(const SceneView& scene,
                                                                  const Camera& camera,
                                                                  const FrameOptions& frame,
                                                                  std::uint64_t& peak,
                                                                  ShadowRanks* ranks) {
  std::vector<InstanceView> list;
  SceneView casters = scene;
  if (!std::ranges::all_of(scene.instances, &InstanceView::casts_shadows)) {
    list.assign(scene.instances.begin(), scene.instances.end());
    for (InstanceView& i : list) i.visible = i.visible && i.casts_shadows;
    casters.instances = list;
  }
  const auto draw_depth = [&](const Camera& light, const FrameOptions& look,
                              ImageView<float> depth) {
    const Targets targets{.depth = depth};
    const FrameStats stats =
        render_alone(casters, light, {.frame = look, .targets = targets, .is_shadow_map = true});
    peak = std::max(peak, stats.peak_bytes);
  };
  return shadows.draw(scene, camera, frame, draw_depth, ranks);
}

/// Greys need the depth range of the picture, so they are a pass after the frame.
FrameStats Renderer::Impl::draw_depth(SceneDraws& scene, const Call& call) {
  const FrameOptions& o = call.frame;
  const Targets& targets = call.targets;
  if (call.pass.over)
    reject(
        "the depth shader stretches the depths of a whole picture and cannot draw over "
        "one; take another shader");
  check_targets(targets, o, !call.apart.part);
  Targets first = targets;
  first.color8 = {};
  first.color = {};
  ImageView<float> depths = targets.depth;  // the depths to turn grey
  if (depths.empty() || call.pass.load) {
    if (own_depth.width() != o.width || own_depth.height() != o.height)
      own_depth = Image<float>(o.width, o.height);
    depths = own_depth.view();
  }
  if (!call.pass.load) first.depth = depths;
  const raster::FragmentShader unused(
      [](const raster::FrameGeometry&, const Fragment&) { return Vec4{}; });
  Call pass{o, first, call.pass};
  pass.device.why_not = call.device.why_not;
  FrameStats stats = draw(scene.draws(), unused, scene.test(), pass, &scene);
  add_stage(stats, "stretch depth", [&] {
    // Greys show all passes so far, whose depths the keys have.
    if (call.pass.load) depths_of_keys(targets.keys, depths, threads.get());
    stretch_depth(depths, o.background, targets, isa, threads.get());
  });
  return stats;
}

FrameStats Renderer::Impl::draw(std::span<raster::Draw> draws, const raster::Shading& shading,
                                const raster::Testing& test, const Call& call,
                                const SceneDraws* scene) {
  const FrameOptions& o = call.frame;
  const Targets& targets = call.targets;
  if (!call.apart.part && call.known == nullptr) check_targets(targets, o);
  if (scene == nullptr) {
    check_outputs(targets, false, false);
    if (!o.clip_planes.empty())
      throw Error(Errc::unsupported,
                  "clip planes need a scene's world; a program discards fragments itself");
  }
  check_ids(targets, call.pass.first_id, draws);
  raster::MixedDraws mixed(draws, shading, test);
  draws = mixed.draws();
  if (const std::size_t outputs = extra_count(mixed.shading()); targets.extra.size() > outputs)
    reject(targets.extra.size(), " extra targets, but the shader has ", outputs,
           " outputs beside its colour");
  if (call.pass.load && targets.keys.empty())
    reject("a pass that loads needs the visibility keys of the passes before");
  if (call.pass.load && call.apart.sink == nullptr &&
      (raster::blends(draws, o.transparency) || o.samples > 1))
    reject(
        "a pass that loads can neither blend translucent surfaces over what the passes "
        "before have drawn nor add samples to it; draw all in one pass");
  if (call.pass.load && call.apart.sink == nullptr)
    check_loaded(targets.keys, call.pass.first_id, threads.get());
  std::vector<raster::Draw> over;  // leaves the caller's draws unchanged
  if (call.pass.over) {
    check_over(targets, call.pass, o);
    over.assign(draws.begin(), draws.end());
    for (raster::Draw& d : over) d.flags |= raster::kOverPicture;
    draws = over;
  }
  raster::FrameRequest request;
  request.width = o.width;
  request.height = o.height;
  if (o.cull != Cull::none)
    for (raster::Draw& d : draws) d.cull = o.cull;
  request.isa = isa;
  request.draws = draws;
  if (scene != nullptr) {
    request.names = scene->names();
    request.linear_light = scene->linear_light();
    request.surface = scene->surface();
  }
  request.part = call.apart.part;
  request.test = mixed.test();
  request.shading = mixed.shading();
  request.background = o.background;
  request.targets = targets;
  request.pass = call.pass;
  request.no_distance = o.no_distance;
  request.sink = call.apart.sink;
  request.device = call.device;
  request.other_bytes = textures.bytes() + light_textures.bytes() + shadows.bytes();
  request.transparency = o.transparency;
  request.samples = o.samples;
  if (options.memory_limit != 0) {
    const Kind now{o.width, o.height, o.samples, call.known == nullptr && request.needs_layers()};
    if (kind != Kind{} && kind != now) make_drawer();
    kind = now;
  }
  memory.restart_peak();
  FrameStats stats =
      call.known == nullptr ? drawer->draw(request) : drawer->shade(request, *call.known);
  stats.peak_bytes = memory.peak();
  // For frames that the device leaves to the CPU, the drawer has set this.
  if (options.device != Device::cuda) stats.device = options.device;
  if (stats.device_why.empty()) stats.device_why = device_why;
  return stats;
}

std::optional<Pick> Renderer::pick(const SceneView& scene, const Camera& camera,
                                   const FrameOptions& frame, int x, int y, StopToken stop) {
  return parallel::in_turn(impl_->one_at_a_time, stop, [&]() -> std::optional<Pick> {
    check(frame);
    if (x < 0 || x >= frame.width || y < 0 || y >= frame.height)
      reject("pick: pixel (", x, ", ", y, ") lies outside of the frame of ", frame.width, "x",
             frame.height);
    const int x0 = x / raster::kBinSize * raster::kBinSize;
    const int y0 = y / raster::kBinSize * raster::kBinSize;
    const raster::Rect bin{x0, y0, std::min(x0 + raster::kBinSize, frame.width),
                           std::min(y0 + raster::kBinSize, frame.height)};
    Image<std::uint64_t> keys(bin.x1 - bin.x0, bin.y1 - bin.y0);
    Targets targets;
    targets.keys = raster::placed(keys.view(), bin);
    FrameOptions plain = frame;
    plain.lights.clear();
    plain.environment_behind = false;
    // These options show the surfaces that Shader::depth shows.
    if (plain.shader == Shader::depth) {
      plain.shader = Shader::flat;
      plain.transparency.method = Transparency::none;
    }
    (void)impl_->render(scene, camera,
                        {.frame = plain, .targets = targets, .apart = {.part = bin}});
    const std::uint64_t key = targets.keys(x, y);
    if (key == 0) return std::nullopt;
    return surface_of_key(scene, camera, frame, key, x, y);
  });
}

Image<Rgba8> render(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                    const RendererOptions& options) {
  return in_memory([&] {
    Image<Rgba8> image(frame.width, frame.height);
    Renderer(options).render(scene, camera, frame, {.color8 = image});
    return image;
  });
}

}  // namespace rastrum
