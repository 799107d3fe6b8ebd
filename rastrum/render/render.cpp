#include <rastrum/render.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <mutex>
#include <string>
#include <utility>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/turn.hpp>
#include <rastrum/program.hpp>
#include <rastrum/raster/bin/tile_grid.hpp>
#include <rastrum/raster/draws/cut.hpp>
#include <rastrum/raster/draws/mixed_draws.hpp>
#include <rastrum/raster/resolve/surface_point.hpp>
#include <rastrum/raster/shade/alpha.hpp>
#include <rastrum/raster/shade/interpolate.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/shade/texture.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/render/scene_checks.hpp>
#include <rastrum/render/surface_of_key.hpp>
#include <rastrum/render/surfaces.hpp>

namespace rastrum {
namespace {

/// Calls f(view, name) for each target of the surface at a pixel that needs a scene, and for the
/// others of it.
template <class F>
void each_target_of_scene(const Targets& t, const F& f) {
  f(t.positions, "positions");
  f(t.normals, "normals");
  f(t.camera_normals, "camera_normals");
  f(t.view_depth, "view_depth");
  f(t.distance, "distance");
  f(t.albedo, "albedo");
}
template <class F>
void each_target_of_surface(const Targets& t, const F& f) {
  f(t.instances, "instances");
  f(t.primitives, "primitives");
  f(t.barycentrics, "barycentrics");
  each_target_of_scene(t, f);
}
bool wants_surface(const Targets& targets) {
  bool any = false;
  each_target_of_surface(targets, [&](const auto& view, const char*) { any |= !view.empty(); });
  return any;
}

void check_targets(const Targets& targets, const FrameOptions& o) {
  const auto check_target = [&](const auto& view, const char* name) {
    check_size(view, o.width, o.height, std::string("the ").append(name) + " target");
  };
  check_target(targets.color8, "color8");
  check_target(targets.color, "color");
  check_target(targets.depth, "depth");
  check_target(targets.ids, "ids");
  check_target(targets.overdraw, "overdraw");
  check_target(targets.keys, "keys");
  check_target(targets.errors, "errors");
  check_target(targets.linear, "linear");
  each_target_of_surface(targets, check_target);
  for (const ImageView<Vec4>& extra : targets.extra) {
    if (extra.empty()) throw Error(Errc::invalid_argument, "an extra target is empty");
    check_target(extra, "extra");
  }
}

/// What only a scene has, or only materials have.
void check_outputs(const Targets& targets, bool has_scene, bool shades_materials) {
  if (!has_scene)
    each_target_of_scene(targets, [](const auto& view, const char* name) {
      if (!view.empty())
        throw Error(Errc::unsupported, std::string("the ").append(name) +
                                           " target is of a scene's surfaces; a program returns "
                                           "its own as a further output (Targets::extra)");
    });
  if (!targets.linear.empty() && !shades_materials)
    throw Error(Errc::unsupported,
                "the linear target is of the shader 'material': the others compute display values");
}

raster::LitModel lit_model(Shader shader) {
  switch (shader) {
    case Shader::flat:
      return raster::LitModel::flat;
    case Shader::normal:
      return raster::LitModel::normal;
    case Shader::id:
      return raster::LitModel::id;
    case Shader::lambert:
      return raster::LitModel::lambert;
    case Shader::wireframe:
      return raster::LitModel::wireframe;
    default:
      return raster::LitModel::phong;
  }
}

/// Nearest white, farthest black; one depth alone is white. A surface at depth 0 is left to the
/// background, from which its depth does not tell it.
void stretch_depth(ImageView<float> depth, Vec4 background, const Targets& targets) {
  float nearest = 0;
  float farthest = 1;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x) {
      const float d = depth(x, y);
      if (!(d > 0)) continue;
      nearest = std::max(nearest, d);
      farthest = std::min(farthest, d);
    }
  const float scale = nearest > farthest ? 1 / (nearest - farthest) : 0.0F;
  const Vec4 behind{background.x * background.w, background.y * background.w,
                    background.z * background.w, background.w};
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x) {
      const float d = depth(x, y);
      const float grey = 1 - (nearest - d) * scale;
      const Vec4 color = d > 0 ? Vec4{grey, grey, grey, 1} : behind;
      if (!targets.color8.empty()) targets.color8(x, y) = raster::to_straight_rgba8(color);
      if (!targets.color.empty()) targets.color(x, y) = color;
    }
}

/// What of a frame in a device's memory the host would have to read or write.
void check_in_place(const SceneView& scene, const Targets& targets, Shader shader,
                    const FrameOptions& o) {
  const auto require = [](bool ok, const char* what) {
    if (!ok)
      throw Error(Errc::unsupported,
                  std::string("arrays in the device's memory (in_place): ").append(what));
  };
  require(shader != Shader::depth && shader != Shader::material && shader != Shader::wireframe,
          "the shaders depth, material and wireframe need them in the host's");
  require(scene.materials.empty(), "materials need them in the host's");
  if (const std::string why = why_not_on_device(scene); !why.empty()) require(false, why.c_str());
  require(o.opacity == 1 && o.samples == 1, "surfaces must be opaque, with one sample a pixel");
  require(targets.overdraw.empty() && targets.errors.empty() && targets.extra.empty() &&
              targets.linear.empty() && !wants_surface(targets) && !targets.load && !targets.over,
          "of the targets there are color8, color, depth, ids and keys, in one pass");
  require(o.clip_planes.empty() &&
              std::ranges::all_of(scene.instances,
                                  [](const InstanceView& i) { return i.clip_planes.empty(); }),
          "clip planes need them in the host's");
}

/// What scenes of more than meshes do not have yet.
void check_asked_of_meshes(const SceneView& scene, const Targets& targets, const FrameOptions& o) {
  const auto refuse = [](const char* what) {
    throw Error(Errc::unsupported,
                std::string(what).append(": of meshes alone, but the scene has spheres, cylinders, "
                                         "tubes or discs"));
  };
  if (wants_surface(targets)) refuse("targets beside colour, depth, ids and keys");
  if (!o.clip_planes.empty() || std::ranges::any_of(scene.instances, [](const InstanceView& i) {
        return !i.clip_planes.empty();
      }))
    refuse("clip planes");
}

void check_over(const Targets& targets, const FrameOptions& o) {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw Error(Errc::invalid_argument, what);
  };
  require(!targets.depth.empty(), "to draw over a picture its depth is needed");
  require(!targets.load, "a pass that loads keys knows what it draws over by them");
  require(o.samples == 1, "a picture that is drawn over has one sample a pixel");
}

}  // namespace

void check(const FrameOptions& o) {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw Error(Errc::invalid_argument, what);
  };
  if (o.width < 1 || o.height < 1 || o.width > kMaxImageSize || o.height > kMaxImageSize)
    throw Error(Errc::invalid_argument, "image size " + std::to_string(o.width) + "x" +
                                            std::to_string(o.height) +
                                            " is outside 1x1 to 32768x32768");
  check_enum(o.shader, Shader::wireframe, "the shader");
  check_enum(o.cull, Cull::front, "cull");
  check_enum(o.transparency.method, Transparency::none, "the method of transparency");
  const Vec4 b = o.background;
  require(std::isfinite(b.x) && std::isfinite(b.y) && std::isfinite(b.z) && std::isfinite(b.w),
          "the background must be four finite numbers");
  // Written so that a NaN fails.
  require(o.opacity >= 0 && o.opacity <= 1, "opacity must lie in [0, 1]");
  require(o.transparency.filter >= 1 && o.transparency.filter <= 64,
          "the filter of transparency must hold 1 to 64 samples");
  require(o.transparency.alpha_threshold > 0 && o.transparency.alpha_threshold <= 1,
          "the alpha threshold must be > 0 and at most 1");
  require(o.samples == 1 || o.samples == 4 || o.samples == 8 || o.samples == 16,
          "samples must be 1, 4, 8 or 16");
  raster::check_clip_planes(o.clip_planes, "the frame: ");
}

struct Renderer::Impl {
  Impl(RendererOptions given, DeviceChoice choice, bool plain, MakeFrameDrawer maker);

  /// What a caller wants of one frame, which was checked. `in_place`: its arrays are memory of a
  /// GPU.
  struct Call {
    const FrameOptions& frame;
    const Targets& targets;
    bool in_place = false;
    std::optional<raster::Rect> part{};  ///< FrameRequest::part
    std::string why_host{};              ///< FrameRequest::why_host
  };
  FrameStats render(const SceneView& scene, const Camera& camera, Call call);
  FrameStats draw_depth(std::span<raster::Draw> draws, const raster::Testing& test,
                        const Call& call, const raster::SurfaceScene* surface);
  /// What draws of a scene have beside them.
  struct OfScene {
    bool linear_light = false;
    const raster::SurfaceScene* surface = nullptr;
  };
  FrameStats draw(std::span<raster::Draw> draws, const raster::Shading& shading,
                  const raster::Testing& test, const Call& call, const OfScene* scene = nullptr);

  void make_drawer();

  std::mutex one_at_a_time;
  RendererOptions options;
  std::string device_why;
  Isa isa = Isa::scalar;
  MemoryAccount memory;
  raster::TextureSet textures{memory};
  std::unique_ptr<parallel::Threads> threads;
  MakeFrameDrawer make;
  /// What the scratch of the drawer is for. Scratch never shrinks: where memory is limited, frames
  /// of another kind begin with a new one.
  struct Kind {
    int width = 0, height = 0, samples = 0;
    bool layers = false;
    bool operator==(const Kind&) const = default;
  } kind;
  std::unique_ptr<raster::FrameDrawer> drawer;
};

Renderer::Impl::Impl(RendererOptions given, DeviceChoice choice, bool plain, MakeFrameDrawer maker)
    : options(given), make(std::move(maker)) {
  if (options.threads < 0 || options.threads > 4096)
    throw Error(Errc::invalid_argument, "threads must lie between 0 (all) and 4096");
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
    : Renderer(std::make_unique<Impl>(options, choose_device(options.device), false,
                                      rastrum::make_drawer)) {}
Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const RendererOptions& Renderer::options() const {
  return impl_->options;
}

Renderer RendererAccess::make(RendererOptions options, DeviceChoice choice, bool plain,
                              MakeFrameDrawer make) {
  return Renderer(
      std::make_unique<Renderer::Impl>(options, std::move(choice), plain, std::move(make)));
}

FrameStats Renderer::render(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                            const Targets& targets, std::stop_token stop) {
  const parallel::Turn turn(impl_->one_at_a_time, stop);
  check(frame);
  return impl_->render(scene, camera, {frame, targets});
}

FrameStats Renderer::render_in_place(const SceneView& scene, const Camera& camera,
                                     const FrameOptions& frame, const Targets& targets,
                                     std::stop_token stop) {
  const parallel::Turn turn(impl_->one_at_a_time, stop);
  check(frame);
  return impl_->render(scene, camera, {frame, targets, impl_->options.device == Device::cuda});
}

FrameStats RendererAccess::draw(Renderer& renderer, std::span<raster::Draw> draws,
                                const raster::Shading& shading, const raster::Testing& test,
                                const FrameOptions& frame, const Targets& targets,
                                std::stop_token stop) {
  Renderer::Impl& impl = *renderer.impl_;
  const parallel::Turn turn(impl.one_at_a_time, stop);
  check(frame);
  return impl.draw(draws, shading, test, {frame, targets});
}

FrameStats Renderer::draw(std::span<const raster::ProgramDraw> draws, const FrameOptions& frame,
                          const Targets& targets, std::stop_token stop) {
  std::vector<raster::Draw> own(draws.begin(), draws.end());
  return RendererAccess::draw(*this, own, {}, {}, frame, targets, std::move(stop));
}

FrameStats Renderer::Impl::render(const SceneView& scene, const Camera& camera, Call call) {
  const FrameOptions& o = call.frame;
  const Shader taken = shader_for(o.shader, scene);
  if (call.in_place)
    check_in_place(scene, call.targets, taken, o);
  else
    check_scene(scene);
  if (options.device == Device::cuda) call.why_host = why_not_on_device(scene);
  raster::check_materials(scene);
  check_surfaces(scene);
  check_outputs(call.targets, true, taken == Shader::material);
  std::deque<raster::DrawCut> cuts;  // draws point to them
  const Mat4d to_clip = world_to_clip(camera, o.width, o.height);
  std::vector<raster::Draw> draws;
  draws.reserve(scene.instances.size());
  const bool blends = o.transparency.method != Transparency::none && taken != Shader::depth;
  const bool all_translucent = blends && o.opacity < 1;
  const std::vector<std::uint32_t> material_flags = raster::material_flags(scene.materials, blends);
  std::uint32_t any_flags = 0;  // of materials and colours
  std::uint32_t any_surface_flags = 0;
  const auto is_mesh = [](const InstanceView& instance) { return instance.mesh() != nullptr; };
  SceneView meshes = scene;
  std::vector<InstanceView> mesh_list;
  if (!std::ranges::all_of(scene.instances, is_mesh)) {
    mesh_list = mesh_instances(scene);
    meshes.instances = mesh_list;
    check_asked_of_meshes(scene, call.targets, o);
  }
  const bool some_translucent =
      blends && std::ranges::any_of(meshes.instances, [](const InstanceView& instance) {
        return instance.visible && instance.opacity < 1;
      });
  std::optional<raster::LitModel> model;
  if (taken != Shader::material) model = lit_model(taken);
  SurfaceDraws surfaces(scene, {model, blends, o.opacity}, camera, o.width, o.height);
  for (const InstanceView& instance : scene.instances) {
    raster::Draw& draw = draws.emplace_back();
    draw.visible = instance.visible;
    draw.winding = instance.winding;
    if (surfaces.add(instance, to_clip, draw)) {
      any_surface_flags |= draw.flags;
      continue;
    }
    const MeshView& mesh = *instance.mesh();
    draw.set_triangles(mesh);
    draw.source = raster::MatrixVertices(mesh.positions, to_clip * instance.object_to_world);
    draw.cull = material_cull(instance, scene.materials, taken);
    std::uint32_t flags = raster::set_material_flags(draw, instance, material_flags);
    if (blends && scene.materials.empty() && !call.in_place && instance.visible &&
        raster::has_color_alpha(instance, threads.get())) {
      draw.flags |= raster::kTranslucent;
      flags |= raster::kTranslucent;
    }
    if (all_translucent || (blends && instance.opacity < 1)) draw.flags |= raster::kTranslucent;
    any_flags |= flags;
    if (o.clip_planes.empty() && instance.clip_planes.empty()) continue;
    raster::check_clip_planes(
        instance.clip_planes,
        std::string("instance ").append(std::to_string(draws.size() - 1)).append(": ").c_str());
    draw.cut = &cuts.emplace_back(instance, o.clip_planes);
  }
  const bool any_mask = (any_flags & raster::kTested) != 0;
  const bool any_blend = some_translucent || (any_flags & raster::kTranslucent) != 0;
  const bool is_translucent =
      all_translucent || any_blend || (any_surface_flags & raster::kTranslucent) != 0;
  const bool shades_materials = taken == Shader::material;
  const bool wants_albedo = !call.targets.albedo.empty();
  std::optional<raster::MaterialScene> materials;
  if (shades_materials || any_mask || any_blend || wants_albedo) {
    textures.update(scene.textures,
                    raster::texture_uses(scene, shades_materials || wants_albedo, any_blend),
                    threads.get());
    materials.emplace(meshes, camera, o.width, o.height, textures);
  }
  std::optional<raster::SurfaceScene> surface;
  if (wants_surface(call.targets)) {
    surface.emplace(scene, camera, o.width, o.height);
    surface->materials = materials ? &*materials : nullptr;
    if (!call.targets.view_depth.empty() || !call.targets.distance.empty())
      (void)view_distance(camera, 1);  // throws where depth tells none
  }
  raster::Testing test;
  if (any_mask) test = raster::MaskTest{&*materials};
  const auto named = [&](FrameStats stats) {
    stats.shader = name(taken);
    return stats;
  };
  if (taken == Shader::depth)
    return named(draw_depth(draws, test, call, surface ? &*surface : nullptr));
  const bool linear = shades_materials && (is_translucent || !call.targets.linear.empty());
  if (linear) surfaces.leave_linear();
  std::optional<raster::LitScene> lit;
  raster::Shading shading;
  if (shades_materials) {
    shading = raster::MaterialShading{&*materials, linear};
  } else {
    lit.emplace(meshes, camera, o.width, o.height);
    shading = raster::LitShading{lit_model(taken), &*lit};
  }
  if (is_translucent) shading = shading.with_alpha(any_blend ? &*materials : nullptr, o.opacity);
  const OfScene of_scene{linear, surface ? &*surface : nullptr};
  return named(draw(draws, shading, test, call, &of_scene));
}

/// Grey by depth needs the range of depths in the picture, so it is a pass after the frame.
FrameStats Renderer::Impl::draw_depth(std::span<raster::Draw> draws, const raster::Testing& test,
                                      const Call& call, const raster::SurfaceScene* surface) {
  const FrameOptions& o = call.frame;
  const Targets& targets = call.targets;
  if (targets.over)
    throw Error(Errc::invalid_argument,
                "the depth shader stretches the depths of a whole picture and cannot draw over "
                "one; take another shader");
  check_targets(targets, o);
  Image<float> depth;
  Targets first = targets;
  first.color8 = {};
  first.color = {};
  if (first.depth.empty()) {
    depth = Image<float>(o.width, o.height);
    first.depth = depth.view();
  }
  const raster::FragmentShader unused(
      [](const raster::FrameGeometry&, const raster::Fragment&) { return Vec4{}; });
  const OfScene of_scene{false, surface};
  Call pass{o, first};
  pass.why_host = call.why_host;
  FrameStats stats = draw(draws, unused, test, pass, &of_scene);
  const auto begin = std::chrono::steady_clock::now();
  stretch_depth(first.depth, o.background, targets);
  const double ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  stats.stages.push_back({"stretch depth", stats.frame_ms, stats.frame_ms + ms});
  stats.frame_ms += ms;
  return stats;
}

FrameStats Renderer::Impl::draw(std::span<raster::Draw> draws, const raster::Shading& shading,
                                const raster::Testing& test, const Call& call,
                                const OfScene* scene) {
  const FrameOptions& o = call.frame;
  const Targets& targets = call.targets;
  if (!call.part) check_targets(targets, o);
  if (scene == nullptr) {
    check_outputs(targets, false, false);
    if (!o.clip_planes.empty())
      throw Error(Errc::unsupported,
                  "clip planes are of a scene's world; a program discards fragments itself");
  }
  raster::MixedDraws mixed(draws, shading, test);
  draws = mixed.draws();
  if (const std::size_t outputs = mixed.shading().extra_count(); targets.extra.size() > outputs)
    throw Error(Errc::invalid_argument, std::to_string(targets.extra.size()) +
                                            " extra targets, but the shader has " +
                                            std::to_string(outputs) + " outputs beside its colour");
  if (targets.load && targets.keys.empty())
    throw Error(Errc::invalid_argument,
                "a pass that loads needs the visibility keys of the passes before");
  if (targets.load && (blends(draws, o.transparency) || o.samples > 1))
    throw Error(Errc::invalid_argument,
                "a pass that loads can neither blend translucent surfaces over what the passes "
                "before have drawn nor add samples to it; draw all in one pass");
  std::vector<raster::Draw> over;  // the caller's stay as they are
  if (targets.over) {
    check_over(targets, o);
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
    request.draw_noun = "instance";
    request.linear_light = scene->linear_light;
    request.surface = scene->surface;
  }
  request.wants_surface = wants_surface(targets);
  request.cuts = std::ranges::any_of(draws, [](const raster::Draw& d) { return d.cut != nullptr; });
  request.part = call.part;
  request.test = mixed.test();
  request.shading = mixed.shading();
  request.background = o.background;
  request.targets = targets;
  request.in_place = call.in_place;
  request.why_host = call.why_host;
  request.texture_bytes = textures.bytes();
  request.transparency = o.transparency;
  request.samples = o.samples;
  if (options.memory_limit != 0) {
    const Kind now{o.width, o.height, o.samples, needs_layers(request)};
    if (kind != Kind{} && kind != now) make_drawer();
    kind = now;
  }
  memory.restart_peak();
  FrameStats stats = drawer->draw(request);
  stats.peak_bytes = memory.peak();
  // A frame that the device leaves to the CPU says so itself.
  if (options.device != Device::cuda) stats.device = options.device;
  if (stats.device_why.empty()) stats.device_why = device_why;
  return stats;
}

std::optional<Pick> Renderer::pick(const SceneView& scene, const Camera& camera,
                                   const FrameOptions& frame, int x, int y, std::stop_token stop) {
  check(frame);
  if (x < 0 || x >= frame.width || y < 0 || y >= frame.height)
    throw Error(Errc::invalid_argument, "pick: pixel (" + std::to_string(x) + ", " +
                                            std::to_string(y) + ") lies outside of the frame of " +
                                            std::to_string(frame.width) + "x" +
                                            std::to_string(frame.height));
  const int x0 = x / raster::kBinSize * raster::kBinSize;
  const int y0 = y / raster::kBinSize * raster::kBinSize;
  const raster::Rect bin{x0, y0, std::min(x0 + raster::kBinSize, frame.width),
                         std::min(y0 + raster::kBinSize, frame.height)};
  Image<std::uint64_t> keys(bin.x1 - bin.x0, bin.y1 - bin.y0);
  Targets targets;
  targets.keys = keys;
  FrameOptions plain = frame;
  // Grey by depth is of the same surfaces.
  if (plain.shader == Shader::depth) {
    plain.shader = Shader::flat;
    plain.transparency.method = Transparency::none;
  }
  const parallel::Turn turn(impl_->one_at_a_time, stop);
  (void)impl_->render(scene, camera, {plain, targets, false, bin});
  const std::uint64_t key = keys(x - x0, y - y0);
  if (key == 0) return std::nullopt;
  return surface_of_key(scene, camera, frame.width, frame.height, key, x, y);
}

Image<Rgba8> render(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                    const RendererOptions& options) {
  Image<Rgba8> image(frame.width, frame.height);
  Renderer(options).render(scene, camera, frame, {.color8 = image});
  return image;
}

}  // namespace rastrum
