// SPDX-License-Identifier: BSD-3-Clause
// layers: every fragment of a pixel in order, for transparency and several samples a pixel. This
// makes the renderer's own method (transparency/layers.hpp) a region, for other coverages whose
// threads own tiles.
#pragma once

#include <papers/axes/region.hpp>

namespace rastrum::family {

[[nodiscard]] const Visibility& layers() noexcept;

}  // namespace rastrum::family
