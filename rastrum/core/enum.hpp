// SPDX-License-Identifier: BSD-3-Clause
// Enums that come from a caller: a cast can give them a value that none of their names has.
#pragma once

#include <string>
#include <type_traits>

#include <rastrum/error.hpp>

namespace rastrum {

/// Throws Error{invalid_argument} that begins with `name` where `value` is above `last`, the last
/// of an enum whose values count from 0.
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
