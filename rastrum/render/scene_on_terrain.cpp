// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/on_terrain.hpp>

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <rastrum/core/no_memory.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/turn.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/render/terrain_camera.hpp>
#include <rastrum/render/tone_pass.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/transform.hpp>

namespace rastrum {

struct SceneOnTerrain::Impl {
  explicit Impl(Renderer given) : renderer(std::move(given)) {
    const RendererOptions& o = renderer.options();
    if (o.device == Device::threads) threads.emplace(o.threads);
  }

  template <class Row>
  void for_each_row(const Row& row) {
    const auto call = [&](std::size_t y) {
      if (!threads) throw_if_stopped();  // as loops on threads do
      row(static_cast<int>(y));
    };
    parallel::for_each_index(threads ? &*threads : nullptr,
                             static_cast<std::size_t>(depth.height()), call);
  }
  /// Throws if the shader has no linear light to map.
  [[nodiscard]] static bool maps_light(const SceneView& scene, const FrameOptions& frame) {
    if (frame.tone == ToneMapping{}) return false;
    const Shader taken = shader_for(frame.shader, scene);
    if (taken != Shader::material)
      reject(
          "meshes on ground with tone mapping need the shader 'material', which has linear light, "
          "not '",
          name(taken), "'");
    return true;
  }

  std::mutex one_at_a_time;
  Renderer renderer;
  std::optional<parallel::Threads> threads;  ///< none: serial
  Image<float> depth;                        ///< reversed
  Image<Vec4> linear;                        ///< of a frame whose tone is mapped
  std::vector<InstanceView> instances;
};

SceneOnTerrain::SceneOnTerrain(Renderer renderer)
    : impl_("SceneOnTerrain",
            in_memory([&] { return std::make_unique<Impl>(std::move(renderer)); })) {}
SceneOnTerrain::~SceneOnTerrain() = default;
SceneOnTerrain::SceneOnTerrain(SceneOnTerrain&&) noexcept = default;
SceneOnTerrain& SceneOnTerrain::operator=(SceneOnTerrain&&) noexcept = default;

FrameStats SceneOnTerrain::draw(const TerrainScene& given, const FrameOptions& frame,
                                const terrain::TerrainOptions& options,
                                const terrain::TerrainCamera& camera,
                                const terrain::TerrainTargets& picture, StopToken stop) {
  return parallel::in_turn(impl_->one_at_a_time, stop, [&] {
    const int width = frame.width, height = frame.height;
    if (options.width != width || options.height != height)
      reject("what stands on a terrain is drawn at ", width, "x", height, ", the terrain at ",
             options.width, "x", options.height,
             "; give FrameOptions and TerrainOptions the same size");
    if (picture.depth.empty())
      reject("meshes on a terrain need its depth: draw both with TerrainTargets::depth");
    check_size(picture.depth, width, height, "the depth target");
    check_size(picture.color8, width, height, "the color8 target");
    Image<float>& depth = impl_->depth;
    Image<Vec4>& linear = impl_->linear;
    if (depth.width() != width || depth.height() != height) depth = Image<float>(width, height);
    std::vector<InstanceView>& instances = impl_->instances;
    instances.assign(given.scene.instances.begin(), given.scene.instances.end());
    for (const std::size_t i : given.facing) {
      if (i >= instances.size())
        reject("there is no instance with the number ", i, " that is to face the camera");
      // The terrain's camera turns the same way: 0 faces +z, the south.
      instances[i].object_to_world =
          instances[i].object_to_world * rotation(rotation_about({0, 1, 0}, camera.angle_rad));
    }
    SceneView scene = given.scene;
    scene.instances = instances;

    if (frame.environment_behind)
      draw_environment_behind(frame.lights, frame.tone, options, camera, picture,
                              impl_->threads ? impl_->renderer.options().threads : 1);
    impl_->for_each_row([&](int y) {
      for (int x = 0; x < width; ++x)
        depth(x, y) = terrain::reversed_depth(picture.depth(x, y), kNear);
    });
    Targets targets;
    targets.depth = depth.view();
    FrameOptions over = frame;
    over.environment_behind = false;
    over.tone = {};
    if (!impl_->maps_light(scene, frame)) {
      targets.color8 = picture.color8;
    } else {
      // Draws linear light over nothing. It is mapped, then laid over the ground.
      if (linear.width() != width || linear.height() != height) linear = Image<Vec4>(width, height);
      std::ranges::fill(linear.pixels(), Vec4{});
      targets.linear = linear.view();
    }
    FrameStats stats =
        impl_->renderer.render(scene, terrain_lens(options, camera), over, targets, {.over = true});
    if (!targets.linear.empty() && !picture.color8.empty()) {
      const ToneCurve curve(frame.tone);
      impl_->for_each_row([&](int y) {
        for (int x = 0; x < width; ++x) {
          if (!(linear(x, y).w > 0)) continue;
          const Vec4 light = raster::straight_from_premultiplied(linear(x, y));
          const Vec3 display = curve({light.x, light.y, light.z});
          const Vec4 front =
              raster::premultiplied_from_straight({display.x, display.y, display.z, light.w});
          const raster::Backdrop ground =
              raster::Backdrop::of(raster::straight_from_rgba8(picture.color8(x, y)));
          picture.color8(x, y) = ground.color8_over(front);
        }
      });
    }
    impl_->for_each_row([&](int y) {
      for (int x = 0; x < width; ++x)
        // Depths of the terrain keep their bits.
        if (depth(x, y) != terrain::reversed_depth(picture.depth(x, y), kNear))
          picture.depth(x, y) = static_cast<float>(kNear / static_cast<double>(depth(x, y)));
    });
    return stats;
  });
}

}  // namespace rastrum
