// SPDX-License-Identifier: BSD-3-Clause
// One frame, as it is handed down to the code that draws it.
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

/// A block of 8 × 8 pixels whose keys are known, so that it is shaded without drawing anything.
struct KnownBlock {
  const std::uint64_t* keys;  ///< 64
  std::uint64_t mask;         ///< pixels of this pass: bit 8 y + x
  int x0, y0;                 ///< the image's pixel in its upper left corner
};
struct KnownBlocks {
  std::span<const KnownBlock> blocks;
  std::uint64_t forward = 0;  ///< ids of the pass are those of the keys plus this
  /// The targets of block i of the list, each stored by itself; thread-safe. Pixels have the places
  /// that they have in the image.
  std::function<Targets(std::size_t i)> targets;
};

/// All that concerns a device alone; the CPU's rooms do not read it.
struct ForDevice {
  std::string why_not{};                ///< why it is left to the CPU; empty: nothing is known
  bool in_place = false;                ///< arrays and targets are memory of the device that draws
  std::optional<DeviceStream> after{};  ///< a caller's stream, whose earlier work comes first
};

/// Whether a draw has translucent primitives that must not be drawn opaque.
[[nodiscard]] bool blends(std::span<const Draw> draws, const TransparencyOptions& options);

/// One frame, as the façade hands it to a drawer. How it is drawn is FramePlan's.
struct FrameRequest {
  int width = 0, height = 0;
  Isa isa = Isa::scalar;
  std::span<Draw> draws;
  DrawNames names{};
  Testing test;       ///< none: no piece is tested
  Shading shading;    ///< may be none where no colour is asked for
  Vec4 background{};  ///< display values, straight alpha
  Targets targets;    ///< pixels have the places that they have in the image
  Pass pass{};
  float no_distance = std::numeric_limits<float>::infinity();  ///< FrameOptions has it
  const SurfaceScene* surface = nullptr;  ///< the scene that targets of the surface are read from
  std::optional<Rect> part;  ///< the part of the image that is drawn, cut at bins; none: all of it
  ForDevice device;
  std::uint64_t other_bytes = 0;     ///< counted by the memory limit beside the frame's own
  TransparencyOptions transparency;  ///< where layers are needed
  FragmentSink* sink = nullptr;      ///< takes the translucent fragments; null: they are blended
  int samples = 1;                   ///< a pixel; more want layers
  /// The shader returns linear light: it is blended as such, also over the background, and the sRGB
  /// transfer is applied to the result.
  bool linear_light = false;

  /// Whether keys are not enough: something is translucent, or pixels have several samples.
  [[nodiscard]] bool needs_layers() const { return samples > 1 || blends(draws, transparency); }
  /// Whether some draw is of spheres and their like.
  [[nodiscard]] bool has_quadrics() const;
  /// Whether some draw has clip planes.
  [[nodiscard]] bool has_cuts() const;
  /// Whether some piece may be tested: by `test` (kTested), against the picture that the targets
  /// hold (kOverPicture), or against clip planes (kCut).
  [[nodiscard]] bool has_tests() const { return test || pass.over || has_cuts(); }
  /// The samples of `block.mask` that the tests of the piece keep; `points` as FragmentTest's.
  /// Pieces drawn over a picture read Targets::depth at a pixel before it is written.
  [[nodiscard]] std::uint64_t kept(const FrameGeometry& frame, const Piece& piece,
                                   const Block& block, const ShadingPoints* points) const noexcept;
};

}  // namespace rastrum::raster
