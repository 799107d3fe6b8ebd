// Checks that a call is refused, and in which words.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include <rastrum/error.hpp>

namespace rastrum::test {

/// That f() throws Error{code}, and that its message holds `part`.
template <class F>
void expect_refused(const char* part, Errc code, F&& f) {
  try {
    f();
    ADD_FAILURE() << part;
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), code) << e.what();
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}
template <class F>
void expect_refused(const char* part, F&& f) {
  expect_refused(part, Errc::invalid_argument, f);
}

}  // namespace rastrum::test
