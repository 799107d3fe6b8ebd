// SPDX-License-Identifier: BSD-3-Clause
// Which device and which instructions a renderer takes.
#pragma once

#include <optional>
#include <string>

#include <rastrum/device.hpp>

namespace rastrum {

struct DeviceChoice {
  Device device;    ///< not `automatic`
  std::string why;  ///< what `automatic` went by; empty where a device was asked for
};
/// The device that is had for `wanted`. Throws Error{no_device} with what to do where `cuda` is
/// asked for and cannot be had, Error{invalid_argument} for a value that is no device.
[[nodiscard]] DeviceChoice choose_device(Device wanted);

/// `wanted`, or the best of available_isas(). Every function that is given an instruction set asks
/// here, so that a missing one is never replaced by plain C++ in silence: throws Error{no_device}
/// that names the available ones, Error{invalid_argument} for a value that is none.
[[nodiscard]] Isa choose_isa(std::optional<Isa> wanted);

}  // namespace rastrum
