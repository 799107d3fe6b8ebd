// SPDX-License-Identifier: BSD-3-Clause
// Small triangles that setup writes to their bins give the same keys as pieces.
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/make_piece.hpp>

namespace rastrum::raster::small_test {
namespace {

constexpr Rect kImage{0, 0, 250, 240};
constexpr int kPitch = 256;
using KeyPicture = std::vector<std::uint64_t>;

struct Scene {
  std::vector<ProjectedVertex> vertices;
  SetupInput input;
};

/// Triangles in and around `view`, mostly small, also at the corners of its bins.
Scene scene(Rect view, const std::vector<std::uint32_t>& numbers) {
  std::mt19937 random(5);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Scene made;
  for (std::uint32_t i = 0; i < kSetupBatch; ++i) {
    const double sizes[] = {3, 9, 15.5, 17, 40};
    const double size = sizes[random() % std::size(sizes)];
    const double x = uniform(view.x0 - size, view.x1), y = uniform(view.y0 - size, view.y1);
    for (int c = 0; c < 3; ++c) {
      // A quarter of them on sample centres and pixel corners.
      const auto snapped = [&](double px) {
        const auto fx8 = static_cast<std::int32_t>(px * kSubpixels);
        return random() % 4 == 0 ? fx8 / kHalfPixel * kHalfPixel : fx8;
      };
      made.vertices.push_back({snapped(x + uniform(0, size)), snapped(y + uniform(0, size)),
                               static_cast<float>(uniform(-0.1, 1.1)), 1});
    }
  }
  SetupInput& in = made.input;
  in.vertices = made.vertices.data();
  in.vertex_count = made.vertices.size();
  in.count = kSetupBatch;
  in.first_id = 0xFFFFFFFFU - kSetupBatch;  // the largest that fit
  in.numbers = numbers.empty() ? nullptr : numbers.data();
  in.view = kImage;
  in.bin_columns = 4;
  in.bins.view = view;
  return made;
}

void raise_pieces(const Piece* pieces, std::uint32_t n, Rect view, KeyPicture& keys) {
  for (std::uint32_t i = 0; i < n; ++i)
    for_each_covered(pieces[i], view, [&](int x, int y) {
      std::uint64_t& key = keys[static_cast<std::size_t>(y * kPitch + x)];
      key = std::max(key, make_key(plane_depth_at(pieces[i], x, y), pieces[i].low));
    });
}

/// Raises the keys of small triangles in parts of `side` px of the bins of `view`.
void raise_small(Isa isa, const std::vector<BinTriangle>& triangles, const BinNumbers& numbers,
                 int side, KeyPicture& keys) {
  const Rect view = numbers.view;
  const int columns = (view.x1 - view.x0 + kBinSize - 1) / kBinSize;
  for (int y0 = view.y0; y0 < view.y1; y0 += side)
    for (int x0 = view.x0; x0 < view.x1; x0 += side) {
      const int column = (x0 - view.x0) / kBinSize, row = (y0 - view.y0) / kBinSize;
      const auto bin = static_cast<std::uint32_t>(row * columns + column);
      std::vector<BinTriangle> own;
      for (const BinTriangle& t : triangles)
        if (t.bin == bin || t.bin == bin + numbers.later) own.push_back(t);
      const Rect rect{x0, y0, std::min(x0 + side, view.x1), std::min(y0 + side, view.y1)};
      std::vector<std::uint64_t> memory(RowKeys::kSize);
      RowKeys rows{.keys = memory.data(), .touched = {rect.x1, rect.y1, rect.x0, rect.y0}};
      kernels(isa).raise_small(own.data(), own.size(), view.x0 + column * kBinSize,
                               view.y0 + row * kBinSize, rect, nullptr, rows);
      std::uint64_t fragments = 0;
      for (int y = 0; y < kBinSize; ++y)
        for (int x = 0; x < static_cast<int>(RowKeys::kRow); ++x) {
          const std::uint64_t key =
              memory[static_cast<std::size_t>(y) * RowKeys::kRow + static_cast<std::size_t>(x)];
          if (key == 0) continue;
          ++fragments;
          const Rect box = rows.touched;
          ASSERT_TRUE(x0 + x >= box.x0 && x0 + x < box.x1 && y0 + y >= box.y0 && y0 + y < box.y1);
          ASSERT_TRUE(x0 + x < rect.x1 && y0 + y < rect.y1);
          std::uint64_t& all = keys[static_cast<std::size_t>((y0 + y) * kPitch + x0 + x)];
          all = std::max(all, key);
        }
      ASSERT_GE(rows.fragments, fragments);
    }
}

TEST(SmallTriangles, AreTheSameKeysAsPieces) {
  std::vector<std::uint32_t> numbers(kSetupBatch);
  for (std::uint32_t i = 0; i < kSetupBatch; ++i) numbers[i] = i * 37 % kSetupBatch;
  // The whole image, whose last bins are cut, and a part of it.
  for (const Rect view : {kImage, Rect{64, 64, 192, 180}})
    for (const Isa isa : available_isas())
      for (const bool numbered : {false, true}) {
        if (kernels(isa).raise_small == nullptr) continue;
        SCOPED_TRACE(testing::Message() << name(isa) << " from " << view.x0 << ", " << numbered);
        Scene s = scene(view, numbered ? numbers : std::vector<std::uint32_t>{});
        if (numbered) s.input.numbers = numbers.data();
        const auto columns = static_cast<std::uint32_t>((view.x1 - view.x0 + 63) / kBinSize);
        const auto rows = static_cast<std::uint32_t>((view.y1 - view.y0 + 63) / kBinSize);
        s.input.bins.later = columns * rows;
        std::vector<Piece> pieces(kSetupBatch);
        std::vector<std::uint32_t> slow(kSetupBatch);
        const SetupOutput plain =
            kernels(Isa::scalar).setup(s.input, pieces.data(), nullptr, slow.data());
        KeyPicture expected(static_cast<std::size_t>(kPitch * kPitch));
        raise_pieces(pieces.data(), plain.pieces, view, expected);

        std::vector<BinTriangle> small(std::size_t{4} * kSetupBatch);
        s.input.small = small.data();
        const SetupOutput out = kernels(isa).setup(s.input, pieces.data(), nullptr, slow.data());
        EXPECT_EQ(out.pieces + out.small_triangles, plain.pieces);
        EXPECT_GT(out.small_triangles, plain.pieces / 2);
        small.resize(out.small);
        for (const BinTriangle& t : small) ASSERT_LT(t.bin, 2 * columns * rows);
        EXPECT_TRUE(std::ranges::any_of(
            small, [&](const BinTriangle& t) { return t.bin >= columns * rows; }));
        for (const int side : {kBinSize, 16}) {
          KeyPicture found(expected.size());
          raise_pieces(pieces.data(), out.pieces, view, found);
          raise_small(isa, small, s.input.bins, side, found);
          EXPECT_EQ(found, expected) << side;
        }
      }
}

}  // namespace
}  // namespace rastrum::raster::small_test
