// SPDX-License-Identifier: BSD-3-Clause
// Settings and counts of layers on a device, for code without a CUDA header.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <rastrum/frame.hpp>
#include <rastrum/raster/context/added_transparency.hpp>

namespace rastrum::transparency {

/// No choice changes a pixel.
struct DeviceLayerTuning {
  /// Most records of a block of low and of high density; others go through device memory. At most
  /// 256 and 2,048, which shared memory holds.
  std::size_t low_records = 256, high_records = 2048;
  /// Device memory of records and fragments at a time, but for one block's records or one pixel's
  /// fragments. 0: half a GiB.
  std::uint64_t bytes = 0;

  /// Half of the bytes are for records of 16. A fragment has a sort_key and an owner, twice while
  /// it is sorted.
  [[nodiscard]] std::uint64_t most_records() const { return share(16); }
  [[nodiscard]] std::uint64_t most_fragments() const { return share(24); }
  /// The same with at most `low` and `high` records, the densities that teams are cut for.
  [[nodiscard]] DeviceLayerTuning within_teams(std::size_t low, std::size_t high) const {
    DeviceLayerTuning t = *this;
    t.low_records = std::min(low_records, low);
    t.high_records = std::max(std::min(high_records, high), t.low_records);
    return t;
  }

 private:
  [[nodiscard]] std::uint64_t share(std::uint64_t each) const {
    constexpr std::uint64_t kDefaultBytes = std::uint64_t{1} << 29;
    return std::max<std::uint64_t>((bytes == 0 ? kDefaultBytes : bytes) / 2 / each, 1);
  }
};

struct DeviceLayerCounts {
  std::uint64_t fragments = 0;  ///< translucent ones before the opaque surface
  std::uint64_t deepest = 0;    ///< at the pixel that has most
  std::uint64_t repaired = 0;   ///< pixels that the filter could not order
  std::uint64_t records = 0;    ///< pieces in blocks
  std::uint64_t low_blocks = 0, high_blocks = 0, deep_blocks = 0;
  std::uint64_t turns = 0;

  /// Adds another part of the picture.
  void add(const DeviceLayerCounts& c) {
    fragments += c.fragments;
    deepest = std::max(deepest, c.deepest);
    repaired += c.repaired;
    records += c.records;
    low_blocks += c.low_blocks;
    high_blocks += c.high_blocks;
    deep_blocks += c.deep_blocks;
    turns += c.turns;
  }
};

/// Empty if the device draws a frame's layers; else why the CPU does, for the statistics.
[[nodiscard]] inline std::string_view why_not_on_a_device(const TransparencyOptions& options) {
  return options.method == Transparency::added ? options.added->why_host : std::string_view();
}

}  // namespace rastrum::transparency
