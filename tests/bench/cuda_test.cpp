// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench cuda` without a GPU: all its tables, small, with device code compiled for the CPU
// (CMakeLists.txt). Each table checks its pictures against the threads' and says so.
#include <bench/bench.hpp>
#include <bench/cuda/device.hpp>
#include <bench/cuda/rates.hpp>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/parallel/cuda/driver.hpp>
#include <rastrum/parallel/cuda/library.hpp>

#include "tests/io/files.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::parallel {
namespace {

// As in tests/raster/cuda/cuda_on_cpu.cpp.
[[maybe_unused]] const bool is_taken = (set_cuda_library(*rastrum_cuda_library()), true);

}  // namespace

CudaStatus driver_status() {
  return {.usable = true,
          .why_not = {},
          .name = "CPU in the place of a GPU",
          .free_bytes = std::uint64_t{1} << 36};
}

}  // namespace rastrum::parallel

namespace rastrum::bench::cuda_test {
namespace {

TEST(BenchCuda, AllTablesRunAndTheDevicesPicturesAreRight) {
  const test::TempFolder folder;
  const std::string out = folder.path("").string();
  const auto figures = [&](const std::string& table) {
    return nlohmann::json::parse(test::slurp(folder.path(table + ".json")))["figures"];
  };
  const std::vector<std::string_view> args{"cuda", "--quick", "--threads", "2", "--out", out};
  ASSERT_EQ(run(args), 0);
  for (const std::string name :
       {"cuda", "cuda-frames", "paper2", "paper3", "transparency", "paper5-table4"}) {
    const std::string text = test::slurp(folder.path(name + ".md"));
    EXPECT_TRUE(test::holds(text, "CPU in the place of a GPU: its memory copies ")) << name;
    EXPECT_FALSE(test::holds(text, "WRONG"));
    EXPECT_FALSE(test::holds(text, "left to the CPU"));
  }

  std::set<std::string> words;
  for (const nlohmann::json& f : figures("cuda")) {
    words.insert(f["word"].get<std::string>());
    EXPECT_GT(f["cuda"]["median_ms"], 0);
    EXPECT_GT(f["floor_ms"], 0);
  }
  EXPECT_EQ(words.size(), 5U);

  std::set<std::string> looks;
  for (const nlohmann::json& f : figures("cuda-frames")) {
    looks.insert(f["look"].get<std::string>());
    for (const char* way : {"threads", "cuda", "in_place"})
      EXPECT_GT(f[way]["median_ms"], 0) << way;
  }
  EXPECT_EQ(looks.size(), 3U);

  // Subdivided 0, 1 and 2 times at scales 1, 2 and 4; the finest is drawn in parts.
  std::map<std::string, std::set<std::string>> tables;
  for (const nlohmann::json& f : figures("paper5-table4")) {
    if (!f.contains("floor_ms")) continue;
    EXPECT_GT(f["floor_ms"], 0);
    EXPECT_GT(f["ms"], 0);
    tables[f["table"]].insert(f["row"].get<std::string>() + " " + f["column"].get<std::string>());
  }
  EXPECT_EQ(tables.size(), 3U);
  for (const auto& [table, cells] : tables) EXPECT_EQ(cells.size(), 9U) << table;

  std::set<std::string> methods, shadows;
  for (const nlohmann::json& f : figures("paper3")) {
    if (f["table"] == "frames") methods.insert(f["method"].get<std::string>());
    if (!f.contains("device_sharp")) continue;
    EXPECT_GT(f["device_sharp"]["median_ms"], 0);
    EXPECT_GT(f["device_march"]["median_ms"], 0);
    shadows.insert(f["width"].dump() + " " + f["samples"].dump());
  }
  EXPECT_TRUE(methods.contains("fast, cuda") && methods.contains("words, cuda"));
  EXPECT_GE(shadows.size(), 3U);

  for (const nlohmann::json& row : figures("transparency")) {
    ASSERT_EQ(row["device"].size(), 2U);
    for (const nlohmann::json& lap : row["device"]) EXPECT_GT(lap["median_ms"], 0) << lap.dump();
    EXPECT_GT(row["device_floor_ms"], 0);
  }
}

TEST(BenchCuda, TheFloorIsEachByteOnceOverTheBandwidth) {
  MachineLimits device{.copy_gbs = 2};
  // 500 + 1000 times 12 bytes, 2000 of 4, at 2 bytes a nanosecond.
  EXPECT_DOUBLE_EQ(floor_ms(1000, 2000, device), (12 * 1500 + 4 * 2000) / 2e6);
  EXPECT_DOUBLE_EQ(floor_ms(1000, 2000, device, 3000), (12 * 4000 + 4 * 2000) / 2e6);
}

TEST(BenchCuda, RatesAreItemsASecondAndTimesOverTheFloor) {
  Rates rates("cuda", "scene");
  rates.add("a", "x", 3'000'000, 2, 0.5);
  rates.add("a", "y", 1, 0, 1);
  rates.add("b", "y", 5'000'000, 5, 1);
  Document document{"d", "t"};
  rates.add_to(document);
  const std::vector<std::vector<std::string>> rows{{"a", "1500 (4.00)", ""},
                                                   {"b", "", "1000 (5.00)"}};
  EXPECT_EQ(document.grids[0].rows, rows);
  EXPECT_EQ(document.grids[0].columns, (std::vector<std::string>{"scene", "x", "y"}));
  EXPECT_EQ(document.figures.size(), 2U);
}

}  // namespace
}  // namespace rastrum::bench::cuda_test
