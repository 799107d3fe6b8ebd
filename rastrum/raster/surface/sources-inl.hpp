// SPDX-License-Identifier: BSD-3-Clause
// Where in memory the corners of visible triangles lie. Lanes follow pointers to them, a triangle a
// lane.
#if defined(RASTRUM_RASTER_SURFACE_SOURCES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SURFACE_SOURCES_INL_HPP
#undef RASTRUM_RASTER_SURFACE_SOURCES_INL_HPP
#else
#define RASTRUM_RASTER_SURFACE_SOURCES_INL_HPP
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

#include <rastrum/mesh.hpp>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/surface/seen_triangles-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

struct CornerSources {
  const float* vertex[3][kLanes];    ///< ProjectedVertex
  const float* position[3][kLanes];  ///< 16 bytes may be read, so some of the next
  const float* normal[3][kLanes];
  /// Copies of what cannot be read in place: a vertex or a position, and a normal.
  alignas(16) float place_copy[3][kLanes][4];
  alignas(16) float normal_copy[3][kLanes][4];
};

/// An attribute of a mesh whose values lanes can read in place.
struct PackedValues {
  const float* data = nullptr;             ///< null: the mesh has none
  const std::uint32_t* indices = nullptr;  ///< by corner; null: the vertices'
  std::size_t last = 0;

  /// Returns whether lanes can read it, or the mesh has none.
  template <class T>
  HWY_INLINE bool look_at(const AttributeView<T>& attribute) {
    *this = {};
    if (attribute.empty()) return true;
    const bool is_indexed = !attribute.indices.empty();
    if (!attribute.values.is_packed()) return false;
    if (is_indexed ? !attribute.indices.is_packed() : attribute.per != Per::vertex) return false;
    if (is_indexed) indices = attribute.indices.data();
    data = &attribute.values.data()->x;
    last = attribute.values.size() - 1;
    return true;
  }
  [[nodiscard]] HWY_INLINE std::size_t number(std::uint64_t corner, std::uint32_t vertex) const {
    return indices != nullptr ? indices[corner] : vertex;
  }
  /// Three floats. The last value is copied: 16 bytes are read, and nothing behind it may be.
  [[nodiscard]] HWY_INLINE const float* at(std::size_t i, float (&copy)[4]) const {
    if (i != last) return data + i * 3;
    std::copy_n(data + i * 3, 3, copy);
    return copy;
  }
  HWY_INLINE void prefetch(std::uint64_t corner) const {
    if (indices != nullptr) __builtin_prefetch(indices + corner);
  }
};

/// Finds the draws of triangles in sequence, which are mostly the same. `Look` is what shading
/// knows about a draw: its `mesh`.
template <class Look>
class DrawFinder {
 protected:
  explicit HWY_INLINE DrawFinder(const FrameGeometry& frame) : frame_(frame) {}

  [[nodiscard]] HWY_INLINE bool is_other(std::uint64_t id) const {
    return draw_ == nullptr || id - draw_->first_id >= draw_->primitive_count;
  }
  /// Begins with another draw. Returns whether it draws its mesh's triangles in order, with
  /// vertices and indices that lanes can read.
  HWY_INLINE bool begin(const Draw& draw, const Look& look) {
    draw_ = &draw;
    look_ = &look;
    projected_ = frame_.projected_of(draw);
    words_ = {};
    const MeshView& mesh = *look.mesh;
    if (draw.is_copied() || mesh.faces.kind != FaceKind::triangles) return false;
    if (!mesh.indices.empty()) words_ = mesh.indices.words();
    return projected_ != nullptr && (mesh.indices.empty() || words_.first != nullptr);
  }
  /// The vertices of the triangle with corners `corner` to corner + 2.
  HWY_INLINE void vertices(std::uint64_t corner, std::uint32_t (&out)[3]) const {
    for (std::size_t c = 0; c < 3; ++c) {
      out[c] = static_cast<std::uint32_t>(corner + c);
      if (words_.first != nullptr) std::memcpy(&out[c], word(corner + c), sizeof out[c]);
    }
  }
  [[nodiscard]] HWY_INLINE const float* projected(std::uint32_t vertex) const {
    return reinterpret_cast<const float*>(projected_ + vertex);
  }
  HWY_INLINE void prefetch_indices(std::uint64_t corner) const {
    if (words_.first != nullptr) __builtin_prefetch(word(corner));
  }

  const FrameGeometry& frame_;
  const Draw* draw_ = nullptr;
  const Look* look_ = nullptr;

 private:
  [[nodiscard]] HWY_INLINE const std::byte* word(std::uint64_t corner) const {
    return words_.first + static_cast<std::ptrdiff_t>(corner) * words_.stride;
  }

  const ProjectedVertex* projected_ =
      nullptr;                ///< null: vertices are projected where they are read
  IndexView::Words words_{};  ///< null: vertices in order
};

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SURFACE_SOURCES_INL_HPP
