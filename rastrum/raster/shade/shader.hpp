// SPDX-License-Identifier: BSD-3-Clause
// The colours that any Shading gives a block of pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/shading.hpp>
#include <rastrum/raster/surface/seen_bin.hpp>

namespace rastrum::raster {

/// FragmentRuns number pixels as 64 · row + column.
inline constexpr int kRunPitch = 64;
/// So many keys and pixels beyond the end may be read, and as many colours written.
inline constexpr std::size_t kRunSlack = 16;

/// Fragments of a region of at most 64 × 64 px, sorted by primitive, not by pixel.
struct FragmentRuns {
  const std::uint64_t* keys;
  const std::uint16_t* pixels;
  std::size_t count;
  const std::uint64_t* firsts;  ///< a bit a fragment: the first of its primitive
  const std::uint64_t* wanted;  ///< a bit a fragment: shade it; null: all
  int x0, y0;                   ///< first pixel of the region
};

/// As BlockShader::shade. `shading` must not be empty.
bool shade_block(const Shading& shading, const FrameGeometry& frame, const VisibleBlock& block,
                 Isa isa, BlockColors& colors) noexcept;
/// shade_block and store_opaque at once. False: not possible, nothing is set; use shade_block.
bool store_shaded(const Shading& shading, const FrameGeometry& frame, const VisibleBlock& block,
                  Isa isa, Rgba8 empty, BlockPixels to) noexcept;
/// shade_block for fragments sorted by primitive: colors[i] is fragment i's, with shade_block's
/// bits. kRunSlack more may be set. False: only blocks are possible, nothing is set; use
/// shade_block.
bool shade_runs(const Shading& shading, const FrameGeometry& frame, const FragmentRuns& runs,
                Isa isa, Vec4* colors) noexcept;
/// Whether a bin's blocks are shaded faster with VisibleBlock::bin.
[[nodiscard]] bool suits_bin(const Shading& shading, const BinSurface& bin, Isa isa) noexcept;
/// Fills `seen` for rows of blocks, from `row` to seen.end_row. Requires suits_bin.
void see_bin(const Shading& shading, const FrameGeometry& frame, const BinSurface& bin, int row,
             Isa isa, SeenBin& seen) noexcept;
void prefetch(const Shading& shading, const FrameGeometry& frame, std::uint64_t id) noexcept;
/// The alpha of all fragments, if known before shading.
[[nodiscard]] std::optional<float> constant_alpha(const Shading& shading) noexcept;
/// An empty shading gives false or 0.
[[nodiscard]] bool wants_depth(const Shading& shading) noexcept;
[[nodiscard]] std::size_t scratch_bytes(const Shading& shading) noexcept;
[[nodiscard]] std::size_t extra_count(const Shading& shading) noexcept;

/// The samples of `block.mask` that the test keeps; `points` as FragmentTest's.
[[nodiscard]] std::uint64_t test_block(const Testing& testing, const FrameGeometry& frame,
                                       const Piece& piece, const Block& block,
                                       const ShadingPoints* points) noexcept;

}  // namespace rastrum::raster
