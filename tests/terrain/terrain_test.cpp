// What a terrain answers at a point, on any size of map and beyond its edges.
#include <rastrum/terrain/renderer.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace rastrum::terrain {
namespace {

TEST(Tiled, FloorsNegativeCoordinates) {
  EXPECT_EQ(tiled(-1, 3, Tiling::repeat), 2);
  EXPECT_EQ(tiled(-3, 3, Tiling::repeat), 0);
  EXPECT_EQ(tiled(7, 3, Tiling::repeat), 1);
  EXPECT_EQ(tiled(-1, 3, Tiling::mirror), 0);
  EXPECT_EQ(tiled(3, 3, Tiling::mirror), 2);
  EXPECT_EQ(tiled(-4, 3, Tiling::mirror), 2);
  EXPECT_EQ(tiled(-5, 3, Tiling::clamp), 0);
  EXPECT_EQ(tiled(5, 3, Tiling::clamp), 2);
}

}  // namespace
}  // namespace rastrum::terrain
