// SPDX-License-Identifier: BSD-3-Clause
// The tables of `rastrum bench transparency`: missed goals, lower bounds, gaps. And the measurement
// without any peer.
#include <papers/paper4/bench/tables.hpp>

#include <bench/scenes.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/shapes.hpp>

#include "tests/support/refused.hpp"

namespace rastrum::bench::transparency_test {
namespace {

/// A row of 100,000 triangles: unsorted takes 10 ms, exact 15, and no goal is missed.
TransparencyRow row() {
  TransparencyRow r;
  r.scene = "hairball";
  r.size = {100, 100};
  r.work.triangles = 100'000;
  r.work.fragments = 1'000'000;
  r.work.pixels = 10'000;
  r.floor.operations_ms = 5;
  r.deepest = 77;
  r.samples_per_block = 12.5;
  const auto lap = [](std::string_view name, double ms) {
    Lap l;
    l.name = name;
    l.timing = {l.name, {ms, ms, ms}};
    return l;
  };
  for (const Technique& t : kTechniques) r.ours.push_back(lap(t.name, 20));
  r.ours[kExact].timing.samples_ms = {15, 15, 15};
  r.ours[kExact].stats.peak_bytes = 4'000'000;
  r.ours[kExact].stats.stages = {{"set up", 0, 3}, {"tiles", 3, 14}, {"set up", 14, 15}};
  r.ours[kExact].stats.frame_ms = 15;
  r.ours[kUnsorted].timing.samples_ms = {10, 10, 10};
  r.ours[kFilter3].wrong_pixels = 41;
  const double peers[]{80, 150, 750, 750};
  for (std::size_t p = 0; p < kPeerCount; ++p) r.peers.push_back(lap(kPeerNames[p], peers[p]));
  for (const double ms : {30.0, 20.0, 30.0, 10.0}) r.thresholds.push_back(lap("exact", ms));
  return r;
}

void set_ms(Lap& lap, double ms) {
  lap.timing.samples_ms = {ms, ms, ms};
}

Document document_of(const TransparencyRow& r, std::vector<std::string> absent = {}) {
  Document document{"transparency", "t"};
  add_transparency(document, {&r, 1}, absent);
  return document;
}
std::string tables_of(const TransparencyRow& r, std::vector<std::string> absent = {}) {
  return to_markdown(document_of(r, std::move(absent)));
}

TEST(TransparencyGoals, EachIsJudged) {
  EXPECT_EQ(missed_goals(row()), "");
  TransparencyRow r = row();
  set_ms(r.ours[kExact], 31);
  EXPECT_TRUE(test::holds(missed_goals(r), "exact ÷ unsorted 3.10 > 3"));
  const double just_too_fast[]{79, 149, 749, 749};
  const char* names[]{"llvmpipe unsorted ÷ unsorted", "llvmpipe lists ÷ exact",
                      "llvmpipe peeling ÷ exact", "VTK peeling ÷ exact"};
  for (std::size_t p = 0; p < kPeerCount; ++p) {
    r = row();
    set_ms(r.peers[p], just_too_fast[p]);
    EXPECT_TRUE(test::holds(missed_goals(r), names[p]));
  }
  r = row();
  set_ms(r.ours[kExact], 17);  // 80 < 5 × 17
  EXPECT_TRUE(test::holds(missed_goals(r), "llvmpipe unsorted ÷ exact"));
}

TEST(TransparencyGoals, PeersCountFromSeventyThousandTrianglesOn) {
  TransparencyRow r = row();
  for (Lap& peer : r.peers) set_ms(peer, 1);
  r.work.triangles = 12'000;
  EXPECT_EQ(missed_goals(r), "");
  r.work.triangles = 69'451;  // the bunny
  EXPECT_NE(missed_goals(r), "");
}

TEST(TransparencyGoals, ALowerBoundIsNoMiss) {
  TransparencyRow r = row();
  set_ms(r.peers[kGlPeeling], 700);
  r.peers[kGlPeeling].at_least = true;
  EXPECT_TRUE(test::holds(missed_goals(r), "not known whether"));
  EXPECT_TRUE(test::holds(tables_of(r), "> 700"));
  set_ms(r.peers[kGlPeeling], 7000);
  EXPECT_EQ(missed_goals(r), "");
  r.peers[kGlPeeling].not_run = "no device";
  EXPECT_EQ(missed_goals(r), "");
}

TEST(TransparencyTables, ShowWhatWasMeasuredAndWhatWasPublished) {
  TransparencyRow r = row();
  r.peers[kVtkPeeling].not_run = "VTK: not here";
  const std::string text = tables_of(r, {"pine"});
  for (const char* part :
       {"hairball, 100x100", "1.5", "8", "16.0",  // 16 B × 10⁶ + 4 B × 10⁴
        "tiles 73 %", "0.41", "12.5", "3.3 (2.1 to 5.1)", "white-oak (not drawn here)",
        "not run (VTK: not here)", "not run: no file", "mboit4"})
    EXPECT_TRUE(test::holds(text, part));
  EXPECT_EQ(text.find("hairball (not drawn here)"), std::string::npos);
}

TEST(TransparencyTables, KeepTheirFigures) {
  const Document document = document_of(row());
  const nlohmann::json& j = document.figures.at(0);
  EXPECT_EQ(j["scene"], "hairball");
  EXPECT_DOUBLE_EQ(j["exact_over_unsorted"], 1.5);
  EXPECT_EQ(j["ours"].size(), kTechniques.size());
  EXPECT_DOUBLE_EQ(j["ours"][kExact]["stages_ms"]["set up"], 4);
  EXPECT_EQ(j["peers"].size(), static_cast<std::size_t>(kPeerCount));
  EXPECT_DOUBLE_EQ(j["ratios"]["llvmpipe lists ÷ exact"], 10);
  EXPECT_EQ(j["thresholds"].size(), 4U);
}

TEST(TransparencyMeasure, RunsWithoutPeers) {
  // Triangles that cross each other, too many layers for a filter of three.
  Mesh mesh = shapes::soup(1500, 0.1F, 0.8F);
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.indices.push_back(i);
  mesh.normals = {vertex_normals(mesh.positions, mesh.indices), {}};
  TransparencyPeers peers{Started<GlTransparency>("no OpenGL"), Started<VtkPeer>("no VTK")};
  TransparencyPlan plan;
  plan.plan = {1, 1.0};
  const TransparencyRow r = measure_transparency(mesh, {96, 96}, peers, plan);
  for (const Lap& lap : r.ours) {
    EXPECT_TRUE(lap.ran()) << lap.name << ": " << lap.not_run;
    EXPECT_EQ(counter(lap.stats, "translucent fragments"), r.work.fragments) << lap.name;
  }
  for (const Lap& lap : r.thresholds) EXPECT_TRUE(lap.ran()) << lap.name << ": " << lap.not_run;
  for (const Lap& lap : r.peers) EXPECT_FALSE(lap.ran());
  EXPECT_TRUE(r.right());
  EXPECT_EQ(r.ours[kExact].error.rmse, 0);
  for (std::size_t i = kUnsorted; i < r.ours.size(); ++i) {
    if (r.ours[i].name.find("filter") != std::string::npos) continue;
    EXPECT_GT(r.ours[i].error.worst, 1e-4) << r.ours[i].name;
  }
  EXPECT_GT(r.ours[kFilter3].wrong_pixels, r.ours[kFilter3 + 2].wrong_pixels);
  EXPECT_GT(r.deepest, 3U);
  EXPECT_GT(r.samples_per_block, 1);
  EXPECT_LE(r.samples_per_block, 64);
}

}  // namespace
}  // namespace rastrum::bench::transparency_test
