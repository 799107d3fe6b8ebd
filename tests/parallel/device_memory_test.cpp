// SPDX-License-Identifier: BSD-3-Clause
// Features of the device's backend only: pooled memory, and sums whose reading is deferred.
#include <algorithm>

#include "tests/parallel/backends.hpp"

#include "tests/support/refused.hpp"

namespace rastrum::parallel::test::device_memory_test {
namespace {

TEST(DeviceMemory, FramesAfterTheFirstAskForNothing) {
  MemoryAccount account;
  Cuda exec(&account);
  std::uint64_t after_the_first = 0;
  for (int frame = 0; frame < (rastrum::test::test_share() < 100 ? 2 : 5); ++frame) {
    auto keys = random_values<std::uint32_t>(300007, 1000);
    auto values = keys;
    sort_by_key(exec, keys, values, 10);
    const auto reduced = reduce_by_key(exec, keys, values);
    const auto odd = filter(exec, reduced.keys, [](std::uint32_t k) { return k % 2 == 1; });
    EXPECT_EQ(odd.size(), 500U);
    if (frame == 0) after_the_first = exec.memory()->held();
    EXPECT_EQ(exec.memory()->held(), after_the_first);
  }
  EXPECT_GT(after_the_first, 300007U * 8);
  EXPECT_EQ(account.peak(), after_the_first);
  EXPECT_EQ(account.held(), after_the_first);
}

TEST(DeviceMemory, BuffersMoveAndOutliveTheirContext) {
  MemoryAccount account;
  DeviceBuffer<int> kept;
  {
    Cuda exec(&account);
    const std::vector<int> values = {3, 1, 4, 1, 5};
    auto buffer = to_device(exec, values);
    DeviceBuffer<int> moved(std::move(buffer));
    EXPECT_EQ(buffer.size(), 0U);
    kept = std::move(moved);
    EXPECT_EQ(to_host(exec, kept), values);
  }
  Cuda other;
  EXPECT_EQ(to_host(other, kept), (std::vector<int>{3, 1, 4, 1, 5}));
  EXPECT_GT(account.held(), 0U);
  kept = {};
  EXPECT_EQ(account.held(), 0U);
}

// Thrust's exception is not a rastrum::Error, and only device code knows its type.
TEST(DeviceErrors, OfThrustComeOutAsError) {
  rastrum::test::expect_refused("failed to synchronize", Errc::no_device, [&] {
    cuda_system::with_errors([]() -> int {
      throw thrust::system_error(thrust::errc::io_error, thrust::generic_category(),
                                 "for_each: failed to synchronize");
    });
  });
  EXPECT_EQ(
      rastrum::test::refusal_of(
          [&] { cuda_system::with_errors([] { throw Error(Errc::out_of_memory, "9 bytes"); }); },
          Errc::out_of_memory),
      "9 bytes");
  EXPECT_EQ(cuda_system::with_errors([] { return 7; }), 7);
}

// A context of one device is used while another device is current.
TEST(DeviceContext, CallsItsOwnDevice) {
  struct Restored {
    ~Restored() { cuda_system::set_device(0); }
  } restored;
  if (!cuda_system::kOnHost) GTEST_SKIP() << "needs two devices";
  cuda_system::set_device(1);
  const Cuda exec;
  cuda_system::set_device(0);
  EXPECT_EQ(exec.device(), 1);
  EXPECT_EQ(on_device_of(exec, [] { return cuda_system::current_device(); }), 1);
  EXPECT_EQ(cuda_system::current_device(), 0);
  EXPECT_THROW(on_device_of(exec, [] { throw Error(Errc::out_of_memory, "9 bytes"); }), Error);
  EXPECT_EQ(cuda_system::current_device(), 0);
}

TEST(DeviceContext, CopiesRowsThatLieApart) {
  Cuda exec;
  const std::vector<int> values = {1, 2, 3, 4, 5, 6};  // two rows of three
  auto buffer = to_device(exec, values);
  std::vector<int> apart(2 * 5, 0);
  copy_image(exec, buffer.data(), 3, apart.data(), 5, 2, false);
  exec.wait();
  EXPECT_EQ(apart, (std::vector<int>{1, 2, 3, 0, 0, 4, 5, 6, 0, 0}));
  copy_image(exec, buffer.data(), 3, apart.data() + 5, -5, 2, false);
  exec.wait();
  EXPECT_EQ(apart, (std::vector<int>{4, 5, 6, 0, 0, 1, 2, 3, 0, 0}));
  auto back = make_buffer<int>(exec, 6);
  copy_image(exec, back.data(), 3, apart.data(), 5, 2, true);
  exec.wait();
  EXPECT_EQ(to_host(exec, back), (std::vector<int>{4, 5, 6, 1, 2, 3}));
}

TEST(Pending, IsTheSumThatAScanHadWhenItWasDone) {
  Cuda exec;
  std::vector<std::uint32_t> values = {1, 2, 3, 4};
  const auto sum = exclusive_scan(exec, values, values, std::uint32_t{10});
  EXPECT_EQ(values, (std::vector<std::uint32_t>{10, 11, 13, 16}));
  std::fill(values.begin(), values.end(), 77U);
  const std::uint32_t asked = sum;
  EXPECT_EQ(asked, 20U);
  EXPECT_EQ(*sum.device(), 20U);
}

}  // namespace
}  // namespace rastrum::parallel::test::device_memory_test
