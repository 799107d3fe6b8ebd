// SPDX-License-Identifier: BSD-3-Clause
// Memory for the arrays of frames, from one to the next.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bindings.hpp"

namespace rastrum::python {

/// An array of NumPy's whose numbers are whatever they are. Where arrays of its size have died (and
/// all views of theirs), it lies where one of them lay: pages that are new cost as much time as
/// drawing into them. Up to 128 MiB are kept so. `type`: uint8, int32, int64 or float32. Throws
/// Error{out_of_memory}.
[[nodiscard]] nb::ndarray<nb::numpy> empty(const std::vector<std::size_t>& shape,
                                           const std::string& type);

}  // namespace rastrum::python
