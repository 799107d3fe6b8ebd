// SPDX-License-Identifier: BSD-3-Clause
// Tests of an OpenGL peer, which are skipped, with the reason, if there is none.
#pragma once

#include <bench/peers/started.hpp>

#include <optional>

#include <gtest/gtest.h>

namespace rastrum::bench {

template <class P>
class GlFixture : public testing::Test {
 protected:
  void SetUp() override {
    if (!started_.peer) GTEST_SKIP() << started_.note;
  }

 private:
  Started<P> started_{2};

 protected:
  std::optional<P>& gl_ = started_.peer;
};

}  // namespace rastrum::bench
