// The papers' rasterizers on a device, for who draws with them: the rows of both axes by their
// names, and the driver around them. The rows are compiled once, in family.cu and visibilities.cu.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include <rastrum/raster/cuda/family/frame.cuh>
#include <rastrum/raster/cuda/rasterizer.cuh>

namespace rastrum::raster::family {

template <class Exec>
struct CoverageOnDevice {
  std::string_view name;
  /// Enumerates pieces that have a sample in the frame's view into FamilyFrame::emit.
  void (*draw)(FamilyFrame<Exec>&, std::span<const Piece>) = nullptr;
};

template <class Exec>
struct VisibilityOnDevice {
  std::string_view name;
  std::uint64_t pixel_bytes = 0;  ///< of a band, beside its keys
  bool shades = false;            ///< sets Shading::colors
  std::unique_ptr<DeviceVisibility<Exec>> (*make)(FamilyFrame<Exec>&) = nullptr;
};

template <class Exec>
[[nodiscard]] std::span<const VisibilityOnDevice<Exec>> visibilities_on_device();

/// A point of the table.
template <class Exec>
struct Point {
  const CoverageOnDevice<Exec>* coverage = nullptr;
  const VisibilityOnDevice<Exec>* visibility = nullptr;
};

/// Throws Error{invalid_argument} where a device has no row of that name.
template <class Exec>
[[nodiscard]] Point<Exec> point_of(std::string_view coverage, std::string_view visibility);

/// As draw_surface (rasterizer.cuh), by a point of the family; of the counts `sum`, `fragments` and
/// `batches` are filled, and the rows' own are added to `counters`. `tuning` is one that the host's
/// row takes.
template <class Exec>
[[nodiscard]] DeviceCounts draw_surface(Exec& exec, const DeviceScene<Exec>& scene,
                                        const DeviceSurface& surface, const DevicePlan& plan,
                                        const Point<Exec>& point, const Tuning& tuning,
                                        std::uint32_t skip, const Shading& shading,
                                        Counters& counters);

/// What Shading::shade is made of: `shade` as resolve_surface takes it.
template <class Shade>
struct ColorOfFragment {
  SurfaceView keys;
  std::span<const std::uint32_t> element;
  std::span<const std::uint64_t> key;
  Shade shade;
  RASTRUM_HD Vec4 operator()(std::size_t k) const {
    const auto columns = static_cast<std::size_t>(keys.columns);
    const std::size_t block = element[k] / 64;
    const int i = static_cast<int>(element[k] % 64);
    const int bx = keys.bx0 + static_cast<int>(block % columns);
    const int by = keys.by0 + static_cast<int>(block / columns);
    return shade(key[k], bx * kBlockSize + i % kBlockSize, by * kBlockSize + i / kBlockSize);
  }
};

}  // namespace rastrum::raster::family
