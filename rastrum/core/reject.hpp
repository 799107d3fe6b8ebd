// SPDX-License-Identifier: BSD-3-Clause
// Refuses arguments.
#pragma once

#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>

namespace rastrum {

/// Throws Error{invalid_argument} with text_of(parts...).
template <class... Parts>
[[noreturn]] void reject(const Parts&... parts) {
  throw Error(Errc::invalid_argument, text_of(parts...));
}

/// The same unless `ok`. The condition says what must hold, so that a NaN fails.
template <class... Parts>
void require(bool ok, const Parts&... parts) {
  if (!ok) reject(parts...);
}

}  // namespace rastrum
