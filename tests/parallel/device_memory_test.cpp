// What the device's backend has of its own: memory that is pooled, and sums that wait for who asks.
#include <algorithm>

#include <tests/parallel/backends.hpp>

namespace rastrum::parallel::test::device_memory_test {
namespace {

TEST(DeviceMemory, FramesAfterTheFirstAskForNothing) {
  MemoryAccount account;
  Cuda exec(&account);
  std::uint64_t after_the_first = 0;
  for (int frame = 0; frame < 5; ++frame) {
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

// Thrust's exception is no rastrum::Error, and nobody outside of the device's code knows it.
TEST(DeviceErrors, OfThrustComeOutAsError) {
  try {
    cuda_system::with_errors([]() -> int {
      throw thrust::system_error(thrust::errc::io_error, thrust::generic_category(),
                                 "for_each: failed to synchronize");
    });
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::no_device);
    EXPECT_NE(std::string(error.what()).find("failed to synchronize"), std::string::npos)
        << error.what();
  }
  try {
    cuda_system::with_errors([] { throw Error(Errc::out_of_memory, "9 bytes"); });
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::out_of_memory);
    EXPECT_STREQ(error.what(), "9 bytes");
  }
  EXPECT_EQ(cuda_system::with_errors([] { return 7; }), 7);
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
