// SPDX-License-Identifier: BSD-3-Clause
// Checks by hand the estimated costs of triangle frames, and which frames are worth a GPU.
#include <rastrum/render/device_work.hpp>

#include <vector>

#include <gtest/gtest.h>

namespace rastrum::device_work_test {
namespace {

/// A valid frame, but without a source of vertices.
struct Request {
  Request(std::size_t triangles, int width, int height)
      : indices(triangles * 3), picture(width, height) {
    draw.indices = indices;
    draw.primitive_count = triangles;
    draw.vertex_count = triangles / 2;
    request.width = width;
    request.height = height;
    request.draws = {&draw, 1};
    request.targets.color8 = picture.view();
  }
  Request(const Request&) = delete;
  Request& operator=(const Request&) = delete;

  std::vector<std::uint32_t> indices;
  Image<Rgba8> picture;
  raster::Draw draw;
  raster::FrameRequest request;
};

TEST(DeviceWork, CountsArraysAndTargets) {
  Request r(1000, 64, 32);
  constexpr std::uint64_t kArrays = 500 * 24 + 3000 * 4, kPixels = 64 * 32;
  EXPECT_EQ(device_work(r.request).bytes, kArrays + kPixels * 4);
  EXPECT_EQ(device_work(r.request).what, "1000 primitives at 64x32");
  Image<std::uint64_t> keys(64, 32);
  r.request.targets.keys = keys.view();
  EXPECT_EQ(device_work(r.request).bytes, kArrays + kPixels * (4 + 8));
  r.request.pass.load = true;
  EXPECT_EQ(device_work(r.request).bytes, kArrays + kPixels * (4 + 16));
}

TEST(DeviceWork, SmallPicturesAreTheThreadsAndLargeMeshesTheDevices) {
  const auto worth = [](std::size_t triangles, int width, int height, int threads) {
    const Request r(triangles, width, height);
    return estimate(device_work(r.request), threads).is_worth_it();
  };
  EXPECT_FALSE(worth(1000, 320, 240, 4));
  EXPECT_FALSE(worth(1000, 1024, 1024, 16));
  EXPECT_TRUE(worth(1'000'000, 1024, 1024, 2));
  EXPECT_TRUE(worth(100'000, 1920, 1080, 2));
  EXPECT_TRUE(worth(4'000'000, 4096, 4096, 8));
}

}  // namespace
}  // namespace rastrum::device_work_test
