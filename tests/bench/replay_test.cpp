// SPDX-License-Identifier: BSD-3-Clause
// Compares replays of hand-made loops with makespans computed by hand; and records a real frame.
#include <papers/models/replay/simulate.hpp>

#include <algorithm>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/prepared_mesh.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::bench::replay_test {
namespace {

ReplayedLoop loop_of(std::vector<double> at, bool in_order = false) {
  return {.in_order = in_order, .n = at.size(), .at = at};
}

TEST(Replay, OneWorkerTakesTheSum) {
  EXPECT_EQ(replay(loop_of({8, 4, 2, 1}), 1, {}), 15);
  EXPECT_EQ(replay(loop_of({8, 4, 2, 1}, true), 1, {}), 15);
  // Three splits and four tasks; five claims.
  EXPECT_EQ(replay(loop_of({8, 4, 2, 1}), 1, {.loop = 10, .task = 1}), 10 + 15 + 7);
  EXPECT_EQ(replay(loop_of({8, 4, 2, 1}, true), 1, {.claim = 2}), 15 + 5 * 2);
}

TEST(Replay, HalvesAreTakenByWhoIsFree) {
  // The second takes [2, 4), and at 3 index 1: it ends at 7, before the first at 8.
  EXPECT_EQ(replay(loop_of({8, 4, 2, 1}), 2, {}), 8);
  // The first has 0 until 5, then 1; the second has 2 and 3 until 6.
  EXPECT_EQ(replay(loop_of({5, 4, 3, 3}), 2, {}), 9);
  // The first has 0 from 1 to 9. The second finds 1 queued, begins 2 at 2 and 3 at 4, takes 1 at 5,
  // begins it at 6 and ends it at 10, which the first notices at 15.
  EXPECT_EQ(replay(loop_of({8, 4, 2, 1}), 2, {.loop = 1, .take = 1, .join = 5}), 15);
}

TEST(Replay, InOrderTheNextGoesToWhoIsFree) {
  // 5 and 3 beside 4 and 3; by halves it was 9.
  EXPECT_EQ(replay(loop_of({5, 4, 3, 3}, true), 2, {}), 8);
  // One worker at a time uses the counter: the first until 1, the second until 2, …
  EXPECT_EQ(replay(loop_of({10, 10}, true), 2, {.claim = 1}), 13);
}

TEST(Replay, WhoSleepsComesLate) {
  // The first does both: [0, 1) until 4, then the other one, which the second would only see at 20.
  EXPECT_EQ(replay(loop_of({4, 4}), 2, {.wake = 20}, true), 8);
  // The second takes index 1 at 2.
  EXPECT_EQ(replay(loop_of({4, 4}), 2, {.wake = 2}, true), 6);
}

TEST(Replay, ManyWorkersEndWithTheLargestTask) {
  std::vector<double> at(1000, 1);
  at[0] = 50;
  EXPECT_EQ(replay(loop_of(at, true), 64, {}), 50);
  EXPECT_GE(replay(loop_of(at), 64, {}), 50);
  EXPECT_LE(replay(loop_of(at), 64, {}), 80);
}

TEST(Replay, AFrameIsItsLoopsAndWhatIsBetween) {
  ReplayedFrame frame{{loop_of({8, 4, 2, 1}), loop_of({5, 4, 3, 3}, true)}, 7};
  frame.loops[0].before = 10;
  frame.loops[1].before = 20;
  EXPECT_EQ(replay(frame, 1, {}).ns, 10 + 15 + 20 + 15 + 7);
  const Replay two = replay(frame, 2, {});
  EXPECT_EQ(two.loops, (std::vector<double>{8, 8}));
  EXPECT_EQ(two.ns, 10 + 8 + 20 + 8 + 7);
  // Workers sleep before the first loop, and after 20 without one.
  EXPECT_EQ(replay(frame, 2, {.wake = 100}).ns, 10 + 15 + 20 + 8 + 7);
  EXPECT_EQ(replay(frame, 2, {.wake = 100, .linger = 15}).ns, 10 + 15 + 20 + 15 + 7);
}

TEST(Replay, TasksThatRangesAreNotSplitIntoAreRefused) {
  EXPECT_THROW((void)replay(loop_of({8, -1, 2, 1}), 2, {}), Error);
}

TEST(MedianFrame, OfEachTaskAndGapWhereLoopsAreAlike) {
  const auto frame = [](std::int64_t gap, std::int64_t task, std::size_t n) {
    RecordedFrame f;
    f.begin_ns = 1000;
    parallel::Recording::Loop loop{1000 + gap, 0, n, 1, false, {}};
    std::int64_t at = loop.begin_ns;
    for (std::size_t i = 0; i < n; ++i) {
      loop.tasks.push_back({i, i + 1, at, at + task});
      at += task;
    }
    loop.end_ns = at;
    f.recording.loops.push_back(loop);
    f.end_ns = at + 2 * gap;
    return f;
  };
  const ReplayedFrame f = median_frame(
      std::vector{frame(10, 100, 3), frame(999, 999, 4), frame(30, 300, 3), frame(20, 200, 3)});
  ASSERT_EQ(f.loops.size(), 1U);
  EXPECT_EQ(f.loops[0].at, (std::vector<double>{200, 200, 200}));
  EXPECT_EQ(f.loops[0].before, 20);
  EXPECT_EQ(f.after, 40);
  EXPECT_EQ(f.loops[0].work(), 600);
}

/// Opaque, translucent, prepared and sampled frames of triangles that are mostly in one bin.
class RecordedFrames : public testing::TestWithParam<const char*> {};

TEST_P(RecordedFrames, CoverTheFrameAndDrawTheSame) {
  const std::string how = GetParam();
  const Mesh mesh = shapes::from_spec("soup?count=60000&min_size=0.01&max_size=0.02");
  const MeshView plain = mesh.view();
  const PreparedMesh prepared(plain, 1);
  InstanceView instance{.geometry = how == "prepared" ? prepared.view() : plain};
  const SceneView scene{.instances = {&instance, 1}};
  FrameOptions frame{.width = 330,
                     .height = 200,
                     .shader = Shader::phong,
                     .opacity = how == "translucent" ? 0.3F : 1,
                     .samples = how == "sampled" ? 4 : 1};
  Camera camera = fit_camera(scene, 1.0472F, false);
  Renderer renderer({.threads = 1});
  Image<Rgba8> one(330, 200), many(330, 200);
  std::size_t fewest = 0;
  for (const int workers : {1, 64}) {
    RecordedFrame f;
    f.recording.workers = workers;
    FrameStats stats;
    {
      const parallel::RecordScope scope(f.recording);
      f.begin_ns = parallel::Recording::now_ns();
      stats = renderer.render(scene, camera, frame, {.color8 = workers == 1 ? one : many});
      f.end_ns = parallel::Recording::now_ns();
    }
    std::int64_t at = f.begin_ns, tasks = 0, between = 0, loops = 0;
    std::size_t largest = 0;
    for (const auto& loop : f.recording.loops) {
      EXPECT_LE(at, loop.begin_ns);
      between += loop.begin_ns - at;
      at = loop.end_ns;
      loops += loop.end_ns - loop.begin_ns;
      std::vector<int> found(loop.n, 0);
      for (const auto& task : loop.tasks) {
        for (std::size_t i = task.begin; i < task.end; ++i) ++found[i];
        tasks += task.end_ns - task.begin_ns;
      }
      EXPECT_EQ(found, std::vector<int>(loop.n, 1));
      largest = std::max(largest, loop.tasks.size());
    }
    ASSERT_LE(at, f.end_ns);
    between += f.end_ns - at;
    EXPECT_EQ(between + loops, f.end_ns - f.begin_ns);
    EXPECT_LE(tasks, loops);
    const ReplayedFrame replayed = median_frame({&f, 1});
    EXPECT_NEAR(replay(replayed, 1, {}).ns, static_cast<double>(tasks + between), 1000);
    // 24 bins, or 15 groups; 64 workers make more tasks.
    if (workers == 1) fewest = largest;
    if (workers != 1 && how != "sampled") {
      EXPECT_GT(largest, fewest);
    }
  }
  EXPECT_EQ(std::memcmp(one.pixels().data(), many.pixels().data(), one.pixels().size_bytes()), 0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, RecordedFrames,
                         testing::Values("opaque", "translucent", "prepared", "sampled"),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace rastrum::bench::replay_test
