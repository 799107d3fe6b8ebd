#include <rastrum/render/shadows.hpp>

#include <algorithm>
#include <cmath>
#include <variant>

#include <rastrum/core/elementary.hpp>
#include <rastrum/scene/fit_ranks.hpp>

namespace rastrum {
namespace {

/// A light of the camera's as one of the world.
Light in_world(Light light, const Camera& camera) {
  if (!light.of_camera) return light;
  light.of_camera = false;
  return placed(light, inverse(world_to_camera(camera)).value_or(Mat4d::identity()));
}

/// Of a picture, so that its border lies outside of what is asked for.
constexpr double kMargin = 1.01;

Vec3 across(Vec3 v) {
  return std::abs(v.x) < std::abs(v.y) ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
}

/// What the light looks through, and how wide a texel is where w is 1.
struct Eye {
  Camera camera;
  double texel = 0;
};

Eye eye_of(const SceneView& scene, const DirectionalLight& light, FitRanks* ranks) {
  Eye eye;
  eye.camera = fit_camera(scene, 1, true, light.direction, across(light.direction), ranks);
  const double height = static_cast<double>(eye.camera.orthographic_height) * kMargin;
  eye.camera.orthographic_height = static_cast<float>(height);
  eye.texel = height / kShadowSize;
  return eye;
}

Eye eye_of(const SceneView& scene, const SpotLight& light, FitRanks* ranks) {
  const Camera all = fit_camera(scene, 1, false, {0, 0, -1}, {0, 1, 0}, ranks);
  const double reach = length(all.target - light.position) + length(all.eye - all.target);
  const Vec3 d = light.direction;
  const Vec3 up = across(d);
  Eye eye;
  Camera& c = eye.camera;
  c.eye = light.position;
  c.target = light.position + Vec3d{d.x, d.y, d.z};
  c.up = {up.x, up.y, up.z};
  c.fov_rad = static_cast<float>(2 * static_cast<double>(light.outer_rad) * kMargin + 0.005);
  c.near_plane = static_cast<float>(reach / 1000);
  eye.texel = 2 * elementary::tan(static_cast<double>(c.fov_rad) / 2) / kShadowSize;
  return eye;
}

Eye eye_of(const SceneView& scene, const Light& light, FitRanks* ranks) {
  const auto* const spot = std::get_if<SpotLight>(&light.kind);
  return spot != nullptr ? eye_of(scene, *spot, ranks)
                         : eye_of(scene, std::get<DirectionalLight>(light.kind), ranks);
}

}  // namespace

bool has_shadow(const Light& light) {
  constexpr float kWidest = 1.48F;  // nearly 85°
  const auto* const spot = std::get_if<SpotLight>(&light.kind);
  return spot != nullptr ? spot->outer_rad <= kWidest
                         : std::holds_alternative<DirectionalLight>(light.kind);
}

std::span<const raster::LightShadow> Shadows::draw(const SceneView& scene, const Camera& camera,
                                                   const FrameOptions& frame,
                                                   const RendererOptions& options,
                                                   ShadowRanks* ranks) {
  shadows_.clear();
  if (!frame.shadows || std::ranges::none_of(frame.lights, has_shadow)) return {};
  own_work(ranks, [&] {
    if (renderer_) return;
    const Device device = options.device == Device::serial ? Device::serial : Device::threads;
    renderer_ = std::make_unique<Renderer>(
        RendererOptions{.device = device, .threads = options.threads, .isa = options.isa});
  });
  FrameOptions look;
  look.width = look.height = kShadowSize;
  look.shader = Shader::flat;
  look.cull = frame.cull;
  look.transparency.method = Transparency::none;
  look.clip_planes = frame.clip_planes;
  depths_.resize(std::max(depths_.size(), frame.lights.size()));
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    raster::LightShadow& shadow = shadows_.emplace_back();
    if (!has_shadow(frame.lights[i])) continue;
    const Eye eye = eye_of(scene, in_world(frame.lights[i], camera), ranks);
    own_work(ranks, [&] {
      if (depths_[i].empty()) depths_[i] = Image<float>(kShadowSize, kShadowSize);
      (void)renderer_->render(scene, eye.camera, look, {.depth = depths_[i]});
    });
    if (ranks != nullptr) ranks->meet(depths_[i]);
    shadow.depth = depths_[i].view();
    shadow.world_to_clip = world_to_clip(eye.camera, kShadowSize, kShadowSize);
    shadow.texel = eye.texel;
  }
  return shadows_;
}

}  // namespace rastrum
