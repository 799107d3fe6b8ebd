#include <rastrum/raster/shade/alpha.hpp>

#include <algorithm>
#include <atomic>

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

std::uint32_t set_material_flags(Draw& draw, const MeshView& mesh,
                                 std::span<const std::uint32_t> flags) {
  if (flags.empty()) return 0;
  std::uint32_t any = 0, all = ~0U;
  if (mesh.face_materials.empty()) {
    any = all = flags[mesh.material];
  } else if (std::equal(flags.begin() + 1, flags.end(), flags.begin())) {
    any = all = flags.front();
  } else {
    for (const std::uint32_t m : mesh.face_materials.first(mesh.triangle_count())) {
      any |= flags[m];
      all &= flags[m];
    }
  }
  if (any != all) {
    draw.face_materials = mesh.face_materials;
    draw.material_flags = flags;
  } else {
    draw.flags |= any;
  }
  return any;
}

bool has_vertex_alpha(const MeshView& mesh, parallel::Threads* exec) {
  constexpr std::size_t kGrain = 1 << 14;
  const std::span<const Vec4> colors = mesh.colors.values;
  std::atomic<bool> any = false;
  const auto look = [&](std::size_t part) {
    if (any.load(std::memory_order_relaxed)) return;
    const std::size_t begin = part * kGrain;
    // Written so that a NaN is found.
    if (!std::ranges::all_of(colors.subspan(begin, std::min(kGrain, colors.size() - begin)),
                             [](const Vec4& c) { return c.w >= 1; }))
      any.store(true, std::memory_order_relaxed);
  };
  const std::size_t parts = (colors.size() + kGrain - 1) / kGrain;
  if (exec != nullptr)
    parallel::for_each_index(*exec, parts, look);
  else
    for (std::size_t i = 0; i < parts; ++i) look(i);
  return any;
}

}  // namespace rastrum::raster
