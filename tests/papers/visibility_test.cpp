// SPDX-License-Identifier: BSD-3-Clause
// Every visibility method against a plain maximum at each pixel, on generated blocks: one thread
// that owns the region, many that share it, few and many layers, equal depths, depth 0, on a
// surface that already holds keys, and some fragments with finished keys. Also each method's exact
// counters.
#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <papers/axes/region.hpp>
#include <rastrum/core/memory.hpp>
#include <rastrum/raster/rules/make_piece.hpp>

#include "tests/support/random.hpp"

namespace rastrum::test::visibility_test {
namespace {

using namespace rastrum::family;

constexpr int kWidth = 100, kHeight = 75;
constexpr Rect kImage{0, 0, kWidth, kHeight};

/// A colour that depends on pixel and id.
class ByKey final : public BlockShader {
 public:
  bool shade(const FrameGeometry&, const VisibleBlock& block, Isa,
             BlockColors& colors) const noexcept override {
    // Scratch that is kept between blocks must begin with zeros in each case and belong to one
    // thread.
    auto* const kept = static_cast<std::uint64_t*>(block.scratch);
    if (kept[0] != kept[1] || (kept[2] != 0 && kept[2] != case_number)) std::abort();
    ++kept[0];
    kept[2] = case_number;
    for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      colors.set(i, color(block.keys[i], block.x0 + i % kBlockSize, block.y0 + i / kBlockSize));
    }
    ++kept[1];
    return false;
  }
  [[nodiscard]] std::size_t scratch_bytes() const noexcept override { return 24; }

  std::uint64_t case_number = 0;
  static Vec4 color(std::uint64_t key, int x, int y) {
    return {static_cast<float>(key & 1023), static_cast<float>(key >> 50), static_cast<float>(x),
            static_cast<float>(y)};
  }
};

struct Fragment {
  int x, y;
  std::uint64_t key;
};

/// Pieces, and blocks of them with random masks in chunks.
struct Case {
  std::vector<Piece> pieces;
  std::vector<std::vector<Block>> chunks;
  std::vector<std::uint64_t> before;  ///< keys that the surface begins with, pixel by pixel
  std::uint64_t fragments = 0;

  template <class F>
  void for_each_fragment(const F& f) const {
    for (const std::vector<Block>& chunk : chunks)
      for (const Block& b : chunk)
        for (std::uint64_t m = b.mask; m != 0; m &= m - 1) {
          const int i = std::countr_zero(m);
          const int x = b.bx * kBlockSize + i % kBlockSize, y = b.by * kBlockSize + i / kBlockSize;
          const Piece& p = pieces[b.piece];
          f(Fragment{x, y, make_key(depth_at(p, x, y), p.low)});
        }
  }
  [[nodiscard]] std::vector<std::uint64_t> maxima() const {
    std::vector<std::uint64_t> keys = before;
    for_each_fragment([&](const Fragment& f) {
      std::uint64_t& key = keys[static_cast<std::size_t>(f.y * kWidth + f.x)];
      key = std::max(key, f.key);
    });
    return keys;
  }
};

Case generate(std::uint64_t seed, int layers, std::size_t chunk_count) {
  Random random(seed);
  Case c;
  const bool on_surface = random.chance(0.5);
  const int pieces = 200;
  for (int i = 0; i < pieces; ++i) {
    Piece p{};
    for (int k = 0; k < 3; ++k) {
      p.x[k] = random.integer(0, kWidth * 256);
      p.y[k] = random.integer(0, kHeight * 256);
    }
    // A third have the same depth, so that ids decide; some of these have depth 0.
    p.z0 = i % 3 == 0 ? (i % 2 == 0 ? 0.5F : 0.0F) : static_cast<float>(random.real(0.1, 1));
    if (i % 3 == 1) {
      p.zx = static_cast<float>(random.real(-0.01, 0.01));
      p.zy = static_cast<float>(random.real(-0.01, 0.01));
    }
    const auto id = static_cast<std::uint64_t>(1000 + (i * 77) % pieces);
    p.low = kIdMask - (i == 7 ? 0 : i == 8 ? kMaxId : id);
    c.pieces.push_back(p);
  }
  c.chunks.resize(chunk_count);
  for (int layer = 0; layer < layers; ++layer)
    for (int by = 0; by * kBlockSize < kHeight; ++by)
      for (int bx = 0; bx * kBlockSize < kWidth; ++bx) {
        std::uint64_t mask = 0;
        switch (random.integer(0, 3)) {
          case 0:
            continue;
          case 1:
            mask = ~std::uint64_t{0};
            break;
          case 2:
            mask = random.bits();
            break;
          default:
            mask = std::uint64_t{5} << random.integer(0, 61);
        }
        mask &= samples_inside(kImage, bx, by);
        if (mask == 0) continue;
        c.chunks[static_cast<std::size_t>(random.bits() % chunk_count)].push_back(
            {static_cast<std::uint32_t>(random.integer(0, pieces - 1)),
             static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), mask});
        c.fragments += static_cast<std::uint64_t>(std::popcount(mask));
      }
  c.before.resize(std::size_t{kWidth} * kHeight);
  if (on_surface)
    for (std::uint64_t& key : c.before)
      if (random.chance(0.5))
        key = make_key(random.chance(0.3) ? 0.5F : static_cast<float>(random.real(0, 1)),
                       kIdMask - static_cast<std::uint64_t>(random.integer(0, 2000)));
  return c;
}

struct Resolved {
  std::vector<std::uint64_t> keys;  ///< pixel by pixel
  std::vector<Vec4> colors;
  std::map<std::string, std::uint64_t> counters;
};

/// Resolves cases with one method. Its state between cases is part of the test.
class Resolver {
 public:
  Resolver(const Visibility& method, Isa isa, int threads)
      : exec_(threads, &memory_), kernel_(kernels(isa)), takes_fragments_(method.takes_fragments) {
    request_.width = kWidth;
    request_.height = kHeight;
    request_.isa = isa;
    request_.shading = &shader_;
    request_.targets.color = {color_.data(), kWidth, kHeight, kWidth};
    plan_ = FramePlan::of(request_, true, false);
    shared_ = method.make(Sharing::shared, memory_);
    owned_ = method.make(Sharing::owned, memory_);
  }

  Resolved shared(const Case& c, std::uint64_t fragment_bytes) {
    const SurfaceView surface = whole(c);
    shared_->begin({{&request_, &plan_, &frame_, &kernel_, fragment_bytes, nullptr}, &exec_, false},
                   surface, kImage, c.chunks.size());
    while (const auto pass = shared_->next())
      parallel::for_each_index(exec_, pass->last - pass->first, [&](std::size_t i) {
        hand_over(*shared_, pass->first + i, c.pieces, c.chunks[pass->first + i]);
      });
    return read(surface, *shared_);
  }

  /// Bins one after the other; every second one has keys of its own. If the method takes finished
  /// fragments, every third block is handed over so.
  Resolved owned(const Case& c, std::uint64_t fragment_bytes) {
    const SurfaceView surface = whole(c);
    for (int y = 0; y < kHeight; y += kBinSize)
      for (int x = 0; x < kWidth; x += kBinSize) {
        const Rect bin{x, y, std::min(x + kBinSize, kWidth), std::min(y + kBinSize, kHeight)};
        std::vector<Block> blocks;
        std::vector<BinFragment> finished;
        std::size_t n = 0;
        for (const std::vector<Block>& chunk : c.chunks)
          for (const Block& b : chunk) {
            if (b.bx * kBlockSize / kBinSize != x / kBinSize ||
                b.by * kBlockSize / kBinSize != y / kBinSize)
              continue;
            if (takes_fragments_ && n++ % 3 == 0)
              add_fragments(c.pieces[b.piece], b, finished);
            else
              blocks.push_back(b);
          }
        const SurfaceView part = surface.part(x / kBlockSize, y / kBlockSize);
        SurfaceView local = part;
        local.columns = kBlocksPerBinRow;
        alignas(64) std::uint64_t keys[kBinSize * kBinSize];
        std::vector<BlockColors> colors(kBlocksPerBin);
        const bool is_local = x == 0;
        if (is_local) {
          local.keys = keys;
          local.colors = colors.data();
          copy(bin, part, local);
        }
        owned_->begin(
            {{&request_, &plan_, &frame_, &kernel_, fragment_bytes, nullptr}, nullptr, false},
            is_local ? local : part, bin, 1);
        while (const auto pass = owned_->next()) {
          EXPECT_EQ(pass->first, 0U);
          EXPECT_EQ(pass->last, 1U);
          if (!finished.empty()) owned_->fragments(finished);
          hand_over(*owned_, 0, c.pieces, blocks);
        }
        if (is_local) copy(bin, local, part);
      }
    return read(surface, *owned_);
  }

 private:
  static void hand_over(Region& region, std::size_t chunk, const std::vector<Piece>& pieces,
                        std::span<const Block> blocks) {
    while (!blocks.empty()) {
      const std::size_t n = std::min<std::size_t>(blocks.size(), 37);
      region.blocks(chunk, pieces.data(), blocks.first(n));
      blocks = blocks.subspan(n);
    }
  }

  static void add_fragments(const Piece& piece, const Block& b, std::vector<BinFragment>& to) {
    const int block = b.by % kBlocksPerBinRow * kBlocksPerBinRow + b.bx % kBlocksPerBinRow;
    for (std::uint64_t m = b.mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      const int x = b.bx * kBlockSize + i % kBlockSize, y = b.by * kBlockSize + i / kBlockSize;
      to.push_back({make_key(depth_at(piece, x, y), piece.low), 0,
                    static_cast<std::uint32_t>(64 * block + i)});
    }
  }

  static void copy(Rect bin, const SurfaceView& from, const SurfaceView& to) {
    for (int by = from.by0; by * kBlockSize < bin.y1; ++by)
      for (int bx = from.bx0; bx * kBlockSize < bin.x1; ++bx) {
        std::copy_n(from.block(bx, by), 64, to.block(bx, by));
        *to.colors_of(bx, by) = *from.colors_of(bx, by);
      }
  }

  SurfaceView whole(const Case& c) {
    ++shader_.case_number;
    keys_.assign(block_count(kImage) * 64, 0);
    colors_.assign(block_count(kImage), BlockColors{});
    const SurfaceView surface{0, 0, block_columns(kImage), keys_.data(), colors_.data()};
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        surface.block(x / kBlockSize,
                      y / kBlockSize)[y % kBlockSize * kBlockSize + x % kBlockSize] =
            c.before[static_cast<std::size_t>(y * kWidth + x)];
    return surface;
  }

  static Resolved read(const SurfaceView& surface, Region& region) {
    Resolved r;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const int bx = x / kBlockSize, by = y / kBlockSize;
        const int i = y % kBlockSize * kBlockSize + x % kBlockSize;
        r.keys.push_back(surface.block(bx, by)[i]);
        const BlockColors& colors = *surface.colors_of(bx, by);
        r.colors.push_back({colors.r[i], colors.g[i], colors.b[i], colors.a[i]});
      }
    Counters counters;
    region.collect(counters);
    for (const auto& [name, value] : counters) r.counters[std::string(name)] = value;
    return r;
  }

  MemoryAccount memory_;
  parallel::Threads exec_;
  const Kernels& kernel_;
  bool takes_fragments_;
  FrameRequest request_;
  FramePlan plan_;
  FrameGeometry frame_;
  ByKey shader_;
  std::vector<Vec4> color_ = std::vector<Vec4>(std::size_t{kWidth} * kHeight);
  // Kernels need aligned keys.
  std::vector<std::uint64_t, parallel::ArenaAllocator<std::uint64_t>> keys_{
      parallel::ArenaAllocator<std::uint64_t>(std::make_shared<parallel::Arena>())};
  std::vector<BlockColors> colors_;
  std::unique_ptr<Region> shared_, owned_;
};

const Visibility& method(std::string_view name) {
  for (const Visibility& v : family::visibilities())
    if (v.name == name) return v;
  throw std::runtime_error("no such method");
}

class Methods : public testing::TestWithParam<std::string> {
 protected:
  const Visibility& method_ = method(GetParam());

  void expect(Resolver& resolver, const Case& c, std::uint64_t bytes = 0) const {
    expect(c, resolver.shared(c, bytes));
    expect(c, resolver.owned(c, bytes));
  }
  void expect(const Case& c, const Resolved& r) const {
    ASSERT_EQ(r.keys, c.maxima());
    if (!method_.shades) return;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const auto i = static_cast<std::size_t>(y * kWidth + x);
        // Keys from before have no colour here.
        const Vec4 expected = r.keys[i] == c.before[i] ? Vec4{} : ByKey::color(r.keys[i], x, y);
        ASSERT_EQ(r.colors[i], expected);
      }
  }
};

constexpr int kLayers[] = {0, 1, 2, 5, 16, 64};

TEST_P(Methods, KeepTheMaximumOfEachPixel) {
  std::uint64_t seed = 0;
  for (const Isa isa : {Isa::scalar, available_isas().back()})
    for (const int threads : {1, 2, 8}) {
      Resolver resolver(method_, isa, threads);
      for (const int layers : kLayers)
        for (const std::size_t chunks : {std::size_t{1}, std::size_t{3}, std::size_t{200}}) {
          const Case c = generate(++seed, layers, chunks);
          SCOPED_TRACE(std::to_string(layers) + " layers in " + std::to_string(chunks) +
                       " chunks, " + std::to_string(threads) + " threads");
          expect(resolver, c);
          if (HasFatalFailure()) return;
        }
    }
}

// Very few fragments: tables and sorts have minimum sizes.
TEST_P(Methods, KeepTheMaximumOfAFewFragments) {
  Resolver resolver(method_, available_isas().back(), 2);
  for (std::uint64_t seed = 1000; seed < 1200; ++seed) {
    Case c = generate(seed, 1, 1);
    c.chunks[0].resize(std::min<std::size_t>(c.chunks[0].size(), 1 + seed % 4));
    for (Block& b : c.chunks[0]) b.mask &= std::uint64_t{0xFFFF} << 48;
    std::erase_if(c.chunks[0], [](const Block& b) { return b.mask == 0; });
    expect(resolver, c);
    if (HasFatalFailure()) return;
  }
}

// With very little memory for fragments.
TEST_P(Methods, KeepTheMaximumWithinABudget) {
  Resolver resolver(method_, available_isas().back(), 8);
  std::uint64_t seed = 100;
  for (const std::uint64_t bytes :
       {std::uint64_t{1}, std::uint64_t{5000}, std::uint64_t{200000}, std::uint64_t{3000000}})
    for (const std::size_t chunks : {std::size_t{1}, std::size_t{3}, std::size_t{200}}) {
      const Case c = generate(++seed, 20, chunks);
      SCOPED_TRACE(std::to_string(bytes) + " bytes, " + std::to_string(chunks) + " chunks");
      expect(resolver, c, bytes);
      if (HasFatalFailure()) return;
    }
}

TEST_P(Methods, CountTheSameWithEveryNumberOfThreads) {
  const Case c = generate(7, 16, 200);
  const auto expected = Resolver(method_, Isa::scalar, 1).shared(c, 0).counters;
  for (const int threads : {2, 8})
    for (int i = 0; i < 20; ++i)
      ASSERT_EQ(Resolver(method_, Isa::scalar, threads).shared(c, 0).counters, expected);
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Visibility& v : family::visibilities()) all.emplace_back(v.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(All, Methods, testing::ValuesIn(names()),
                         [](const auto& p) { return p.param; });

class Counted : public testing::TestWithParam<int> {
 protected:
  Resolved resolve(std::string_view name, Sharing sharing, std::uint64_t bytes = 0) {
    Resolver resolver(method(name), available_isas().back(), 2);
    return sharing == Sharing::shared ? resolver.shared(case_, bytes)
                                      : resolver.owned(case_, bytes);
  }
  const Case case_ = generate(static_cast<std::uint64_t>(GetParam()), GetParam(), 10);
};

TEST_P(Counted, SearchComparesEveryFragmentOnceMore) {
  const std::vector<std::uint64_t> maxima = case_.maxima();
  std::uint64_t matches = 0;
  case_.for_each_fragment([&](const Fragment& f) {
    matches += f.key >> kIdBits == maxima[static_cast<std::size_t>(f.y * kWidth + f.x)] >> kIdBits;
  });
  for (const Sharing sharing : {Sharing::owned, Sharing::shared})
    EXPECT_EQ(resolve("search", sharing).counters,
              (std::map<std::string, std::uint64_t>{{"fragments compared", case_.fragments},
                                                    {"depth matches", matches}}));
}

TEST_P(Counted, TupleShadesEveryFragment) {
  for (const Sharing sharing : {Sharing::owned, Sharing::shared})
    EXPECT_EQ(resolve("tuple", sharing).counters,
              (std::map<std::string, std::uint64_t>{{"fragments shaded", case_.fragments}}));
}

TEST_P(Counted, SortedWritesEveryFragmentOnce) {
  // In an image this small a band is a block; a slice holds 32,768.
  std::set<std::pair<int, int>> blocks;
  std::map<std::pair<int, int>, std::uint64_t> bins;
  case_.for_each_fragment([&](const Fragment& f) {
    blocks.insert({f.x / kBlockSize, f.y / kBlockSize});
    ++bins[{f.x / kBinSize, f.y / kBinSize}];
  });
  std::uint64_t slices = 0;
  for (const auto& [bin, n] : bins) slices += (n + 32767) / 32768;
  const auto expected = [&](std::uint64_t sorts) {
    return std::map<std::string, std::uint64_t>{{"fragments materialized", case_.fragments},
                                                {"sorts", sorts}};
  };
  EXPECT_EQ(resolve("sorted", Sharing::shared).counters, expected(blocks.size()));
  EXPECT_EQ(resolve("sorted", Sharing::owned).counters, expected(slices));
  EXPECT_EQ(resolve("sorted", Sharing::shared, 100000).counters.at("fragments materialized"),
            case_.fragments);
}

TEST_P(Counted, HashedHasASlotForEveryPixelItMeets) {
  std::set<std::pair<int, int>> pixels;
  case_.for_each_fragment([&](const Fragment& f) { pixels.insert({f.x, f.y}); });
  for (const Sharing sharing : {Sharing::owned, Sharing::shared}) {
    const auto counters = resolve("hashed", sharing).counters;
    EXPECT_EQ(counters.at("fragments hashed"), case_.fragments);
    EXPECT_EQ(counters.at("table entries"), pixels.size());
    EXPECT_GE(counters.at("probes"), pixels.size());
    EXPECT_LE(counters.at("probes"), pixels.size() * 4);
    EXPECT_GE(counters.at("table slots"), pixels.size());
  }
  // Counted before, so there are at most as many slots as the load factor 0.7 needs, up to a few
  // blocks.
  const auto bound = std::min<std::uint64_t>(case_.fragments, block_count(kImage) * 64);
  const auto slots = resolve("hashed", Sharing::shared).counters.at("table slots");
  EXPECT_GE(slots * 7, bound * 10);
  EXPECT_LE(slots * 7, (bound + 1) * 10 + 256 * 7);
}

INSTANTIATE_TEST_SUITE_P(Layers, Counted, testing::ValuesIn(kLayers));

}  // namespace
}  // namespace rastrum::test::visibility_test
