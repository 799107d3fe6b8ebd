// SPDX-License-Identifier: BSD-3-Clause
// The SIMD kernels: one table of functions per instruction set, chosen once a frame. `Isa::scalar`
// is the plain C++ of the headers (projection, setup, coverage). All others come from one Highway
// source and give the same bits.
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

/// The bins of a view, which begins at a corner of a bin, numbered row by row. Pieces with
/// kFacesAway or a flag of kMayDrop have lists of their own, whose numbers are `later` higher. 0:
/// they have none.
struct BinNumbers {
  Rect view;
  std::uint32_t later = 0;
  int reach = 0;  ///< the largest distance of samples from pixel centres, n.8

  [[nodiscard]] std::uint32_t of(const Piece& piece, std::uint32_t bin) const {
    return bin + ((piece.flags & (kFacesAway | kMayDrop)) != 0 ? later : 0);
  }
};

/// A triangle of few pixels as a bin reads it. Setup writes one for each bin that its box touches,
/// and no piece. It is not clipped and has no fragment test, and its id is below 2^32.
struct alignas(32) BinTriangle {
  struct Corner {
    std::int16_t x, y;  ///< from the bin's first pixel, n.8; up to kMostRows px outside
  };
  Corner corner[3];  ///< wound as in a Piece
  float z0, zx, zy;  ///< as in a Piece
  std::uint32_t id;
  std::uint32_t bin;  ///< as in BinNumbers
};
static_assert(sizeof(BinTriangle) == 32);
/// The largest box of a BinTriangle, px each way.
inline constexpr int kMostRows = 16;

/// Triangles [first, first + count) of a draw.
struct SetupInput {
  const std::uint32_t* indices = nullptr;  ///< the draw's; null: vertices in order
  const ProjectedVertex* vertices = nullptr;
  std::size_t vertex_count = 0;
  std::uint64_t first = 0;
  std::uint32_t count = 0;
  std::uint64_t first_id = 0;  ///< id of triangle 0 of the draw
  /// The number of each triangle that `first` counts; null: in order.
  const std::uint32_t* numbers = nullptr;
  std::uint32_t flags = 0;
  Cull cull = Cull::none;
  Rect view;
  std::uint32_t bin_columns = 0;  ///< bins in a row of the image
  bool micro = false;             ///< micro triangles may become fragments
  /// Several samples a pixel: a triangle is set up once and moved for each sample, whose number is
  /// in the pieces' flags. Empty: only the pixels' centres.
  std::span<const SampleOffset> samples;
  bool together = false;  ///< with `samples`: one piece for all (kAllSamples)
  /// With `samples`: bit first_seen + i is set where triangle i is not culled and its box holds a
  /// sample.
  std::uint64_t* seen = nullptr;
  std::uint32_t first_seen = 0;
  /// Room for triangles that are small enough, in the bins of `bins`; null: they become pieces.
  /// Holds four times the number of triangles.
  BinTriangle* small = nullptr;
  BinNumbers bins;
};

/// The id of triangle `t`, counted as `first`.
[[nodiscard]] inline std::uint64_t id_of(const SetupInput& in, std::uint64_t t) {
  return in.first_id + (in.numbers != nullptr ? in.numbers[t] : t);
}

/// The most triangles a call, counting those of each sample. Callers provide that many pieces and
/// slow entries, and kSetupFragments fragments.
inline constexpr std::uint32_t kSetupBatch = 256;
/// Vectors may write a little beyond the reported end.
inline constexpr std::uint32_t kSetupFragments = kSetupBatch * kMicroSize * kMicroSize + 16;

struct SetupOutput {
  std::uint32_t pieces = 0;     ///< written
  std::uint32_t fragments = 0;  ///< written
  std::uint32_t small = 0;      ///< written, for small_triangles triangles
  std::uint32_t small_triangles = 0;
  std::uint32_t micro = 0;     ///< triangles drawn as fragments, or covering no sample
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
  std::uint32_t flags = 0;  ///< none of kMayDrop
  Rect view;
  std::uint32_t bin_columns = 0;  ///< bins in a row of the image
};
/// The largest such point, n.8: nine fragments take no more memory than a piece and its places.
inline constexpr std::int32_t kMicroPoint = 3 * kSubpixels;

/// Coverages that draw some pieces later number the bins twice (BinNumbers).
struct PieceInBin {
  std::uint32_t bin, piece;
};

/// The pieces of a bin, as positions in `pieces`.
struct PieceList {
  const Piece* pieces = nullptr;
  const PieceInBin* list = nullptr;
  std::size_t count = 0;
};

inline constexpr int kBinSize = 64;
inline constexpr int kBlocksPerBinRow = kBinSize / kBlockSize;
inline constexpr int kBlocksPerBin = kBlocksPerBinRow * kBlocksPerBinRow;

/// The fragment at pixel (x, y) of an image with `bin_columns` bins in a row; `flags`: its piece's.
RASTRUM_HD inline BinFragment fragment_at(int x, int y, std::uint64_t key, std::uint32_t flags,
                                          std::uint32_t bin_columns) {
  const auto ux = static_cast<std::uint32_t>(x), uy = static_cast<std::uint32_t>(y);
  return {key, uy / kBinSize * bin_columns + ux / kBinSize,
          ((uy % kBinSize / kBlockSize * kBlocksPerBinRow + ux % kBinSize / kBlockSize) * 64 +
           uy % kBlockSize * kBlockSize + ux % kBlockSize) |
              ((flags & kTranslucent) != 0 ? kTranslucentFragment : 0)};
}
/// In px.
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
/// highest depth is strictly below a bound, so no pixel changes, even in a tie.
struct DepthBounds {
  float block[kBlocksPerBin] = {};  ///< no sample of the block is farther; 0: unknown
  float bin = 0;                    ///< the lowest of them
  std::uint64_t hidden_pieces = 0, hidden_blocks = 0;  ///< left out

  void restart() {
    std::fill_n(block, kBlocksPerBin, 0.0F);
    bin = 0;
  }
};

/// Spheres, cones and the like of one draw, whose pieces may be deferred.
struct QuadricInput {
  const QuadricEye* eye = nullptr;
  const QuadricShape* shapes = nullptr;    ///< some part of each is to be drawn
  const std::uint32_t* numbers = nullptr;  ///< each shape's number in the batch
  std::uint32_t count = 0;
  std::uint64_t first_id = 0;  ///< of number 0
  std::uint32_t flags = 0;     ///< the pieces'
  Rect view;
};

/// All that a bin reads of a deferred piece, in one place, since a million pieces are far apart.
struct DeferredInBin {
  std::uint64_t low;            ///< the key's low part
  float highest;                ///< none of its depths is larger
  std::uint8_t x0, y0, x1, y1;  ///< samples of its box, px in the bin
  std::uint32_t bin;
};

/// Deferred quadrics that a bin makes at once, one a lane. All are of one stage.
struct QuadricBatch {
  static constexpr std::uint32_t kCapacity = 16;
  const QuadricEye* eye = nullptr;
  QuadricKind kind{};  ///< of all
  std::uint32_t count = 0;
  QuadricShape shapes[kCapacity];
  DeferredInBin places[kCapacity];
};

/// The keys of a bin's samples, four samples of a pixel side by side, so that a row of a small
/// triangle is contiguous. `keys` is aligned to 64 bytes.
struct SampledKeys {
  /// The distance between rows of pixels: a cache line more than a row, so that the keys of a
  /// column do not compete for the same cache sets.
  static constexpr std::size_t kRow = 4 * kBinSize + 8;
  static constexpr std::size_t kFour = kRow * kBinSize;  ///< between four samples and the next four

  std::uint64_t* keys = nullptr;
  int x0 = 0, y0 = 0;  ///< the bin's first pixel
  std::span<const SampleOffset> samples;
  /// Whether, with four samples, a key's last bits tell where in the pixel its primitive is shaded.
  /// Ids below kPlacedIds leave room for that. The place is the same at all samples of a pixel, so
  /// the largest key is still the nearest surface.
  bool has_places = false;

  static constexpr int kPlaceBits = 3;
  static constexpr std::uint64_t kPlacedIds = (kIdMask >> kPlaceBits) - 1;
  /// 0: the centre. 1 + s: sample s, the first that the primitive covers. Unknown for fragments
  /// that are tested, for primitives other than triangles, and for clipped triangles, where another
  /// piece may cover the centre.
  static constexpr std::uint64_t kUnknownPlace = (1 << kPlaceBits) - 1;

  /// The low part of a piece's keys here.
  [[nodiscard]] std::uint64_t low(std::uint64_t piece_low, std::uint64_t place) const {
    return has_places ? ((piece_low << kPlaceBits) & kIdMask) | place : piece_low;
  }
  /// The key as it is elsewhere, without a place. `key` must not be 0.
  [[nodiscard]] std::uint64_t plain(std::uint64_t key) const {
    if (!has_places) return key;
    return (key & ~kIdMask) | kLargeLow | (key & kIdMask) >> kPlaceBits;
  }
  /// High bits of `low` that all ids below kPlacedIds share.
  static constexpr std::uint64_t kLargeLow = kIdMask & ~(kIdMask >> kPlaceBits);

  /// The keys of the first four samples of pixel (x, y).
  [[nodiscard]] std::uint64_t* at(int x, int y) const {
    return keys + static_cast<std::size_t>(y - y0) * kRow + static_cast<std::size_t>(x - x0) * 4;
  }
  [[nodiscard]] std::uint64_t& at(int x, int y, std::size_t sample) const {
    return at(x, y)[sample / 4 * kFour + sample % 4];
  }
};

struct SeenBySamples {
  std::uint64_t covered = 0;  ///< pixels with a sample that sees a primitive
  std::uint64_t mixed = 0;    ///< pixels whose samples see different ones
  /// In mixed pixels, four bits a sample: the first sample that sees the same primitive.
  alignas(64) std::uint64_t first[64];
  /// For keys without places, a bit for each first sample: two opposite samples see its primitive,
  /// so it covers the centre between them, too.
  alignas(64) std::uint64_t centred[64];
  /// For keys with places, four bits a sample: its place.
  alignas(64) std::uint64_t places[64];
};

/// Keys of a bin's small triangles, or of a part of a bin, on their way to its blocks. They lie in
/// rows of pixels, so that a triangle's row is contiguous wherever it begins.
struct RowKeys {
  /// The distance between rows, with room for the rest of a vector that begins in the bin's last
  /// pixel.
  static constexpr std::size_t kRow = kBinSize + kBlockSize;
  static constexpr std::size_t kSize = kRow * kBinSize;

  std::uint64_t* keys = nullptr;  ///< kSize; 0: nothing waits
  Rect touched;                   ///< all outside of it are 0; px of the picture
  std::uint64_t fragments = 0;    ///< samples covered
  /// By block: triangles since its bound was updated, large ones counted several times.
  std::uint32_t unseen[kBlocksPerBin] = {};
};

struct RaisedKeys {
  std::uint64_t fragments = 0;      ///< samples covered
  std::uint64_t blocks = 0;         ///< a bit for each block that has one
  std::uint64_t hidden_blocks = 0;  ///< left out, since they are hidden
};

struct Kernels {
  /// n positions through matrix, divide, viewport and snapping.
  void (*project)(const Vec3* positions, std::size_t n, const Mat4& object_to_clip,
                  Viewport viewport, ProjectedVertex* out) noexcept;

  /// The same, in float64 up to clip space, where positions are rounded once.
  void (*project64)(const Vec3d* positions, std::size_t n, const Mat4d& object_to_clip,
                    Viewport viewport, ProjectedVertex* out) noexcept;

  /// Culls and sets up a batch. With `micro`, a triangle without a fragment test and with a small
  /// enough box may become fragments, or nothing where it covers no sample.
  SetupOutput (*setup)(const SetupInput& input, Piece* pieces, BinFragment* fragments,
                       std::uint32_t* slow) noexcept;

  /// Turns points into fragments, in order. The result's `micro` counts the points that were.
  SetupOutput (*points)(const PointsInput& input, BinFragment* fragments,
                        std::uint32_t* slow) noexcept;

  /// Writes the blocks of `bin` that pieces list[cursor …] cover (no mask is empty) until the list
  /// ends, fewer than kBlocksPerBin places are left, or kMostRowPieces pieces were taken with rows.
  /// Returns their number and moves the cursor. `bounds` and `rows` may be null. Triangles without
  /// a fragment test may raise `rows`, which starts at the first pixel of `bin`, instead.
  std::size_t (*cover)(const PieceList& pieces, std::size_t& cursor, Rect bin, Block* out,
                       std::size_t capacity, DepthBounds* bounds, RowKeys* rows) noexcept;

  /// Raises `rows` by small triangles of the bin whose first pixel is (x0, y0), cut to `rect`: the
  /// bin or a part of it, at whose first pixel the rows start. `bounds` may be null. This entry is
  /// null where setup writes no small triangles.
  void (*raise_small)(const BinTriangle* triangles, std::size_t n, int x0, int y0, Rect rect,
                      DepthBounds* bounds, RowKeys& rows) noexcept;

  /// Finds the masks of blocks whose mask is 0. They may be empty.
  void (*masks)(const Piece* pieces, Block* blocks, std::size_t n) noexcept;

  /// Writes the piece's keys, covered or not, in the rows of a block where it covers a sample.
  /// Leaves the other rows unchanged.
  void (*keys)(const Piece& piece, const Block& block, std::uint64_t* keys) noexcept;

  /// The atomic sink for keys that the caller owns: the maximum at every covered sample.
  void (*maximum)(const Piece* pieces, const Block* blocks, std::size_t n,
                  const SurfaceView& surface) noexcept;

  std::uint64_t (*lowest)(const std::uint64_t* keys) noexcept;

  /// Raises the 64 keys of a block by those waiting in `rows` (from the block's first on) and
  /// clears these. Returns the block's smallest key.
  std::uint64_t (*take_rows)(std::uint64_t* rows, std::uint64_t* block) noexcept;

  std::uint64_t (*covered)(const std::uint64_t* keys) noexcept;

  /// Raises the keys of `bin` by those pieces in [begin, end) of a list that are for all samples
  /// and have no fragment test. Returns the number of samples covered. With `bounds` (may be null),
  /// raises the bounds of blocks that a large triangle fills.
  std::uint64_t (*raise_samples)(const PieceList& pieces, std::size_t begin, std::size_t end,
                                 Rect bin, const SampledKeys& keys, DepthBounds* bounds) noexcept;

  /// The least depth of each block of `bin` in which all samples see a surface.
  void (*find_sampled_bounds)(const SampledKeys& keys, Rect bin, DepthBounds& bounds) noexcept;

  /// Merges the samples of the block at pixel (x, y): each pixel's largest key and the key of its
  /// first sample, both without places, and what all samples see.
  void (*merge)(const SampledKeys& keys, int x, int y, std::uint64_t* largest, std::uint64_t* first,
                SeenBySamples& seen) noexcept;

  /// Stores a block of opaque colours in 8 bits, `background` where nothing is covered.
  void (*store_opaque)(const BlockColors& colors, std::uint64_t covered, Rgba8 background,
                       Rgba8* out, std::ptrdiff_t stride) noexcept;

  void (*store_blended)(const BlockColors& colors, std::uint64_t covered, const Backdrop& backdrop,
                        Rgba8* out, std::ptrdiff_t stride) noexcept;

  void (*fill)(Rgba8 with, int columns, int rows, Rgba8* to, std::ptrdiff_t stride) noexcept;

  /// For pixels that are not read soon. Whole cache lines bypass the caches. `from` has `columns`
  /// pixels a row. Other threads see the pixels after `end_stream`.
  void (*stream)(const Rgba8* from, int columns, int rows, Rgba8* to,
                 std::ptrdiff_t stride) noexcept;
  void (*stream_fill)(Rgba8 with, int columns, int rows, Rgba8* to, std::ptrdiff_t stride) noexcept;
  void (*end_stream)() noexcept;

  /// Finds the bin that holds each piece's box. kManyBins: the piece needs a closer look (a box in
  /// several bins or none, a line, a point, a deferred piece).
  void (*bins)(const Piece* pieces, std::size_t n, const BinNumbers& numbers,
               std::uint32_t* bins) noexcept;

  /// Writes the deferred pieces of quadrics with one surface, in front, that the near plane does
  /// not cut. `slow` gets the numbers of the others, for assemble_primitive.
  SetupOutput (*defer)(const QuadricInput& input, Piece* pieces, std::uint32_t* slow) noexcept;

  /// Makes the quadrics of deferred pieces and raises a bin's keys by them. `bounds` may be null.
  RaisedKeys (*raise)(const QuadricBatch& batch, Rect bin, const DepthBounds* bounds,
                      const SurfaceView& surface) noexcept;
};

/// The table of `isa`, if in available_isas() (choose_isa); else plain C++.
[[nodiscard]] const Kernels& kernels(Isa isa);

}  // namespace rastrum::raster
