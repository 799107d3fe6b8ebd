// SPDX-License-Identifier: BSD-3-Clause
// Visibility keys to the images that a caller asked for. All rasterizers share this, so shading and
// output exist once.
#pragma once

#include <cstdint>

#include <rastrum/raster/context/frame_plan.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::raster {

/// Shades one 8 × 8 block (`keys`: 64, 64-byte aligned) and writes its part of every target. Leaves
/// out pixels outside the image and those that an earlier pass won (Pass::load). `scratch`: the
/// shader's (hooks.hpp). `shaded`: colours that visibility has made, else null. `to`: where 8-bit
/// colours go if the block lies wholly in the image and the frame writes all pixels; null: to their
/// place. `bin`: VisibleBlock::bin. Returns the number of pixels with a surface of this pass.
int resolve_block(const FrameRequest& request, const FramePlan& plan, const FrameGeometry& frame,
                  const std::uint64_t* keys, int x0, int y0, void* scratch,
                  const BlockColors* shaded = nullptr, BlockPixels to = {},
                  const SeenBin* bin = nullptr) noexcept;

/// Sets the first keys of the blocks of `rect`: 0, or those of earlier passes (Pass::load).
void load_keys(const FrameRequest& request, Rect rect, const SurfaceView& surface) noexcept;

/// The pixels of `covered` with a surface of this pass: ids count on from pass to pass.
[[nodiscard]] std::uint64_t of_this_pass(const FrameRequest& request, const std::uint64_t* keys,
                                         std::uint64_t covered) noexcept;

/// Whether `rect`, at most a bin, has the whole lines of FramePlan::streams.
[[nodiscard]] bool streams_colors(const FramePlan& plan, Rect rect) noexcept;

void resolve_empty(const FrameRequest& request, const FramePlan& plan, Rect rect) noexcept;

}  // namespace rastrum::raster
