// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/core/number_text.hpp>
#include <rastrum/parallel/device_estimate.hpp>

#include <algorithm>

namespace rastrum {
namespace {

/// To start a kernel and, now and then, to wait for it.
constexpr double kLaunch_ns = 4000;
/// Bytes per nanosecond to and from pageable arrays. An H100 has 7.5 to the device and 10.7 back.
constexpr double kBus = 8;

}  // namespace

DeviceEstimate estimate(const FrameWork& work, int threads) {
  return {work.host_ns / std::max(1, threads) / 1e6,
          (work.device_ns + kLaunch_ns * static_cast<double>(work.launches) +
           static_cast<double>(work.bytes) / kBus) /
              1e6};
}

DeviceChoice choose_device(const DeviceChoice& there, const FrameWork& work, int threads) {
  if (there.device != Device::cuda) return there;
  const DeviceEstimate ms = estimate(work, threads);
  const std::string figures = " are expected to take " + fixed_text(ms.host_ms, 2) + " ms on " +
                              std::to_string(threads) + " thread" + (threads == 1 ? "" : "s") +
                              " and " + fixed_text(ms.device_ms, 2) + " ms there, with " +
                              fixed_text(static_cast<double>(work.bytes) / 1e6, 2) + " MB to copy";
  DeviceChoice choice{ms.is_worth_it() ? Device::cuda : Device::threads, there.why};
  choice.why.append(ms.is_worth_it() ? "; " : ", but ").append(work.what).append(figures);
  return choice;
}

}  // namespace rastrum
