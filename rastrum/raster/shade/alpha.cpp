#include <rastrum/raster/shade/alpha.hpp>

#include <algorithm>
#include <atomic>

#include <rastrum/raster/shade/material_kernels.hpp>

namespace rastrum::raster {
namespace {

class AlphaTest final : public FragmentTest {
 public:
  AlphaTest(const MaterialScene& scene, Isa isa) : scene_(scene), kernels_(material_kernels(isa)) {}

  std::uint64_t test(const FrameGeometry& frame, const Piece& piece, const Block& block,
                     const ShadingPoints* points) const noexcept override {
    return kernels_.alpha_test(scene_.view(), frame, id_of_key(piece.low), block.mask,
                               block.bx * kBlockSize, block.by * kBlockSize, points);
  }
  [[nodiscard]] const MaterialScene& scene() const { return scene_; }

 private:
  const MaterialScene& scene_;
  const MaterialKernels& kernels_;
};

class AlphaShader final : public BlockShader {
 public:
  AlphaShader(const BlockShader& inner, const MaterialScene* blending, float opacity)
      : inner_(inner), blending_(blending), opacity_(opacity) {}

  bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
             BlockColors& colors) const noexcept override {
    const MaterialKernels& kernel = material_kernels(isa);
    alignas(64) float alpha[64];
    AlphaMasks masks;
    if (blending_ != nullptr) {
      masks = kernel.alpha(blending_->view(), frame, block, opacity_, alpha);
    } else {
      std::fill_n(alpha, 64, opacity_);
      if (opacity_ > 0) masks.visible = block.covered;
      if (opacity_ == 1) masks.opaque = block.covered;
    }
    if (masks.opaque == block.covered) return inner_.shade(frame, block, isa, colors);
    if (masks.visible == 0) {
      colors = {};
      return false;
    }
    VisibleBlock visible = block;
    visible.covered = masks.visible;
    if (inner_.shade(frame, visible, isa, colors)) std::fill_n(colors.a, 64, 1.0F);
    kernel.premultiply(alpha, colors);
    return false;
  }

  void prefetch(const FrameGeometry& frame, std::uint64_t id) const noexcept override {
    inner_.prefetch(frame, id);
  }
  [[nodiscard]] std::optional<float> alpha() const noexcept override {
    const std::optional<float> own = inner_.alpha();
    return own && blending_ == nullptr ? std::optional(*own * opacity_) : std::nullopt;
  }
  [[nodiscard]] std::size_t scratch_bytes() const noexcept override {
    return inner_.scratch_bytes();
  }
  [[nodiscard]] AlphaForm form() const { return {&inner_, blending_, opacity_}; }

 private:
  const BlockShader& inner_;
  const MaterialScene* blending_;
  float opacity_;
};

}  // namespace

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

std::unique_ptr<FragmentTest> make_alpha_test(const MaterialScene& scene, Isa isa) {
  return std::make_unique<AlphaTest>(scene, isa);
}

std::unique_ptr<BlockShader> make_alpha_shader(const BlockShader& inner,
                                               const MaterialScene* blending, float opacity) {
  return std::make_unique<AlphaShader>(inner, blending, opacity);
}

std::optional<AlphaForm> alpha_form(const BlockShader& shader) {
  const auto* const alpha = dynamic_cast<const AlphaShader*>(&shader);
  return alpha == nullptr ? std::nullopt : std::optional(alpha->form());
}

const MaterialScene* alpha_test_form(const FragmentTest& test) {
  const auto* const alpha = dynamic_cast<const AlphaTest*>(&test);
  return alpha == nullptr ? nullptr : &alpha->scene();
}

}  // namespace rastrum::raster
