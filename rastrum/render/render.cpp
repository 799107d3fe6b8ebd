#include <rastrum/render.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/turn.hpp>
#include <rastrum/program.hpp>
#include <rastrum/raster/draws/mixed_draws.hpp>
#include <rastrum/raster/shade/alpha.hpp>
#include <rastrum/raster/shade/interpolate.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/shade/texture.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/render/surfaces.hpp>

namespace rastrum {
namespace {

void check_attribute(std::size_t values, std::span<const std::uint32_t> indices,
                     const MeshView& mesh, std::size_t instance, const char* what) {
  if (values == 0) return;
  const auto fail = [&](const std::string& problem) {
    throw Error(Errc::invalid_argument,
                "instance " + std::to_string(instance) + ": " + what + " " + problem);
  };
  if (indices.empty()) {
    if (values < mesh.positions.size())
      fail("are fewer (" + std::to_string(values) + ") than positions (" +
           std::to_string(mesh.positions.size()) + ")");
    return;
  }
  if (indices.size() < mesh.triangle_count() * 3) fail("have fewer indices than the triangles");
  for (const std::uint32_t i : indices)
    if (i >= values)
      fail("index " + std::to_string(i) + " is out of range, there are " + std::to_string(values));
}

/// Attributes are read only where a triangle is seen, so their indices are checked before the
/// frame.
void check_attributes(const SceneView& scene) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (scene.instances[i].mesh() == nullptr) continue;
    const MeshView& mesh = *scene.instances[i].mesh();
    check_attribute(mesh.normals.values.size(), mesh.normals.indices, mesh, i, "normals");
    check_attribute(mesh.texcoords.values.size(), mesh.texcoords.indices, mesh, i, "texcoords");
    check_attribute(mesh.colors.values.size(), mesh.colors.indices, mesh, i, "colors");
  }
}

template <class T>
void check_target(const ImageView<T>& view, const FrameOptions& options, const char* what) {
  check_size(view, options.width, options.height, std::string("the ").append(what) + " target");
}

void check_targets(const Targets& targets, const FrameOptions& o) {
  check_target(targets.color8, o, "color8");
  check_target(targets.color, o, "color");
  check_target(targets.depth, o, "depth");
  check_target(targets.ids, o, "ids");
  check_target(targets.overdraw, o, "overdraw");
  check_target(targets.keys, o, "keys");
  check_target(targets.errors, o, "errors");
  for (const ImageView<Vec4>& extra : targets.extra) {
    if (extra.empty()) throw Error(Errc::invalid_argument, "an extra target is empty");
    check_target(extra, o, "extra");
  }
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
  require(o.opacity == 1 && o.samples == 1, "surfaces must be opaque, with one sample a pixel");
  require(targets.overdraw.empty() && targets.errors.empty() && targets.extra.empty() &&
              !targets.load && !targets.over,
          "of the targets there are color8, color, depth, ids and keys, in one pass");
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
}

struct Renderer::Impl {
  Impl(RendererOptions given, DeviceChoice choice, bool plain, MakeFrameDrawer maker);

  /// What a caller wants of one frame. `in_place`: its arrays are memory of a GPU.
  struct Call {
    const FrameOptions& frame;
    const Targets& targets;
    bool in_place = false;
  };
  FrameStats render(const SceneView& scene, const Camera& camera, const Call& call);
  FrameStats draw_depth(std::span<raster::Draw> draws, const raster::Testing& test,
                        const Call& call);
  FrameStats draw(std::span<raster::Draw> draws, const raster::Shading& shading,
                  const raster::Testing& test, const Call& call, std::string_view noun = "draw",
                  bool linear_light = false);

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
  return impl_->render(scene, camera, {frame, targets});
}

FrameStats Renderer::render_in_place(const SceneView& scene, const Camera& camera,
                                     const FrameOptions& frame, const Targets& targets,
                                     std::stop_token stop) {
  const parallel::Turn turn(impl_->one_at_a_time, stop);
  return impl_->render(scene, camera, {frame, targets, impl_->options.device == Device::cuda});
}

FrameStats RendererAccess::draw(Renderer& renderer, std::span<raster::Draw> draws,
                                const raster::Shading& shading, const raster::Testing& test,
                                const FrameOptions& frame, const Targets& targets,
                                std::stop_token stop) {
  Renderer::Impl& impl = *renderer.impl_;
  const parallel::Turn turn(impl.one_at_a_time, stop);
  return impl.draw(draws, shading, test, {frame, targets});
}

FrameStats Renderer::draw(std::span<const raster::ProgramDraw> draws, const FrameOptions& frame,
                          const Targets& targets, std::stop_token stop) {
  std::vector<raster::Draw> own(draws.begin(), draws.end());
  return RendererAccess::draw(*this, own, {}, {}, frame, targets, std::move(stop));
}

FrameStats Renderer::Impl::render(const SceneView& scene, const Camera& camera, const Call& call) {
  const FrameOptions& o = call.frame;
  check(o);
  const Shader taken = shader_for(o.shader, scene);
  if (call.in_place)
    check_in_place(scene, call.targets, taken, o);
  else
    check_attributes(scene);
  raster::check_materials(scene);
  check_surfaces(scene);
  const Mat4d to_clip = world_to_clip(camera, o.width, o.height);
  std::vector<raster::Draw> draws;
  draws.reserve(scene.instances.size());
  const bool blends = o.transparency.method != Transparency::none && taken != Shader::depth;
  const bool all_translucent = blends && o.opacity < 1;
  const std::vector<std::uint32_t> material_flags = raster::material_flags(scene.materials, blends);
  std::uint32_t any_flags = 0;  // of materials and vertex colours
  std::uint32_t any_surface_flags = 0;
  SceneView meshes = scene;
  const std::vector<InstanceView> mesh_list = mesh_instances(scene);
  meshes.instances = mesh_list;
  std::optional<raster::LitModel> model;
  if (taken != Shader::material) model = lit_model(taken);
  SurfaceDraws surfaces(scene, {model, blends, o.opacity}, camera, o.width, o.height);
  for (const InstanceView& instance : scene.instances) {
    raster::Draw& draw = draws.emplace_back();
    if (surfaces.add(instance, to_clip, draw)) {
      any_surface_flags |= draw.flags;
      continue;
    }
    const MeshView& mesh = *instance.mesh();
    draw.source = raster::MatrixVertices(mesh.positions, to_clip * instance.object_to_world);
    draw.vertex_count = mesh.positions.size();
    draw.indices = mesh.indices;
    draw.primitive_count = mesh.triangle_count();
    draw.cull = material_cull(instance, scene.materials, taken);
    std::uint32_t flags = raster::set_material_flags(draw, mesh, material_flags);
    if (blends && scene.materials.empty() && !call.in_place &&
        raster::has_vertex_alpha(mesh, threads.get())) {
      draw.flags |= raster::kTranslucent;
      flags |= raster::kTranslucent;
    }
    if (all_translucent) draw.flags |= raster::kTranslucent;
    any_flags |= flags;
  }
  const bool any_mask = (any_flags & raster::kTested) != 0;
  const bool any_blend = (any_flags & raster::kTranslucent) != 0;
  const bool is_translucent =
      all_translucent || any_blend || (any_surface_flags & raster::kTranslucent) != 0;
  const bool shades_materials = taken == Shader::material;
  std::optional<raster::MaterialScene> materials;
  if (shades_materials || any_mask || any_blend) {
    textures.update(scene.textures, raster::texture_uses(scene, shades_materials, any_blend),
                    threads.get());
    materials.emplace(meshes, camera, o.width, o.height, textures);
  }
  raster::Testing test;
  if (any_mask) test = raster::MaskTest{&*materials};
  const auto named = [&](FrameStats stats) {
    stats.shader = name(taken);
    return stats;
  };
  if (taken == Shader::depth) return named(draw_depth(draws, test, call));
  const bool linear = is_translucent && shades_materials;
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
  return named(draw(draws, shading, test, call, "instance", linear));
}

/// Grey by depth needs the range of depths in the picture, so it is a pass after the frame.
FrameStats Renderer::Impl::draw_depth(std::span<raster::Draw> draws, const raster::Testing& test,
                                      const Call& call) {
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
  FrameStats stats = draw(draws, unused, test, {o, first}, "instance");
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
                                std::string_view noun, bool linear_light) {
  const FrameOptions& o = call.frame;
  const Targets& targets = call.targets;
  check(o);
  check_targets(targets, o);
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
  request.draw_noun = noun;
  request.test = mixed.test();
  request.shading = mixed.shading();
  request.background = o.background;
  request.targets = targets;
  request.in_place = call.in_place;
  request.texture_bytes = textures.bytes();
  request.transparency = o.transparency;
  request.samples = o.samples;
  request.linear_light = linear_light;
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

Image<Rgba8> render(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                    const RendererOptions& options) {
  Image<Rgba8> image(frame.width, frame.height);
  Renderer(options).render(scene, camera, frame, {.color8 = image});
  return image;
}

}  // namespace rastrum
