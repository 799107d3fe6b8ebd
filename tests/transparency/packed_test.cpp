// SPDX-License-Identifier: BSD-3-Clause
// The kernels of packed fragments on every instruction set, against their definitions.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/transparency/blend_kernels.hpp>
#include <rastrum/transparency/layer_lists.hpp>
#include <rastrum/transparency/packed_kernels.hpp>

#include "tests/support/random.hpp"

namespace rastrum::test::packed_test {
namespace {

using raster::BlockColors;
using transparency::kPackedPitch;
using transparency::kPackSlack;
using transparency::packed_kernels;
using transparency::packed_sort_key;
using transparency::PackedRow;
using transparency::Seen;

class Packed : public testing::TestWithParam<Isa> {
 protected:
  const transparency::PackedKernels& kernels_ = packed_kernels(GetParam());
};

raster::Piece piece(Random& random) {
  raster::Piece p{};
  p.x[0] = random.integer(-4000, 20000);
  p.y[0] = random.integer(-4000, 20000);
  p.z0 = static_cast<float>(random.real(-0.2, 1.2));
  p.zx = static_cast<float>(random.real(-0.02, 0.02));
  p.zy = static_cast<float>(random.real(-0.02, 0.02));
  p.low = raster::kIdMask - static_cast<std::uint64_t>(random.integer(0, 1 << 30));
  return p;
}

TEST_P(Packed, HasTheKeysOfTheBlocks) {
  Random random(1);
  // A region whose first pixel is (72, 16).
  constexpr transparency::PackedPlace kPlace{72, 16};
  std::vector<std::uint64_t> keys(64 * 20 + kPackSlack);
  std::vector<std::uint16_t> pixels(64 * 20 + kPackSlack);
  for (int i = 0; i < 200; ++i) {
    std::vector<raster::Piece> pieces;
    std::vector<transparency::Window> windows;
    for (int k = random.integer(1, 20); k > 0; --k) pieces.push_back(piece(random));
    std::size_t samples = 0;
    for (const raster::Piece& p : pieces) {
      std::uint64_t mask = random.bits();
      if (random.integer(0, 2) != 0) mask &= random.bits() & random.bits();
      if (random.integer(0, 9) == 0) mask = ~std::uint64_t{0};
      if (mask == 0) continue;
      samples += static_cast<std::size_t>(parallel::popcount(mask));
      const int x = random.integer(0, 56), y = random.integer(0, 56);
      windows.push_back({&p, mask, static_cast<std::uint32_t>(y * kPackedPitch + x)});
    }
    ASSERT_EQ(kernels_.pack(windows, {}, kPlace, keys.data(), pixels.data()), samples);
    std::size_t f = 0;
    for (const transparency::Window& w : windows)
      for (std::uint64_t mask = w.mask; mask != 0; mask &= mask - 1, ++f) {
        const int sample = std::countr_zero(mask);
        const int x = static_cast<int>(w.pixel % kPackedPitch) + sample % 8;
        const int y = static_cast<int>(w.pixel / kPackedPitch) + sample / 8;
        ASSERT_EQ(keys[f], raster::make_key(raster::depth_at(*w.piece, kPlace.x + x, kPlace.y + y),
                                            w.piece->low));
        ASSERT_EQ(pixels[f], y * kPackedPitch + x);
      }
  }
}

/// Ids of windows and of micro triangles, in runs of any length, are merged in the order of ids.
/// Fragments of one id stay together.
TEST_P(Packed, PutsMicroTrianglesBetweenTheWindows) {
  Random random(6);
  for (int i = 0; i < 300; ++i) {
    std::vector<raster::Piece> pieces;
    std::vector<std::uint64_t> micro_keys;
    std::vector<std::uint16_t> micro_pixels;
    std::vector<std::pair<std::uint64_t, int>> expected;  // low part, pixel
    std::uint64_t low = raster::kIdMask - 5;
    for (int runs = random.integer(0, 6); runs > 0; --runs) {
      for (int k = random.integer(0, i % 3 == 0 ? 30 : 4); k > 0; --k) {
        low -= static_cast<std::uint64_t>(random.integer(1, 3));
        for (int samples = random.integer(1, 3); samples > 0; --samples) {
          micro_keys.push_back(random.bits() << raster::kIdBits | low);
          micro_pixels.push_back(static_cast<std::uint16_t>(random.integer(0, 4095)));
          expected.emplace_back(low, micro_pixels.back());
        }
      }
      for (int k = random.integer(0, 3); k > 0; --k) {
        low -= static_cast<std::uint64_t>(random.integer(1, 3));
        pieces.push_back(piece(random));
        pieces.back().low = low;
        expected.emplace_back(low, 0);
        expected.emplace_back(low, kPackedPitch + 1);
      }
    }
    std::vector<transparency::Window> windows;
    for (const raster::Piece& p : pieces) windows.push_back({&p, 0x201, 0});
    const std::vector<std::uint64_t> only = micro_keys;
    micro_keys.resize(micro_keys.size() + kPackSlack);
    micro_pixels.resize(micro_pixels.size() + kPackSlack);
    std::vector<std::uint64_t> keys(expected.size() + kPackSlack);
    std::vector<std::uint16_t> pixels(expected.size() + kPackSlack);
    ASSERT_EQ(kernels_.pack(windows, {micro_keys.data(), micro_pixels.data(), only.size()}, {0, 0},
                            keys.data(), pixels.data()),
              expected.size());
    std::size_t m = 0;
    for (std::size_t f = 0; f < expected.size(); ++f) {
      ASSERT_EQ(keys[f] & raster::kIdMask, expected[f].first) << f;
      ASSERT_EQ(pixels[f], expected[f].second) << f;
      if (m < only.size() && (only[m] & raster::kIdMask) == expected[f].first) {
        ASSERT_EQ(keys[f], only[m++]);
      }
    }
    ASSERT_EQ(m, only.size());
  }
}

TEST_P(Packed, TakesTranslucentFragmentsUpToTheFirstOpaqueOne) {
  Random random(7);
  // A region whose first pixel is (16, 8) of its bin.
  constexpr std::uint32_t kFirst = 8 * kPackedPitch + 16;
  for (int count = 0; count < 60; ++count) {
    std::vector<raster::BinFragment> fragments;
    std::vector<int> expected;
    const int opaque = random.integer(0, 70);
    for (int i = 0; i < count; ++i) {
      const int x = random.integer(16, 63), y = random.integer(8, 63);
      fragments.push_back(raster::fragment_at(640 + x, 128 + y, random.bits() >> 1,
                                              i == opaque ? 0 : kTranslucent, 40));
      expected.push_back((y - 8) * kPackedPitch + x - 16);
    }
    std::vector<std::uint64_t> keys(fragments.size() + kPackSlack);
    std::vector<std::uint16_t> pixels(fragments.size() + kPackSlack);
    const auto taken = static_cast<std::size_t>(std::min(count, opaque));
    ASSERT_EQ(kernels_.take(fragments, kFirst, keys.data(), pixels.data()), taken);
    for (std::size_t i = 0; i < taken; ++i) {
      ASSERT_EQ(keys[i], fragments[i].key);
      ASSERT_EQ(pixels[i], expected[i]);
    }
  }
}

TEST_P(Packed, FindsWhereIdsBegin) {
  Random random(5);
  for (const std::size_t count : {1U, 2U, 63U, 64U, 65U, 200U, 1000U}) {
    std::vector<std::uint64_t> keys(count + kPackSlack), firsts((count + 63) / 64);
    std::vector<bool> expected(count);
    std::uint64_t low = raster::kIdMask - 7;
    for (std::size_t f = 0; f < count; ++f) {
      expected[f] = f == 0 || random.integer(0, 2) == 0;
      if (expected[f]) low -= static_cast<std::uint64_t>(random.integer(1, 3));
      keys[f] = random.bits() << raster::kIdBits | low;
    }
    EXPECT_TRUE(kernels_.find_firsts(keys.data(), count, firsts.data()));
    for (std::size_t f = 0; f < count; ++f)
      EXPECT_EQ((firsts[f / 64] >> f % 64 & 1) != 0, expected[f]) << count << " " << f;
    if (count < 2) continue;
    // An id below its predecessor, anywhere.
    keys[static_cast<std::size_t>(random.integer(1, static_cast<int>(count) - 1))] |=
        raster::kIdMask;
    EXPECT_FALSE(kernels_.find_firsts(keys.data(), count, firsts.data()));
  }
}

TEST_P(Packed, CountsWhatPixelsHave) {
  Random random(9);
  for (const std::size_t rows : {8U, 64U, 512U}) {
    std::vector<std::uint16_t> pixels;
    std::vector<int> expected(rows * 8);
    for (int n = random.integer(0, 20000); n > 0; --n) {
      // Each row has many fragments in one pixel.
      const int row = random.integer(0, static_cast<int>(rows) - 1);
      const int pixel = row * 8 + (n % 2 == 0 ? random.integer(0, 7) : row * 5 % 8);
      pixels.push_back(static_cast<std::uint16_t>(pixel));
      ++expected[static_cast<std::size_t>(pixel)];
    }
    alignas(64) std::uint16_t of_pixel[4096];
    std::uint16_t most[512];
    std::fill_n(of_pixel, 4096, std::uint16_t{7});
    kernels_.count(pixels.data(), pixels.size(), rows, of_pixel, most);
    for (std::size_t i = 0; i < rows * 8; ++i) ASSERT_EQ(of_pixel[i], expected[i]);
    for (std::size_t r = 0; r < rows; ++r) {
      const auto first = expected.begin() + static_cast<std::ptrdiff_t>(r * 8);
      ASSERT_EQ(most[r], *std::max_element(first, first + 8));
    }
  }
}

TEST_P(Packed, PointsLieAtTheirPixels) {
  Random random(2);
  std::uint16_t pixels[64];
  for (std::uint16_t& p : pixels)
    p = static_cast<std::uint16_t>(random.integer(0, kPackedPitch * kPackedPitch - 1));
  raster::ShadingPoints points;
  kernels_.points(pixels, points);
  for (int i = 0; i < 64; ++i) {
    EXPECT_EQ(static_cast<float>(i % 8) + points.dx[i], static_cast<float>(pixels[i] % 64));
    EXPECT_EQ(static_cast<float>(i / 8) + points.dy[i], static_cast<float>(pixels[i] / 64));
  }
}

/// Rows of 8 sort_keys: pixel i has `counts[i]` keys, then zeros.
std::vector<std::uint64_t> row_of(Random& random, std::size_t layers, std::size_t& numbers) {
  std::vector<std::uint64_t> sort_keys(layers * 8, 0);
  numbers = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto count =
        i == 3 ? layers : static_cast<std::size_t>(random.integer(0, static_cast<int>(layers)));
    for (std::size_t k = 0; k < count; ++k) {
      // Few depths, so that many are equal and the numbers decide.
      const auto depth = static_cast<float>(random.integer(0, 9)) / 8;
      sort_keys[k * 8 + i] = packed_sort_key(
          std::uint64_t{std::bit_cast<std::uint32_t>(depth)} << raster::kIdBits, numbers++);
    }
  }
  return sort_keys;
}

/// Compares with the definition, a list per pixel.
TEST_P(Packed, FiltersAsInsertionDoes) {
  Random random(11);
  std::uint64_t all_misplaced = 0;
  MemoryAccount memory;
  transparency::LayerLists<> lists(memory);
  for (const std::size_t filter : {1U, 2U, 3U, 8U, 64U})
    for (std::size_t layers = 1; layers < 90; layers += layers < 20 ? 1 : 23) {
      std::size_t numbers;
      const std::vector<std::uint64_t> plain = row_of(random, layers, numbers);
      alignas(64) std::uint64_t row[90 * 8];
      std::copy(plain.begin(), plain.end(), row);
      lists.restart(transparency::LayerOrder::depth, filter, 128);
      for (std::size_t k = 0; k < layers; ++k)
        for (std::size_t i = 0; i < 8; ++i)
          if (row[k * 8 + i] != 0) lists.insert(static_cast<int>(i), row[k * 8 + i]);
      const std::uint64_t misplaced = kernels_.filter(row, layers, filter);
      ASSERT_EQ(misplaced, lists.misplaced()) << filter << " " << layers;
      all_misplaced |= misplaced;
      for (std::size_t k = 0; k < layers; ++k)
        for (std::size_t i = 0; i < 8; ++i)
          ASSERT_EQ(row[k * 8 + i], (lists.mask(k) >> i & 1) != 0 ? lists.plane(k)[i] : 0)
              << filter << " " << layers;
    }
  EXPECT_EQ(all_misplaced, 0xFFU);
}

TEST_P(Packed, SortsEveryPixel) {
  Random random(3);
  for (std::size_t layers = 2; layers <= 150; ++layers) {
    std::size_t numbers = 0;
    const std::vector<std::uint64_t> before = row_of(random, layers, numbers);
    alignas(64) std::uint64_t aligned[150 * 8];
    std::copy(before.begin(), before.end(), aligned);
    kernels_.sort(aligned, layers);
    for (std::size_t i = 0; i < 8; ++i) {
      std::vector<std::uint64_t> expected, actual;
      for (std::size_t k = 0; k < layers; ++k) {
        expected.push_back(before[k * 8 + i]);
        actual.push_back(aligned[k * 8 + i]);
      }
      std::sort(expected.begin(), expected.end(), std::greater<>());
      ASSERT_EQ(actual, expected) << layers << " layers, pixel " << i;
    }
  }
}

/// A row's layers against the kernels of planes, which blend_test compares with Porter and Duff.
TEST_P(Packed, BlendsAsPlanesDo) {
  Random random(4);
  const transparency::BlendKernels& planes = transparency::blend_kernels(Isa::scalar);
  for (std::size_t layers = 0; layers < 12; ++layers) {
    std::size_t numbers = 0;
    const std::vector<std::uint64_t> sort_keys = row_of(random, layers, numbers);
    alignas(64) std::uint64_t aligned[12 * 8];
    std::copy(sort_keys.begin(), sort_keys.end(), aligned);
    std::vector<BlockColors> shaded(numbers / 64 + 1);
    std::vector<Vec4> colors(1 + shaded.size() * 64);
    const auto number = [&](float low) { return static_cast<float>(random.real(low, 1)); };
    for (std::size_t b = 0; b < shaded.size(); ++b) {
      for (int i = 0; i < 64; ++i) shaded[b].set(i, {number(0), number(0), number(0), number(0)});
      kernels_.interleave(shaded[b], colors.data() + 1 + b * 64);
    }
    const PackedRow row{aligned, layers, colors.data()};
    for (const std::size_t first : {std::size_t{0}, std::size_t{56}}) {
      const float opaque_at = layers % 2 == 0 ? 0 : 0.3F;
      Seen seen, expected_seen;
      BlockColors over, expected_over;
      std::uint64_t finished = 0;
      for (int i = 0; i < 64; ++i) {
        seen.r[i] = seen.g[i] = seen.b[i] = seen.a[i] = number(0) / 4;
        seen.through[i] = number(0);
        finished |= std::uint64_t{opaque_at > 0 && seen.through[i] <= opaque_at} << i;
        over.set(i, {number(0), number(0), number(0), number(0)});
      }
      expected_seen = seen;
      expected_over = over;
      for (std::size_t k = 0; k < layers; ++k) {
        BlockColors plane, gathered;
        std::uint64_t mask = 0;
        kernels_.gather({aligned + k * 8, 1, colors.data()}, first, gathered);
        for (std::size_t i = 0; i < 8; ++i) {
          const std::uint64_t sort_key = aligned[k * 8 + i];
          if (sort_key == 0) {
            EXPECT_EQ(gathered.a[first + i], 0.0F);
            continue;
          }
          const std::size_t f = transparency::number_of_sort_key(sort_key);
          const BlockColors& from = shaded[f / 64];
          plane.set(static_cast<int>(first + i),
                    {from.r[f % 64], from.g[f % 64], from.b[f % 64], from.a[f % 64]});
          mask |= std::uint64_t{1} << (first + i);
          EXPECT_EQ(gathered.g[first + i], plane.g[first + i]);
        }
        const std::uint64_t drawn = opaque_at > 0 ? mask & ~finished : mask;
        finished |= planes.behind(plane, drawn, opaque_at, expected_seen);
        planes.before(plane, mask, expected_over);
      }
      kernels_.behind(row, first, opaque_at, seen);
      kernels_.before(row, first, over);
      EXPECT_EQ(std::memcmp(&seen, &expected_seen, sizeof(seen)), 0) << layers;
      EXPECT_EQ(std::memcmp(&over, &expected_over, sizeof(over)), 0) << layers;
    }
  }
}

/// A block's rows over a background against the kernels of planes.
TEST_P(Packed, PutsABlockOverWhatIsBehindIt) {
  Random random(8);
  const transparency::BlendKernels& planes = transparency::blend_kernels(Isa::scalar);
  for (int i = 0; i < 30; ++i) {
    std::vector<std::uint64_t> sort_keys[8];
    std::vector<Vec4> colors(1);
    const auto number = [&] { return static_cast<float>(random.real(0, 1)); };
    BlockColors behind;
    for (int k = 0; k < 64; ++k) behind.set(k, {number(), number(), number(), number()});
    const float opaque_at = i % 3 == 0 ? 0.3F : 0;
    Seen seen{};
    std::fill_n(seen.through, 64, 1.0F);
    PackedRow rows[8];
    alignas(64) std::uint64_t aligned[8][9 * 8];
    for (std::size_t y = 0; y < 8; ++y) {
      const auto layers = static_cast<std::size_t>(random.integer(0, 9));
      for (std::size_t k = 0; k < layers * 8; ++k) {
        aligned[y][k] = 0;
        if (random.integer(0, 3) == 0) continue;
        aligned[y][k] = packed_sort_key(std::uint64_t{1} << 40, colors.size() - 1);
        // Some are opaque.
        colors.push_back({number(), number(), number(), random.integer(0, 4) == 0 ? 1 : number()});
      }
      rows[y] = {aligned[y], layers, nullptr};
    }
    colors.resize(colors.size() + kPackSlack);
    for (std::size_t y = 0; y < 8; ++y) {
      rows[y].colors = colors.data();
      packed_kernels(Isa::scalar).behind(rows[y], y * 8, opaque_at, seen);
    }
    BlockColors expected, actual;
    for (const bool any : {true, false}) {
      static constexpr BlockColors kNothing{};
      planes.finish(seen, any ? behind : kNothing, expected);
      kernels_.over(rows, any ? &behind : nullptr, opaque_at, actual);
      EXPECT_EQ(std::memcmp(&actual, &expected, sizeof actual), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Isas, Packed, testing::ValuesIn(available_isas()),
                         [](const auto& p) { return std::string(name(p.param)); });

}  // namespace
}  // namespace rastrum::test::packed_test
