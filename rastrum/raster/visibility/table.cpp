// The rows of the visibility axis.
#include <algorithm>
#include <array>

#include <rastrum/raster/visibility/atomic.hpp>
#include <rastrum/raster/visibility/hashed.hpp>
#include <rastrum/raster/visibility/region.hpp>
#include <rastrum/raster/visibility/search.hpp>
#include <rastrum/raster/visibility/sorted.hpp>
#include <rastrum/raster/visibility/tuple.hpp>

namespace rastrum::raster {

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

void add_counter(Counters& counters, std::string_view name, std::uint64_t value) {
  const auto found = std::find_if(counters.begin(), counters.end(),
                                  [&](const auto& c) { return c.first == name; });
  if (found != counters.end())
    found->second += value;
  else
    counters.emplace_back(name, value);
}

void raise_counter(Counters& counters, std::string_view name, std::uint64_t value) {
  add_counter(counters, name, 0);
  std::uint64_t& held = std::ranges::find(counters, name, &Counters::value_type::first)->second;
  held = std::max(held, value);
}

}  // namespace rastrum::raster
