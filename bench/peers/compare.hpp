// SPDX-License-Identifier: BSD-3-Clause
// Compares Rastrum's pictures with the peers', pixel by pixel.
#pragma once

#include <cstdint>

#include <rastrum/camera.hpp>
#include <rastrum/image.hpp>
#include <rastrum/mesh.hpp>

namespace rastrum::bench {

/// Fragments at each pixel, ours against a peer's.
struct CountDifference {
  std::uint64_t pixels = 0;            ///< where the counts differ
  std::uint64_t coverage = 0;          ///< of these, where one of the counts is 0
  std::uint64_t ours = 0, theirs = 0;  ///< fragments in all
};
[[nodiscard]] CountDifference compare_counts(const Image<std::uint32_t>& ours,
                                             const Image<std::uint32_t>& theirs);

/// Colours at the pixels that either picture covers (alpha not 0).
struct ColorDifference {
  std::uint64_t covered = 0;   ///< pixels that either covers
  std::uint64_t one_only = 0;  ///< pixels that only one covers; they count as far
  std::uint64_t far = 0;       ///< pixels with a channel that differs by more than `tolerance`
  int largest = 0;             ///< largest difference of a channel where both cover

  /// The share of covered pixels within the tolerance; 1 if nothing is covered.
  [[nodiscard]] double share() const {
    return covered == 0 ? 1 : 1 - static_cast<double>(far) / static_cast<double>(covered);
  }
};
[[nodiscard]] ColorDifference compare_colors(const Image<Rgba8>& ours, const Image<Rgba8>& theirs,
                                             int tolerance);

/// Compares premultiplied float pictures where either covers (alpha not 0), as displayed over
/// black: values above 1 count as 1.
struct PictureError {
  std::uint64_t covered = 0;  ///< pixels that either covers
  std::uint64_t far = 0;      ///< pixels with a channel, alpha too, farther apart than `tolerance`
  double rmse = 0;            ///< over red, green and blue
  double worst = 0;           ///< largest difference of a channel, alpha too

  [[nodiscard]] double share() const {
    return covered == 0 ? 1 : 1 - static_cast<double>(far) / static_cast<double>(covered);
  }
  /// For a signal in [0, 1], in dB; infinite if nothing differs.
  [[nodiscard]] double psnr() const;
};
[[nodiscard]] PictureError picture_error(const Image<Vec4>& ours, const Image<Vec4>& theirs,
                                         double tolerance);

/// Pixels whose numbers differ.
[[nodiscard]] std::uint64_t count_different(const Image<std::int64_t>& ours,
                                            const Image<std::int32_t>& theirs);

/// `count` random triangles whose vertices lie exactly on 1/256 px of a width × height image, from
/// a pixel in size to the whole image. Many vertices lie on half pixels, so that samples lie
/// exactly on edges. z = −0.5. All are inside the image, because OpenGL drivers clip at its sides
/// and round the new vertices.
[[nodiscard]] Mesh window_triangles(int width, int height, int count, std::uint64_t seed);
/// Maps window coordinates (x, height − y) to pixels. float32 rounding stays far below 1/512 px, so
/// snapping restores the exact position.
[[nodiscard]] Camera window_camera(int width, int height);

}  // namespace rastrum::bench
