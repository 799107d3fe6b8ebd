// SPDX-License-Identifier: BSD-3-Clause
// The targets that the root asks for, a rank's images for them, and the way of won pixels to the
// root.
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

/// Calls f(view, bit) for each target that ranks can fill, in the order of sending.
template <class T, class F>
constexpr void each_target(T& t, const F& f) {
  std::uint32_t bit = 1;
  raster::for_each_target([&](const auto& row) {
    if (row.has_ranks()) f(t.*row.image, std::exchange(bit, bit << 1));
  });
}
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
/// The bits of `depth` and `ids`, which words and the list of parts determine.
inline constexpr std::uint32_t kKnownTargets =
    bits_of([](const auto& row) { return row.kind == raster::TargetKind::key; });
/// The bits of targets that layers change: `color8`, `color` and `linear`.
inline constexpr std::uint32_t kColorTargets =
    bits_of([](const auto& row) { return row.kind == raster::TargetKind::color; });
inline constexpr std::uint32_t kColorTarget =
    bits_of([](const auto& row) { return row.name == "color"; });
inline constexpr std::uint32_t kLinearTarget =
    bits_of([](const auto& row) { return row.name == "linear"; });

[[nodiscard]] std::uint32_t targets_asked(const Targets& targets);

/// The targets whose bits are set; the others become empty.
[[nodiscard]] Targets targets_of(const Targets& targets, std::uint32_t bits);

/// Views an image in the picture's coordinates; its first row is the picture's row `top`.
template <class T>
[[nodiscard]] ImageView<T> in_place(ImageView<T> rows, int top) {
  if (rows.empty()) return rows;
  rows.data -= top * rows.stride;
  rows.height += top;
  return rows;
}
[[nodiscard]] Targets in_place(const Targets& rows, int top);
/// The first `rows` rows of each target, including 32-bit ones.
[[nodiscard]] Targets first_rows(const Targets& targets, int rows);

/// A rank's images of a part of the picture, for the targets of `asked`.
class OwnImages {
 public:
  OwnImages(std::uint32_t asked, raster::Rect part);
  /// In the picture's coordinates; only pixels of the part exist.
  [[nodiscard]] const Targets& targets() const { return targets_; }

 private:
  template <class... T>
  using Lists = std::tuple<std::vector<Image<T>>...>;
  Lists<Rgba8, Vec2, Vec3, Vec4, float, std::int64_t, std::int32_t, std::uint64_t, std::uint32_t,
        std::uint8_t>
      images_;
  Targets targets_;
};

/// A rank's pixels in some blocks, for the targets of `asked`: 64 per block and target, block after
/// block, uninitialized.
class OwnBlocks {
 public:
  OwnBlocks(std::uint32_t asked, std::size_t blocks);
  /// Block k's targets without depth and ids, in the picture's coordinates; (x0, y0) is its upper
  /// left pixel.
  [[nodiscard]] Targets at(std::size_t k, int x0, int y0) const;
  /// Copies the blocks `won` from images of the picture.
  void take(const BlockGrid& grid, std::span<const BlockMask> won, const Targets& images) const;
  /// The targets of all blocks; pixel i of block k is at (i % 8, 8 k + i / 8).
  [[nodiscard]] const Targets& targets() const { return targets_; }

 private:
  std::vector<std::unique_ptr<std::byte[]>> pixels_;
  Targets targets_, shaded_;
};

/// Ranks send 64-bit numbers; this converts them for a root that asked for 32 bits.
class WideTargets {
 public:
  /// Replaces narrow targets by images of this object.
  [[nodiscard]] Targets widen(const Targets& targets, int width, int height);
  /// Converts into the caller's `targets`. Throws Error{invalid_argument} if a number does not fit.
  void narrow(const Targets& targets) const;

 private:
  std::array<Image<std::int64_t>, 3> images_;  ///< of the targets that have a narrow form
};

/// Packs the pixels of `won`; `own` has the same blocks.
void send_pixels(std::span<const BlockMask> won, const OwnBlocks& own, Bytes& to);
/// Unpacks them into the root's targets, which must be the same ones.
void take_pixels(const BlockGrid& grid, Reader from, const Targets& targets);

}  // namespace rastrum::ranks
