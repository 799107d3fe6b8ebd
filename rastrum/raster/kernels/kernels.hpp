// SPDX-License-Identifier: BSD-3-Clause
// The SIMD leaves of the pipeline: one table of functions per instruction set, chosen once per
// frame. `Isa::scalar` is the plain C++ of the headers (projection, setup, coverage); every other
// entry comes from one Highway source and gives the same bits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/frame.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/projection.hpp>
#include <rastrum/raster/rules/quadrics.hpp>
#include <rastrum/raster/rules/samples.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::raster {

struct QuadricEye;

inline constexpr std::uint32_t kManyBins = 0xFFFFFFFF;

/// The bins of a view are numbered row by row; `view` begins at a corner of a bin. Pieces with
/// kFacesAway or a flag of kMayDrop are in lists of their own, whose numbers are `later` higher; 0:
/// they are not.
struct BinNumbers {
  Rect view;
  std::uint32_t later = 0;
  int reach = 0;  ///< how far from the pixels' centres samples lie at most, n.8

  [[nodiscard]] std::uint32_t of(const Piece& piece, std::uint32_t bin) const {
    return bin + ((piece.flags & (kFacesAway | kMayDrop)) != 0 ? later : 0);
  }
};

/// A triangle of few pixels as a bin reads it: setup writes one for each bin that its box touches,
/// and no piece. It has no fragment test and was not clipped, and its id is below 2^32.
struct alignas(32) BinTriangle {
  struct Corner {
    std::int16_t x, y;  ///< from the bin's first pixel on, n.8; up to kMostRows px beside it
  };
  Corner corner[3];  ///< wound as a Piece's
  float z0, zx, zy;  ///< as a Piece has them
  std::uint32_t id;
  std::uint32_t bin;  ///< as BinNumbers has it
};
static_assert(sizeof(BinTriangle) == 32);
/// The largest box of one, px each way.
inline constexpr int kMostRows = 16;

/// Triangles [first, first + count) of a draw.
struct SetupInput {
  const std::uint32_t* indices = nullptr;  ///< of the draw; null: vertices in order
  const ProjectedVertex* vertices = nullptr;
  std::size_t vertex_count = 0;
  std::uint64_t first = 0;
  std::uint32_t count = 0;
  std::uint64_t first_id = 0;  ///< id of triangle 0 of the draw
  /// The number of each of its triangles, as `first` counts them; null: in order.
  const std::uint32_t* numbers = nullptr;
  std::uint32_t flags = 0;
  Cull cull = Cull::none;
  Rect view;
  std::uint32_t bin_columns = 0;  ///< bins in a row of the image
  bool micro = false;             ///< micro triangles may become fragments
  /// Several samples a pixel: a triangle is set up once, and drawn as each sample sees it, with the
  /// sample's number in the pieces' flags. Empty: the pixels' centres alone.
  std::span<const SampleOffset> samples;
  bool together = false;  ///< with `samples`: one piece for all of them (kAllSamples)
  /// With `samples`: a bit for each triangle of `count`, from bit `first_seen` on, is set where its
  /// box holds a sample and it is not culled.
  std::uint64_t* seen = nullptr;
  std::uint32_t first_seen = 0;
  /// Room for triangles that are small enough, in the bins of `bins`; null: they become pieces. It
  /// holds four times as many as there are triangles.
  BinTriangle* small = nullptr;
  BinNumbers bins;
};

/// The id of triangle `t` of a draw, counted as `first` is.
[[nodiscard]] inline std::uint64_t id_of(const SetupInput& in, std::uint64_t t) {
  return in.first_id + (in.numbers != nullptr ? in.numbers[t] : t);
}

/// At most this many triangles a call, those of each sample counted; callers provide that many
/// pieces and slow entries, and kSetupFragments fragments.
inline constexpr std::uint32_t kSetupBatch = 256;
/// Vectors may write some more than are said to be there.
inline constexpr std::uint32_t kSetupFragments = kSetupBatch * kMicroSize * kMicroSize + 16;

struct SetupOutput {
  std::uint32_t pieces = 0;     ///< written
  std::uint32_t fragments = 0;  ///< written
  std::uint32_t small = 0;      ///< written, of so many triangles
  std::uint32_t small_triangles = 0;
  std::uint32_t micro = 0;     ///< drawn as fragments, or covering no sample
  std::uint32_t slow = 0;      ///< triangles left to the clipper, as offsets from `first`
  bool index_in_range = true;  ///< false: the batch was abandoned
};

/// Points that become fragments at once. `slow` gets those that need the clipper or are larger than
/// kMicroPoint.
struct PointsInput {
  const ProjectedVertex* vertices = nullptr;  ///< one a point
  std::uint32_t count = 0;                    ///< at most kSetupBatch
  const std::int32_t* sizes = nullptr;        ///< n.8, one a point; null: all are one pixel
  std::uint64_t first_id = 0;
  std::uint32_t flags = 0;  ///< without any of kMayDrop
  Rect view;
  std::uint32_t bin_columns = 0;  ///< bins in a row of the image
};
/// The largest of them, n.8: nine fragments take no more memory than a piece and its places.
inline constexpr std::int32_t kMicroPoint = 3 * kSubpixels;

/// A (bin, piece) pair. Coverages that draw some pieces after the rest number the bins twice
/// (BinNumbers).
struct PieceInBin {
  std::uint32_t bin, piece;
};

/// The pieces of a bin, by their positions in `pieces`.
struct PieceList {
  const Piece* pieces = nullptr;
  const PieceInBin* list = nullptr;
  std::size_t count = 0;
};

/// Bins own their keys: 8 × 8 blocks in rows, 64 keys each.
inline constexpr int kBinSize = 64;
inline constexpr int kBlocksPerBinRow = kBinSize / kBlockSize;
inline constexpr int kBlocksPerBin = kBlocksPerBinRow * kBlocksPerBinRow;

/// A fragment at pixel (x, y) of an image with so many bins in a row; `flags` are its piece's.
RASTRUM_HD inline BinFragment fragment_at(int x, int y, std::uint64_t key, std::uint32_t flags,
                                          std::uint32_t bin_columns) {
  const auto ux = static_cast<std::uint32_t>(x), uy = static_cast<std::uint32_t>(y);
  return {key, uy / kBinSize * bin_columns + ux / kBinSize,
          ((uy % kBinSize / kBlockSize * kBlocksPerBinRow + ux % kBinSize / kBlockSize) * 64 +
           uy % kBlockSize * kBlockSize + ux % kBlockSize) |
              ((flags & kTranslucent) != 0 ? kTranslucentFragment : 0)};
}
/// Where in its bin a fragment lies, px.
RASTRUM_HD inline int column_in_bin(const BinFragment& f) {
  const auto pixel = static_cast<int>(f.pixel & ~kTranslucentFragment);
  return pixel / 64 % kBlocksPerBinRow * kBlockSize + pixel % kBlockSize;
}
RASTRUM_HD inline int row_in_bin(const BinFragment& f) {
  const auto pixel = static_cast<int>(f.pixel & ~kTranslucentFragment);
  return pixel / 64 / kBlocksPerBinRow * kBlockSize + pixel % 64 / kBlockSize;
}

/// Hierarchical Z (Greene, "Hierarchical polygon tiling with coverage masks", 1996; papers 1 and 5
/// name it as missing): what is surely hidden in a bin. A piece or block is left out where its
/// highest depth is strictly below a bound, so that no pixel changes, ties included.
struct DepthBounds {
  float block[kBlocksPerBin] = {};  ///< no sample of the block is farther; 0: nothing is known
  float bin = 0;                    ///< the lowest of them
  std::uint64_t hidden_pieces = 0, hidden_blocks = 0;  ///< what was left out

  void restart() {
    std::fill_n(block, kBlocksPerBin, 0.0F);
    bin = 0;
  }
};

/// Spheres, cones and their like of one draw, whose pieces may be deferred.
struct QuadricInput {
  const QuadricEye* eye = nullptr;
  const QuadricShape* shapes = nullptr;    ///< something of each is to be drawn
  const std::uint32_t* numbers = nullptr;  ///< in the batch, of each shape
  std::uint32_t count = 0;
  std::uint64_t first_id = 0;  ///< of number 0
  std::uint32_t flags = 0;     ///< of the pieces
  Rect view;
};

/// A deferred piece in a bin: all that a bin reads of it, since a million pieces are far apart.
struct DeferredInBin {
  std::uint64_t low;            ///< the key's
  float highest;                ///< none of its depths is larger
  std::uint8_t x0, y0, x1, y1;  ///< the samples of its box, px in the bin
  std::uint32_t bin;
};

/// Deferred quadrics that a bin makes at once, one a lane: all are of one stage.
struct QuadricBatch {
  static constexpr std::uint32_t kCapacity = 16;
  const QuadricEye* eye = nullptr;
  QuadricKind kind{};  ///< of all
  std::uint32_t count = 0;
  QuadricShape shapes[kCapacity];
  DeferredInBin places[kCapacity];
};

/// The keys of a bin's samples, four samples of a pixel side by side: a row of a small triangle is
/// one run of memory. `keys` is aligned to 64 bytes.
struct SampledKeys {
  /// The distance from one row of pixels to the next. It is a cache line longer than a row, so that
  /// the keys of a column do not all fall on the same places of a cache.
  static constexpr std::size_t kRow = 4 * kBinSize + 8;
  static constexpr std::size_t kFour = kRow * kBinSize;  ///< from four samples to the next four

  std::uint64_t* keys = nullptr;
  int x0 = 0, y0 = 0;  ///< the bin's first pixel
  std::span<const SampleOffset> samples;
  /// Whether the last bits of keys tell where in the pixel a primitive is shaded, with four
  /// samples: ids below kPlacedIds leave room for it. The place is the same at all samples of a
  /// pixel, so the largest key is still the nearest surface.
  bool has_places = false;

  static constexpr int kPlaceBits = 3;
  static constexpr std::uint64_t kPlacedIds = (kIdMask >> kPlaceBits) - 1;
  /// 0: at the centre, 1 + s: at sample s, the first that the primitive covers. Unknown for other
  /// primitives than triangles, for fragments that are tested, and for clipped triangles, where
  /// another piece may cover the centre.
  static constexpr std::uint64_t kUnknownPlace = (1 << kPlaceBits) - 1;

  /// The low part that a piece's keys have here.
  [[nodiscard]] std::uint64_t low(std::uint64_t piece_low, std::uint64_t place) const {
    return has_places ? ((piece_low << kPlaceBits) & kIdMask) | place : piece_low;
  }
  /// The form that a key has elsewhere, without a place. `key` must not be 0.
  [[nodiscard]] std::uint64_t plain(std::uint64_t key) const {
    if (!has_places) return key;
    return (key & ~kIdMask) | kLargeLow | (key & kIdMask) >> kPlaceBits;
  }
  /// The high bits of `low` that all ids below kPlacedIds have in common.
  static constexpr std::uint64_t kLargeLow = kIdMask & ~(kIdMask >> kPlaceBits);

  /// The keys of the first four samples of pixel (x, y).
  [[nodiscard]] std::uint64_t* at(int x, int y) const {
    return keys + static_cast<std::size_t>(y - y0) * kRow + static_cast<std::size_t>(x - x0) * 4;
  }
  [[nodiscard]] std::uint64_t& at(int x, int y, std::size_t sample) const {
    return at(x, y)[sample / 4 * kFour + sample % 4];
  }
};

/// Which primitives the samples of a block's pixels see.
struct SeenBySamples {
  std::uint64_t covered = 0;  ///< pixels of which some sample sees a primitive
  std::uint64_t mixed = 0;    ///< pixels whose samples do not all see the same
  /// Where pixels are mixed, four bits for each sample: the first sample that sees the same.
  alignas(64) std::uint64_t first[64];
  /// For keys without places, a bit for each first sample: two opposite samples see the same, so
  /// the primitive covers the centre between them, too.
  alignas(64) std::uint64_t centred[64];
  /// For keys with places, four bits for each sample: its place.
  alignas(64) std::uint64_t places[64];
};

/// Keys of small triangles of a bin, or of a part of one, on their way to its blocks: in rows of
/// pixels, so that a triangle's row is a run of memory wherever it begins.
struct RowKeys {
  /// The distance from one row to the next. It leaves room for the rest of a vector that begins in
  /// the bin's last pixel.
  static constexpr std::size_t kRow = kBinSize + kBlockSize;
  static constexpr std::size_t kSize = kRow * kBinSize;

  std::uint64_t* keys = nullptr;  ///< kSize; 0 where nothing is on its way
  Rect touched;                   ///< outside of it, px of the picture, all are 0
  std::uint64_t fragments = 0;    ///< samples that were covered
  /// By block: triangles since the last look at it, large ones several times.
  std::uint32_t unseen[kBlocksPerBin] = {};
};

/// The result of raising the keys of a bin.
struct RaisedKeys {
  std::uint64_t fragments = 0;      ///< samples that are covered
  std::uint64_t blocks = 0;         ///< a bit for each block that has one
  std::uint64_t hidden_blocks = 0;  ///< not covered, since they are hidden
};

struct Kernels {
  /// n positions through the matrix, the divide, the viewport and the snapping.
  void (*project)(const Vec3* positions, std::size_t n, const Mat4& object_to_clip,
                  Viewport viewport, ProjectedVertex* out) noexcept;

  /// The same in float64 up to clip space, where they are rounded once.
  void (*project64)(const Vec3d* positions, std::size_t n, const Mat4d& object_to_clip,
                    Viewport viewport, ProjectedVertex* out) noexcept;

  /// Culls and sets up a batch. With `micro`, a triangle without a fragment test whose box is small
  /// enough may become fragments instead of a piece, or nothing where it covers no sample.
  SetupOutput (*setup)(const SetupInput& input, Piece* pieces, BinFragment* fragments,
                       std::uint32_t* slow) noexcept;

  /// Turns points into fragments, in order: `micro` of the result counts those that are drawn so.
  SetupOutput (*points)(const PointsInput& input, BinFragment* fragments,
                        std::uint32_t* slow) noexcept;

  /// Writes the blocks of `bin` that pieces list[cursor …] cover (no mask is empty) until the list
  /// ends, fewer than kBlocksPerBin places are left or kMostRowPieces pieces were taken with rows.
  /// Returns how many, and moves the cursor. `bounds` and `rows` may be null. Triangles without a
  /// fragment test may raise `rows`, whose first key is that of the first pixel of `bin`, instead
  /// of writing blocks.
  std::size_t (*cover)(const PieceList& pieces, std::size_t& cursor, Rect bin, Block* out,
                       std::size_t capacity, DepthBounds* bounds, RowKeys* rows) noexcept;

  /// Raises `rows` by small triangles of the bin whose first pixel is (x0, y0), as far as they lie
  /// in `rect`. `rect` is that bin or a part of it, and the first key is that of its first pixel.
  /// `bounds` may be null. Null where setup writes no small triangles.
  void (*raise_small)(const BinTriangle* triangles, std::size_t n, int x0, int y0, Rect rect,
                      DepthBounds* bounds, RowKeys& rows) noexcept;

  /// Finds the masks of blocks whose mask is 0; they may be empty.
  void (*masks)(const Piece* pieces, Block* blocks, std::size_t n) noexcept;

  /// Writes the keys that the piece would have, covered or not, in those rows of a block in which
  /// it covers a sample. The other rows are left as they are.
  void (*keys)(const Piece& piece, const Block& block, std::uint64_t* keys) noexcept;

  /// The atomic sink on keys that the caller owns: maximum at every covered sample.
  void (*maximum)(const Piece* pieces, const Block* blocks, std::size_t n,
                  const SurfaceView& surface) noexcept;

  /// The smallest of 64 keys.
  std::uint64_t (*lowest)(const std::uint64_t* keys) noexcept;

  /// Raises the 64 keys of a block by those that wait in `rows` (from the block's first on), which
  /// become 0. Returns the smallest key of the block.
  std::uint64_t (*take_rows)(std::uint64_t* rows, std::uint64_t* block) noexcept;

  /// Which of 64 keys are not 0.
  std::uint64_t (*covered)(const std::uint64_t* keys) noexcept;

  /// Raises the keys of `bin` by those pieces in [begin, end) of a list that are of all samples and
  /// have no fragment test. Returns how many samples they cover. `bounds` may be null, else the
  /// bounds of blocks that a large triangle fills are raised.
  std::uint64_t (*raise_samples)(const PieceList& pieces, std::size_t begin, std::size_t end,
                                 Rect bin, const SampledKeys& keys, DepthBounds* bounds) noexcept;

  /// The least depths of the blocks of `bin`, as far as something is seen everywhere in them.
  void (*find_sampled_bounds)(const SampledKeys& keys, Rect bin, DepthBounds& bounds) noexcept;

  /// Merges the samples of the block that begins at pixel (x, y): gives the largest key of each
  /// pixel and the key of its first sample, both as other pictures have them, and what all samples
  /// see.
  void (*merge)(const SampledKeys& keys, int x, int y, std::uint64_t* largest, std::uint64_t* first,
                SeenBySamples& seen) noexcept;

  /// Stores a whole block of opaque colours in 8 bits, `background` where nothing is covered.
  void (*store_opaque)(const BlockColors& colors, std::uint64_t covered, Rgba8 background,
                       Rgba8* out, std::ptrdiff_t stride) noexcept;

  /// The same for colours that may be translucent.
  void (*store_blended)(const BlockColors& colors, std::uint64_t covered, const Backdrop& backdrop,
                        Rgba8* out, std::ptrdiff_t stride) noexcept;

  /// Fills rows with a pixel.
  void (*fill)(Rgba8 with, int columns, int rows, Rgba8* to, std::ptrdiff_t stride) noexcept;

  /// Copies rows of pixels, or fills them. Whole cache lines go past the caches, for pixels that
  /// are not read soon. `from` has `columns` pixels from one row to the next. Other threads see the
  /// pixels after `end_stream`.
  void (*stream)(const Rgba8* from, int columns, int rows, Rgba8* to,
                 std::ptrdiff_t stride) noexcept;
  void (*stream_fill)(Rgba8 with, int columns, int rows, Rgba8* to, std::ptrdiff_t stride) noexcept;
  void (*end_stream)() noexcept;

  /// Finds the bin that holds the box of each of n pieces, or kManyBins where the piece has to be
  /// looked at: a box in several bins or in none, a line, a point, a deferred piece.
  void (*bins)(const Piece* pieces, std::size_t n, const BinNumbers& numbers,
               std::uint32_t* bins) noexcept;

  /// Writes the deferred pieces of those quadrics that have one surface, the one in front, and are
  /// not cut by the near plane. `slow` gets the numbers of the others, which assemble_primitive
  /// must make.
  SetupOutput (*defer)(const QuadricInput& input, Piece* pieces, std::uint32_t* slow) noexcept;

  /// Makes the quadrics of deferred pieces and raises the keys of a bin by them. `bounds` may be
  /// null.
  RaisedKeys (*raise)(const QuadricBatch& batch, Rect bin, const DepthBounds* bounds,
                      const SurfaceView& surface) noexcept;
};

/// The table of `isa`, one of available_isas() (choose_isa); of others, plain C++.
[[nodiscard]] const Kernels& kernels(Isa isa);

}  // namespace rastrum::raster
