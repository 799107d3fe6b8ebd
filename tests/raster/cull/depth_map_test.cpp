// SPDX-License-Identifier: BSD-3-Clause
// The depth map hides what is behind the surface, by blocks of a view.
#include <rastrum/raster/cull/depth_map.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/raster/rules/make_piece.hpp>

namespace rastrum::raster::depth_map_test {
namespace {

/// A view whose keys are all of one surface at depth 0.5.
struct FlatView {
  Rect view;
  std::vector<std::uint64_t> keys = std::vector<std::uint64_t>(
      static_cast<std::size_t>(block_count(view)) * 64, make_key(0.5F, 7));
  SurfaceView surface{0, 0, block_columns(view), keys.data(), nullptr};
  const Kernels& kernel = kernels(Isa::scalar);
};

// At equal depths the smaller id wins, so triangles at the surface's depth are not hidden.
TEST(DepthMap, WhatIsAsNearIsNotHidden) {
  MemoryAccount memory;
  DepthMap depths(memory);
  FlatView flat{{0, 0, 20, 70}};
  const auto look = [&] {
    depths.begin(flat.view);
    depths.look(flat.kernel, flat.surface.part(0, 0), {0, 0, 20, 64});
    depths.look(flat.kernel, flat.surface.part(0, 8), {0, 64, 20, 70});
  };
  look();
  Candidate c;
  c.highest = 0.5F;
  c.bx1 = 3;
  c.by1 = 9;
  EXPECT_FALSE(depths.hides(c));
  c.highest = std::nextafter(0.5F, 0.0F);
  EXPECT_TRUE(depths.hides(c));
  flat.keys[5 * 64 + 63] = 0;  // an empty sample in block (2, 1)
  look();
  EXPECT_TRUE(depths.hides(c));  // beyond the picture's edge: column 23 of 20
  flat.keys[5 * 64 + 56] = 0;
  look();
  EXPECT_FALSE(depths.hides(c));
  c.by0 = 2;
  EXPECT_TRUE(depths.hides(c));
  c.highest = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(depths.hides(c));
}

// If several threads share a bin, each updates its own part.
TEST(DepthMap, APartOfABinSaysNothingOfTheRest) {
  MemoryAccount memory;
  DepthMap depths(memory);
  const FlatView flat{{0, 0, 96, 64}};
  const auto hides = [&](std::uint16_t bx0, std::uint16_t by0, std::uint16_t bx1) {
    Candidate c;
    c.highest = 0.25F;
    c.bx0 = bx0, c.by0 = by0, c.bx1 = bx1, c.by1 = 8;
    return depths.hides(c);
  };
  depths.begin(flat.view);
  depths.look(flat.kernel, flat.surface, {0, 0, 32, 64});
  depths.look(flat.kernel, flat.surface, {64, 32, 96, 64});  // a part of a bin that the view cuts
  EXPECT_TRUE(hides(0, 0, 4));
  EXPECT_TRUE(hides(8, 4, 12));
  EXPECT_FALSE(hides(0, 0, 8));
  EXPECT_FALSE(hides(8, 0, 12));
  depths.look(flat.kernel, flat.surface, {32, 0, 64, 64});
  EXPECT_TRUE(hides(0, 0, 8));
}

}  // namespace
}  // namespace rastrum::raster::depth_map_test
