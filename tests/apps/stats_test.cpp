// SPDX-License-Identifier: BSD-3-Clause
// --stats and --trace: the schema, and sums that must hold.
#include "frame/stats_json.hpp"

#include <set>

#include <rastrum/version.hpp>

#include "program.hpp"

namespace rastrum::test::stats_test {
namespace {

using Json = nlohmann::ordered_json;
using Stats = Program;

Args keys(const Json& object) {
  Args names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

double sum_of(const Json& object) {
  double sum = 0;
  for (const auto& [key, value] : object.items()) sum += value.get<double>();
  return sum;
}

TEST_F(Stats, SchemaAndSums) {
  // One triangle with a NaN, one cut by the near plane, one without area, one behind the eye.
  write("t.obj",
        "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv nan 0 0\nv 0 0 9\nv 0 3 20\nv 1 3 20\n"
        "f 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 1 2\nf 5 6 7\n");
  must(
      "render --look plain t.obj --eye 0,0,4 --target 0,0,0 --size 60x40 --frames 5 --stats s.json "
      "--ids i.npy");
  const Json s = json("s.json");
  EXPECT_EQ(keys(s), (Args("version device device_why threads isa rasterizer visibility why shader "
                           "size triangles fragments pixels_covered counters peak_bytes load_ms "
                           "stages_ms frame_ms inputs cameras")));
  EXPECT_EQ(s["version"], version());
  EXPECT_EQ(s["size"], Json::array({60, 40}));
  EXPECT_EQ(s["triangles"].dump(), R"({"input":5,"dropped":1,"culled":2,"clipped":1,"drawn":2})");
  std::uint64_t covered = 0;
  for (const std::int64_t id : npy("i.npy").values<std::int64_t>()) covered += id >= 0;
  EXPECT_EQ(s["pixels_covered"], covered);
  EXPECT_GE(s["fragments"], covered);
  EXPECT_GT(s["peak_bytes"], 0);
  EXPECT_GT(s["load_ms"], 0);
  const Json& f = s["frame_ms"];
  EXPECT_EQ(keys(f), (Args("median min max frames")));
  EXPECT_EQ(f["frames"], 5);
  EXPECT_LE(f["min"], f["median"]);
  EXPECT_LE(f["median"], f["max"]);
  EXPECT_GT(f["min"], 0);
  EXPECT_GE(s["stages_ms"].size(), 2U);
  EXPECT_NEAR(sum_of(s["stages_ms"]) / f["median"].get<double>(), 1, 0.05);
}

TEST_F(Stats, SumsOfManyTriangles) {
  for (const char* cull : {"none", "back"}) {
    must({"render", "--look", "plain", "builtin:soup?count=3000,max_size=0.6", "builtin:sphere",
          "--eye", "0,0.1,0.5", "--target", "0,0,0", "--size", "80x80", "--cull", cull, "--stats",
          "s.json"});
    const Json t = json("s.json")["triangles"];
    const auto n = [&](const char* key) { return t[key].get<std::uint64_t>(); };
    EXPECT_EQ(n("input"), 3000U + 2 * 31 * 64);
    EXPECT_EQ(n("input"), n("dropped") + n("culled") + n("drawn"));
    EXPECT_GT(n("clipped"), 0U);
    EXPECT_LE(n("clipped"), n("drawn") + n("culled"));
  }
}

TEST_F(Stats, DashIsStandardOutput) {
  const Outcome r = run("render --look plain builtin:sphere --size 9x9 --stats -");
  EXPECT_EQ(Json::parse(r.out)["size"], Json::array({9, 9})) << r.err;
  EXPECT_EQ(r.status, 0);
  EXPECT_TRUE(files().empty()) << "no file called -";
}

TEST_F(Stats, CountsDoNotDependOnTheOutputs) {
  const auto counts = [&](const Args& outputs) {
    must("render --look plain builtin:boxes --size 64x64 --stats s.json" + outputs);
    const Json s = json("s.json");
    return Json::array({s["triangles"], s["fragments"], s["pixels_covered"]});
  };
  const Json plain = counts({});
  EXPECT_EQ(counts("-o p.exr"), plain);
  EXPECT_EQ(counts("--heatmap h.png --depth d.npy"), plain);
}

TEST_F(Stats, TraceHoldsEveryFrameAndItsStagesAddUp) {
  must(
      "render --look plain builtin:boxes?count=6 builtin:sphere?x=9 --frames 4 --trace t.json -o "
      "p.png --heatmap h.png --size 400x300");
  const Json trace = json("t.json");
  std::vector<Json> frames, stages;
  std::set<std::string> others;
  for (const Json& e : trace["traceEvents"]) {
    if (e["ph"] == "M") continue;
    EXPECT_EQ(e["ph"], "X");
    EXPECT_TRUE(e["ts"].is_number() && e["dur"].is_number() && e.contains("pid") &&
                e.contains("tid"));
    EXPECT_GE(e["dur"], 0);
    if (e["cat"] == "frame")
      frames.push_back(e);
    else if (e["cat"] == "stage")
      stages.push_back(e);
    else
      others.insert(e["name"]);
  }
  ASSERT_EQ(frames.size(), 4U);
  const auto begin = [](const Json& e) { return e["ts"].get<double>(); };
  const auto end = [&](const Json& e) { return begin(e) + e["dur"].get<double>(); };
  constexpr double kRounding_us = 0.01;
  for (const Json& frame : frames) {
    double sum = 0;
    for (const Json& stage : stages)
      if (begin(stage) >= begin(frame) - kRounding_us && end(stage) <= end(frame) + kRounding_us)
        sum += stage["dur"].get<double>();
    EXPECT_NEAR(sum / frame["dur"].get<double>(), 1, 0.05) << frame["name"];
  }
  for (const char* name : {"load builtin:boxes?count=6", "load builtin:sphere?x=9", "write p.png",
                           "write h.png", "other images"})
    EXPECT_TRUE(others.contains(name)) << name;
}

TEST(MedianFrame, IsAFrame) {
  const auto frames = [](std::initializer_list<double> times) {
    std::vector<FrameStats> f;
    for (const double ms : times) f.emplace_back().frame_ms = ms;
    return f;
  };
  EXPECT_EQ(cli::median_frame(frames({5})), 0U);
  EXPECT_EQ(cli::median_frame(frames({5, 1, 3})), 2U);
  EXPECT_EQ(cli::median_frame(frames({4, 1, 3, 2})), 3U) << "the faster of the middle two";
}

}  // namespace
}  // namespace rastrum::test::stats_test
