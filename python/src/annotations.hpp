// SPDX-License-Identifier: BSD-3-Clause
// Words, axes and effects over a picture, by name (rastrum/annotate.hpp).
#pragma once

#include "bindings.hpp"

namespace rastrum::python {

void bind_annotations(nb::module_& m);

}  // namespace rastrum::python
