// What an entrant cannot do is a cell of a table, not the end of the run.
#pragma once

#include <new>
#include <string>

#include <rastrum/error.hpp>

#include "contest.hpp"

namespace rastrum::bench {

/// What f returns, the reason why something is not run; or why f could not come to that.
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
