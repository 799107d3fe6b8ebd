// SPDX-License-Identifier: BSD-3-Clause
// A refused device call must end in an Error without side effects. These faults are for the CPU
// that stands in for a device (host_stream.hpp).
#pragma once

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/parallel/cuda/host_stream.hpp>

namespace rastrum::test {

/// While it lives, refuses the n-th call of this thread that a driver may refuse.
class Refused {
 public:
  explicit Refused(std::uint64_t n) { parallel::cuda_system::DeviceFaults::of_thread() = {0, n}; }
  ~Refused() { parallel::cuda_system::DeviceFaults::of_thread() = {}; }
  Refused(const Refused&) = delete;
  Refused& operator=(const Refused&) = delete;
};

/// For n = 1, 2, … makes `start()`, runs `use(result)` with the n-th call refused, then
/// `again(result)` with none, until a use succeeds. Returns how many calls were refused. A failing
/// use must throw an Error that names the device; otherwise the test fails and this returns early.
template <class Start, class Use, class Again>
std::uint64_t refuse_each_call(Start&& start, Use&& use, Again&& again) {
  for (std::uint64_t n = 1; n < 3000; ++n) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, "call " + std::to_string(n));
    auto result = start();
    bool is_refused = false;
    try {
      const Refused fault(n);
      use(result);
    } catch (const Error& error) {
      is_refused = true;
      EXPECT_TRUE(error.code() == Errc::no_device || error.code() == Errc::out_of_memory)
          << error.what();
      EXPECT_NE(std::string(error.what()).find("device"), std::string::npos) << error.what();
    }
    again(result);
    if (!is_refused || testing::Test::HasFailure()) return n - 1;
  }
  ADD_FAILURE() << "it does not end";
  return 0;
}

}  // namespace rastrum::test
