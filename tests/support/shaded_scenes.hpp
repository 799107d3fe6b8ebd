// SPDX-License-Identifier: BSD-3-Clause
// Generated scenes with all that affects colours: every built-in shader, normals, colours and
// texture coordinates of any kind, materials, textures, layers, samples. Reproducible from a seed
// with every compiler: each statement draws one number.
#pragma once

#include <cstdint>

#include <rastrum/render.hpp>

#include "tests/support/scenes.hpp"

namespace rastrum::test {

struct ShadedScene : GeneratedScene {
  FrameOptions frame;
};

/// At most 200 triangles, or 4,000 in layers. The seed chooses the picture's size, 8 to 64 pixels.
[[nodiscard]] ShadedScene generate_shaded(std::uint64_t seed);

}  // namespace rastrum::test
