// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bindings.hpp"

namespace rastrum::python {

/// A NumPy array with any content. It reuses the memory of a dead array of its size (with dead
/// views), because new pages cost as much time as drawing into them. Keeps up to 128 MiB. `type`:
/// uint8, int32, int64 or float32. Throws Error{out_of_memory}.
[[nodiscard]] nb::ndarray<nb::numpy> empty(const std::vector<std::size_t>& shape,
                                           const std::string& type);

}  // namespace rastrum::python
