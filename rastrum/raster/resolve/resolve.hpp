// SPDX-License-Identifier: BSD-3-Clause
// From visibility keys to the images a caller asked for. Shared by every rasterizer: shading and
// output exist once.
#pragma once

#include <cstdint>

#include <rastrum/raster/context/frame_plan.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::raster {

/// Shades one 8 × 8 block (`keys`: 64, 64-byte aligned) and writes its part of every target. Pixels
/// outside the image are left out, and so are those that an earlier pass won (Pass::load).
/// `scratch` is the shader's (hooks.hpp). `shaded`: the colours where visibility has shaded
/// already, else null. `to`: where to write the 8-bit colours of a block that lies in the image
/// wholly, in a frame that writes all pixels; null: to their place. `bin`: VisibleBlock::bin.
/// Returns how many pixels hold a surface of this pass.
int resolve_block(const FrameRequest& request, const FramePlan& plan, const FrameGeometry& frame,
                  const std::uint64_t* keys, int x0, int y0, void* scratch,
                  const BlockColors* shaded = nullptr, BlockPixels to = {},
                  const SeenBin* bin = nullptr) noexcept;

/// Sets the keys that the blocks of `rect` begin with: 0, or those of the passes before
/// (Pass::load).
void load_keys(const FrameRequest& request, Rect rect, const SurfaceView& surface) noexcept;

/// The pixels of `covered` that hold a surface of this pass: ids count on from pass to pass.
[[nodiscard]] std::uint64_t of_this_pass(const FrameRequest& request, const std::uint64_t* keys,
                                         std::uint64_t covered) noexcept;

/// Whether `rect`, at most a bin, is of the whole lines that FramePlan::streams is about.
[[nodiscard]] bool streams_colors(const FramePlan& plan, Rect rect) noexcept;

/// Writes the targets of a rectangle in which this pass has no surface.
void resolve_empty(const FrameRequest& request, const FramePlan& plan, Rect rect) noexcept;

}  // namespace rastrum::raster
