// SPDX-License-Identifier: BSD-3-Clause
// The parts of fits that work alike for vertices on several ranks.
#pragma once

#include <cstddef>
#include <vector>

#include <rastrum/core/vectors.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// Calls f(). With ranks, it ends alike on all of them.
template <class F>
void own_work(FitRanks* ranks, const F& f) {
  if (ranks == nullptr)
    f();
  else
    ranks->own(f);
}

/// Widens a box to those of all ranks.
inline void gather_boxes(FitRanks* ranks, Box3d& box) {
  if (ranks == nullptr) return;
  const double own[] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
  const std::vector<double> all = ranks->gather(own);
  // In the order of ranks, so that of 0 and −0 the first stays.
  for (std::size_t r = 0; r < all.size(); r += 6) {
    const Box3d b{{all[r], all[r + 1], all[r + 2]}, {all[r + 3], all[r + 4], all[r + 5]}};
    if (r == 0)
      box = b;
    else
      box.add(b);
  }
}

}  // namespace rastrum
