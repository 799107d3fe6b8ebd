// SPDX-License-Identifier: BSD-3-Clause
// A failed entrant costs a cell of a table, not the whole run.
#pragma once

#include <new>
#include <string>

#include <rastrum/error.hpp>

#include "contest.hpp"

namespace rastrum::bench {

/// Returns f's result: why something is not run, or "" if it is. If f throws, the error is that
/// reason.
template <class F>
[[nodiscard]] std::string attempt(F&& f) {
  try {
    return f();
  } catch (const Error& e) {
    return why_not(e);
  } catch (const std::bad_alloc&) {
    return "out of memory";
  }
}

}  // namespace rastrum::bench
