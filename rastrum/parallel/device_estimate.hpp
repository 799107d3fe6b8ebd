// SPDX-License-Identifier: BSD-3-Clause
// How Device::automatic chooses where there is a GPU. It estimates a frame's time on the CPU's
// threads and on the device (kernels, launches, copies over the bus), and takes the smaller. The
// model only has to tell a small picture from a large mesh. Its costs are measured
// (docs/log/devices.md: an H100 and an H200 behind PCIe 5); `rastrum bench cuda` prints another
// machine's.
#pragma once

#include <cstdint>
#include <string>

#include <rastrum/parallel/device.hpp>

namespace rastrum {

struct FrameWork {
  std::string what;            ///< for people, e.g. "968 triangles at 1024x1024"
  double host_ns = 0;          ///< on one thread; n threads take 1/n of it
  double device_ns = 0;        ///< in the device's kernels
  std::uint64_t launches = 0;  ///< kernels, copies and waits
  std::uint64_t bytes = 0;     ///< over the bus, both ways
};

struct DeviceEstimate {
  double host_ms = 0, device_ms = 0;
  [[nodiscard]] bool is_worth_it() const { return device_ms < host_ms; }
};
[[nodiscard]] DeviceEstimate estimate(const FrameWork& work, int threads);

/// If `there`, the choice for the machine, is CUDA: CUDA or threads for this frame, with
/// `there.why` and the figures. Otherwise returns `there`.
[[nodiscard]] DeviceChoice choose_device(const DeviceChoice& there, const FrameWork& work,
                                         int threads);

}  // namespace rastrum
