// SPDX-License-Identifier: BSD-3-Clause
// A stopped frame (parallel/stop.hpp) ends after a bounded amount of work, counted in calls of the
// caller's functions, and leaves no trace: the next frame equals a new renderer's, counters
// included. For every point of the coverage × visibility table, and with layers.
#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/raster/frame/bins.hpp>
#include <rastrum/raster/frame/frame_run.hpp>
#include <rastrum/render.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/terrain.hpp>

#include "tests/support/clip_mesh.hpp"
#include "tests/support/family.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/stop_trigger.hpp"

namespace rastrum::test::stop_test {
namespace {

constexpr int kSize = 256;
/// The blocks of a thread that go to a region together.
constexpr std::int64_t kCapacity = raster::kBlockCapacity;

/// A soup whose vertices, fragments and pixels are counted.
class Counted final : public ClipMesh, public raster::FragmentTest, public raster::BlockShader {
 public:
  Counted() : ClipMesh(shapes::soup(4000, 0.02F, 0.5F)) {}

  struct Triggers {
    StopTrigger project, test, shade;
  };
  void use(Triggers& t) { triggers_ = &t; }
  [[nodiscard]] raster::Draw draw(bool translucent) const {
    return ClipMesh::draw(kTested | (translucent ? kTranslucent : 0U));
  }

  void project(std::size_t begin, std::size_t end, raster::Viewport viewport, Isa isa,
               raster::ProjectedVertex* out) const noexcept override {
    triggers_->project.call();
    ClipMesh::project(begin, end, viewport, isa, out);
  }
  std::uint64_t test(const raster::FrameGeometry&, const raster::Piece&, const raster::Block& block,
                     const raster::ShadingPoints*) const noexcept override {
    triggers_->test.call();
    return block.mask;
  }
  bool shade(const raster::FrameGeometry&, const raster::VisibleBlock& block, Isa,
             raster::BlockColors& colors) const noexcept override {
    triggers_->shade.call();
    for (int i = 0; i < 64; ++i)
      colors.set(i, {static_cast<float>(block.keys[i] & 255) / 512, 0.25F, 0, 0.5F});
    return false;
  }

 private:
  Triggers* triggers_ = nullptr;
};

Frame frame(Painter& renderer, Counted& counted, Counted::Triggers& triggers, bool translucent) {
  counted.use(triggers);
  raster::Draw d = counted.draw(translucent);
  return draw(renderer, {&d, 1}, counted, &counted);
}

/// Stops frames of one renderer at calls of each function and draws whole frames between them. At
/// most `most_shaded` blocks may follow a stop.
void expect_bounded(const RenderOptions& o, bool translucent, std::int64_t most_shaded) {
  const std::int64_t most_tested = kCapacity * o.threads;
  Counted counted;
  Counted::Triggers whole;
  Painter fresh(o), renderer(o);
  const Frame expected = frame(fresh, counted, whole, translucent);
  for (StopTrigger Counted::Triggers::*const which :
       {&Counted::Triggers::project, &Counted::Triggers::test, &Counted::Triggers::shade}) {
    const std::int64_t calls = (whole.*which).calls();
    ASSERT_GT(calls, 0);
    for (const std::int64_t at : {std::int64_t{0}, calls / 3}) {
      Counted::Triggers triggers;
      (triggers.*which).stop_at(at);
      const std::stop_token token = (triggers.*which).token();
      const StopScope scope(token);
      EXPECT_THROW(static_cast<void>(frame(renderer, counted, triggers, translucent)), Stopped);
      EXPECT_LE((triggers.*which).after(),
                which == &Counted::Triggers::shade ? most_shaded : most_tested)
          << "of " << calls << ", stopped at " << at;
    }
    Counted::Triggers again;
    const Frame actual = frame(renderer, counted, again, translucent);
    EXPECT_TRUE(same_frames(actual, expected));
    EXPECT_EQ(actual.stats.counters, expected.stats.counters);
  }
}

RenderOptions options(int threads) {
  return RenderOptions({.width = kSize, .height = kSize}, {.threads = threads});
}

class Stop : public testing::TestWithParam<TablePoint> {};

TEST_P(Stop, EndsSoonAndLeavesNothing) {
  RenderOptions o = options(4);
  static_cast<family::Row&>(o) = GetParam();
  // A thread shades a bin. `tuple` shades blocks as they come.
  expect_bounded(o, false, o.visibility == "tuple" ? 4 * kCapacity : 4 * raster::kBlocksPerBin);
}

INSTANTIATE_TEST_SUITE_P(Points, Stop, testing::ValuesIn(table_points()),
                         [](const auto& p) { return test_name(p.param); });

TEST(StopLayers, EndSoonAndLeaveNothing) {
  for (const int threads : {1, 4})
    for (const TransparencyOptions& method : {TransparencyOptions{}, family::filtered(3)}) {
      SCOPED_TRACE(std::to_string(threads) + " threads, method " +
                   (method.added == nullptr ? "exact" : "filter"));
      RenderOptions o = options(threads);
      o.transparency = method;
      // A thread shades the packed fragments of a bin, fewer than 2¹⁶, then the opaque surfaces
      // behind them.
      expect_bounded(o, true, ((1 << 16) / 64 + raster::kBlocksPerBin) * threads);
    }
}

TEST(StopReference, EndsSoon) {
  for (const float opacity : {1.0F, 0.5F}) {
    RenderOptions o({.width = 64, .height = 64, .opacity = opacity}, {.device = Device::serial});
    Painter renderer(o);
    const Fitted boxes(shapes::from_spec("boxes"));
    std::stop_source source;
    const std::stop_token token = source.get_token();
    const StopScope scope(token);
    EXPECT_NO_THROW(static_cast<void>(draw(renderer, boxes.view, boxes.camera)));
    source.request_stop();
    EXPECT_THROW(static_cast<void>(draw(renderer, boxes.view, boxes.camera)), Stopped);
  }
}

// A frame's token stops it from outside, in the middle.
TEST(StopToken, EndsAFrameAndLeavesTheRenderer) {
  for (const bool translucent : {false, true})
    for (const Device device : {Device::serial, Device::threads}) {
      SCOPED_TRACE(std::string(name(device)) + (translucent ? ", translucent" : ""));
      RenderOptions o = options(4);
      o.device = device;
      if (device == Device::serial) o.width = o.height = 64;  // the reference of layers is slow
      Counted counted;
      Counted::Triggers whole;
      Painter renderer(o);
      const Frame expected = frame(renderer, counted, whole, translucent);
      const std::int64_t calls = whole.test.calls();
      Counted::Triggers triggers;
      triggers.test.stop_at(calls / 3);
      counted.use(triggers);
      raster::Draw d = counted.draw(translucent);
      Image<Rgba8> color(o.width, o.height);
      Targets targets{.color8 = color.view()};
      EXPECT_THROW(renderer.draw({&d, 1}, counted, &counted, targets, {}, triggers.test.token()),
                   Stopped);
      // One fragment at a time; a triangle covers at most all pixels.
      EXPECT_LE(triggers.test.after(),
                device == Device::serial ? o.width * o.height : kCapacity * o.threads);
      Counted::Triggers again;
      const Frame actual = frame(renderer, counted, again, translucent);
      EXPECT_TRUE(same_images(actual, expected));
    }
}

TEST(StopToken, IsTakenByAllThatDrawFrames) {
  std::stop_source source;
  const std::stop_token token = source.get_token();
  constexpr int kSide = 48;
  const Fitted boxes(shapes::from_spec("boxes"));
  Image<Rgba8> color(kSide, kSide);
  Image<float> depth(kSide, kSide);
  RenderOptions o({.width = kSide, .height = kSide});
  Painter renderer(o);
  const Targets targets{.color8 = color};
  const terrain::Terrain ground = terrain::Terrain::of([](double, double) { return 1.0F; },
                                                       [](double, double) {
                                                         return Rgba8{1, 2, 3, 255};
                                                       });
  TerrainLook how({.width = kSide, .height = kSide});
  TerrainPainter terrain(how);
  SceneOnTerrain on_terrain(family::make_renderer(o, o));
  const terrain::TerrainTargets picture{.color8 = color, .depth = depth};
  const auto draw_all = [&](const auto& expect) {
    expect([&] { renderer.render(boxes.view, boxes.camera, targets, {}, token); });
    expect([&] { terrain.render(ground, {}, picture, token); });
    expect([&] { on_terrain.draw({.scene = boxes.view}, o, how, {}, picture, token); });
  };
  draw_all([](const auto& frame) { EXPECT_NO_THROW(frame()); });
  source.request_stop();
  draw_all([](const auto& frame) { EXPECT_THROW(frame(), Stopped); });
  // A frame without a token obeys the scope around it.
  const StopScope scope(token);
  EXPECT_THROW(renderer.render(boxes.view, boxes.camera, targets), Stopped);
}

TEST(StopToken, IsOfAnyTypeThatAsks) {
  struct Asks {
    bool asks;
    [[nodiscard]] bool stop_requested() const { return asks; }
  };
  const Fitted boxes(shapes::from_spec("boxes"));
  Image<Rgba8> color(32, 32);
  Renderer renderer({.threads = 2});
  const auto draw = [&](StopToken stop) {
    renderer.render(boxes.view, boxes.camera, {.width = 32, .height = 32}, {.color8 = color}, {},
                    stop);
  };
  std::stop_source source;
  EXPECT_NO_THROW(draw({}));
  EXPECT_NO_THROW(draw(Asks{false}));
  EXPECT_NO_THROW(draw(source));
  EXPECT_NO_THROW(draw(std::stop_token()));
  source.request_stop();
  EXPECT_THROW(draw(Asks{true}), Stopped);
  EXPECT_THROW(draw(source), Stopped);
  EXPECT_THROW(draw(source.get_token()), Stopped);
  EXPECT_FALSE(StopToken(std::stop_token()).stop_possible());
  EXPECT_TRUE(StopToken(source).stop_possible());
}

/// Draws nothing; a stop is requested meanwhile.
class AskedMeanwhile final : public raster::FrameDrawer {
 public:
  explicit AskedMeanwhile(std::stop_source& source) : source_(source) {}
  FrameStats draw(raster::FrameRequest& /*request*/) override {
    source_.request_stop();
    asked = stop_requested();
    return {};
  }
  FrameStats shade(raster::FrameRequest& /*request*/, const raster::KnownBlocks&) override {
    return {};
  }
  static inline bool asked = false;  ///< whether the frame noticed the request

 private:
  std::stop_source& source_;
};

TEST(StopToken, IsInForceInTheMiddleOfWhatStandsOnATerrain) {
  constexpr int kSide = 48;
  const Fitted boxes(shapes::from_spec("boxes"));
  for (const Device device : {Device::serial, Device::threads}) {
    SCOPED_TRACE(name(device));
    std::stop_source source;
    const std::stop_token token = source.get_token();
    SceneOnTerrain on_terrain(
        RendererAccess::make({.device = device}, {device, ""}, false,
                             [&](const DrawerOptions&, MemoryAccount&, parallel::Threads*) {
                               return std::make_unique<AskedMeanwhile>(source);
                             }));
    Image<Rgba8> color(kSide, kSide);
    Image<float> depth(kSide, kSide);
    FrameOptions frame{.width = kSide, .height = kSide};
    terrain::TerrainOptions how{.width = kSide, .height = kSide};
    AskedMeanwhile::asked = false;
    EXPECT_THROW(on_terrain.draw({.scene = boxes.view}, frame, how, {},
                                 {.color8 = color, .depth = depth}, token),
                 Stopped);
    EXPECT_TRUE(AskedMeanwhile::asked);
  }
}

}  // namespace
}  // namespace rastrum::test::stop_test
