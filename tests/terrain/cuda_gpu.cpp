// SPDX-License-Identifier: BSD-3-Clause
#include "tests/terrain/cuda_device.hpp"

namespace rastrum::test {

bool TerrainOnDevice::set_free_bytes(std::uint64_t) {
  return false;
}

}  // namespace rastrum::test
