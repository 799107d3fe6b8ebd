// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bindings.hpp"

namespace rastrum::python {

void bind_annotations(nb::module_& m);

}  // namespace rastrum::python
