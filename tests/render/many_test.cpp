// SPDX-License-Identifier: BSD-3-Clause
// Renderer::render_many draws each picture as render does, side by side or one after the other.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/stop.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::many_test {
namespace {

constexpr unsigned kKinds = kPicture | kInstances;

/// Scenes that differ in size, so that scratch grows; some are translucent. Each has its camera.
class Many {
 public:
  explicit Many(int count) {
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<float>(i);
      scenes_.push_back(single(i % 3 == 0   ? shapes::sphere(4 + i, 8)
                               : i % 3 == 1 ? shapes::soup(200 * (i + 1), 0.05F, 0.4F)
                                            : shapes::teapot(3)));
      scenes_.back().instances.front().opacity = i % 4 == 3 ? 0.5F : 1;
      cameras_.push_back({.eye = {3 - 0.2F * k, 1.0F + 0.1F * k, 2}});
    }
    for (const Scene& scene : scenes_) bound_.emplace_back(scene);
  }
  [[nodiscard]] std::size_t size() const { return scenes_.size(); }
  [[nodiscard]] SceneView view(std::size_t i) const { return bound_[i].view(); }
  [[nodiscard]] const Camera& camera(std::size_t i) const { return cameras_[i]; }
  [[nodiscard]] std::vector<Frame> drawn(Renderer& by, const FrameOptions& o,
                                         StopToken stop = {}) const {
    std::vector<Frame> frames;
    std::vector<ScenePicture> pictures;
    for (std::size_t i = 0; i < size(); ++i) frames.emplace_back(o.width, o.height, kKinds);
    for (std::size_t i = 0; i < size(); ++i)
      pictures.push_back({view(i), camera(i), frames[i].targets()});
    const std::vector<FrameStats> stats = by.render_many(pictures, o, stop);
    for (std::size_t i = 0; i < size(); ++i) frames[i].stats = stats.at(i);
    return frames;
  }
  void expect_each(Renderer& by, const FrameOptions& o) const {
    const std::vector<Frame> all = drawn(by, o);
    for (std::size_t i = 0; i < size(); ++i) {
      SCOPED_TRACE(i);
      Renderer alone({.threads = 1});
      const Frame want = test::draw(alone, view(i), camera(i), o, kKinds);
      EXPECT_TRUE(same_images(all[i], want, kKinds));
      EXPECT_EQ(all[i].stats.triangles.drawn, want.stats.triangles.drawn);
    }
  }

  std::vector<Scene>& scenes() { return scenes_; }

 private:
  std::vector<Scene> scenes_;
  std::vector<Camera> cameras_;
  std::vector<SceneBinding> bound_;
};

FrameOptions small(int samples = 1) {
  return {.width = 70, .height = 50, .shader = Shader::phong, .samples = samples};
}

TEST(ManyPictures, AreThoseOfEach) {
  const Many many(13);
  for (const int threads : {1, 2, 5})
    for (const int samples : {1, 4}) {
      SCOPED_TRACE(std::to_string(threads) + " threads, " + std::to_string(samples) + " samples");
      Renderer renderer({.threads = threads});
      many.expect_each(renderer, small(samples));
      many.expect_each(renderer, small(samples));  // by the scratch of before
    }
  Renderer serial({.device = Device::serial});
  many.expect_each(serial, small());
}

TEST(ManyPictures, ThatAreLargeOrLackMemoryComeOneAfterTheOther) {
  const Many many(3);
  Renderer renderer({.threads = 3});
  FrameOptions large = small();
  large.width = 600, large.height = 500;
  many.expect_each(renderer, large);
  Renderer little({.memory_limit = std::uint64_t{20} << 20, .threads = 3});
  many.expect_each(little, small());
  Renderer enough({.memory_limit = std::uint64_t{200} << 20, .threads = 3});
  many.expect_each(enough, small());
}

TEST(ManyPictures, AreSideBySideIfSeveralThreadsHaveSeveralSmallOnes) {
  const auto side_by_side = [](const RendererOptions& options, std::size_t count,
                               std::int64_t pixels) {
    Renderer renderer(options);
    std::atomic<std::size_t> drawn{0}, sum{0};
    const bool did =
        RendererAccess::draw_side_by_side(renderer, count, pixels,
                                          [&](Renderer& by, std::size_t worker, std::size_t i) {
                                            EXPECT_EQ(by.options().threads, 1);
                                            EXPECT_LT(worker, 3U);
                                            ++drawn;
                                            sum += i;
                                          },
                                          {});
    EXPECT_EQ(drawn, did ? count : 0);
    EXPECT_EQ(sum, did ? count * (count - 1) / 2 : 0);
    return did;
  };
  constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
  EXPECT_TRUE(side_by_side({.threads = 3}, 50, 512 * 512));
  EXPECT_TRUE(side_by_side({.threads = 3}, 2, 100));
  EXPECT_TRUE(side_by_side({.memory_limit = 192 * kMiB, .threads = 3}, 7, 100));
  EXPECT_FALSE(side_by_side({.memory_limit = 191 * kMiB, .threads = 3}, 7, 100));
  EXPECT_FALSE(side_by_side({.threads = 3}, 50, 512 * 512 + 1));
  EXPECT_FALSE(side_by_side({.threads = 3}, 1, 100));
  EXPECT_FALSE(side_by_side({.threads = 1}, 50, 100));
  EXPECT_FALSE(side_by_side({.device = Device::serial}, 50, 100));
}

void wait_a_ms() {
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(ManyPictures, AreNotBegunAfterAFailure) {
  Renderer renderer({.threads = 3});
  std::atomic<int> drawn{0};
  EXPECT_THROW((void)RendererAccess::draw_side_by_side(
                   renderer, 10000, 100,
                   [&](Renderer&, std::size_t, std::size_t i) {
                     // The others have begun by then, so that only the failure ends them.
                     for (int ms = 0; i == 0 && drawn == 0 && ms < 5000; ++ms) wait_a_ms();
                     if (i == 0) throw Error(Errc::invalid_argument, "the first one");
                     ++drawn;
                     wait_a_ms();
                   },
                   {}),
               Error);
  EXPECT_LT(drawn, 1000);
}

TEST(ManyPictures, OneThatFailsLeavesTheRendererUsable) {
  Many many(9);
  Renderer renderer({.threads = 3});
  std::uint32_t& index = many.scenes()[6].meshes[0].indices[4];
  const std::uint32_t before = index;
  index = 1000000;
  try {
    (void)many.drawn(renderer, small());
    ADD_FAILURE() << "drawn";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(e.what()).find("1000000"), std::string::npos) << e.what();
  }
  index = before;
  many.expect_each(renderer, small());
}

TEST(ManyPictures, Stop) {
  const Many many(9);
  Renderer renderer({.threads = 3});
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)many.drawn(renderer, small(), stop.get_token()), Stopped);
  many.expect_each(renderer, small());
}

TEST(ManyPictures, MayBeNone) {
  Renderer renderer({.threads = 3});
  EXPECT_TRUE(renderer.render_many({}, small()).empty());
}

}  // namespace
}  // namespace rastrum::test::many_test
