// SPDX-License-Identifier: BSD-3-Clause
// Reports exhausted memory to users of the library.
#pragma once

#include <new>

#include <rastrum/error.hpp>

namespace rastrum {

/// Returns f(). Throws Error{out_of_memory} instead of std::bad_alloc. Public functions wrap their
/// work in this.
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
