// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/alpha.hpp>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <type_traits>

namespace rastrum::raster {

std::vector<std::uint32_t> material_flags(std::span<const Material> materials, bool blends) {
  std::vector<std::uint32_t> flags;
  flags.reserve(materials.size());
  for (const Material& m : materials) {
    const bool translucent = blends && (m.alpha_mode == AlphaMode::blend || m.opacity < 1);
    flags.push_back((m.alpha_mode == AlphaMode::mask ? kTested : 0U) |
                    (translucent ? kTranslucent : 0U));
  }
  return flags;
}

namespace {

/// Calls f(values, n) for runs of a view; packed values are not copied.
template <class View, class F>
void for_each_run(const View& view, std::size_t begin, std::size_t end, const F& f) {
  if (view.is_packed()) return f(view.data() + begin, end - begin);
  std::remove_cvref_t<decltype(view[0])> values[256];
  for (std::size_t i = begin; i < end; i += std::size(values)) {
    const std::size_t n = std::min(std::size(values), end - i);
    view.read(i, n, values);
    f(values, n);
  }
}

}  // namespace

std::uint32_t set_material_flags(Draw& draw, const InstanceView& instance,
                                 std::span<const std::uint32_t> flags) {
  if (flags.empty()) return 0;
  const MeshView& mesh = *instance.mesh();
  std::uint32_t any = 0, all = ~0U;
  if (instance.material || mesh.face_materials.empty()) {
    any = all = flags[instance.material.value_or(mesh.material)];
  } else if (std::equal(flags.begin() + 1, flags.end(), flags.begin())) {
    any = all = flags.front();
  } else {
    for_each_run(mesh.face_materials, 0, mesh.face_count(),
                 [&](const std::uint32_t* materials, std::size_t n) {
                   for (std::size_t i = 0; i < n; ++i) {
                     any |= flags[materials[i]];
                     all &= flags[materials[i]];
                   }
                 });
  }
  if (any != all) {
    draw.face_materials = mesh.face_materials;
    draw.material_flags = flags;
  } else {
    draw.flags |= any;
  }
  return any;
}

bool has_color_alpha(const InstanceView& instance, const ArrayView<Vec4>& colors,
                     parallel::Threads* exec) {
  // Finds a NaN, too.
  const auto is_opaque = [](const Vec4& c) { return c.w >= 1; };
  if (instance.color) return !is_opaque(*instance.color);
  constexpr std::size_t kGrain = 1 << 14;
  std::atomic<bool> any = false;
  const auto look = [&](std::size_t part) {
    if (any.load(std::memory_order_relaxed)) return;
    const std::size_t begin = part * kGrain;
    for_each_run(colors, begin, std::min(begin + kGrain, colors.size()),
                 [&](const Vec4* some, std::size_t n) {
                   if (!std::all_of(some, some + n, is_opaque))
                     any.store(true, std::memory_order_relaxed);
                 });
  };
  const std::size_t parts = (colors.size() + kGrain - 1) / kGrain;
  if (exec != nullptr)
    parallel::for_each_index(*exec, parts, look);
  else
    for (std::size_t i = 0; i < parts; ++i) look(i);
  return any;
}

}  // namespace rastrum::raster
