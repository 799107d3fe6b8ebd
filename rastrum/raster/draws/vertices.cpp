// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/draws/vertices.hpp>

#include <algorithm>
#include <type_traits>

#include <rastrum/raster/kernels/kernels.hpp>

namespace rastrum::raster {

namespace {

/// Positions read at once where they are not packed or not in order.
constexpr std::size_t kPositionsAtOnce = 256;

/// Calls read(first, n, positions) for the next n positions, float32 or float64.
template <class Read>
void project_read(const MatrixVertices& m, std::size_t count, Viewport viewport, Isa isa,
                  ProjectedVertex* out, const Read& read) {
  const Kernels& kernel = kernels(isa);
  const auto each = [&](auto& positions, const auto& project) {
    for (std::size_t i = 0; i < count; i += kPositionsAtOnce) {
      const std::size_t n = std::min(kPositionsAtOnce, count - i);
      read(i, n, positions);
      project(positions, n, out + i);
    }
  };
  if (m.positions.is_wide()) {
    Vec3d positions[kPositionsAtOnce];
    each(positions, [&](const Vec3d* p, std::size_t n, ProjectedVertex* to) {
      kernel.project64(p, n, m.object_to_clip, viewport, to);
    });
  } else {
    Vec3 positions[kPositionsAtOnce];
    each(positions, [&](const Vec3* p, std::size_t n, ProjectedVertex* to) {
      kernel.project(p, n, m.object_to_clip32, viewport, to);
    });
  }
}

void project_range(const MatrixVertices& m, std::size_t begin, std::size_t end, Viewport viewport,
                   Isa isa, ProjectedVertex* out) {
  const ArrayView<Vec3>& positions = m.positions;
  if (positions.is_packed())
    return kernels(isa).project(positions.data() + begin, end - begin, m.object_to_clip32, viewport,
                                out);
  project_read(m, end - begin, viewport, isa, out, [&](std::size_t i, std::size_t n, auto* to) {
    if constexpr (std::is_same_v<decltype(to), Vec3d*>)
      positions.read_wide(begin + i, n, to);
    else
      positions.read(begin + i, n, to);
  });
}

void project_named(const MatrixVertices& m, std::span<const std::uint32_t> indices,
                   Viewport viewport, Isa isa, ProjectedVertex* out) {
  const ArrayView<Vec3>& positions = m.positions;
  project_read(m, indices.size(), viewport, isa, out, [&](std::size_t i, std::size_t n, auto* to) {
    const std::span<const std::uint32_t> some = indices.subspan(i, n);
    if constexpr (std::is_same_v<decltype(to), Vec3d*>) {
      positions.gather_wide(some, to);
    } else if (positions.is_packed()) {
      for (std::size_t k = 0; k < n; ++k) to[k] = positions.data()[some[k]];
    } else {
      positions.gather(some, to);
    }
  });
}

/// Takes runs of indices into the same copy together.
void project_named(const CopiedVertices& all, std::span<const std::uint32_t> indices,
                   Viewport viewport, Isa isa, ProjectedVertex* out) {
  const std::size_t size = all.positions.size();
  std::uint32_t own[kPositionsAtOnce];
  for (std::size_t i = 0; i < indices.size();) {
    const std::size_t first = indices[i] / size * size;
    std::size_t n = 0;
    for (; n < kPositionsAtOnce && i + n < indices.size(); ++n) {
      const std::size_t vertex = indices[i + n] - first;  // wraps for an earlier copy
      if (vertex >= size) break;
      own[n] = static_cast<std::uint32_t>(vertex);
    }
    project_named(all.copy(first / size), {own, n}, viewport, isa, out + i);
    i += n;
  }
}

}  // namespace

void VertexStage::project(std::size_t begin, std::size_t end, Viewport viewport, Isa isa,
                          ProjectedVertex* out) const noexcept {
  if (const MatrixVertices* const m = matrix())
    return project_range(*m, begin, end, viewport, isa, out);
  const CopiedVertices* const all = copies();
  if (all == nullptr) return own().project(begin, end, viewport, isa, out);
  const std::size_t size = all->positions.size();
  while (begin < end) {
    const std::size_t first = begin / size * size;
    const std::size_t stop = std::min(end, first + size);
    project_range(all->copy(first / size), begin - first, stop - first, viewport, isa, out);
    out += stop - begin;
    begin = stop;
  }
}

void VertexStage::project_indexed(std::span<const std::uint32_t> indices, Viewport viewport,
                                  Isa isa, ProjectedVertex* out) const noexcept {
  if (const MatrixVertices* const m = matrix())
    return project_named(*m, indices, viewport, isa, out);
  if (const CopiedVertices* const all = copies())
    return project_named(*all, indices, viewport, isa, out);
  for (std::size_t i = 0; i < indices.size(); ++i)
    own().project(indices[i], std::size_t{indices[i]} + 1, viewport, isa, out + i);
}

}  // namespace rastrum::raster
