// SPDX-License-Identifier: BSD-3-Clause
// Triangles in SIMD lanes: rows of small triangles give the same keys and sample counts as blocks,
// and setup does not depend on how many triangles are left for its last lanes.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/frame.hpp>
#include <rastrum/image.hpp>
#include <rastrum/raster/cover/row_lists.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/raster/rules/points_and_lines.hpp>

namespace rastrum::raster::rows_test {
namespace {

constexpr Rect kImage{0, 0, 200, 190};

/// Triangles around `bin`, mostly small, some with a fragment test, some flat or steep in depth,
/// some degenerate to a point.
std::vector<Piece> pieces_around(Rect bin, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double sizes[] = {0.7, 3, 7.9, 9, 15.5, 17, 60};
  std::vector<Piece> pieces;
  while (pieces.size() < 2000) {
    const double size = sizes[random() % std::size(sizes)];
    const double x = uniform(bin.x0 - size, bin.x1), y = uniform(bin.y0 - size, bin.y1);
    ProjectedVertex v[3];
    for (ProjectedVertex& c : v) {
      // A quarter of them on sample centres and pixel corners.
      const auto snapped = [&](double px) {
        const auto fx8 = static_cast<std::int32_t>(px * kSubpixels);
        return random() % 4 == 0 ? fx8 / kHalfPixel * kHalfPixel : fx8;
      };
      c.x_fx8 = snapped(x + uniform(0, size));
      c.y_fx8 = snapped(y + uniform(0, size));
      c.depth = static_cast<float>(uniform(-0.1, random() % 8 == 0 ? 4 : 1));
    }
    Piece piece;
    const std::uint32_t flags = random() % 16 == 0 ? kTested : 0U;
    if (make_piece(v[0], v[1], v[2], pieces.size(), flags, Cull::none, kImage, piece) !=
        SetupResult::drawn)
      continue;
    if (random() % 32 == 0) {
      piece.flags |= kPoint;
      piece.x[1] = 5 * kSubpixels;
    }
    pieces.push_back(piece);
  }
  return pieces;
}

struct Surface {
  std::vector<std::uint64_t> memory =
      std::vector<std::uint64_t>(std::size_t{kBlocksPerBin} * 64 + 8);
  SurfaceView view;

  explicit Surface(Rect bin) {
    auto* const keys = memory.data();
    const auto misplaced = (reinterpret_cast<std::uintptr_t>(keys) / 8) % 8;
    view = {bin.x0 / kBlockSize, bin.y0 / kBlockSize, kBlocksPerBinRow, keys + (8 - misplaced) % 8,
            nullptr};
  }
  [[nodiscard]] std::vector<std::uint64_t> keys() const {
    return {view.keys, view.keys + std::size_t{kBlocksPerBin} * 64};
  }
};

/// Draws all pieces and returns the number of covered samples.
std::uint64_t draw(Isa isa, const std::vector<Piece>& pieces, Rect bin, Surface& surface,
                   RowKeys* rows) {
  const Kernels& kernel = kernels(isa);
  std::vector<PieceInBin> list;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) list.push_back({0, i});
  std::vector<Block> blocks(kBlocksPerBin + 10);  // so small that drawing often stops and resumes
  std::uint64_t covered = 0;
  for (std::size_t cursor = 0; cursor < list.size();) {
    const std::size_t n = kernel.cover({pieces.data(), list.data(), list.size()}, cursor, bin,
                                       blocks.data(), blocks.size(), nullptr, rows);
    kernel.maximum(pieces.data(), blocks.data(), n, surface.view);
    for (std::size_t i = 0; i < n; ++i)
      covered += static_cast<std::uint64_t>(std::popcount(blocks[i].mask));
  }
  return covered + (rows != nullptr ? rows->fragments : 0);
}

TEST(Rows, AreTheSameKeysAsBlocks) {
  // A whole bin, one at the edge of the image, and a part of one.
  const Rect bins[] = {{64, 64, 128, 128}, {192, 128, 200, 190}, {96, 64, 128, 96}};
  for (const Rect bin : bins)
    for (const Isa isa : available_isas()) {
      SCOPED_TRACE(testing::Message() << name(isa) << " from " << bin.x0 << ", " << bin.y0);
      const std::vector<Piece> pieces = pieces_around(bin, 7);
      Surface expected(bin), found(bin);
      const std::uint64_t covered = draw(Isa::scalar, pieces, bin, expected, nullptr);
      std::vector<std::uint64_t> keys(RowKeys::kSize);
      RowKeys rows{.keys = keys.data(), .touched = {bin.x1, bin.y1, bin.x0, bin.y0}};
      EXPECT_EQ(draw(isa, pieces, bin, found, &rows), covered);
      EXPECT_EQ(rows.fragments != 0, isa != Isa::scalar);
      for (int y = 0; y < kBinSize; ++y)
        for (int x = 0; x < static_cast<int>(RowKeys::kRow); ++x) {
          const bool is_touched = bin.x0 + x >= rows.touched.x0 && bin.x0 + x < rows.touched.x1 &&
                                  bin.y0 + y >= rows.touched.y0 && bin.y0 + y < rows.touched.y1;
          const std::size_t i =
              static_cast<std::size_t>(y) * RowKeys::kRow + static_cast<std::size_t>(x);
          ASSERT_TRUE(is_touched || keys[i] == 0) << x << ", " << y;
        }
      for (int by = 0; by < block_rows(bin); ++by)
        for (int bx = 0; bx < block_columns(bin); ++bx) {
          std::uint64_t* const block = found.view.block(found.view.bx0 + bx, found.view.by0 + by);
          const std::uint64_t lowest = kernels(isa).take_rows(
              keys.data() + static_cast<std::size_t>(by) * kBlockSize * RowKeys::kRow +
                  static_cast<std::size_t>(bx) * kBlockSize,
              block);
          EXPECT_EQ(lowest, *std::min_element(block, block + 64));
        }
      EXPECT_EQ(found.keys(), expected.keys());
      EXPECT_EQ(std::ranges::count(keys, 0U), static_cast<std::ptrdiff_t>(keys.size()));
    }
}

/// Rows may begin anywhere in a cache line: all pixels are written, and no others.
TEST(Rows, AreStreamedWhereverTheyLie) {
  constexpr int kRows = 3, kPitch = 150;
  std::vector<Rgba8> from(static_cast<std::size_t>(kRows * kBinSize));
  for (std::size_t i = 0; i < from.size(); ++i)
    from[i] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i / 256), 3, 255};
  constexpr Rgba8 kElse{9, 9, 9, 9}, kFill{1, 2, 3, 4};
  for (const Isa isa : available_isas())
    for (const int columns : {8, 16, 40, kBinSize})
      for (int first = 0; first < 17; ++first) {
        SCOPED_TRACE(testing::Message() << name(isa) << ", " << columns << " from " << first);
        const Kernels& kernel = kernels(isa);
        std::vector<Rgba8> copied(kRows * kPitch, kElse), filled = copied, streamed = copied;
        kernel.stream(from.data(), columns, kRows, copied.data() + first, kPitch);
        kernel.fill(kFill, columns, kRows, filled.data() + first, kPitch);
        kernel.stream_fill(kFill, columns, kRows, streamed.data() + first, kPitch);
        kernel.end_stream();
        // A picture's pixels need not be aligned to four bytes.
        std::vector<std::uint8_t> bytes((kRows * kPitch + 1) * sizeof(Rgba8));
        for (const std::size_t byte : {1U, 2U, 3U}) {
          auto* const to = reinterpret_cast<Rgba8*>(bytes.data() + byte) + first;
          kernel.stream(from.data(), columns, kRows, to, kPitch);
          ASSERT_EQ(std::memcmp(to + kPitch, from.data() + columns,
                                static_cast<std::size_t>(columns) * sizeof(Rgba8)),
                    0);
          kernel.stream_fill(kFill, columns, kRows, to, kPitch);
          kernel.end_stream();
          ASSERT_EQ(to[2 * kPitch + columns - 1], kFill);
        }
        for (int i = 0; i < kRows * kPitch; ++i) {
          const int y = i / kPitch, x = i % kPitch - first;
          const bool is_row = x >= 0 && x < columns;
          const auto at = static_cast<std::size_t>(i);
          ASSERT_EQ(copied[at], is_row ? from[static_cast<std::size_t>(y * columns + x)] : kElse);
          ASSERT_EQ(filled[at], is_row ? kFill : kElse);
          ASSERT_EQ(streamed[at], filled[at]);
        }
      }
}

TEST(Rows, ALongListIsLeftInBetween) {
  const Rect bin{64, 64, 128, 128};
  std::vector<Piece> pieces;
  for (unsigned seed = 1; pieces.size() < 3 * kMostRowPieces; ++seed)
    for (const Piece& piece : pieces_around(bin, seed)) {
      const Rect box = piece_bounds(piece, kImage);
      if (box.x1 - box.x0 < kBlockSize) pieces.push_back(piece);
    }
  std::vector<PieceInBin> list;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) list.push_back({0, i});
  std::vector<Block> blocks(4 * list.size());
  for (const Isa isa : available_isas()) {
    if (isa == Isa::scalar) continue;  // it raises none
    std::vector<std::uint64_t> keys(RowKeys::kSize);
    RowKeys rows;
    rows.keys = keys.data();
    std::size_t cursor = 0, calls = 0;
    for (std::size_t before = 0; cursor < list.size(); before = cursor, ++calls) {
      kernels(isa).cover({pieces.data(), list.data(), list.size()}, cursor, bin, blocks.data(),
                         blocks.size(), nullptr, &rows);
      ASSERT_LE(cursor, before + kMostRowPieces) << name(isa);
      ASSERT_GT(cursor, before) << name(isa);
    }
    EXPECT_GE(calls, 3U) << name(isa);
    // Without rows it stops when there is no room.
    cursor = 0;
    kernels(isa).cover({pieces.data(), list.data(), list.size()}, cursor, bin, blocks.data(),
                       blocks.size(), nullptr, nullptr);
    EXPECT_GT(cursor, kMostRowPieces) << name(isa);
  }
}

/// The keys of a call of setup, the triangles that it left to the clipper, and the number that it
/// drew, some of which cover nothing.
struct SetUpKeys {
  std::vector<std::uint64_t> keys = std::vector<std::uint64_t>(64 * 64);
  std::uint32_t slow = 0, drawn = 0;
};

SetUpKeys set_up(Isa isa, SetupInput input) {
  std::vector<Piece> pieces(kSetupBatch);
  std::vector<BinFragment> fragments(kSetupFragments);
  std::vector<std::uint32_t> slow(kSetupBatch);
  const SetupOutput out = kernels(isa).setup(input, pieces.data(), fragments.data(), slow.data());
  EXPECT_TRUE(out.index_in_range);
  SetUpKeys found;
  found.drawn = out.pieces + out.micro;
  for (std::uint32_t i = 0; i < out.slow; ++i) found.slow = found.slow * 31 + slow[i] + 1;
  const auto raise = [&](std::size_t at, std::uint64_t key) {
    found.keys[at] = std::max(found.keys[at], key);
  };
  for (std::uint32_t i = 0; i < out.pieces; ++i)
    for_each_covered(pieces[i], input.view, [&](int x, int y) {
      raise(static_cast<std::size_t>(y * 64 + x),
            make_key(plane_depth_at(pieces[i], x, y), pieces[i].low));
    });
  for (std::uint32_t i = 0; i < out.fragments; ++i) {
    const BinFragment& f = fragments[i];
    EXPECT_EQ(f.bin, 0U);
    raise(static_cast<std::size_t>(row_in_bin(f) * 64 + column_in_bin(f)), f.key);
  }
  return found;
}

TEST(Setup, TheLastLanesAreLikeTheOthers) {
  std::mt19937 random(3);
  std::vector<ProjectedVertex> vertices(300);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    // Three neighbouring vertices make a triangle, small or large.
    const double size = i / 3 % 3 == 0 ? 30 : 3;
    const auto place = [&](std::size_t corner) {
      return static_cast<std::int32_t>((10.0 + static_cast<double>(corner * 7 % 40) +
                                        std::uniform_real_distribution<double>(0, size)(random)) *
                                       kSubpixels);
    };
    vertices[i] = {place(i / 3), place(i / 3 * 5), 0.5F, 1};
    if (i % 41 == 0) vertices[i].x_fx8 = kNeedsClip;
  }
  std::vector<std::uint32_t> indices(vertices.size());
  for (std::uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
  for (const Isa isa : available_isas())
    for (const bool indexed : {false, true})
      for (std::uint32_t count = 1; count < 40; ++count) {
        SCOPED_TRACE(testing::Message() << name(isa) << ", " << count);
        SetupInput input;
        input.indices = indexed ? indices.data() : nullptr;
        input.vertices = vertices.data();
        // The last five triangles are missing.
        input.vertex_count = (count + 5) * 3;
        input.first = 5;
        input.count = count;
        input.view = {0, 0, 64, 64};
        input.bin_columns = 1;
        input.micro = true;
        const SetUpKeys expected = set_up(Isa::scalar, input), found = set_up(isa, input);
        ASSERT_EQ(found.keys, expected.keys);
        ASSERT_EQ(found.slow, expected.slow);
        ASSERT_EQ(found.drawn, expected.drawn);
        // One index is out of range.
        SetupInput too_far = input;
        too_far.vertex_count -= 1;
        Piece pieces[kSetupBatch];
        std::vector<BinFragment> fragments(kSetupFragments);
        std::uint32_t slow[kSetupBatch];
        ASSERT_FALSE(kernels(isa).setup(too_far, pieces, fragments.data(), slow).index_in_range);
      }
}

}  // namespace
}  // namespace rastrum::raster::rows_test
