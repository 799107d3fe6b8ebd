// SPDX-License-Identifier: BSD-3-Clause
// A region that needs a single pass over everything.
#pragma once

#include <utility>

#include <papers/axes/region.hpp>

namespace rastrum::family {

class OnePassRegion : public Region {
 public:
  std::optional<Pass> next() override {
    if (std::exchange(done_, true)) return std::nullopt;
    return Pass{0, chunks_};
  }

 protected:
  void restart(std::size_t chunks) {
    chunks_ = chunks;
    done_ = false;
  }

 private:
  std::size_t chunks_ = 0;
  bool done_ = false;
};

}  // namespace rastrum::family
