// SPDX-License-Identifier: BSD-3-Clause
// Memory that is not there, as users of the library see it.
#pragma once

#include <new>

#include <rastrum/error.hpp>

namespace rastrum {

/// Returns f(). Throws Error{out_of_memory} in the place of std::bad_alloc: doors of the library
/// have this around what they do.
template <class F>
auto in_memory(const F& f) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
    throw Error(Errc::out_of_memory,
                "there is not enough memory; a smaller picture needs less, and so does a memory "
                "limit, by which it is drawn in pieces (RendererOptions::memory_limit, "
                "--memory-limit)");
  }
}

}  // namespace rastrum
