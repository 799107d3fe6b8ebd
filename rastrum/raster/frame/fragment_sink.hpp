// Where the translucent fragments of a frame go that are not blended in it: those of several ranks
// meet at the owner of their pixel (ranks/).
#pragma once

#include <cstdint>

#include <rastrum/raster/shade/color.hpp>

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

/// A frame with one draws its opaque surfaces as always, and leaves the keys of these alone. Its
/// translucent fragments before them, also before what the passes before have left
/// (Targets::load), are the sink's; with several samples a pixel the opaque surfaces of each, too.
/// Of one sample it is asked of layers alone, that is, not where nothing is translucent.
class FragmentSink {
 public:
  enum class Takes : std::uint8_t {
    nothing,  ///< with one sample a pixel
    keys,     ///< in any order, unshaded
    colors,   ///< of each sample in the order of the frame's blend, and no more than that needs
  };
  explicit FragmentSink(Takes t) : takes(t) {}
  virtual ~FragmentSink() = default;
  const Takes takes;
  /// Thread-safe for distinct blocks; a block's planes come one after the other.
  virtual void take(const FragmentPlane& /*plane*/) {}
  /// The same of opaque surfaces, with one sample a pixel: each block that has some, once. A device
  /// that draws a frame calls it not.
  virtual void take(const OpaqueKeys& /*surfaces*/) {}
};

}  // namespace rastrum::raster
