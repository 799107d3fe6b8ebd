// SPDX-License-Identifier: BSD-3-Clause
// How a Renderer has its frames drawn.
#pragma once

#include <rastrum/raster/context/request.hpp>

namespace rastrum::raster {

/// The fast path, the serial reference, a device or a row of the family. Draws one frame at a time
/// and keeps its scratch.
class FrameDrawer {
 public:
  virtual ~FrameDrawer() = default;
  /// Throws Error{invalid_argument} where an index is out of range, Error{out_of_memory} where the
  /// limit is too small for any piece of the work.
  [[nodiscard]] virtual FrameStats draw(FrameRequest& request) = 0;
  /// Shades blocks with known keys, as opaque surfaces, into targets of their own. The targets of
  /// `request` say which there are. Throws as draw().
  [[nodiscard]] virtual FrameStats shade(FrameRequest& request, const KnownBlocks& known) = 0;
};

}  // namespace rastrum::raster
