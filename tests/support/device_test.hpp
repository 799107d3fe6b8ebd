// SPDX-License-Identifier: BSD-3-Clause
// A test of the façade that runs on each device.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/painter.hpp"

namespace rastrum::test {

class DeviceTest : public testing::TestWithParam<Device> {
 protected:
  [[nodiscard]] static RenderOptions options(int width, int height) {
    return RenderOptions({.width = width, .height = height}, {.device = GetParam(), .threads = 4});
  }
};

inline std::string device_name(const testing::TestParamInfo<Device>& p) {
  return p.param == Device::serial ? "serial" : "threads";
}

}  // namespace rastrum::test
