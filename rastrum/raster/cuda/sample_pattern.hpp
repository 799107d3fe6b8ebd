// SPDX-License-Identifier: BSD-3-Clause
// A pixel's samples (samples.hpp) by value, for kernels of a device.
#pragma once

#include <algorithm>
#include <span>

#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/samples.hpp>

namespace rastrum::raster {

/// By default one sample, at the centre.
struct SamplePattern {
  int count = 1;
  SampleOffset at[kMaxSamples] = {};
  SampleOffset least{}, most{};  ///< of all, in x and y

  [[nodiscard]] static SamplePattern of(int samples) {
    const std::span<const SampleOffset> offsets = sample_offsets(samples);
    SamplePattern p;
    p.count = static_cast<int>(offsets.size());
    std::ranges::copy(offsets, p.at);
    for (const SampleOffset& o : offsets) {
      p.least = {std::min(p.least.x, o.x), std::min(p.least.y, o.y)};
      p.most = {std::max(p.most.x, o.x), std::max(p.most.y, o.y)};
    }
    return p;
  }
};

/// The pixels of `view` where the piece, relative to pixel centres, may cover a sample. May be
/// empty.
[[nodiscard]] RASTRUM_HD inline Rect sampled_bounds(const Piece& piece, Rect view,
                                                    const SamplePattern& samples) {
  if (samples.count == 1) return piece_bounds(piece, view);
  const Rect first = piece_bounds(moved(piece, samples.most), view);
  const Rect last = piece_bounds(moved(piece, samples.least), view);
  return {first.x0, first.y0, last.x1, last.y1};
}

}  // namespace rastrum::raster
