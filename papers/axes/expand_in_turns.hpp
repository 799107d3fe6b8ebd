// SPDX-License-Identifier: BSD-3-Clause
// An expansion whose results are wanted in memory, but not more of them at once than a frame's
// limit leaves room for: expand, a turn at a time. Without a limit there is one turn, and this is
// expand.
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

/// Calls f(results) for consecutive parts of expand(in, size, get), at least once; `result_bytes`
/// is what f needs for each result, the result included. A turn is never smaller than one chunk of
/// an expansion. Work O(n + total + f's). Returns how many results there were.
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
  do {  // once without results too: tiles without any are drawn
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
