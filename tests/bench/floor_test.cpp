// SPDX-License-Identifier: BSD-3-Clause
// Floors computed by hand, and plausible limits of a machine.
#include <bench/floor.hpp>

#include <gtest/gtest.h>

namespace rastrum::bench::floor_test {
namespace {

MachineLimits machine() {
  return MachineLimits{.read_gbs = 12, .stream_gbs = 40, .gflops = 100};
}

TEST(Floor, CountsEachArrayOnceAndEachPixelOnce) {
  Workload work;
  work.vertices = 1'000'000;   // 24 MB
  work.triangles = 2'000'000;  // 24 MB
  work.pixels = 10'000'000;    // 40 MB
  const Floor floor = floor_of(work, machine());
  EXPECT_DOUBLE_EQ(floor.bytes, 88e6);
  EXPECT_DOUBLE_EQ(floor.bytes_ms, 48e6 / 12e6 + 40e6 / 40e6);  // 4 ms + 1 ms
}

TEST(Floor, SaysWhichOneBinds) {
  Workload empty{.pixels = 1'000'000};
  EXPECT_EQ(floor_of(empty, machine()).binds(), "bytes");
  Workload deep = empty;
  deep.fragments = 1'000'000'000;
  const Floor floor = floor_of(deep, machine());
  EXPECT_EQ(floor.binds(), "ops");
  EXPECT_DOUBLE_EQ(floor.ms(), floor.operations / 100e6);
  EXPECT_GE(floor.operations, 1e9);
}

TEST(Floor, ABlendedFragmentIsShadedButNotStored) {
  Workload opaque, translucent;
  opaque.pixels_covered = translucent.blended = 1000;
  const double stored = floor_of(opaque, machine()).operations;
  const double blended = floor_of(translucent, machine()).operations;
  EXPECT_DOUBLE_EQ(blended - stored, 1000 * (8.0 - 6.0));
}

TEST(Machine, MeasuresSomethingPossible) {
  const MachineLimits m = measure_machine(1);
  EXPECT_EQ(m.threads, 1);
  for (const double bandwidth : {m.read_gbs, m.write_gbs, m.stream_gbs, m.copy_gbs}) {
    EXPECT_GT(bandwidth, 0.05);
    EXPECT_LT(bandwidth, 2000);
  }
  EXPECT_GT(m.gflops, 0.05);
  EXPECT_LT(m.gflops, 1000);
  EXPECT_LT(m.gflops_fma, 2000);
}

}  // namespace
}  // namespace rastrum::bench::floor_test
