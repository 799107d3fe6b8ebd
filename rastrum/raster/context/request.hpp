// SPDX-License-Identifier: BSD-3-Clause
// One frame, as the code that draws it gets it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include <rastrum/device.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/raster/context/fragment_sink.hpp>
#include <rastrum/raster/context/target_table.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/numbering.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

struct SurfaceScene;

/// A block of 8 × 8 pixels whose keys are known, to be shaded without drawing.
struct KnownBlock {
  const std::uint64_t* keys;  ///< 64
  std::uint64_t mask;         ///< pixels of this pass: bit 8 y + x
  int x0, y0;                 ///< the image's pixel in its upper left corner
};
struct KnownBlocks {
  std::span<const KnownBlock> blocks;
  std::uint64_t forward = 0;  ///< ids of the pass: those of the keys plus this
  /// The separately stored targets of block i; thread-safe. Pixels have their places in the image.
  std::function<Targets(std::size_t i)> targets;
};

/// Concerns a device alone; the CPU does not read it.
struct ForDevice {
  std::string why_not{};                ///< why the CPU has to draw; empty: no reason known
  bool in_place = false;                ///< arrays and targets are memory of the drawing device
  std::optional<DeviceStream> after{};  ///< a caller's stream, whose earlier work finishes first
};

/// Whether a draw has translucent primitives that must not be drawn opaque.
[[nodiscard]] bool blends(std::span<const Draw> draws, const TransparencyOptions& options);

/// One frame, as the façade hands it to a drawer. FramePlan says how it is drawn.
struct FrameRequest {
  int width = 0, height = 0;
  Isa isa = Isa::scalar;
  std::span<Draw> draws;
  DrawNames names{};
  Testing test;       ///< none: no piece is tested
  Shading shading;    ///< may be none where no colour is asked for
  Vec4 background{};  ///< display values, straight alpha
  Targets targets;    ///< pixels have their places in the image
  Pass pass{};
  float no_distance = std::numeric_limits<float>::infinity();  ///< see FrameOptions
  const SurfaceScene* surface = nullptr;  ///< the scene that surface targets are read from
  std::optional<Rect> part;               ///< the part of the image to draw, cut at bins; none: all
  ForDevice device;
  std::uint64_t other_bytes = 0;     ///< what the memory limit counts beside the frame's own
  TransparencyOptions transparency;  ///< where layers are needed
  FragmentSink* sink = nullptr;      ///< takes translucent fragments; null: they are blended
  int samples = 1;                   ///< a pixel; several need layers
  /// The shader returns linear light. It is blended as such, also over the background, and then
  /// gets the sRGB transfer.
  bool linear_light = false;

  /// Keys are not enough: something is translucent, or pixels have several samples.
  [[nodiscard]] bool needs_layers() const { return samples > 1 || blends(draws, transparency); }
  [[nodiscard]] bool has_quadrics() const;
  [[nodiscard]] bool has_cuts() const;
  /// Whether some piece may be tested: by `test` (kTested), against the targets' picture
  /// (kOverPicture), or against clip planes (kCut).
  [[nodiscard]] bool has_tests() const { return test || pass.over || has_cuts(); }
  /// The samples of `block.mask` that the piece's tests keep. `points`: as FragmentTest's. Pieces
  /// drawn over a picture read Targets::depth at a pixel before it is written.
  [[nodiscard]] std::uint64_t kept(const FrameGeometry& frame, const Piece& piece,
                                   const Block& block, const ShadingPoints* points) const noexcept;
};

}  // namespace rastrum::raster
