// SPDX-License-Identifier: BSD-3-Clause
// A pixel's fragments on a device, blended exactly, through the small depth filter of paper 4
// (section "Sample blending"), or in the order of submission.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include <rastrum/raster/cuda/sample_pattern.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/surface_view.hpp>
#include <rastrum/transparency/over.hpp>
#include <rastrum/transparency/records.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::transparency::cuda {

struct KeepAll {
  RASTRUM_HD bool operator()(std::uint64_t, int, int) const { return true; }
};

/// A clipped triangle's pieces lie side by side and may overlap by a snapped vertex. The nearest
/// gives a pixel its fragment, of equal ones the first. key_at(piece) → its key there, 0 if it does
/// not cover the pixel.
template <class KeyAt>
RASTRUM_HD bool is_nearest_of_clipped(std::span<const raster::Piece> pieces, std::size_t piece,
                                      std::uint64_t key, const KeyAt& key_at) {
  const std::uint64_t low = pieces[piece].low;
  for (std::size_t k = piece; k-- > 0 && pieces[k].low == low;)
    if (key_at(pieces[k]) >= key) return false;
  for (std::size_t k = piece + 1; k < pieces.size() && pieces[k].low == low; ++k)
    if (key_at(pieces[k]) > key) return false;
  return true;
}

/// A triangle's data for a shader, made once for all of its fragments. Only shaders with a
/// Shade::Record have them; they also have Shade::wants_records and record(), and take a record in
/// place of a key's triangle.
struct NoRecord {};
template <class Shade>
struct RecordOfShade {
  using Type = NoRecord;
};
template <class Shade>
requires requires {
  typename Shade::Record;
}
struct RecordOfShade<Shade> {
  using Type = typename Shade::Record;
};
template <class Shade>
using RecordOf = typename RecordOfShade<Shade>::Type;
template <class Shade>
inline constexpr bool kHasRecords = !std::is_same_v<RecordOf<Shade>, NoRecord>;

/// A frame, or a band of it. Device memory: 8 × 8 blocks, row by row, of 64 pixels each, element 8
/// · row + column.
template <class Shade, class Test>
struct FrameView {
  raster::Rect view;  ///< begins with a block's first pixel
  std::span<const raster::Piece> pieces;
  std::uint64_t* keys;  ///< of the opaque surface; become the nearest fragment's
  Vec4* colors;         ///< of the opaque surface, premultiplied; become the picture's
  float opaque_at;      ///< a pixel is finished if no more shows through its layers
  Shade shade;          ///< (key, x, y) → premultiplied colour
  Test test;            ///< (key, x, y) → whether a fragment of a piece with kMayDrop passes
  const RecordOf<Shade>* shaded = nullptr;  ///< of each piece; may be null

  RASTRUM_HD std::size_t columns() const {
    return static_cast<std::size_t>((view.x1 - view.x0 + raster::kBlockSize - 1) /
                                    raster::kBlockSize);
  }
  RASTRUM_HD std::size_t rows() const {
    return static_cast<std::size_t>((view.y1 - view.y0 + raster::kBlockSize - 1) /
                                    raster::kBlockSize);
  }
  RASTRUM_HD int x_of(std::size_t b, std::size_t i) const {
    const auto column = static_cast<int>(raster::BlockPlace(b, columns()).column);
    return view.x0 + column * raster::kBlockSize + static_cast<int>(i % raster::kBlockSize);
  }
  RASTRUM_HD int y_of(std::size_t b, std::size_t i) const {
    const auto row = static_cast<int>(raster::BlockPlace(b, columns()).row);
    return view.y0 + row * raster::kBlockSize + static_cast<int>(i / raster::kBlockSize);
  }
  /// Samples of a pixel that a kernel blends at once.
  static constexpr int kSamples = 1;
  [[nodiscard]] FrameView from_sample(const raster::SamplePattern&, int, std::size_t) const {
    return *this;
  }
  RASTRUM_HD std::uint64_t& key_of(int, std::size_t at) const { return keys[at]; }
  RASTRUM_HD Vec4& color_of(int, std::size_t at) const { return colors[at]; }
  /// A record's key in a pixel of its mask; 0 if it has no fragment there or the test drops it.
  RASTRUM_HD std::uint64_t key(const raster::Block& record, int x, int y, int = 0) const {
    const raster::Piece& piece = pieces[record.piece];
    const std::uint64_t w = raster::make_key(raster::depth_at(piece, x, y), piece.low);
    const auto key_at = [&](const raster::Piece& other) { return key_where_covered(other, x, y); };
    return kept(record, w, x, y, key_at);
  }
  /// `key` is of any sample.
  RASTRUM_HD Vec4 color(std::uint32_t piece, std::uint64_t key, int x, int y) const {
    if constexpr (kHasRecords<Shade>)
      if (shaded != nullptr) return shade(shaded[piece], key, x, y);
    return shade(key, x, y);
  }

 protected:
  static RASTRUM_HD std::uint64_t key_where_covered(const raster::Piece& piece, int x, int y) {
    if (!raster::covers_centre(raster::edges_of(piece), x, y)) return 0;
    return raster::make_key(raster::depth_at(piece, x, y), piece.low);
  }
  template <class KeyAt>
  RASTRUM_HD std::uint64_t kept(const raster::Block& record, std::uint64_t w, int x, int y,
                                const KeyAt& key_at) const {
    const std::uint32_t flags = pieces[record.piece].flags;
    if (w == 0) return 0;
    if ((flags & raster::kClipped) != 0 && !is_nearest_of_clipped(pieces, record.piece, w, key_at))
      return 0;
    return (flags & raster::kMayDrop) != 0 && !test(w, x, y) ? 0 : w;
  }
};

/// Four of a frame's samples, whose keys and colours are planes. The pieces are at the pixels'
/// centres. A record has the pixels of which it covers any sample, so a given sample may have no
/// fragment. `shade` and `test` hold for all samples of a pixel, so four samples call them once.
template <class Shade, class Test>
struct SampledView : FrameView<Shade, Test> {
  static constexpr int kSamples = 4;
  raster::SampleOffset at[kSamples] = {};
  std::size_t plane = 0;  ///< from a sample to the next

  [[nodiscard]] SampledView from_sample(const raster::SamplePattern& samples, int first,
                                        std::size_t plane_size) const {
    SampledView v = *this;
    v.keys += static_cast<std::size_t>(first) * plane_size;
    v.colors += static_cast<std::size_t>(first) * plane_size;
    v.plane = plane_size;
    for (int s = 0; s < kSamples; ++s) v.at[s] = samples.at[first + s];
    return v;
  }
  RASTRUM_HD std::uint64_t& key_of(int s, std::size_t i) const {
    return this->keys[static_cast<std::size_t>(s) * plane + i];
  }
  RASTRUM_HD Vec4& color_of(int s, std::size_t i) const {
    return this->colors[static_cast<std::size_t>(s) * plane + i];
  }
  RASTRUM_HD Vec4 color(std::uint32_t piece, std::uint64_t key, int x, int y) const {
    if constexpr (kHasRecords<Shade>)
      if (this->shaded != nullptr)
        return this->shade(this->pieces[piece], this->shaded[piece], key, x, y);
    return this->shade(this->pieces[piece], key, x, y);
  }
  RASTRUM_HD std::uint64_t key(const raster::Block& record, int x, int y, int s) const {
    const auto key_at = [&](const raster::Piece& piece) {
      return this->key_where_covered(raster::moved(piece, at[s]), x, y);
    };
    return this->kept(record, key_at(this->pieces[record.piece]), x, y, key_at);
  }
};

struct Sample {
  std::uint64_t key = 0;  ///< 0: none
  Vec4 color{};
};

/// Holds back the nearest kHeld fragments, so that those of records that overlap in depth leave in
/// order. Eight cost the paper 1.5 % more than three. Here a fragment is 24 bytes, not 8, and
/// pixels that neither can order are repaired, so four.
class FrontToBackPixel {
 public:
  static constexpr std::size_t kHeld = 4;
  /// So few records may come in any order.
  static constexpr std::size_t kAnyOrder = kHeld + 1;

  /// Ascending, the order in which fragments should come. The primitive's id makes it unique;
  /// pieces of one triangle have no pixel in common.
  static RASTRUM_HD std::uint64_t record_sort_key(const raster::Piece& piece,
                                                  const raster::Block& b) {
    return near_first(piece, b.mask, b.bx, b.by) |
           static_cast<std::uint32_t>(raster::kIdMask - piece.low);
  }
  static RASTRUM_HD std::uint64_t fragment_sort_key(std::uint64_t key) { return ~key; }
  static RASTRUM_HD std::uint64_t key_of_sort_key(std::uint64_t sort_key) { return ~sort_key; }

  RASTRUM_HD void begin(Vec4 /*behind*/) { *this = FrontToBackPixel(); }

  RASTRUM_HD void take(Sample sample, float opaque_at) {
    for (std::size_t k = 0; k < kHeld; ++k)
      if (sample.key > held_[k].key) {
        const Sample other = held_[k];
        held_[k] = sample;
        sample = other;
      }
    if (sample.key == 0) return;
    leave(held_[0], opaque_at);
    for (std::size_t k = 1; k < kHeld; ++k) held_[k - 1] = held_[k];
    held_[kHeld - 1] = sample;
  }
  RASTRUM_HD void end(float opaque_at) {
    for (std::size_t k = 0; k < kHeld; ++k)
      if (held_[k].key != 0) leave(held_[k], opaque_at);
  }
  /// Only fragments with keys above this one change anything; `opaque` is the surface's key.
  /// Fragments behind a finished pixel's last layer are hidden; nearer ones should have come before
  /// it.
  [[nodiscard]] RASTRUM_HD std::uint64_t limit(std::uint64_t opaque) const {
    return misplaced_ ? ~std::uint64_t{0} : finished_ ? last_ : opaque;
  }
  [[nodiscard]] RASTRUM_HD bool misplaced() const { return misplaced_; }
  [[nodiscard]] RASTRUM_HD std::uint64_t nearest() const { return nearest_; }
  [[nodiscard]] RASTRUM_HD Vec4 color(Vec4 behind) const { return over(seen_, behind); }

 private:
  RASTRUM_HD void leave(const Sample& sample, float opaque_at) {
    if (sample.key > last_) misplaced_ = true;
    last_ = sample.key;
    if (nearest_ == 0) nearest_ = sample.key;
    if (finished_) return;
    add_behind(seen_, sample.color);
    finished_ = seen_.through <= opaque_at;
  }

  SeenPixel seen_;
  Sample held_[kHeld];  ///< nearest first
  std::uint64_t last_ = ~std::uint64_t{0}, nearest_ = 0;
  bool finished_ = false, misplaced_ = false;
};

/// Blends each fragment over the earlier ones, in the order of submission, as a GPU blends unsorted
/// triangles. A triangle's records share its id, so sorting by it is exact.
class AsSubmittedPixel {
 public:
  static constexpr std::size_t kAnyOrder = 1;
  static RASTRUM_HD std::uint64_t record_sort_key(const raster::Piece& piece,
                                                  const raster::Block&) {
    return raster::kIdMask - piece.low;
  }
  // The depth's sign is never set, so all of it fits behind the id.
  static RASTRUM_HD std::uint64_t fragment_sort_key(std::uint64_t key) {
    return raster::id_of_key(key) << (64 - raster::kIdBits) | key >> raster::kIdBits;
  }
  static RASTRUM_HD std::uint64_t key_of_sort_key(std::uint64_t sort_key) {
    constexpr int kDepthBits = 64 - raster::kIdBits;
    return (sort_key & ((std::uint64_t{1} << kDepthBits) - 1)) << raster::kIdBits |
           (raster::kIdMask - (sort_key >> kDepthBits));
  }

  RASTRUM_HD void begin(Vec4 behind) {
    color_ = behind;
    nearest_ = 0;
  }
  RASTRUM_HD void take(Sample sample, float) {
    color_ = before(sample.color, color_);
    if (sample.key > nearest_) nearest_ = sample.key;
  }
  RASTRUM_HD void end(float) {}
  [[nodiscard]] RASTRUM_HD std::uint64_t limit(std::uint64_t opaque) const { return opaque; }
  [[nodiscard]] RASTRUM_HD bool misplaced() const { return false; }
  [[nodiscard]] RASTRUM_HD std::uint64_t nearest() const { return nearest_; }
  [[nodiscard]] RASTRUM_HD Vec4 color(Vec4) const { return color_; }

 private:
  Vec4 color_{};
  std::uint64_t nearest_ = 0;
};

/// Blends a pixel front to back in several walks, each of which finds the next nearest kWindow
/// fragments: exact without memory, O(n² / kWindow). walk(f) calls f(key) for the fragments, in the
/// same order each time; shade(key) → colour. `nearest`: of all keys.
template <class Walk, class ShadeKey>
RASTRUM_HD SeenPixel blend_in_windows(const Walk& walk, const ShadeKey& shade, float opaque_at,
                                      std::uint64_t& nearest) {
  constexpr std::size_t kWindow = 8;
  struct Place {
    std::uint64_t key = 0;
    std::uint32_t number = 0;  ///< in the walk: equal keys may be several fragments
    RASTRUM_HD bool before(const Place& o) const {
      return key > o.key || (key == o.key && number < o.number);
    }
  };
  SeenPixel seen;
  Place last{~std::uint64_t{0}, 0};
  bool any = false;
  for (;;) {
    Place window[kWindow];
    std::uint32_t number = 0;
    bool more = false;
    walk([&](std::uint64_t key) {
      Place place{key, number++};
      if (any && !last.before(place)) return;
      for (std::size_t k = 0; k < kWindow; ++k)
        if (place.key != 0 && (window[k].key == 0 || place.before(window[k]))) {
          const Place other = window[k];
          window[k] = place;
          place = other;
        }
      more = more || place.key != 0;
    });
    if (!any) nearest = window[0].key;
    for (std::size_t k = 0; k < kWindow && window[k].key != 0; ++k) {
      add_behind(seen, shade(window[k].key));
      if (seen.through <= opaque_at) return seen;
    }
    if (!more) return seen;
    last = window[kWindow - 1];
    any = true;
  }
}

}  // namespace rastrum::transparency::cuda
