// SPDX-License-Identifier: BSD-3-Clause
// Colours of opaque surfaces with several samples a pixel, from each sample's key. A primitive is
// shaded once in a pixel: at the centre or, if it misses that, at the first sample that it covers
// (docs/outputs.md). A key does not say where, so coverage is found again from the vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <rastrum/raster/context/frame_context.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/samples.hpp>

namespace rastrum::raster {

/// Colours of blocks of 8 × 8 pixels, for one thread.
class SampledColors {
 public:
  SampledColors();
  SampledColors(SampledColors&&) noexcept;
  ~SampledColors();

  /// Forgets what was found in another bin, maybe of another frame.
  void begin();
  /// Sets `nearest` to the largest key of each pixel of block (bx, by) and, where the frame wants
  /// colours, `out` to the mean of the samples' premultiplied colours. Handles triangles, points
  /// and lines only.
  void resolve(const BinContext& context, const SampledKeys& keys, int bx, int by,
               std::uint64_t* nearest, BlockColors& out);
  /// Returns the pixels of `block`, where the piece covers a sample, that its fragment test keeps.
  /// Tests where the primitive is shaded, so all samples agree.
  [[nodiscard]] std::uint64_t test(const BinContext& context, const Piece& piece,
                                   const Block& block);

 private:
  struct ExactEdges;
  struct Primitive;
  struct Clipped;
  class Finder;
  static constexpr std::size_t kKept = 256, kKeptClipped = 16;

  /// Notes a surface of a pixel, to be shaded. Returns the place of its colour in colors_.
  std::uint16_t add(const BinContext& context, int pixel, std::uint64_t key,
                    SampleOffset from_centre);
  void flush(const BinContext& context);
  void shade(const BinContext& context, const std::uint64_t* keys, std::uint64_t mask,
             const ShadingPoints* points, BlockColors& colors);

  /// Colours in groups of 64. Group 0 is shaded at pixel centres, each colour in its pixel's place.
  /// The next groups are packed. The last group is 0, for samples without a surface.
  BlockColors colors_[2 + kMaxSamples];
  alignas(64) std::uint64_t centre_keys_[64];
  SeenBySamples seen_;
  std::uint64_t centred_ = 0;  ///< pixels of group 0
  alignas(64) std::uint64_t packed_keys_[64];
  ShadingPoints packed_points_;
  int packed_ = 0;  ///< in the last packed group
  int groups_ = 0;
  int bx_ = 0, by_ = 0;
  std::unique_ptr<Primitive[]> kept_;
  std::unique_ptr<Piece[]> planes_;
  std::unique_ptr<Clipped[]> clipped_;
};

}  // namespace rastrum::raster
