// SPDX-License-Identifier: BSD-3-Clause
// The plan of a frame: which stage makes colours, and which pixels are written.
#include <rastrum/raster/context/frame_plan.hpp>

#include <gtest/gtest.h>

namespace rastrum::test::frame_plan_test {
namespace {

using raster::FramePlan;
using Colors = FramePlan::Colors;

class Plan : public testing::Test {
 protected:
  template <class T>
  [[nodiscard]] static ImageView<T> image() {
    static T pixels[64];
    return {pixels, 8, 8};
  }
  [[nodiscard]] FramePlan plan(bool method_shades = false, bool limits_memory = false) const {
    return FramePlan::of(request_, method_shades, limits_memory);
  }

  Plan() {
    request_.width = request_.height = 8;
    request_.targets.color8 = image<Rgba8>();
  }
  raster::FrameRequest request_;
  Targets& targets_ = request_.targets;
};

TEST_F(Plan, LetsABinMakeColoursWhereItMay) {
  EXPECT_EQ(plan().colors, Colors::bin);
  EXPECT_EQ(plan(false, true).colors, Colors::block) << "the limit does not count a bin's memory";
  EXPECT_EQ(plan(true).colors, Colors::method);
  targets_.normals = image<Vec3>();
  EXPECT_EQ(plan().colors, Colors::block) << "normals are filled by block";
  targets_ = {.depth = image<float>()};
  EXPECT_EQ(plan().colors, Colors::none);
  EXPECT_TRUE(plan().keys && plan().stores && !plan().surface);
}

TEST_F(Plan, LetsShadersStoreWhatNeedsNoMoreThanTheirColours) {
  EXPECT_TRUE(plan().at_once);
  EXPECT_TRUE(plan(false, true).at_once);
  EXPECT_FALSE(plan(true).at_once);
  request_.linear_light = true;
  EXPECT_FALSE(plan().at_once);
  request_.linear_light = false;
  targets_.color = image<Vec4>();
  EXPECT_FALSE(plan().at_once);
}

TEST_F(Plan, WritesWhatThePassesBeforeLeaveToIt) {
  EXPECT_EQ(plan().writes, FramePlan::Writes::all);
  request_.pass.over = true;
  EXPECT_EQ(plan().writes, FramePlan::Writes::surfaces);
  EXPECT_TRUE(plan().tests && !plan().at_once && plan().colors == Colors::bin);
  request_.pass.over = false;
  request_.pass.load = true;
  EXPECT_EQ(plan().writes, FramePlan::Writes::nearer);
  EXPECT_TRUE(plan().at_once && plan().colors == Colors::block);
}

TEST_F(Plan, StreamsPicturesThatNoCacheHolds) {
  EXPECT_FALSE(plan().streams);
  targets_.color8.width = targets_.color8.height = 2509;  // 24 MiB; nothing is drawn
  EXPECT_TRUE(plan().streams);
  request_.pass.load = true;
  EXPECT_FALSE(plan().streams);
}

TEST_F(Plan, KeepsFragmentsForTheSink) {
  EXPECT_EQ(plan().translucent, raster::Translucent::blended);
  raster::FragmentSink sink(raster::Translucent::keys_to_sink);
  request_.sink = &sink;
  EXPECT_EQ(plan().translucent, raster::Translucent::keys_to_sink);
}

}  // namespace
}  // namespace rastrum::test::frame_plan_test
