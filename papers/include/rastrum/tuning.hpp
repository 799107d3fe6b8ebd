// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the family's rasterizers.
#pragma once

#include <cstdint>

#include <rastrum/config.hpp>

namespace RASTRUM_API rastrum {
namespace family {

enum class Schedule : std::uint8_t { automatic, two_stage, persistent };
enum class BlockOrder : std::uint8_t { row_major, morton };
/// How `hybrid` draws small triangles: by the blocks of their boxes or by rows (paper 1, 4.2).
enum class SmallPath : std::uint8_t { blocks, rows };

/// Parameters of the rasterizers; 0 is the default of the rasterizer's paper. Sizes of bins and
/// tiles are powers of two. A bin is up to 128 px and 2 to 16 tiles across. A tile has at least 4
/// px, with `binned` 8. `grouped` takes only bins of 64 px and tiles of 8 px.
struct Tuning {
  int bin_px = 0, tile_px = 0;
  int small_px = 0;  ///< box area up to which a triangle is small (128)
  int large_px = 0;  ///< box area from which `binned` sends a triangle through its queue (4,000)
  Schedule schedule = Schedule::automatic;   ///< for `binned`
  BlockOrder order = BlockOrder::row_major;  ///< the order in which tiles are walked
  SmallPath small_path = SmallPath::blocks;  ///< for `hybrid`

  bool operator==(const Tuning&) const = default;
};

}  // namespace family
}  // namespace rastrum
