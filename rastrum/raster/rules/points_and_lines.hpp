// SPDX-License-Identifier: BSD-3-Clause
// Setup of points and lines, beside that of triangles (make_piece.hpp).
//
// Lines follow OpenGL's diamond-exit rule (OpenGL 4.6, 14.5.1) with y down. With both ends moved by
// −(ε, ε²), a line produces the pixels f whose open diamond |x − x_f| + |y − y_f| < 1/2 it leaves
// before its second end. So a polyline draws the pixel at a shared end once, and a line that leaves
// no diamond draws nothing. line_band (coverage.hpp) has the pixels of the endless line; this file
// finds where they begin and end. A wide line is `width` pixels across the minor axis everywhere.
// All is exact: integers, and a rule for every tie.
#pragma once

#include <cmath>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/make_piece.hpp>

namespace rastrum::raster {

/// The first pixel along the major axis, in growing coordinates, on whose far side end `i` lies. A
/// forward line covers [pixel of end 0, pixel of end 1), a backward one the reverse.
RASTRUM_HD inline std::int32_t pixel_at_end(const Piece& p, const LineBand& band, int i) {
  const bool forward = (band.x_major ? p.x[1] - p.x[0] : p.y[1] - p.y[0]) > 0;
  const std::int32_t major = band.x_major ? p.x[i] : p.y[i];
  const std::int32_t minor = (band.x_major ? p.y[i] : p.x[i]) - band.shift();
  // The end moved by −ε lies in pixel m, and clearly beside all other diamonds.
  const std::int32_t m = (major - 1) >> kSubpixelBits;
  const std::int32_t along = major - (m * kSubpixels + kHalfPixel);
  const auto across = static_cast<std::int32_t>(minor - (band.minor(m) * kSubpixels + kHalfPixel));
  const std::int32_t distance = (along < 0 ? -along : along) + (across < 0 ? -across : across);
  // On the diamond's border −ε in x decides: it moves the end outwards from the left half.
  const std::int32_t x = band.x_major ? along : across;
  const bool outside = distance > kHalfPixel || (distance == kHalfPixel && x <= 0);
  const bool left_behind = outside && (forward ? along > 0 : along <= 0);
  return forward == left_behind ? m + 1 : m;
}

/// Fills `piece` unless it can cover no sample of `view`. The ends must be inside the guard band.
/// `width`: whole px, at least 1.
RASTRUM_HD inline SetupResult make_line(const ProjectedVertex& a, const ProjectedVertex& b,
                                        std::uint64_t id, std::uint32_t flags, std::uint32_t width,
                                        Rect view, Piece& piece) {
  if (a.x_fx8 == b.x_fx8 && a.y_fx8 == b.y_fx8) return SetupResult::culled;
  piece.x[0] = a.x_fx8;
  piece.y[0] = a.y_fx8;
  piece.x[1] = b.x_fx8;
  piece.y[1] = b.y_fx8;
  piece.flags = flags | kLine | width << kLineWidthShift;
  const LineBand band = line_band(piece);
  const std::int32_t at_a = pixel_at_end(piece, band, 0), at_b = pixel_at_end(piece, band, 1);
  piece.x[2] = at_a < at_b ? at_a : at_b;
  piece.y[2] = at_a < at_b ? at_b : at_a;
  if (at_a == at_b || piece_bounds(piece, view).empty()) return SetupResult::culled;

  // Depth changes along the major axis alone, so a wide line has one depth across.
  const double change = (static_cast<double>(b.depth) - static_cast<double>(a.depth)) /
                        (band.x_major ? b.x_fx8 - a.x_fx8 : b.y_fx8 - a.y_fx8) * kSubpixels;
  piece.z0 = a.depth;
  piece.zx = band.x_major ? static_cast<float>(change) : 0.0F;
  piece.zy = band.x_major ? 0.0F : static_cast<float>(change);
  piece.low = kIdMask - id;
  return SetupResult::drawn;
}

/// Fills `piece` unless its square has no sample of `view`. kRound in `flags` makes a disc, unless
/// that may miss all samples.
RASTRUM_HD inline SetupResult make_point(const ProjectedVertex& v, std::uint64_t id,
                                         std::uint32_t flags, std::int32_t size_fx8, Rect view,
                                         Piece& piece) {
  if (size_fx8 < kLeastRound) flags &= ~kRound;
  piece.x[0] = v.x_fx8;
  piece.y[0] = v.y_fx8;
  piece.x[1] = size_fx8;
  piece.x[2] = piece.y[1] = piece.y[2] = 0;
  piece.flags = flags | kPoint;
  if (piece_bounds(piece, view).empty()) return SetupResult::culled;
  piece.z0 = v.depth;
  piece.zx = piece.zy = 0;
  piece.low = kIdMask - id;
  return SetupResult::drawn;
}

/// To the nearest whole number, ties to even, at least 1 (GL).
RASTRUM_HD inline std::uint32_t whole_width(float width) {
  return width > 1 ? static_cast<std::uint32_t>(std::nearbyint(width)) : 1;
}

/// In [1, kMaxPointSize] px. A NaN counts as 1.
RASTRUM_HD inline std::int32_t point_size_fx8(float size) {
  const float most = size < kMaxPointSize ? size : kMaxPointSize;
  return size > 1 ? static_cast<std::int32_t>(std::nearbyint(most * kSubpixels)) : kSubpixels;
}

}  // namespace rastrum::raster
