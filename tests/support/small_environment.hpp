// SPDX-License-Identifier: BSD-3-Clause
// Our own skies of 2,048 pixels: to make a light of one costs a sixteenth of what one of 32,768 and
// more does, which is 0.3 s of a core and 9 s of one under a sanitizer. For tests that want a sky,
// whichever.
#pragma once

#include <rastrum/environment.hpp>
#include <rastrum/image.hpp>

#include "tests/support/pixels.hpp"

namespace rastrum::test {

/// 64 × 32.
[[nodiscard]] inline Image<Vec3> small_environment(BuiltinEnvironment which) {
  constexpr int kStep = 16;
  const Image<Vec3> all = builtin_environment(which);
  Image<Vec3> picture(all.width() / kStep, all.height() / kStep);
  for (const auto& [x, y] : pixels(picture.width(), picture.height()))
    picture(x, y) = all(kStep * x + kStep / 2, kStep * y + kStep / 2);
  return picture;
}

}  // namespace rastrum::test
