// SPDX-License-Identifier: BSD-3-Clause
// for_each_share: what is found in one order, by each thread for the part that falls to it.
//
// Work O(threads · what all look at), span that of the looking and of the largest share. Better
// than a sort where the looking is cheap, and where what is near in memory mostly belongs together.
#pragma once

#include <cstddef>

#include <rastrum/parallel/exec.hpp>

namespace rastrum::parallel {

/// Calls f(share, shares) for each share in [0, shares), of which there are as many as threads.
template <class F>
void for_each_share(Serial&, F&& f) {
  f(std::size_t{0}, std::size_t{1});
}
template <class F>
void for_each_share(Threads& exec, F&& f) {
  const auto shares = static_cast<std::size_t>(exec.concurrency());
  for_each_index(exec, shares, [&](std::size_t share) { f(share, shares); });
}

/// Returns f(exec). For many things, each of which takes some 100 ns, `exec` has threads of its
/// own; a few things are done before threads have begun.
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
