// SPDX-License-Identifier: BSD-3-Clause
// A stop on one rank, at any time, ends the work of all ranks alike; also tests the reports of
// progress.
#include <atomic>
#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/annotate.hpp>
#include <rastrum/stop.hpp>

#include "tests/ranks/deals.hpp"

namespace rastrum::test::ranks_stop_test {
namespace {

constexpr int kRanks = 3;

/// Requests a stop from the n-th query on.
class After {
 public:
  explicit After(int questions) : left_(questions) {}
  [[nodiscard]] bool stop_requested() const { return left_-- <= 0; }
  [[nodiscard]] bool was_asked() const { return left_ < 0; }

 private:
  mutable std::atomic<int> left_;
};

/// Calls f(communicator) on each rank. Returns what each threw: "" for nothing, or "stopped".
template <class F>
std::vector<std::string> said_by(LocalRanks& ranks, const F& f) {
  std::vector<std::string> said(kRanks);
  ranks.run([&](Communicator& c) {
    std::string& own = said[static_cast<std::size_t>(c.rank())];
    try {
      f(c);
    } catch (const Stopped&) {
      own = "stopped";
    } catch (const std::exception& e) {
      own = e.what();
    }
  });
  return said;
}

struct Way {
  const char* name;
  FrameOptions frame;
  RanksOptions options{};
  Annotations notes{};
};

std::vector<Way> ways() {
  FrameOptions frame = frame_of(Shader::phong, 40, 70);
  FrameOptions sampled = frame, shadows = frame;
  sampled.samples = 4;
  shadows.lights = {{.kind = DirectionalLight{{-0.5F, -1, -0.4F}}}};
  shadows.shadows = true;
  return {{"shared", frame},
          {"sparse", frame, {.exchange = WordExchange::sparse}},
          {"bands", frame, {.exchange = WordExchange::sparse, .fragment_bytes = 1}},
          {"rows", frame, {.rows = 64, .take_rows = [](int, int) {}}},
          {"samples", sampled},
          {"shadows", shadows},
          {"annotated", frame, {}, {.occlusion = AmbientOcclusion{}, .bounds = true}}};
}

class RanksStop : public testing::Test {
 protected:
  /// Draws one rank's part of a picture.
  void draw(Communicator& c, const Way& way, const RanksOptions& options, StopToken stop) const {
    const auto& parts = deal_[static_cast<std::size_t>(c.rank())];
    const SomeParts held(whole_.view(), parts);
    Renderer renderer(kThreadRank);
    Image<Rgba8> image(40, options.rows == 0 ? 70 : options.rows);
    const Targets targets = c.rank() == 0 ? Targets{.color8 = image} : Targets{};
    if (way.notes.any()) {
      Annotator annotator(1);
      (void)render_parts(c, renderer, annotator, held.view(), parts, whole_.camera, way.frame,
                         way.notes, targets, options, stop);
    } else {
      (void)render_parts(c, renderer, held.view(), parts, whole_.camera, way.frame, targets,
                         options, stop);
    }
  }

  Whole whole_{glass(), frame_of(Shader::phong, 40, 70)};
  Deal deal_ = round_robin(kRanks);

 private:
  static Scene glass() {
    Scene scene = PartsScene(4, kParts, false).scene;
    for (std::size_t i = 0; i < scene.instances.size(); i += 2) scene.instances[i].opacity = 0.4F;
    return scene;
  }
};

TEST_F(RanksStop, OfOneRankIsThatOfAllWhereverItComes) {
  for (const Way& way : ways()) {
    LocalRanks ranks(kRanks);
    for (const int who : {0, 1}) {
      int stopped = 0;
      // In growing steps, until the picture is finished first.
      for (int after = 0, step = 1;; after += step, step += 1 + step / 8) {
        const After stop(after);
        const auto said = said_by(ranks, [&](Communicator& c) {
          draw(c, way, way.options, c.rank() == who ? StopToken(stop) : StopToken());
        });
        for (const std::string& one : said) ASSERT_EQ(one, said[0]) << way.name << ", " << after;
        if (!stop.was_asked()) {
          EXPECT_EQ(said[0], "") << way.name;
          break;
        }
        stopped += said[0] == "stopped" ? 1 : 0;
        ASSERT_TRUE(said[0].empty() || said[0] == "stopped") << said[0];
      }
      EXPECT_GT(stopped, 5) << way.name;
    }
  }
}

TEST_F(RanksStop, IsATokensToo) {
  LocalRanks ranks(kRanks);
  std::stop_source source;
  const std::stop_token token = source.get_token();
  const auto said = said_by(ranks, [&](Communicator& c) {
    RanksOptions options;
    if (c.rank() == 2)
      options.progress = [&](std::string_view what, std::uint64_t, std::uint64_t) {
        if (what == "draw") source.request_stop();
      };
    draw(c, ways()[0], options, token);
  });
  EXPECT_EQ(said, std::vector<std::string>(kRanks, "stopped"));
}

TEST_F(RanksStop, EndsAFitOnAllRanks) {
  LocalRanks ranks(kRanks);
  int stopped = 0;
  for (int after = 0;; ++after) {
    const After stop(after);
    const auto said = said_by(ranks, [&](Communicator& c) {
      const StopToken token = c.rank() == 1 ? StopToken(stop) : StopToken();
      const StopScope scope(token);
      const SomeParts held(whole_.view(), deal_[static_cast<std::size_t>(c.rank())]);
      FitOfRanks fit(c);
      (void)fit_picture(held.view(), {}, 30, 20, {.ranks = &fit});
      (void)bounding_sphere(held.view(), &fit);
    });
    for (const std::string& one : said) ASSERT_EQ(one, said[0]) << after;
    if (!stop.was_asked()) break;
    stopped += said[0] == "stopped" ? 1 : 0;
  }
  EXPECT_GT(stopped, 5);
}

TEST_F(RanksStop, ProgressRisesToItsEnd) {
  for (const Way& way : ways()) {
    LocalRanks ranks(kRanks);
    std::vector<std::vector<std::pair<std::uint64_t, std::uint64_t>>> told(kRanks);
    const auto said = said_by(ranks, [&](Communicator& c) {
      RanksOptions options = way.options;
      auto& own = told[static_cast<std::size_t>(c.rank())];
      options.progress = [&own](std::string_view, std::uint64_t done, std::uint64_t all) {
        own.emplace_back(done, all);
      };
      draw(c, way, options, {});
    });
    EXPECT_EQ(said, std::vector<std::string>(kRanks)) << way.name;
    for (const auto& own : told) {
      ASSERT_GT(own.size(), 5U) << way.name;
      EXPECT_EQ(own.front().first, 0U) << way.name;
      EXPECT_EQ(own.back().first, own.back().second) << way.name;
      for (std::size_t i = 1; i < own.size(); ++i) {
        EXPECT_GE(own[i].first, own[i - 1].first) << way.name;
        EXPECT_EQ(own[i].second, own[0].second) << way.name;
      }
    }
  }
}

TEST_F(RanksStop, WhatProgressThrowsAllSay) {
  LocalRanks ranks(kRanks);
  for (const bool at_end : {false, true}) {
    const auto said = said_by(ranks, [&](Communicator& c) {
      RanksOptions options;
      if (c.rank() == 1)
        options.progress = [&](std::string_view, std::uint64_t done, std::uint64_t all) {
          if (!at_end || done == all) throw Error(Errc::io, "the window is closed");
        };
      draw(c, ways()[0], options, {});
    });
    EXPECT_EQ(said, std::vector<std::string>(kRanks, "rank 1: the window is closed"));
  }
}

}  // namespace
}  // namespace rastrum::test::ranks_stop_test
