// SPDX-License-Identifier: BSD-3-Clause
// Generated scenes with all that can have a colour: every built-in shader, normals, colours and
// texture coordinates of any kind, materials, textures, layers, samples. Reproducible from a seed,
// by every compiler: numbers are drawn one a statement.
#pragma once

#include <cstdint>

#include <rastrum/render.hpp>

#include "tests/support/scenes.hpp"

namespace rastrum::test {

struct ShadedScene : GeneratedScene {
  FrameOptions frame;
};

/// At most 200 triangles, or 4,000 of layers. The picture's size is the seed's, 8 to 64 pixels.
[[nodiscard]] ShadedScene generate_shaded(std::uint64_t seed);

}  // namespace rastrum::test
