// SPDX-License-Identifier: BSD-3-Clause
// How Device::automatic chooses where there is a GPU: by how long a frame is expected to take on
// the CPU's threads and on the device, from what is known of it before it is drawn. A frame is the
// device's when its kernels, launches and copies over the bus take less than the threads.
//
// The model is two sums: it need not be right, it has to tell a small picture from a large mesh.
// The costs are measurements of both (docs/log/devices.md: an H100 and an H200 behind PCIe 5);
// `rastrum bench cuda` prints what they should be elsewhere.
#pragma once

#include <cstdint>
#include <string>

#include <rastrum/parallel/device.hpp>

namespace rastrum {

/// A frame before it is drawn.
struct FrameWork {
  std::string what;            ///< for people, e.g. "968 triangles at 1024x1024"
  double host_ns = 0;          ///< of one thread, at which all threads work alike
  double device_ns = 0;        ///< of the device's kernels
  std::uint64_t launches = 0;  ///< kernels, copies and waits
  std::uint64_t bytes = 0;     ///< over the bus, there and back
};

struct DeviceEstimate {
  double host_ms = 0, device_ms = 0;
  [[nodiscard]] bool is_worth_it() const { return device_ms < host_ms; }
};
[[nodiscard]] DeviceEstimate estimate(const FrameWork& work, int threads);

/// The choice of `automatic` for a frame where `there`, the choice for the machine, is CUDA: CUDA
/// or the threads, with `there.why` and the figures. Any other choice is returned as it is.
[[nodiscard]] DeviceChoice choose_device(const DeviceChoice& there, const FrameWork& work,
                                         int threads);

}  // namespace rastrum
