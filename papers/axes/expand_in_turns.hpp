// SPDX-License-Identifier: BSD-3-Clause
// An expansion that keeps its results in memory, in turns that fit into the frame's memory limit.
// Without a limit there is one turn.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include <papers/axes/frame.hpp>
#include <rastrum/parallel/expand.hpp>

namespace rastrum::family {

/// Calls f(results) at least once, for consecutive parts of expand(in, size, get). `result_bytes`
/// is what f needs for a result, the result included. A turn has at least one chunk of the
/// expansion. Work O(n + total + f's). Returns the number of results.
template <class In, class Size, class Get, class F>
std::uint64_t expand_in_turns(Frame& frame, const In& in, Size&& size, Get&& get,
                              std::uint64_t result_bytes, F&& f) {
  using Result = parallel::expanded_t<In, Get>;
  const parallel::Expansion expansion(frame.exec, in, size);
  const std::size_t most = frame.expansion_bytes == 0
                               ? std::numeric_limits<std::size_t>::max()
                               : static_cast<std::size_t>(frame.expansion_bytes / result_bytes);
  const std::size_t chunks_at_once = std::max<std::size_t>(most / expansion.per_chunk(), 1);
  std::size_t first = 0;
  do {  // also runs without results: f draws tiles that have none
    const std::size_t last = first + std::min(chunks_at_once, expansion.chunks() - first);
    const std::size_t begin = expansion.chunk_begin(first);
    auto results = parallel::make_buffer<Result>(
        frame.exec, std::min(expansion.size(), expansion.chunk_begin(last)) - begin);
    parallel::for_each_index(frame.exec, last - first, [&](std::size_t c) {
      const parallel::ExpansionChunk<In> chunk(expansion, in, first + c);
      std::size_t k = chunk.begin() - begin;
      chunk.each([&](const auto& x, std::size_t j) { results[k++] = get(x, j); });
    });
    f(std::as_const(results));
    first = last;
  } while (first < expansion.chunks());
  return expansion.size();
}

}  // namespace rastrum::family
