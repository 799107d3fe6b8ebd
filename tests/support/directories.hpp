// SPDX-License-Identifier: BSD-3-Clause
// The folders of the tests' own files and of the shared data. Only one file contains the paths, so
// that other checkouts compile the tests to the same objects, which ccache finds.
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
