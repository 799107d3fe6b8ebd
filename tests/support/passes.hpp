// SPDX-License-Identifier: BSD-3-Clause
// A picture drawn in several passes is the picture drawn at once, for whatever draws.
#pragma once

#include <string_view>

#include <gtest/gtest.h>

#include "tests/support/painter.hpp"

namespace rastrum::test {

/// Draws a built-in shape at once, then in passes of unequal size, each onto the ones before: by
/// their visibility keys (Pass::load), and by their depth (Pass::over). With ids that count
/// on (Pass::first_id) all images are the same bits, the keys too.
[[nodiscard]] testing::AssertionResult passes_equal_one_draw(Painter& renderer,
                                                             std::string_view shape);

}  // namespace rastrum::test
