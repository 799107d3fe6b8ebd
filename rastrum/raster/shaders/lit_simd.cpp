#include <rastrum/raster/shaders/lit_constants.hpp>

namespace rastrum::raster {

bool shade_lit_simd(Isa, LitModel, const LitScene&, const FrameGeometry&,
                    const std::uint64_t (&)[64], int, int, BlockColors&) noexcept {
  return false;
}

}  // namespace rastrum::raster
