// The visibility of transparency: keeps every fragment that may be seen and resolves all of a pixel
// in order (papers 4 and 5; docs/layers.md).
#pragma once

#include <rastrum/raster/visibility/region.hpp>

namespace rastrum::transparency {

/// Records the blocks of translucent pieces and draws opaque ones as `atomic` does; at the end of a
/// region it blends, block by block, by FrameRequest::transparency. Only for regions that one
/// thread owns. The keys become those of the nearest surface, translucent or not.
///
/// Counters: "translucent fragments" that opaque surfaces do not hide, "layer blocks" (a piece's
/// part of an 8 × 8 block), "deepest" (most fragments of a pixel), "windows" (walks over a block's
/// pieces beyond the first), and "wrong pixels" with Transparency::filter or "repaired pixels" with
/// `exact`.
/// Memory: 24 bytes a recorded block of a region, and 8 bytes a pixel of a block and layer.
[[nodiscard]] const raster::Visibility& layers() noexcept;

}  // namespace rastrum::transparency
