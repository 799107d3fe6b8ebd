#include <rastrum/raster/shaders/alpha_test.hpp>

#include <algorithm>

#include <rastrum/raster/shaders/material_kernels.hpp>

namespace rastrum::raster {
namespace {

class AlphaTest final : public FragmentTest {
 public:
  AlphaTest(const MaterialScene& scene, Isa isa) : scene_(scene), kernels_(material_kernels(isa)) {}

  std::uint64_t test(const FrameGeometry& frame, const Piece& piece, const Block& block,
                     const ShadingPoints*) const noexcept override {
    return kernels_.alpha_test(scene_, frame, id_of_word(piece.low), block.mask,
                               block.bx * kBlockSize, block.by * kBlockSize);
  }

 private:
  const MaterialScene& scene_;
  const MaterialKernels& kernels_;
};

}  // namespace

std::vector<std::uint32_t> material_flags(std::span<const Material> materials) {
  std::vector<std::uint32_t> flags;
  flags.reserve(materials.size());
  for (const Material& m : materials)
    flags.push_back(m.alpha_mode == AlphaMode::mask ? kTested : 0U);
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

std::unique_ptr<FragmentTest> make_alpha_test(const MaterialScene& scene, Isa isa) {
  return std::make_unique<AlphaTest>(scene, isa);
}

}  // namespace rastrum::raster
