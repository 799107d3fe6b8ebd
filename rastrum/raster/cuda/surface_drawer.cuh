// SPDX-License-Identifier: BSD-3-Clause
// Draws a band's pieces onto its keys: the device's own listing (by_size.cuh) or a row of the
// papers' (papers/table). The frame around it (render/cuda/frame.cuh) knows only this interface.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include <rastrum/frame.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/cover.cuh>
#include <rastrum/raster/cuda/left_pieces.cuh>
#include <rastrum/raster/cuda/pieces.cuh>
#include <rastrum/raster/cuda/split.cuh>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

/// For a drawer that shades every fragment: shade(elements, keys, colors) sets the colours of
/// fragments, given by their elements of the surface and keys. Spans of the device's.
struct FragmentColors {
  std::function<void(std::span<const std::uint32_t>, std::span<const std::uint64_t>,
                     std::span<Vec4>)>
      shade;               ///< null: no colours are wanted
  std::span<Vec4> colors;  ///< of the surface, placed like its keys; set where keys rise
};

/// Computes FragmentColors::shade; `shade` as in resolve_surface.
template <class Shade>
struct ColorOfFragment {
  SurfaceView keys;
  std::span<const std::uint32_t> element;
  std::span<const std::uint64_t> key;
  Shade shade;
  RASTRUM_HD Vec4 operator()(std::size_t k) const {
    const auto [x, y] = keys.place_of(element[k]);
    return shade(key[k], x, y);
  }
};

/// Counters of a band's kernels, in an array on the device that is 0 when the band begins.
enum BandSum : std::uint8_t {
  kDroppedSum,  ///< primitives, as in Outcomes
  kCulledSum,
  kClippedSum,
  kInvalidSum,
  kFragmentsSum,
  kLargerSum,   ///< pieces drawn by a team
  kTilesSum,    ///< tiles of large pieces
  kCoveredSum,  ///< pixels with a surface
  kLeftSum,     ///< places of LeftPieces
  kRunsSum,     ///< runs of the boxes of tested pieces
  kHeldSum,     ///< not 0: pieces of the band are still to draw, so its images are not made
  kBandSums
};
using BandSums = std::array<std::uint64_t, kBandSums>;  ///< on the host

/// The boxes in px² from which a piece is for a warp, and for blocks of threads.
struct DeviceSizes {
  std::uint64_t small_px = 128, large_px = 4000;
};

/// Keeps counters from band to band. Draws one frame at a time.
class SurfaceDrawer {
 public:
  struct Kind {
    std::string_view rasterizer, visibility;  ///< as in FrameStats
    std::string_view why;                     ///< why it was taken: the start of FrameStats::why
    std::uint64_t pixel_bytes = 0;            ///< in a band, beside keys
    bool shades = false;                      ///< it sets FragmentColors, which it needs
    bool has_samples = false;                 ///< it draws several samples a pixel
    bool leaves_pieces = false;               ///< it fills LeftPieces
  };

  virtual ~SurfaceDrawer() = default;
  [[nodiscard]] virtual Kind kind() const = 0;

  /// Draws all primitives of `scene` onto the keys of `surface`, which are those of earlier
  /// drawing, or 0. Leaves pieces with a flag of `skip` to others, in `left` where there is room
  /// and with kind().leaves_pieces. Still counts their primitives, in the BandSums at `sums` on the
  /// device. Invalid primitives draw nothing. `colors` as kind().shades says. Throws
  /// Error{out_of_memory}, and Stopped between batches. May return before it is done.
  virtual void draw(parallel::Cuda& exec, const DeviceScene<parallel::Cuda>& scene,
                    const DeviceSurface& surface, const DeviceSplit& split, std::uint32_t skip,
                    const LeftPieces& left, const FragmentColors& colors, std::uint64_t* sums) = 0;
  /// Counts from 0, even if the last frame ended early.
  virtual void begin_frame() = 0;
  /// Takes the counts of a finished band.
  virtual void end_band(const BandSums& /*sums*/) {}
  virtual void end_frame(FrameStats& stats) const = 0;
};

}  // namespace rastrum::raster
