// SPDX-License-Identifier: BSD-3-Clause
// Where the tests' own files and the shared data lie. The paths are compiled into one file alone,
// so that a checkout elsewhere compiles the tests to the same objects, which ccache then has.
#pragma once

#include <filesystem>
#include <string>

namespace rastrum::test {

/// Real and malformed data beside the checkout, or where RASTRUM_SHARED says; may be absent. Tests
/// that want it skip, visibly, where it is.
[[nodiscard]] std::filesystem::path shared_dir();
[[nodiscard]] std::filesystem::path shared_data(const std::string& name);

[[nodiscard]] std::filesystem::path golden_dir();
/// The folder of the build into which failing goldens write.
[[nodiscard]] std::filesystem::path golden_failures_dir();

}  // namespace rastrum::test
