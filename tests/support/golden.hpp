// SPDX-License-Identifier: BSD-3-Clause
// Golden pictures: few, small, in plain Git (tests/golden/NAME.png), compared exactly; and digests
// of pictures that need not be looked at (tests/golden/hashes.txt).
#pragma once

#include <string>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/image.hpp>

namespace rastrum::test {

/// Compares with tests/golden/NAME.png. A difference writes NAME.expected.png (if there is a
/// golden), NAME.actual.png and NAME.diff.png into golden-failures/ of the build folder, for `./dev
/// golden`. A match removes them.
[[nodiscard]] testing::AssertionResult matches_golden(const std::string& name,
                                                      const Image<Rgba8>& actual);

/// Compares with the line of `name` in tests/golden/hashes.txt. A difference writes
/// NAME.actual.sha256, which `./dev golden` accepts too.
[[nodiscard]] testing::AssertionResult matches_golden(const std::string& name,
                                                      const Digest& actual);

}  // namespace rastrum::test
