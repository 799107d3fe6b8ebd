#include <rastrum/raster/transform_source.hpp>

#include <algorithm>
#include <cmath>

#include <rastrum/raster/kernels.hpp>

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

Vec4d TransformSource::clip_position(std::size_t vertex) const noexcept {
  const Vec3 p = positions_[vertex];
  const Vec4 clip = transform_point(matrix_, p);
  if (std::isfinite(clip.x) && std::isfinite(clip.y) && std::isfinite(clip.z) &&
      std::isfinite(clip.w))
    return {clip.x, clip.y, clip.z, clip.w};
  // A finite vertex whose float32 transform overflowed; a NaN or infinity stays one.
  const auto row = [&](int i) {
    return matrix64_.m[i][0] * p.x + matrix64_.m[i][1] * p.y + matrix64_.m[i][2] * p.z +
           matrix64_.m[i][3];
  };
  return {row(0), row(1), row(2), row(3)};
}

}  // namespace rastrum::raster
