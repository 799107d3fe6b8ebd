// From visibility keys to the images a caller asked for. Shared by every rasterizer: shading and
// output exist once.
#pragma once

#include <string_view>

#include <rastrum/raster/context/request.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::raster {

/// The backdrop that a frame's colours are drawn over. Takes up to three powers, so it is made once
/// a frame or tile.
[[nodiscard]] Backdrop backdrop_of(const FrameRequest& request);

/// Shades one 8 × 8 block (`keys`: 64, 64-byte aligned) and writes its part of every target. Pixels
/// outside the image are left out, and so are those that an earlier pass won (Targets::load).
/// `scratch` is the shader's (hooks.hpp). `shaded`: the colours where visibility has shaded
/// already, else null. `to`: where to write the 8-bit colours of a block that lies in the image
/// wholly, in a frame without `load` and `over`; null: to their place. `bin`: VisibleBlock::bin.
/// Returns how many pixels hold a surface of this pass.
int resolve_block(const FrameRequest& request, const FrameGeometry& frame, const Backdrop& backdrop,
                  const std::uint64_t* keys, int x0, int y0, void* scratch,
                  const BlockColors* shaded = nullptr, BlockPixels to = {},
                  const SeenBin* bin = nullptr) noexcept;

/// Sets the keys that the blocks of `rect` begin with: 0, or those of the passes before
/// (Targets::load). `part`: FrameRequest::part, which `targets` hold.
void load_keys(const Targets& targets, Rect rect, const SurfaceView& surface,
               Rect part = {}) noexcept;

/// The pixels of `covered` that hold a surface of this pass: ids count on from pass to pass.
[[nodiscard]] std::uint64_t of_this_pass(const FrameRequest& request, const std::uint64_t* keys,
                                         std::uint64_t covered) noexcept;

/// Whether the 8-bit colours of `rect`, at most a bin, go past the caches (Kernels::stream): in
/// pictures that no cache holds, where whole lines are written.
[[nodiscard]] bool streams_colors(const FrameRequest& request, Rect rect) noexcept;

/// Writes the targets of a rectangle in which this pass has no surface.
void resolve_empty(const FrameRequest& request, Rect rect) noexcept;

}  // namespace rastrum::raster
