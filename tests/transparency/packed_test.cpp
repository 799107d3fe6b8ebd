// The kernels of packed fragments, on every instruction set, against their definitions.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/transparency/blend_kernels.hpp>
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

class Packed : public testing::TestWithParam<Isa> {};

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

TEST_P(Packed, HasTheKeysOfTheBlock) {
  Random random(1);
  std::vector<std::uint64_t> keys(64 + kPackSlack);
  std::vector<std::uint16_t> pixels(64 + kPackSlack);
  alignas(64) std::uint64_t expected[64];
  for (int i = 0; i < 2000; ++i) {
    const raster::Piece p = piece(random);
    std::uint64_t mask = random.bits();
    if (i % 3 != 0) mask &= random.bits() & random.bits();
    if (i % 100 == 0) mask = ~std::uint64_t{0};
    if (mask == 0) continue;
    const int bx = random.integer(0, 7), by = random.integer(0, 7);
    const raster::Block block{0, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by),
                              mask};
    raster::kernels(Isa::scalar).keys(p, block, expected);
    const auto first = static_cast<std::uint32_t>((by * kPackedPitch + bx) * 8);
    const std::size_t n =
        packed_kernels(GetParam()).pack(p, mask, bx * 8, by * 8, first, keys.data(), pixels.data());
    ASSERT_EQ(n, static_cast<std::size_t>(parallel::popcount(mask)));
    for (std::size_t f = 0; f < n; ++f, mask &= mask - 1) {
      const int sample = std::countr_zero(mask);
      ASSERT_EQ(keys[f], expected[sample]);
      ASSERT_EQ(pixels[f], (by * 8 + sample / 8) * kPackedPitch + bx * 8 + sample % 8);
    }
  }
}

TEST_P(Packed, PointsLieAtTheirPixels) {
  Random random(2);
  std::uint16_t pixels[64];
  for (std::uint16_t& p : pixels)
    p = static_cast<std::uint16_t>(random.integer(0, kPackedPitch * kPackedPitch - 1));
  raster::ShadingPoints points;
  packed_kernels(GetParam()).points(pixels, points);
  for (int i = 0; i < 64; ++i) {
    EXPECT_EQ(static_cast<float>(i % 8) + points.dx[i], static_cast<float>(pixels[i] % 64));
    EXPECT_EQ(static_cast<float>(i / 8) + points.dy[i], static_cast<float>(pixels[i] / 64));
  }
}

/// Rows of 8 sort_keys: pixel i has `counts[i]`, then zeros.
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

TEST_P(Packed, SortsEveryPixel) {
  Random random(3);
  for (std::size_t layers = 2; layers <= 150; ++layers) {
    std::size_t numbers = 0;
    const std::vector<std::uint64_t> before = row_of(random, layers, numbers);
    alignas(64) std::uint64_t aligned[150 * 8];
    std::copy(before.begin(), before.end(), aligned);
    packed_kernels(GetParam()).sort(aligned, layers);
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

/// A row's layers by the kernels of planes, which blend_test holds to Porter and Duff.
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
      packed_kernels(GetParam()).interleave(shaded[b], colors.data() + 1 + b * 64);
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
        packed_kernels(GetParam()).gather({aligned + k * 8, 1, colors.data()}, first, gathered);
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
      packed_kernels(GetParam()).behind(row, first, opaque_at, seen);
      packed_kernels(GetParam()).before(row, first, over);
      EXPECT_EQ(std::memcmp(&seen, &expected_seen, sizeof(seen)), 0) << layers;
      EXPECT_EQ(std::memcmp(&over, &expected_over, sizeof(over)), 0) << layers;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Isas, Packed, testing::ValuesIn(available_isas()),
                         [](const testing::TestParamInfo<Isa>& p) {
                           return std::string(name(p.param));
                         });

}  // namespace
}  // namespace rastrum::test::packed_test
