#include <rastrum/raster/draws/vertices.hpp>

#include <algorithm>

#include <rastrum/raster/kernels/kernels.hpp>

namespace rastrum::raster {

void VertexStage::project(std::size_t begin, std::size_t end, Viewport viewport, Isa isa,
                          ProjectedVertex* out) const noexcept {
  if (const MatrixVertices* const m = matrix())
    kernels(isa).project(m->positions.data() + begin, end - begin, m->object_to_clip32, viewport,
                         out);
  else
    own().project(begin, end, viewport, isa, out);
}

void VertexStage::project_indexed(std::span<const std::uint32_t> indices, Viewport viewport,
                                  Isa isa, ProjectedVertex* out) const noexcept {
  const MatrixVertices* const m = matrix();
  if (m == nullptr) {
    for (std::size_t i = 0; i < indices.size(); ++i)
      own().project(indices[i], std::size_t{indices[i]} + 1, viewport, isa, out + i);
    return;
  }
  constexpr std::size_t kGather = 256;
  Vec3 gathered[kGather];
  const Kernels& kernel = kernels(isa);
  for (std::size_t begin = 0; begin < indices.size(); begin += kGather) {
    const std::size_t n = std::min(kGather, indices.size() - begin);
    for (std::size_t i = 0; i < n; ++i) gathered[i] = m->positions[indices[begin + i]];
    kernel.project(gathered, n, m->object_to_clip32, viewport, out + begin);
  }
}

}  // namespace rastrum::raster
