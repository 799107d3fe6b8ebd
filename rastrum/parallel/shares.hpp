// SPDX-License-Identifier: BSD-3-Clause
// for_each_share: each thread looks at everything, in order, and works on its own share.
//
// Work O(threads · all elements), span that of looking at all plus the largest share. Better than a
// sort if looking is cheap, and if neighbours in memory mostly belong to the same share.
#pragma once

#include <cstddef>

#include <rastrum/parallel/exec.hpp>

namespace rastrum::parallel {

/// Calls f(share, shares) for each share in [0, shares); there are as many shares as threads.
template <class F>
void for_each_share(Serial&, F&& f) {
  f(std::size_t{0}, std::size_t{1});
}
template <class F>
void for_each_share(Threads& exec, F&& f) {
  const auto shares = static_cast<std::size_t>(exec.concurrency());
  for_each_index(exec, shares, [&](std::size_t share) { f(share, shares); });
}

/// Returns f(exec). `exec` has its own threads if there are many things, each of some 100 ns; for
/// few it is serial, because starting threads takes longer.
template <class F>
decltype(auto) on_threads_of_its_own(std::size_t things, F&& f) {
  constexpr std::size_t kFew = std::size_t{1} << 15;
  if (things < kFew) {
    Serial serial;
    return f(serial);
  }
  Threads threads;
  return f(threads);
}

}  // namespace rastrum::parallel
