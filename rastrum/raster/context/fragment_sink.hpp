// SPDX-License-Identifier: BSD-3-Clause
// Sinks for translucent fragments that a frame does not blend itself. With several ranks they meet
// at the rank that owns their pixel (ranks/).
#pragma once

#include <cstdint>

#include <rastrum/raster/rules/color.hpp>

namespace rastrum::raster {

/// At most one fragment a pixel of block (bx, by), all of one sample.
struct FragmentPlane {
  int bx, by;
  const std::uint64_t* keys;  ///< 64; those outside of `mask` have no fragment
  std::uint64_t mask;         ///< not empty
  const BlockColors* colors;  ///< premultiplied; null where the sink takes keys alone
  int sample = 0;
  bool opaque = false;  ///< with several samples: the surface behind the earlier planes
};

struct OpaqueKeys {
  int bx, by;
  const std::uint64_t* keys;  ///< 64; those outside of `mask` have no surface of this pass
  std::uint64_t mask;         ///< not empty
};

enum class Translucent : std::uint8_t {
  blended,  ///< without a sink
  left_out,
  keys_to_sink,    ///< in any order, unshaded
  colors_to_sink,  ///< shaded, in each sample's order of blending, no more than that needs
};

/// A frame with a sink draws its opaque surfaces as always; its targets hold only their keys. The
/// sink takes the translucent fragments in front of them and of what earlier passes left
/// (Pass::load), and with several samples a pixel also each sample's opaque surfaces. With one
/// sample it gets planes only in frames with layers, where something is translucent.
class FragmentSink {
 public:
  /// `f`: not `blended`, and `left_out` only with one sample a pixel.
  explicit FragmentSink(Translucent f) : fate(f) {}
  virtual ~FragmentSink() = default;
  const Translucent fate;
  /// Thread-safe for distinct blocks; a block's planes come in sequence.
  virtual void take(const FragmentPlane& /*plane*/) {}
  /// The opaque surfaces of each block that has some, once, with one sample a pixel. Thread-safe
  /// for distinct blocks. Devices do not call it.
  virtual void take(const OpaqueKeys& /*surfaces*/) {}
};

}  // namespace rastrum::raster
