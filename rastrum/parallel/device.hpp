// SPDX-License-Identifier: BSD-3-Clause
// Chooses the device and the instruction set of a renderer.
#pragma once

#include <optional>
#include <string>

#include <rastrum/device.hpp>

namespace rastrum {

struct DeviceChoice {
  Device device;    ///< not `automatic`
  std::string why;  ///< why `automatic` chose it; empty where a device was asked for
};
/// The device for `wanted`. Throws Error{no_device}, which says what to do, if `cuda` is asked for
/// and not available, and Error{invalid_argument} for a value that is no device.
[[nodiscard]] DeviceChoice choose_device(Device wanted);

/// `wanted`, or the best of available_isas(). Throws Error{no_device}, which names the available
/// ones, so that plain C++ never silently replaces a missing one; Error{invalid_argument} for a
/// value that is none.
[[nodiscard]] Isa choose_isa(std::optional<Isa> wanted);

}  // namespace rastrum
