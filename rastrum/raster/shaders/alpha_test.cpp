#include <rastrum/raster/shaders/alpha_test.hpp>

#include <algorithm>

#include <rastrum/raster/shaders/material_kernels.hpp>

namespace rastrum::raster {
namespace {

class AlphaTest final : public FragmentTest {
 public:
  AlphaTest(const MaterialScene& scene, Isa isa) : scene_(scene), kernels_(material_kernels(isa)) {}

  std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                     const Block& block) const noexcept override {
    return kernels_.alpha_test(scene_, frame, id_of_word(piece.low), block.mask,
                               block.bx * kBlockSize, block.by * kBlockSize);
  }

 private:
  const MaterialScene& scene_;
  const MaterialKernels& kernels_;
};

}  // namespace

bool has_mask(const MeshView& mesh, std::span<const Material> materials) {
  const auto is_mask = [&](std::uint32_t m) { return materials[m].alpha_mode == AlphaMode::mask; };
  if (std::none_of(materials.begin(), materials.end(),
                   [](const Material& m) { return m.alpha_mode == AlphaMode::mask; }))
    return false;
  if (mesh.face_materials.empty()) return is_mask(mesh.material);
  const auto faces = mesh.face_materials.first(mesh.triangle_count());
  return std::any_of(faces.begin(), faces.end(), is_mask);
}

std::unique_ptr<FragmentTest> make_alpha_test(const MaterialScene& scene, Isa isa) {
  return std::make_unique<AlphaTest>(scene, isa);
}

}  // namespace rastrum::raster
