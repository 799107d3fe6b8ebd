// SPDX-License-Identifier: BSD-3-Clause
// Tests the order of fragments (LayerLists) and their blending (LayerBlend), each by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <vector>

#include <rastrum/family.hpp>
#include <rastrum/transparency/blend.hpp>
#include <rastrum/transparency/layer_lists.hpp>

#include "tests/support/random.hpp"

namespace rastrum::test::blend_test {
namespace {

using raster::BlockColors;
using transparency::Layer;
using transparency::LayerBlend;
using transparency::LayerLists;
using transparency::LayerOrder;

constexpr std::size_t kMany = 1 << 15;

std::uint64_t key(float depth, std::uint64_t id) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(depth)} << raster::kIdBits |
         (raster::kIdMask - id);
}

struct Arrival {
  int pixel;
  std::uint64_t key;
};

std::vector<Arrival> arrivals(std::uint64_t seed, int count, int pixels) {
  Random random(seed);
  std::vector<Arrival> all;
  for (int i = 0; i < count; ++i) {
    // Few depths, so that many are equal.
    const auto depth = static_cast<float>(random.integer(0, 40)) / 64;
    all.push_back({random.integer(0, pixels - 1), key(depth, static_cast<std::uint64_t>(i))});
  }
  return all;
}

/// The keys of each pixel in the lists' order, over all windows.
std::vector<std::vector<std::uint64_t>> drain(LayerLists<>& lists, const std::vector<Arrival>& all,
                                              bool sort, int& windows) {
  std::vector<std::vector<std::uint64_t>> pixels(64);
  windows = 0;
  do {
    for (const Arrival& a : all) lists.insert(a.pixel, a.key);
    if (sort) lists.sort();
    for (std::size_t k = 0; k < lists.depth(); ++k)
      for (std::uint64_t m = lists.mask(k); m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        pixels[static_cast<std::size_t>(i)].push_back(lists.plane(k)[i]);
      }
    ++windows;
  } while (lists.next_window());
  return pixels;
}

std::vector<std::vector<std::uint64_t>> sorted(const std::vector<Arrival>& all) {
  std::vector<std::vector<std::uint64_t>> pixels(64);
  for (const Arrival& a : all) pixels[static_cast<std::size_t>(a.pixel)].push_back(a.key);
  for (auto& p : pixels) std::ranges::sort(p, std::greater<>());
  return pixels;
}

TEST(LayerLists, OrderByDepthWhateverTheFilterAndTheMemory) {
  MemoryAccount account;
  LayerLists<> lists(account);
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto all = arrivals(seed, 3000, seed % 2 == 0 ? 64 : 3);
    const auto expected = sorted(all);
    std::size_t deepest = 0;
    for (const auto& pixel : expected) deepest = std::max(deepest, pixel.size());
    for (const std::size_t filter : {std::size_t{1}, std::size_t{8}, kMany})
      for (const std::size_t capacity : {std::size_t{2}, std::size_t{10}, std::size_t{64}, kMany}) {
        lists.restart(LayerOrder::depth, filter, capacity);
        int windows = 0;
        EXPECT_EQ(drain(lists, all, true, windows), expected) << filter << ", " << capacity;
        EXPECT_EQ(windows > 1, deepest > capacity) << capacity;
      }
  }
}

TEST(LayerLists, OrderBySubmission) {
  MemoryAccount account;
  LayerLists<> lists(account);
  std::vector<Arrival> all = arrivals(5, 2000, 64);
  std::vector<std::vector<std::uint64_t>> expected(64);
  for (const Arrival& a : all) expected[static_cast<std::size_t>(a.pixel)].push_back(a.key);
  std::ranges::reverse(all);
  lists.restart(LayerOrder::submission, 8, kMany);
  int windows = 0;
  EXPECT_EQ(drain(lists, all, true, windows), expected);
}

// Paper 4's filter: a fragment passes at most K others, and is marked if that was too few.
TEST(LayerLists, AFilterOvertakesSoManyAndNotesTheOthers) {
  MemoryAccount account;
  LayerLists<> lists(account);
  const std::vector<Arrival> all{{0, key(0.5F, 0)},  {0, key(0.4F, 1)}, {0, key(0.3F, 2)},
                                 {0, key(0.45F, 3)}, {1, key(0.5F, 0)}, {1, key(0.6F, 1)}};
  lists.restart(LayerOrder::depth, 1, kMany);
  int windows = 0;
  const auto pixels = drain(lists, all, false, windows);
  EXPECT_EQ(pixels[0], (std::vector{all[0].key, all[1].key, all[3].key, all[2].key}));
  EXPECT_EQ(pixels[1], (std::vector{all[5].key, all[4].key}));
  EXPECT_EQ(lists.misplaced(), 1U);
  lists.restart(LayerOrder::depth, 2, kMany);
  EXPECT_EQ(drain(lists, all, false, windows), sorted(all));
  EXPECT_EQ(lists.misplaced(), 0U);
}

TEST(LayerLists, OwnersStayWithTheirKeys) {
  MemoryAccount account;
  LayerLists<std::uint32_t> lists(account);
  const auto all = arrivals(9, 3000, 5);
  for (const std::size_t capacity : {std::size_t{16}, kMany}) {
    lists.restart(LayerOrder::depth, 4, capacity);
    do {
      for (std::uint32_t i = 0; i < all.size(); ++i) lists.insert(all[i].pixel, all[i].key, i);
      lists.sort();
      for (std::size_t k = 0; k < lists.depth(); ++k)
        for (std::uint64_t m = lists.mask(k); m != 0; m &= m - 1) {
          const int i = std::countr_zero(m);
          ASSERT_EQ(all[lists.owners(k)[i]].key, lists.plane(k)[i]);
        }
    } while (lists.next_window());
  }
}

/// `count` layers over all pixels, nearest first, with colours and alpha from a seed.
struct Stack {
  std::vector<BlockColors> colors;
  std::vector<std::vector<std::uint64_t>> keys;
  BlockColors behind;

  Stack(std::uint64_t seed, int count, bool shuffled) {
    Random random(seed);
    const auto channel = [&] { return static_cast<float>(random.real(0, 1)); };
    for (int i = 0; i < 64; ++i) behind.set(i, {channel(), channel(), channel(), 1});
    for (int k = 0; k < count; ++k) {
      const int place = shuffled ? (k * 7 + 3) % count : k;
      BlockColors& c = colors.emplace_back();
      auto& w = keys.emplace_back(64);
      for (int i = 0; i < 64; ++i) {
        const float a = 0.1F + 0.8F * channel();
        c.set(i, {a * channel(), a * channel(), a * channel(), a});
        w[static_cast<std::size_t>(i)] =
            key(0.9F - 0.8F * static_cast<float>(place) / static_cast<float>(count),
                static_cast<std::uint64_t>(k));
      }
    }
  }
};

const TransparencyOptions kExact, kUnsorted{.method = Transparency::unsorted};

BlockColors blended(const Stack& stack, const TransparencyOptions& method, Isa isa = Isa::scalar,
                    std::uint64_t mask = ~std::uint64_t{0}) {
  const auto blend = transparency::make_blend(method, isa);
  // A blend is used for several blocks; the first must leave nothing behind.
  BlockColors out;
  for (int block = 0; block < 2; ++block) {
    blend->begin(stack.behind);
    for (int pass = 0; pass < blend->passes(); ++pass) {
      blend->begin_pass(pass);
      std::vector<std::size_t> order(stack.colors.size());
      for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
      if (blend->order() == LayerOrder::depth)
        std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
          return stack.keys[a][0] > stack.keys[b][0];
        });
      for (const std::size_t k : order) blend->layer({stack.keys[k].data(), mask, stack.colors[k]});
    }
    blend->finish(out);
  }
  return out;
}

float difference(const BlockColors& a, const BlockColors& b) {
  float worst = 0;
  for (int i = 0; i < 64; ++i)
    worst = std::max({worst, std::abs(a.r[i] - b.r[i]), std::abs(a.g[i] - b.g[i]),
                      std::abs(a.b[i] - b.b[i]), std::abs(a.a[i] - b.a[i])});
  return worst;
}

TEST(Blend, EveryInstructionSetGivesTheSameBits) {
  const Stack stack(3, 9, true);
  for (const std::uint64_t mask : {~std::uint64_t{0}, std::uint64_t{0x00F0A50108421234}})
    for (const TransparencyOptions& method : {kExact, kUnsorted}) {
      const BlockColors expected = blended(stack, method, Isa::scalar, mask);
      for (const Isa isa : available_isas())
        EXPECT_EQ(difference(blended(stack, method, isa, mask), expected), 0) << name(isa);
    }
}

TEST(Blend, FinishedPixelsAreThoseThatNothingChanges) {
  TransparencyOptions options;
  for (const float threshold : {1.0F, 0.9F}) {
    options.alpha_threshold = threshold;
    for (const Isa isa : available_isas()) {
      const auto blend = transparency::make_blend(options, isa);
      const BlockColors behind = {};
      blend->begin(behind);
      BlockColors colors = {};
      for (int i = 0; i < 64; ++i) colors.set(i, {0, 0, 0, static_cast<float>(i) / 63});
      const std::vector<std::uint64_t> keys(64, key(0.5F, 1));
      const std::uint64_t finished = blend->layer({keys.data(), ~std::uint64_t{0}, colors});
      for (int i = 0; i < 64; ++i)
        EXPECT_EQ(finished >> i & 1, colors.a[i] >= threshold) << i << ", " << name(isa);
    }
  }
}

const TransparencyOptions kApproximations[] = {family::wboit(), family::mboit4(), family::mboit6(),
                                               family::mlab4()};

TEST(Approximations, AreExactForOneLayer) {
  const Stack stack(1, 1, false);
  const BlockColors exact = blended(stack, kExact);
  EXPECT_LT(difference(blended(stack, kUnsorted), exact), 2e-5F);
  for (const TransparencyOptions& method : kApproximations)
    EXPECT_LT(difference(blended(stack, method), exact), 2e-5F) << &method - kApproximations;
}

TEST(Approximations, MultiLayerBlendingIsExactForFourLayersInAnyOrder) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Stack four(seed, 4, true);
    EXPECT_LT(difference(blended(four, family::mlab4()), blended(four, kExact)), 1e-6F);
    // With three layers kept, the last but one would be behind what it hides.
    Stack five(seed, 5, false);
    std::swap(five.keys[3], five.keys[4]);
    EXPECT_LT(difference(blended(five, family::mlab4()), blended(five, kExact)), 1e-6F);
    const Stack twelve(seed, 12, true);
    EXPECT_GT(difference(blended(twelve, family::mlab4()), blended(twelve, kExact)), 1e-3F);
  }
}

// Two layers are a measure of two points, which four moments determine. In front of each is what
// precedes it and a quarter of its own absorbance (the paper's overestimation).
TEST(Approximations, MomentsTellTwoLayersApart) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const Stack two(seed, 2, true);
    const std::size_t first = two.keys[0][0] > two.keys[1][0] ? 0 : 1;
    const BlockColors &near = two.colors[first], &far = two.colors[1 - first];
    for (const TransparencyOptions& method : {family::mboit4(), family::mboit6()}) {
      const BlockColors actual = blended(two, method);
      for (int i = 0; i < 64; ++i) {
        const double near_absorbance = -std::log(1 - static_cast<double>(near.a[i]));
        const double far_absorbance = -std::log(1 - static_cast<double>(far.a[i]));
        const double near_weight = std::exp(-near_absorbance / 4);
        const double far_weight = std::exp(-near_absorbance - far_absorbance / 4);
        const double through = std::exp(-near_absorbance - far_absorbance);
        const double scale = (1 - through) / (near_weight * static_cast<double>(near.a[i]) +
                                              far_weight * static_cast<double>(far.a[i]));
        const double expected = (near_weight * static_cast<double>(near.r[i]) +
                                 far_weight * static_cast<double>(far.r[i])) *
                                    scale +
                                through * static_cast<double>(two.behind.r[i]);
        EXPECT_NEAR(static_cast<double>(actual.r[i]), expected, 2e-3);
      }
    }
  }
}

TEST(Approximations, KeepTheAlphaOfTheWhole) {
  const Stack stack(8, 10, true);
  const BlockColors exact = blended(stack, kExact);
  for (const TransparencyOptions& method : kApproximations) {
    const BlockColors colors = blended(stack, method);
    for (int i = 0; i < 64; ++i) {
      EXPECT_NEAR(colors.a[i], exact.a[i], 1e-5F);
      for (const float c : {colors.r[i], colors.g[i], colors.b[i]}) {
        EXPECT_GE(c, 0);
        EXPECT_LE(c, 1 + 1e-5F);
      }
    }
  }
}

// Nearer layers count more: a dark one in front of bright ones stays dark.
TEST(Approximations, NearLayersCountMore) {
  Stack stack(8, 2, false);
  for (int i = 0; i < 64; ++i) {
    stack.colors[0].set(i, {0, 0, 0, 0.9F});
    stack.colors[1].set(i, {0.9F, 0.9F, 0.9F, 0.9F});
  }
  Stack turned = stack;
  std::swap(turned.colors[0], turned.colors[1]);
  int number = 0;
  for (const TransparencyOptions& method :
       {kExact, family::wboit(), family::mboit4(), family::mboit6(), family::mlab4()}) {
    const BlockColors dark = blended(stack, method), bright = blended(turned, method);
    for (int i = 0; i < 64; ++i) EXPECT_LT(dark.r[i], bright.r[i]) << number;
    ++number;
  }
}

}  // namespace
}  // namespace rastrum::test::blend_test
