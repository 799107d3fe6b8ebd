// Pictures that stand in a scene: trees, signs, people as one quad with alpha.
#pragma once

#include <rastrum/scene/scene.hpp>

namespace rastrum {

/// A picture (straight alpha) as a quad 1 high and as wide as its proportions, standing on the
/// middle of its lower edge at the origin and facing +z; seen from both sides, unlit, blended by
/// its alpha. Throws Error{invalid_argument} for an empty picture.
[[nodiscard]] Scene sprite(Image<Rgba8> picture);

}  // namespace rastrum
