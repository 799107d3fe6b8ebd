// SPDX-License-Identifier: BSD-3-Clause
// Checks that a picture in several passes equals the picture in one, for any renderer.
#pragma once

#include <string_view>

#include <gtest/gtest.h>

#include "tests/support/painter.hpp"

namespace rastrum::test {

/// Draws a built-in shape at once, then in passes of unequal size onto each other, by visibility
/// keys (Pass::load) and by depth (Pass::over). With consecutive ids (Pass::first_id) all images
/// and keys must have the same bits.
[[nodiscard]] testing::AssertionResult passes_equal_one_draw(Painter& renderer,
                                                             std::string_view shape);

}  // namespace rastrum::test
