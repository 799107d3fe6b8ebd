#include <rastrum/render/target_checks.hpp>

#include <algorithm>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/render/scene_checks.hpp>

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
  f(t.scalars, "scalars");
}
template <class F>
void each_target_of_surface(const Targets& t, const F& f) {
  f(t.instances, "instances");
  f(t.primitives, "primitives");
  f(t.ids32, "ids32");
  f(t.instances32, "instances32");
  f(t.primitives32, "primitives32");
  f(t.barycentrics, "barycentrics");
  each_target_of_scene(t, f);
}

constexpr std::uint64_t kMost32 = 0x7fffffff;

[[noreturn]] void refuse_narrow(const char* target, const std::string& why) {
  throw Error(Errc::invalid_argument,
              std::string("the ").append(target).append(" target has 32 bits: ").append(why));
}

}  // namespace

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

void check_ids(const Targets& targets, std::span<const raster::Draw> draws) {
  if (targets.ids32.empty() && targets.primitives32.empty()) return;
  std::uint64_t primitives = targets.first_id;
  for (const raster::Draw& d : draws) primitives += d.primitive_count;
  if (primitives > kMost32)
    refuse_narrow(targets.ids32.empty() ? "primitives32" : "ids32",
                  "there are " + std::to_string(primitives) + " primitives");
}

void check_instance_ids(const Targets& targets, const SceneView& scene) {
  if (targets.instances32.empty()) return;
  for (const InstanceView& i : scene.instances)
    if (i.id && *i.id != static_cast<std::int32_t>(*i.id))
      refuse_narrow("instances32", "an instance's id is " + std::to_string(*i.id));
}

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
  require(targets.overdraw.empty() && targets.errors.empty() && targets.extra.empty() &&
              targets.linear.empty() && !wants_surface(targets) && !targets.load && !targets.over,
          "of the targets there are color8, color, depth, ids and keys, in one pass");
  require(o.tone == ToneMapping{}, "tone mapping is the CPU's");
  require(o.lights.empty(), "lights of the frame's own are the CPU's");
  require(!o.environment_behind, "an environment behind the picture is the CPU's");
  require(o.clip_planes.empty() &&
              std::ranges::all_of(scene.instances,
                                  [](const InstanceView& i) { return i.clip_planes.empty(); }),
          "clip planes need them in the host's");
}

void check_over(const Targets& targets, const FrameOptions& o) {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw Error(Errc::invalid_argument, what);
  };
  require(!targets.depth.empty(), "to draw over a picture its depth is needed");
  require(!targets.load, "a pass that loads keys knows what it draws over by them");
  require(o.samples == 1, "a picture that is drawn over has one sample a pixel");
}

}  // namespace rastrum
