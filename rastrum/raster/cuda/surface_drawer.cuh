// SPDX-License-Identifier: BSD-3-Clause
// The drawer of a band's pieces onto its keys: the device's own listing (by_size.cuh), or a row of
// the papers' (papers/table). The frame around it (render/cuda/frame.cuh) knows no more of them.
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

/// Colours for a drawer that shades every fragment: shade(elements, keys, colors) sets the colour
/// of each fragment, given by its element of the surface and its key. Spans of the device's.
struct FragmentColors {
  std::function<void(std::span<const std::uint32_t>, std::span<const std::uint64_t>,
                     std::span<Vec4>)>
      shade;               ///< null: no colours are wanted
  std::span<Vec4> colors;  ///< of the surface, in the places of its keys; set where those rise
};

/// The body of FragmentColors::shade; `shade` as resolve_surface takes it.
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

/// Counters of a band's kernels, on the device: places of an array that is 0 when the band begins.
enum BandSum : std::uint8_t {
  kDroppedSum,  ///< primitives, as Outcomes
  kCulledSum,
  kClippedSum,
  kInvalidSum,
  kFragmentsSum,
  kLargerSum,   ///< pieces that a team draws
  kTilesSum,    ///< and tiles of large ones
  kCoveredSum,  ///< pixels that hold a surface
  kLeftSum,     ///< places of LeftPieces
  kRunsSum,     ///< of the boxes of those that are tested
  kHeldSum,     ///< not 0: pieces of the band are still to be drawn, so its images are not made
  kBandSums
};
using BandSums = std::array<std::uint64_t, kBandSums>;  ///< on the host

/// Boxes in px² from which on a piece is for a warp, and for blocks of threads.
struct DeviceSizes {
  std::uint64_t small_px = 128, large_px = 4000;
};

/// Keeps counters from band to band of a frame. One frame at a time.
class SurfaceDrawer {
 public:
  /// Facts that a frame has to know before it draws.
  struct Kind {
    std::string_view rasterizer, visibility;  ///< names, as FrameStats has them
    std::string_view why;                     ///< it was taken: the beginning of FrameStats::why
    std::uint64_t pixel_bytes = 0;            ///< of a band, beside its keys
    bool shades = false;                      ///< it wants FragmentColors, and sets them
    bool has_samples = false;                 ///< it draws several samples a pixel
    bool leaves_pieces = false;               ///< it fills LeftPieces
  };

  virtual ~SurfaceDrawer() = default;
  [[nodiscard]] virtual Kind kind() const = 0;

  /// Draws all primitives of `scene` onto the keys of `surface`, which hold what was drawn before,
  /// or 0. Pieces that have a flag of `skip` are left to others, in `left` where there is room and
  /// kind().leaves_pieces says so. Their primitives are still counted, in the BandSums at `sums` on
  /// the device. Primitives that are not valid draw nothing. `colors` as kind().shades says. Throws
  /// Error{out_of_memory}, and Stopped between batches. May return before it is done.
  virtual void draw(parallel::Cuda& exec, const DeviceScene<parallel::Cuda>& scene,
                    const DeviceSurface& surface, const DeviceSplit& split, std::uint32_t skip,
                    const LeftPieces& left, const FragmentColors& colors, std::uint64_t* sums) = 0;
  /// Counts from 0; a frame may have ended early.
  virtual void begin_frame() = 0;
  /// Takes the counts of a band that is done.
  virtual void end_band(const BandSums& /*sums*/) {}
  /// Adds the frame's counters to `stats`.
  virtual void end_frame(FrameStats& stats) const = 0;
};

}  // namespace rastrum::raster
