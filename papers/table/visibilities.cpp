// SPDX-License-Identifier: BSD-3-Clause
// The rows of the visibility axis.
#include <array>

#include <papers/axes/atomic.hpp>
#include <papers/axes/region.hpp>
#include <papers/paper1/search.hpp>
#include <papers/paper1/tuple.hpp>
#include <papers/paper5/hashed.hpp>
#include <papers/paper5/sorted.hpp>

namespace rastrum::family {

std::span<const Visibility> visibilities() noexcept {
  static constexpr std::array kTable{
      Visibility{"atomic", "64-bit maximum of depth and id, shading deferred", false, true, 8,
                 make_atomic, false, true},
      Visibility{"search",
                 "maximum of the depth, then a second pass for the smallest id that has it", false,
                 true, 12, make_search},
      Visibility{"tuple", "key and colour under a lock, every fragment shaded at once", true, false,
                 25, make_tuple_region},
      Visibility{"sorted", "fragments written, sorted by pixel, the maximum of each segment kept",
                 false, true, 8, make_sorted},
      Visibility{"hashed", "a hash table from pixels to keys, compacted and scattered", false, true,
                 8, make_hashed},
  };
  return kTable;
}

}  // namespace rastrum::family
