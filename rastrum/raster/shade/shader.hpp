// SPDX-License-Identifier: BSD-3-Clause
// The colours that a Shading gives a block of pixels, whichever of its alternatives it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/shading.hpp>
#include <rastrum/raster/surface/seen_bin.hpp>

namespace rastrum::raster {

/// FragmentRuns number pixels by 64 · row + column.
inline constexpr int kRunPitch = 64;
/// This many keys and pixels beyond them may be read, whatever they are, and as many colours set.
inline constexpr std::size_t kRunSlack = 16;

/// Fragments of a region of at most 64 × 64 px, of which those of a primitive lie side by side,
/// whatever their pixels.
struct FragmentRuns {
  const std::uint64_t* keys;
  const std::uint16_t* pixels;
  std::size_t count;
  const std::uint64_t* firsts;  ///< a bit a fragment: the first of its primitive
  const std::uint64_t* wanted;  ///< a bit a fragment: to be shaded; null: all are
  int x0, y0;                   ///< first pixel of the region
};

/// As BlockShader::shade, whatever shades. Requires that `shading` is not empty.
bool shade_block(const Shading& shading, const FrameGeometry& frame, const VisibleBlock& block,
                 Isa isa, BlockColors& colors) noexcept;
/// The same, and store_opaque of what it gives, at once. Returns false and sets nothing where that
/// cannot be: then shade_block must be asked.
bool store_shaded(const Shading& shading, const FrameGeometry& frame, const VisibleBlock& block,
                  Isa isa, Rgba8 empty, BlockPixels to) noexcept;
/// The same as shade_block of fragments that lie side by side by primitive: colours[i] is that of
/// fragment i, with the bits that shade_block gives; kRunSlack beyond them may be set. Returns
/// false and sets nothing where only blocks are shaded: then shade_block must be asked.
bool shade_runs(const Shading& shading, const FrameGeometry& frame, const FragmentRuns& runs,
                Isa isa, Vec4* colors) noexcept;
/// Whether the blocks of a bin are shaded sooner with VisibleBlock::bin.
[[nodiscard]] bool suits_bin(const Shading& shading, const BinSurface& bin, Isa isa) noexcept;
/// Fills `seen` for rows of blocks, from `row` to seen.end_row. Requires suits_bin.
void see_bin(const Shading& shading, const FrameGeometry& frame, const BinSurface& bin, int row,
             Isa isa, SeenBin& seen) noexcept;
void prefetch(const Shading& shading, const FrameGeometry& frame, std::uint64_t id) noexcept;
/// The alpha that all fragments have, where it is known beforehand.
[[nodiscard]] std::optional<float> constant_alpha(const Shading& shading) noexcept;
/// Each of an empty shading: false or 0.
[[nodiscard]] bool wants_depth(const Shading& shading) noexcept;
[[nodiscard]] std::size_t scratch_bytes(const Shading& shading) noexcept;
[[nodiscard]] std::size_t extra_count(const Shading& shading) noexcept;

/// The samples of `block.mask` that the test keeps; `points` as FragmentTest's.
[[nodiscard]] std::uint64_t test_block(const Testing& testing, const FrameGeometry& frame,
                                       const Piece& piece, const Block& block,
                                       const ShadingPoints* points) noexcept;

}  // namespace rastrum::raster
