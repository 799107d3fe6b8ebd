#include <rastrum/raster/draws/transform_source.hpp>

#include <algorithm>

#include <rastrum/raster/kernels/kernels.hpp>

namespace rastrum::raster {

void TransformSource::project(std::size_t begin, std::size_t end, Viewport viewport, Isa isa,
                              ProjectedVertex* out) const noexcept {
  kernels(isa).project(positions_.data() + begin, end - begin, matrix_, viewport, out);
}

void TransformSource::project_indexed(std::span<const std::uint32_t> indices, Viewport viewport,
                                      Isa isa, ProjectedVertex* out) const noexcept {
  constexpr std::size_t kGather = 256;
  Vec3 gathered[kGather];
  const Kernels& kernel = kernels(isa);
  for (std::size_t begin = 0; begin < indices.size(); begin += kGather) {
    const std::size_t n = std::min(kGather, indices.size() - begin);
    for (std::size_t i = 0; i < n; ++i) gathered[i] = positions_[indices[begin + i]];
    kernel.project(gathered, n, matrix_, viewport, out + begin);
  }
}

}  // namespace rastrum::raster
