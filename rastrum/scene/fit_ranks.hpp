// The parts of fits that work alike for vertices on several ranks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <rastrum/fit.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// Calls f(). With ranks, it ends on all of them alike.
template <class F>
void own_work(FitRanks* ranks, const F& f) {
  if (ranks == nullptr)
    f();
  else
    ranks->own(f);
}

/// Widens the box [low, high] to those of all ranks; an empty one is from infinity to −infinity.
inline void gather_boxes(FitRanks* ranks, Vec3d& low, Vec3d& high) {
  if (ranks == nullptr) return;
  const double own[] = {low.x, low.y, low.z, high.x, high.y, high.z};
  const std::vector<double> all = ranks->gather(own);
  // In the order of ranks, so that among 0 and −0 the first one stays.
  for (std::size_t r = 0; r < all.size(); r += 6) {
    const Vec3d p{all[r], all[r + 1], all[r + 2]}, q{all[r + 3], all[r + 4], all[r + 5]};
    low = r == 0 ? p : Vec3d{std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = r == 0 ? q : Vec3d{std::max(high.x, q.x), std::max(high.y, q.y), std::max(high.z, q.z)};
  }
}

}  // namespace rastrum
