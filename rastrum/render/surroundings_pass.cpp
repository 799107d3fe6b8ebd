// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/surroundings_pass.hpp>

#include <cstddef>

#include <rastrum/core/reject.hpp>
#include <rastrum/error.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/render/around.hpp>

namespace rastrum {

bool SurroundingsPass::wanted(const FrameOptions& frame, const Targets& targets, const Pass& pass) {
  if (!frame.environment_behind) return false;
  if (!has_environment(frame.lights))
    reject("the frame's lights have no environment that could be seen behind");
  if (pass.over || pass.load)
    throw Error(Errc::unsupported,
                "an environment is behind a whole picture, not one over another");
  return !targets.color8.empty() || !targets.color.empty() || !targets.linear.empty();
}

Targets SurroundingsPass::targets(const FrameOptions& frame, const Targets& asked) {
  Targets all = asked;
  if (!asked.color8.empty() && asked.color.empty()) {
    own_color_ = Image<Vec4>(frame.width, frame.height);
    all.color = own_color_.view();
  }
  all.color8 = {};
  color_ = all.color;
  return all;
}

void SurroundingsPass::draw(const FrameOptions& frame, const Camera& camera, const Targets& asked,
                            parallel::Threads* threads) const {
  const Around around(frame.lights, frame.tone, camera, frame.width, frame.height);
  const raster::ViewRays rays = raster::ViewRays::of(camera, frame.width, frame.height);
  const auto behind = [](Vec4 c, Vec3 light) {
    const float left = 1 - c.w;
    return Vec4{c.x + light.x * left, c.y + light.y * left, c.z + light.z * left, c.w + left};
  };
  const auto row = [&](std::size_t place) {
    const int y = static_cast<int>(place);
    for (int x = 0; x < frame.width; ++x) {
      const float alpha = color_.empty() ? asked.linear(x, y).w : color_(x, y).w;
      if (alpha < 1) {
        const Vec3 seen = rays.d + rays.dx * (static_cast<float>(x) + 0.5F) +
                          rays.dy * (static_cast<float>(y) + 0.5F);
        const Vec3 light = around.light(seen);
        if (!color_.empty()) color_(x, y) = behind(color_(x, y), around.shown(light));
        if (!asked.linear.empty()) asked.linear(x, y) = behind(asked.linear(x, y), light);
      }
      if (!asked.color8.empty()) asked.color8(x, y) = raster::to_straight_rgba8(color_(x, y));
    }
  };
  parallel::for_each_index(threads, static_cast<std::size_t>(frame.height), row, 8);
}

}  // namespace rastrum
