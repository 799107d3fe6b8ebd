// SPDX-License-Identifier: BSD-3-Clause
// Coverage by windows (raster/cover/windows.hpp) equals coverage by blocks, on every instruction
// set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/cover/windows.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/transparency/records.hpp>

#include "tests/support/random.hpp"

namespace rastrum::test::windows_test {
namespace {

using raster::Block;
using raster::kBlockSize;
using raster::kSubpixels;
using raster::Piece;
using raster::Rect;

/// A triangle around `bin`, mostly smaller than 8 px.
Piece triangle(Random& random, Rect bin) {
  Piece p{};
  const int size = (random.integer(0, 5) == 0 ? 40 : 8) * kSubpixels;
  const int x = random.integer((bin.x0 - 9) * kSubpixels, (bin.x1 + 2) * kSubpixels);
  const int y = random.integer((bin.y0 - 9) * kSubpixels, (bin.y1 + 2) * kSubpixels);
  for (int i = 0; i < 3; ++i) {
    p.x[i] = x + random.integer(0, size);
    p.y[i] = y + random.integer(0, size);
  }
  const std::int64_t area = std::int64_t{p.x[1] - p.x[0]} * (p.y[2] - p.y[0]) -
                            std::int64_t{p.x[2] - p.x[0]} * (p.y[1] - p.y[0]);
  if (area < 0) {
    std::swap(p.x[1], p.x[2]);
    std::swap(p.y[1], p.y[2]);
  }
  p.flags = kTranslucent;
  if (random.integer(0, 7) == 0) p.flags = 0;
  if (random.integer(0, 7) == 0) p.flags |= raster::kClipped;
  return p;
}

using Sample = std::tuple<std::uint32_t, int, int>;  // piece, place in the bin

/// All samples that a kernel covers; `unit`: the unit of a block's place, px.
template <class Cover>
std::vector<Sample> covered(const Cover& cover, const std::vector<Piece>& pieces, Rect bin,
                            int unit, Rect origin, std::vector<Block>* all = nullptr) {
  std::vector<raster::PieceInBin> list;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) list.push_back({0, i});
  const raster::PieceList in{pieces.data(), list.data(), list.size()};
  std::vector<Block> room(raster::kBlocksPerBin + 10);
  std::vector<Sample> samples;
  for (std::size_t cursor = 0; cursor < in.count;) {
    const std::size_t n = cover(in, cursor, bin, room.data(), room.size(), nullptr);
    for (std::size_t k = 0; k < n; ++k) {
      const Block& b = room[k];
      EXPECT_NE(b.mask, 0U);
      if (all != nullptr) all->push_back(b);
      for (int i = 0; i < 64; ++i)
        if ((b.mask >> i & 1) != 0)
          samples.emplace_back(b.piece, b.bx * unit - origin.x0 + i % kBlockSize,
                               b.by * unit - origin.y0 + i / kBlockSize);
    }
  }
  std::sort(samples.begin(), samples.end());
  return samples;
}

class Windows : public testing::TestWithParam<Isa> {};

TEST_P(Windows, CoverWhatBlocksDo) {
  Random random(1);
  std::size_t unaligned = 0;
  for (int round = 0; round < 300; ++round) {
    // Bins, parts of bins, and bins at the picture's edge.
    const int side = 64 >> random.integer(0, 3);
    Rect bin{640, 128, 640 + side, 128 + side};
    if (round % 3 == 0) bin.x1 -= random.integer(0, 7);
    if (round % 3 == 0) bin.y1 -= random.integer(0, 7);
    std::vector<Piece> pieces;
    for (int k = random.integer(1, 60); k > 0; --k) pieces.push_back(triangle(random, bin));
    const raster::Kernels& plain = raster::kernels(Isa::scalar);
    std::vector<Block> all;
    const std::vector<Sample> expected = covered(
        [&](const raster::PieceList& in, std::size_t& cursor, Rect in_bin, Block* out,
            std::size_t capacity, raster::DepthBounds* bounds) {
          return plain.cover(in, cursor, in_bin, out, capacity, bounds, nullptr);
        },
        pieces, bin, kBlockSize, bin);
    const std::vector<Sample> actual =
        covered(raster::cover_windows(GetParam()), pieces, bin, 1, {}, &all);
    ASSERT_EQ(actual, expected);
    for (const Block& b : all) {
      const bool is_block = b.bx % kBlockSize == 0 && b.by % kBlockSize == 0;
      unaligned += static_cast<std::size_t>(!is_block);
      const std::uint32_t flags = pieces[b.piece].flags;
      if (flags != kTranslucent) {
        ASSERT_TRUE(is_block) << flags;
      }
    }
  }
  if (GetParam() != Isa::scalar) {
    EXPECT_GT(unaligned, 1000U);
  }
}

INSTANTIATE_TEST_SUITE_P(Isas, Windows, testing::ValuesIn(available_isas()),
                         [](const auto& p) { return std::string(name(p.param)); });

TEST(MaskSums, AreThoseOfTheSamples) {
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    std::uint64_t mask = random.bits();
    if (i % 3 == 0) mask &= random.bits() & random.bits();
    if (i % 5 == 0) mask |= random.bits() | random.bits();
    if (i == 0) mask = ~std::uint64_t{0};
    int count = 0, columns = 0, rows = 0;
    for (int sample = 0; sample < 64; ++sample)
      if ((mask >> sample & 1) != 0) ++count, columns += sample % 8, rows += sample / 8;
    const transparency::MaskSums sums = transparency::sums_of(mask);
    ASSERT_EQ(sums.count, count);
    ASSERT_EQ(sums.columns, columns);
    ASSERT_EQ(sums.rows, rows);
  }
}

TEST(BlocksOfAWindow, HaveItsSamples) {
  Random random(2);
  for (std::uint32_t y = 0; y < 16; ++y)
    for (std::uint32_t x = 0; x < 16; ++x) {
      std::uint64_t mask = (x + y) % 3 == 0 ? ~std::uint64_t{0} : random.bits();
      // Some stay in a corner.
      if ((x + y) % 3 == 1) mask &= (x % 2 == 0 ? 0x0303U : 0xC0C0U) | std::uint64_t{y % 2} << 63;
      std::uint64_t blocks[3][3] = {};
      std::size_t calls = 0;
      transparency::for_each_block_of(
          mask, x, y, [&](std::uint32_t column, std::uint32_t row, std::uint64_t part) {
            ASSERT_LT(std::max(column, row), 3U);
            ASSERT_NE(part, 0U);
            ASSERT_EQ(blocks[row][column], 0U);
            blocks[row][column] = part;
            ++calls;
          });
      EXPECT_LE(calls, 4U);
      EXPECT_EQ(transparency::blocks_of_window(mask, x, y), calls);
      for (std::uint32_t i = 0; i < 24 * 24; ++i) {
        const std::uint32_t px = i % 24, py = i / 24;
        const bool inside = px >= x && px < x + 8 && py >= y && py < y + 8;
        const bool expected = inside && (mask >> ((py - y) * 8 + px - x) & 1) != 0;
        EXPECT_EQ((blocks[py / 8][px / 8] >> (py % 8 * 8 + px % 8) & 1) != 0, expected);
      }
    }
}

}  // namespace
}  // namespace rastrum::test::windows_test
