// SPDX-License-Identifier: BSD-3-Clause
// Sinks for the translucent fragments that a frame does not blend itself: with several ranks they
// meet at the owner of their pixel (ranks/).
#pragma once

#include <cstdint>

#include <rastrum/raster/rules/color.hpp>

namespace rastrum::raster {

/// At most one fragment a pixel of block (bx, by), of one sample.
struct FragmentPlane {
  int bx, by;
  const std::uint64_t* keys;  ///< 64; those outside of `mask` are of no fragment
  std::uint64_t mask;         ///< not empty
  const BlockColors* colors;  ///< premultiplied; null where the sink takes keys alone
  int sample = 0;
  bool opaque = false;  ///< with several samples: the surface behind the planes before
};

/// The opaque surfaces of a block of one sample a pixel.
struct OpaqueKeys {
  int bx, by;
  const std::uint64_t* keys;  ///< 64; those outside of `mask` are of no surface of this pass
  std::uint64_t mask;         ///< not empty
};

/// The fate of a frame's translucent fragments.
enum class Translucent : std::uint8_t {
  blended,  ///< without a sink
  left_out,
  keys_to_sink,    ///< in any order, unshaded
  colors_to_sink,  ///< of each sample in the order of the frame's blend, no more than that needs
};

/// A frame with a sink draws its opaque surfaces as always, and its targets hold their keys alone.
/// The sink takes the translucent fragments in front of them, and in front of what the passes
/// before have left (Pass::load); with several samples a pixel it takes the opaque surfaces of
/// each, too. With one sample a pixel it gets planes only in frames with layers, that is, where
/// something is translucent.
class FragmentSink {
 public:
  /// `f`: not `blended`; `left_out` with one sample a pixel.
  explicit FragmentSink(Translucent f) : fate(f) {}
  virtual ~FragmentSink() = default;
  const Translucent fate;
  /// Thread-safe for distinct blocks; a block's planes come one after the other.
  virtual void take(const FragmentPlane& /*plane*/) {}
  /// The same for opaque surfaces, with one sample a pixel: each block that has some, once. Devices
  /// do not call it.
  virtual void take(const OpaqueKeys& /*surfaces*/) {}
};

}  // namespace rastrum::raster
