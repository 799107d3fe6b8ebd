// SPDX-License-Identifier: BSD-3-Clause
// Checks enums from callers: a cast can give them a value without a name.
#pragma once

#include <string>
#include <type_traits>

#include <rastrum/error.hpp>

namespace rastrum {

/// Throws Error{invalid_argument} that begins with `name` if `value` is above `last`. Requires that
/// the enum's values count from 0 to `last`.
template <class E>
void check_enum(E value, E last, const std::string& name) {
  static_assert(std::is_unsigned_v<std::underlying_type_t<E>>);
  if (value > last)
    throw Error(Errc::invalid_argument, name + " is " +
                                            std::to_string(static_cast<unsigned>(value)) +
                                            ", which is no value of its enum; the last one is " +
                                            std::to_string(static_cast<unsigned>(last)));
}

}  // namespace rastrum
