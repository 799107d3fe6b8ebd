// What layers on a device are asked for and what they tell, for code that needs no CUDA header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <rastrum/frame.hpp>

namespace rastrum::transparency {

/// How layers on a device go about their work; no choice changes a pixel.
struct DeviceLayerTuning {
  /// Records of a block up to which it is of low density, and up to which of high; those beyond go
  /// through the device's memory. At most 256 and 2,048, which are what shared memory was cut for.
  std::size_t low_records = 256, high_records = 2048;
  /// Most that records and fragments may take of the device's memory at a time; more only where one
  /// block's records, or one pixel's fragments, need it. 0: half a GiB.
  std::uint64_t bytes = 0;
};

struct DeviceLayerCounts {
  std::uint64_t fragments = 0;  ///< translucent ones before the opaque surface
  std::uint64_t deepest = 0;    ///< of them at the pixel that has most
  std::uint64_t repaired = 0;   ///< pixels that the filter could not order
  std::uint64_t records = 0;    ///< pieces in blocks
  std::uint64_t low_blocks = 0, high_blocks = 0, deep_blocks = 0;
  std::uint64_t turns = 0;
};

/// Why a frame's layers are left to the CPU, for the statistics; empty: the device has them.
[[nodiscard]] constexpr std::string_view why_not_on_a_device(Transparency method) {
  switch (method) {
    case Transparency::exact:
    case Transparency::unsorted:
    case Transparency::none:
      return {};
    case Transparency::filter:
      return "the filter without repair, whose errors are those of the CPU's blocks, is the CPU's";
    default:
      return "the approximations of transparency are the CPU's";
  }
}

}  // namespace rastrum::transparency
