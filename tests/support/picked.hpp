// SPDX-License-Identifier: BSD-3-Clause
// Checks that Renderer::pick returns what the frame's images hold.
#pragma once

#include <gtest/gtest.h>

#include <rastrum/pick.hpp>

#include "tests/support/frame.hpp"

namespace rastrum::test {

/// `frame` has kSurfaces. A difference fails fatally.
inline void expect_picked(const Pick& p, const Frame& frame, int x, int y) {
  ASSERT_EQ(static_cast<std::int64_t>(p.id), frame.ids(x, y));
  ASSERT_EQ(p.instance_id, frame.instances(x, y));
  ASSERT_EQ(static_cast<std::int64_t>(p.primitive), frame.primitives(x, y));
  const auto& b = p.barycentrics.weight;
  const Vec2 uv{static_cast<float>(b[1]), static_cast<float>(b[2])};
  ASSERT_TRUE(same_pixel(uv, frame.barycentrics(x, y)));
  ASSERT_TRUE(same_pixel(Vec3(p.position), frame.positions(x, y)));
  ASSERT_TRUE(same_pixel(Vec3(p.normal), frame.normals(x, y)));
  ASSERT_TRUE(same_pixel(p.depth, frame.depth(x, y)));
  ASSERT_TRUE(same_pixel(static_cast<float>(p.view_depth), frame.view_depth(x, y)));
  ASSERT_TRUE(same_pixel(static_cast<float>(p.distance), frame.distance(x, y)));
}

}  // namespace rastrum::test
