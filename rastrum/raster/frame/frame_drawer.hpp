// SPDX-License-Identifier: BSD-3-Clause
// The interface by which a Renderer has its frames drawn.
#pragma once

#include <rastrum/raster/context/request.hpp>

namespace rastrum::raster {

/// The fast path, the serial reference, a device, a row of the family. Keeps its scratch between
/// frames. Draws one frame at a time.
class FrameDrawer {
 public:
  virtual ~FrameDrawer() = default;
  /// Draws one frame. Throws Error{invalid_argument} where an index is out of range,
  /// Error{out_of_memory} where the limit is too small for any piece of the work.
  [[nodiscard]] virtual FrameStats draw(FrameRequest& request) = 0;
  /// Shades blocks whose keys are known, as opaque surfaces are, into targets of their own; those
  /// of `request` say which there are. Throws as draw().
  [[nodiscard]] virtual FrameStats shade(FrameRequest& request, const KnownBlocks& known) = 0;
};

}  // namespace rastrum::raster
