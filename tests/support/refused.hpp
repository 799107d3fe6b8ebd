// SPDX-License-Identifier: BSD-3-Clause
// Checks that a call throws, and its message.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include <rastrum/error.hpp>

namespace rastrum::test {

[[nodiscard]] inline testing::AssertionResult holds(std::string_view text, std::string_view part) {
  return (text.find(part) != std::string_view::npos ? testing::AssertionSuccess()
                                                    : testing::AssertionFailure())
         << "'" << part << "' in: " << text.substr(0, 2000);
}

/// The message of the Error{code} that f() throws; empty if it throws none.
template <class F>
[[nodiscard]] std::string error_message_of(F&& f, Errc code = Errc::invalid_argument) {
  try {
    f();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), code) << e.what();
    return e.what();
  }
  return "";
}

/// The message of the Error{code} that f() must throw.
template <class F>
[[nodiscard]] std::string refusal_of(F&& f, Errc code = Errc::invalid_argument) {
  std::string said = error_message_of(f, code);
  EXPECT_NE(said, "") << "nothing was thrown";
  return said;
}

/// Expects that f() throws Error{code} with `part` in its message.
template <class F>
void expect_refused(const std::string& part, Errc code, F&& f) {
  const std::string said = refusal_of(f, code);
  EXPECT_TRUE(holds(said, part));
}
template <class F>
void expect_refused(const std::string& part, F&& f) {
  expect_refused(part, Errc::invalid_argument, f);
}

}  // namespace rastrum::test
