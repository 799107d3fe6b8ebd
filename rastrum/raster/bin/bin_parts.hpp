// What threads draw of a view, one part after the other: its bins, the largest first, and those
// that hold more than a thread's share cut in pieces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/raster/bin/groups.hpp>

namespace rastrum::raster {

/// A bin or a part of it, at most `side_px` across.
struct BinPart {
  std::size_t bin = 0;
  Rect rect{};
  int side_px = kBinSize;
  std::uint64_t load = 0;  ///< what it takes to draw, some 10 cycles each; 0: nothing is there
};

/// Keeps its memory.
class BinParts {
 public:
  /// The bins of what `groups` has been filled with. With one thread they are whole and in order;
  /// else they are sorted by load, and with `cuts` none has much more than a thread's share.
  /// Work O(bins). Valid until the next call.
  [[nodiscard]] std::span<const BinPart> of(const Frame& frame, const BinTable& lists,
                                            const TriangleGroups& groups, bool cuts);

 private:
  std::vector<BinPart> parts_, sorted_;
};

}  // namespace rastrum::raster
