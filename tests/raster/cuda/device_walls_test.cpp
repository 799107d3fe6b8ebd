// SPDX-License-Identifier: BSD-3-Clause
// Host and device must not read each other's memory. Under the address sanitizer, host code that
// reads device memory and a kernel that reads host memory end the process, whatever they read
// (parallel/cuda/host_walls.hpp). All tests of this program and of the terrain's run with these
// walls.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/parallel/cuda/host_walls.hpp>
#include <rastrum/parallel/cuda/words.cuh>

namespace rastrum::test::device_walls_test {
namespace {

using namespace parallel;  // NOLINT: its words are the subject here

constexpr std::size_t kValues = 1000;

struct Doubled {
  const std::uint32_t* in;
  std::uint32_t* out;
  void operator()(std::size_t i) const { out[i] = 2 * in[i]; }
};
struct DoubledByTeams : Doubled {
  struct Shared {
    std::uint32_t value;
  };
  template <class Team>
  void operator()(std::size_t i, Shared&, const Team& team) const {
    if (team.rank() == 0) Doubled::operator()(i);
  }
};

class DeviceWalls : public testing::Test {
 protected:
  DeviceWalls() {
    for (std::size_t i = 0; i < kValues; ++i) values[i] = static_cast<std::uint32_t>(i);
  }
  void SetUp() override {
    if (!cuda_system::Walls::kCanStand) GTEST_SKIP() << "built without the address sanitizer";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
  }
  std::vector<std::uint32_t> values = std::vector<std::uint32_t>(kValues);
  Cuda exec;
};

TEST_F(DeviceWalls, CopiesKernelsTeamsAndAlgorithmsGoThrough) {
  const auto in = to_device(exec, values);
  auto out = make_buffer<std::uint32_t>(exec, kValues);
  for_each_index(exec, kValues, Doubled{in.data(), out.data()});
  EXPECT_EQ(to_host(exec, out)[999], 1998U);
  for_each_team<DoubledByTeams::Shared>(exec, kValues, DoubledByTeams{{out.data(), out.data()}});
  EXPECT_EQ(to_host(exec, out)[999], 3996U);
  EXPECT_EQ(reduce(exec, in, std::uint32_t{0}), 499500U);
}
TEST_F(DeviceWalls, TheHostReadsNoMemoryOfADevice) {
  const auto in = to_device(exec, values);
  EXPECT_DEATH(std::exit(in.data()[7] == 7 ? 0 : 1), "use-after-poison");
  EXPECT_DEATH(values.assign(in.data(), in.data() + kValues), "use-after-poison");
}
TEST_F(DeviceWalls, KernelsReadAndTeamsWriteNoMemoryOfTheHost) {
  const auto in = to_device(exec, values);
  auto out = make_buffer<std::uint32_t>(exec, kValues);
  const auto kernel = [&] {
    for_each_index(exec, kValues, Doubled{values.data(), out.data()});
    exec.wait();
  };
  EXPECT_DEATH(kernel(), "use-after-poison");
  const auto team = [&] {
    for_each_team<DoubledByTeams::Shared>(exec, kValues,
                                          DoubledByTeams{{in.data(), values.data()}});
    exec.wait();
  };
  EXPECT_DEATH(team(), "use-after-poison");
}

}  // namespace
}  // namespace rastrum::test::device_walls_test
