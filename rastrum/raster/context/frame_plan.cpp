// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/context/frame_plan.hpp>

#include <rastrum/core/srgb.hpp>

namespace rastrum::raster {
namespace {

bool has_kind(const Targets& targets, TargetKind kind) {
  return has_target(targets, [kind](const auto& row) { return row.kind == kind; });
}

}  // namespace

Backdrop backdrop_of(Vec4 b, bool linear_light) {
  Backdrop backdrop = Backdrop::of(b);
  if (!linear_light) return backdrop;
  if (b.w != 0)
    for (float* const channel : {&b.x, &b.y, &b.z})
      *channel = static_cast<float>(linear_from_srgb(static_cast<double>(*channel)));
  backdrop.color = premultiplied_from_straight(b);
  backdrop.linear = true;
  return backdrop;
}

FramePlan FramePlan::of(const FrameRequest& request, bool method_shades, bool limits_memory) {
  // Last-level caches hold smaller pictures until they are read next.
  constexpr std::uint64_t kLarge = std::uint64_t{24} << 20;
  const Targets& t = request.targets;
  FramePlan plan;
  plan.drawn = request.part.value_or(Rect{0, 0, request.width, request.height});
  plan.writes = request.pass.load   ? Writes::nearer
                : request.pass.over ? Writes::surfaces
                                    : Writes::all;
  if (request.sink != nullptr) plan.translucent = request.sink->fate;
  plan.keys = has_kind(t, TargetKind::key);
  plan.surface = wants_surface(t);
  plan.normals = has_kind(t, TargetKind::normal);
  plan.tests = request.has_tests();
  plan.hides = t.overdraw.empty();
  plan.backdrop = backdrop_of(request.background, request.linear_light);
  plan.background = premultiplied_from_straight(request.background);
  const bool has_colors = has_kind(t, TargetKind::color), has_extra = !t.extra.empty();
  plan.stores = has_colors || has_extra || plan.keys || plan.surface;
  if (!has_colors) return plan;
  plan.streams = !t.color8.empty() && plan.writes == Writes::all &&
                 static_cast<std::uint64_t>(t.color8.width) *
                         static_cast<std::uint64_t>(t.color8.height) * sizeof(Rgba8) >=
                     kLarge;
  plan.colors = Colors::method;
  if (method_shades) return plan;
  // The memory limit's plan does not count a bin's triangles. Normals are filled by block.
  const bool by_bin = !limits_memory && !request.pass.load && !has_extra && !plan.normals;
  plan.colors = by_bin ? Colors::bin : Colors::block;
  plan.at_once = t.color.empty() && t.linear.empty() && !has_extra && !plan.normals &&
                 plan.writes != Writes::surfaces && !request.linear_light;
  return plan;
}

}  // namespace rastrum::raster
