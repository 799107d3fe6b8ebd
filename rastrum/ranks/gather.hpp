// SPDX-License-Identifier: BSD-3-Clause
// The targets that the root asked for: which ones, images for them on a rank, and the transfer of
// won pixels from the ranks that have shaded them into the root's targets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/part_list.hpp>
#include <rastrum/raster/context/target_table.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::ranks {

/// Calls f(view, bit) for each target that ranks can fill, in the order in which they are sent.
template <class T, class F>
constexpr void each_target(T& t, const F& f) {
  std::uint32_t bit = 1;
  raster::for_each_target([&](const auto& row) {
    if (row.has_ranks()) f(t.*row.image, std::exchange(bit, bit << 1));
  });
}
/// The bits of the targets of which pred(row) is true.
template <class Pred>
[[nodiscard]] constexpr std::uint32_t bits_of(const Pred& pred) {
  std::uint32_t bits = 0, bit = 1;
  raster::for_each_target([&](const auto& row) {
    if (!row.has_ranks()) return;
    bits |= pred(row) ? bit : 0;
    bit <<= 1;
  });
  return bits;
}
/// The bits of `depth` and `ids`, which follow from words and the list of parts.
inline constexpr std::uint32_t kKnownTargets =
    bits_of([](const auto& row) { return row.kind == raster::TargetKind::key; });
/// The bits of `color8`, `color` and `linear`, which layers change.
inline constexpr std::uint32_t kColorTargets =
    bits_of([](const auto& row) { return row.kind == raster::TargetKind::color; });
inline constexpr std::uint32_t kColorTarget =
    bits_of([](const auto& row) { return row.name == "color"; });
inline constexpr std::uint32_t kLinearTarget =
    bits_of([](const auto& row) { return row.name == "linear"; });

/// The bits of the targets that are not empty.
[[nodiscard]] std::uint32_t targets_asked(const Targets& targets);

/// The targets whose bits are set; the others are empty.
[[nodiscard]] Targets targets_of(const Targets& targets, std::uint32_t bits);

/// A view of an image whose first row is the picture's row `top`, with coordinates of the picture.
template <class T>
[[nodiscard]] ImageView<T> in_place(ImageView<T> rows, int top) {
  if (rows.empty()) return rows;
  rows.data -= top * rows.stride;
  rows.height += top;
  return rows;
}
[[nodiscard]] Targets in_place(const Targets& rows, int top);
/// The first `rows` rows of each target, 32-bit ones too.
[[nodiscard]] Targets first_rows(const Targets& targets, int rows);

/// A rank's own images of a part of the picture, for the targets of these bits.
class OwnImages {
 public:
  OwnImages(std::uint32_t asked, raster::Rect part);
  /// Coordinates are the picture's; only pixels of the part exist.
  [[nodiscard]] const Targets& targets() const { return targets_; }

 private:
  template <class... T>
  using Lists = std::tuple<std::vector<Image<T>>...>;
  Lists<Rgba8, Vec2, Vec3, Vec4, float, std::int64_t, std::int32_t, std::uint64_t, std::uint32_t,
        std::uint8_t>
      images_;
  Targets targets_;
};

/// A rank's own pixels in some blocks, for the targets of these bits. Each target has 64 pixels a
/// block, one block after the other. They are not cleared.
class OwnBlocks {
 public:
  OwnBlocks(std::uint32_t asked, std::size_t blocks);
  /// The targets of block k without depth and ids, with coordinates of the picture; (x0, y0) is the
  /// block's upper left pixel.
  [[nodiscard]] Targets at(std::size_t k, int x0, int y0) const;
  /// Copies the blocks `won` from images that have them at their places in the picture.
  void take(const BlockGrid& grid, std::span<const BlockMask> won, const Targets& images) const;
  /// The targets of all blocks; pixel i of block k is at (i % 8, 8 k + i / 8).
  [[nodiscard]] const Targets& targets() const { return targets_; }

 private:
  std::vector<std::unique_ptr<std::byte[]>> pixels_;
  Targets targets_, shaded_;
};

/// Ranks send numbers of 64 bits. This class converts them for a root that asked for 32.
class WideTargets {
 public:
  /// `targets` with images of this object in the place of narrow ones.
  [[nodiscard]] Targets widen(const Targets& targets, int width, int height);
  /// Converts into the caller's `targets`. Throws Error{invalid_argument} for a number that 32 bits
  /// do not hold.
  void narrow(const Targets& targets) const;

 private:
  std::array<Image<std::int64_t>, 3> images_;  ///< of the targets that have a narrow form
};

/// Packs the pixels of `won`, all of whose blocks are in `own`.
void send_pixels(std::span<const BlockMask> won, const OwnBlocks& own, Bytes& to);
/// The receiving side: stores the pixels in the root's targets, of which the same ones are set.
void take_pixels(const BlockGrid& grid, Reader from, const Targets& targets);

}  // namespace rastrum::ranks
